"""Pure array functions of the statistics."""
