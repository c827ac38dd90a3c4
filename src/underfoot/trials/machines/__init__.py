"""Slip testers, tribometers, pressure sensors: from a record to their numbers."""
