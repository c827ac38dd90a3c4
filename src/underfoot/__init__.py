"""Underfoot: the friction between a shoe, a floor and what is spilled on it."""
