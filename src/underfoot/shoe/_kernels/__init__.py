"""Pure functions of arrays for the outsole."""
