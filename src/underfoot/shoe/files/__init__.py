"""Outsoles from files (CAD, meshes, scans) to a height map in the sole's frame."""

from .mesh import Mesh as Mesh
from .outsole import FileOutsole as FileOutsole
from .outsole import outsole_from_file as outsole_from_file
from .outsole import outsole_from_mesh as outsole_from_mesh
from .read import read_mesh as read_mesh
from .settings import FileSettings as FileSettings
