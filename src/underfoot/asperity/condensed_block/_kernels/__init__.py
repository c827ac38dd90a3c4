"""Pure functions of arrays: element stiffness, active sets."""
