"""Measured cost, memory and scaling, beside named peers or physical limits in the same run."""
