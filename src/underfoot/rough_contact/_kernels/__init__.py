"""Pure functions of arrays behind the rough-contact solvers."""
