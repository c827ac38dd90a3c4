"""Steps: events, required friction, slips, and whether a step can be believed."""
