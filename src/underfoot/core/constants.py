"""Physical constants, SI."""

GRAVITY = 9.80665
"""Standard gravity, m/s^2 (3rd CGPM, 1901): exact by definition."""
