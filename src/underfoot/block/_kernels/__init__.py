"""Compiled kernels of the block; they need Numba: without it a march would take days."""

from underfoot.core.optional import optional_module

optional_module("numba", "fast", "the block of finite elements")
