"""Heights and profiles: read, level, filter, roughness numbers, spectrum, generate."""

from .height_map import HeightMap
from .self_affine import self_affine

__all__ = ["HeightMap", "self_affine"]
