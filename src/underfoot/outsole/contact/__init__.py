"""Coupled contact of a sole with a flooded floor: Newton, preconditioner and time stepping."""
