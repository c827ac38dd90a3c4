"""Heights as files of surface metrology: X3P and SDF, which other programs read."""

from pathlib import Path

import numpy as np

from underfoot.core import InputError
from underfoot.core.files import whole_file

from .heights import HeightMap, Profile

FORMS = (".x3p", ".sdf")
"""Endings of files that ``write_surface`` writes."""


def write_surface(surface: Profile | HeightMap, path: Path | str) -> None:
    """Write the heights of a profile or a map, in double precision.

    Parameters:
        surface: As it was read or made; what it was processed by is not in the file.
        path: ``.x3p`` (ISO 5436-2:2000, which all readers of X3P take) or ``.sdf`` (ISO 25178-71,
            version ISO-1.0; a profile is a map of one row).

    Raises:
        InputError: Another ending.
    """
    import sdfio
    import x3pio

    path = Path(path)
    if path.suffix.casefold() not in FORMS:
        raise InputError(
            f'"{path.suffix}" is no ending of a file of heights',
            where=str(path),
            allowed=" or ".join(FORMS),
        )
    rows = np.ascontiguousarray(surface.heights.T)  # along x first in both formats
    along, across = surface.spacings[0], surface.spacings[-1]
    with whole_file(path) as part:
        if path.suffix.casefold() == ".x3p":
            revision = x3pio.Revision.ISO5436_2000
            scale = across if isinstance(surface, HeightMap) else None
            x3pio.write(part, rows, x_scale=along, y_scale=scale, revision=revision)
        else:
            head = sdfio.Metadata(revision=sdfio.Revision.ISO_1_0, manufacturer_id="Underfoot")
            sdfio.write(part, np.atleast_2d(rows), x_scale=along, y_scale=across, metadata=head)
