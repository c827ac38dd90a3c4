"""Compiled loops of the block's finite elements."""
