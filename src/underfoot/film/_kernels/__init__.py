"""Pure functions of arrays for the film."""
