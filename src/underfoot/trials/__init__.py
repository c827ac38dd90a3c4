"""Measurements: files to trials, trials to the numbers the field publishes."""

from .measurement import Measurement
from .trial import Channel, Edit, Event, Marker, Plate, Trial, file_checksum

__all__ = [
    "Channel",
    "Edit",
    "Event",
    "Marker",
    "Measurement",
    "Plate",
    "Trial",
    "file_checksum",
]
