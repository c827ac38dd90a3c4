"""Pure array functions of the measurements."""
