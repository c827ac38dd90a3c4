"""Labelled arrays on named axes: what a data set of xarray holds, without its import.

A run needs names, axes, units and a netCDF file. xarray (with pandas) takes longer to import than a
quick march takes to solve, so it is imported where a person asks for the data set.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import xarray

COMPRESSION = {"compression": "gzip", "compression_opts": 4, "shuffle": True}


@dataclass(frozen=True, slots=True)
class Field:
    """An array with the names of its axes and its attributes (``units``, ``long_name``)."""

    dims: tuple[str, ...]
    values: NDArray[Any]
    attrs: Mapping[str, Any] = field(default_factory=dict)

    @property
    def dtype(self) -> np.dtype[Any]:
        """Return the type of the values."""
        return self.values.dtype

    @property
    def ndim(self) -> int:
        """Return the number of axes."""
        return self.values.ndim

    @property
    def size(self) -> int:
        """Return the number of values."""
        return self.values.size

    def transpose(self, *dims: str) -> Field:
        """Return the field with its axes in the order given."""
        if dims == self.dims:
            return self
        return Field(dims, self.values.transpose([self.dims.index(name) for name in dims]))

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        return np.array(self.values, dtype) if copy else np.asarray(self.values, dtype)


@dataclass(frozen=True, slots=True)
class Fields:
    """Named fields and the coordinates of their axes; reads as ``xarray.Dataset`` does."""

    data_vars: Mapping[str, Field] = field(default_factory=dict)
    coords: Mapping[str, Field] = field(default_factory=dict)

    def __getitem__(self, name: str) -> Field:
        return self.data_vars[name] if name in self.data_vars else self.coords[name]

    def __contains__(self, name: object) -> bool:
        return name in self.data_vars or name in self.coords

    def get(self, name: str) -> Field | None:
        """Return the field of a name, None where there is none."""
        return self.data_vars.get(name, self.coords.get(name))

    @property
    def sizes(self) -> dict[str, int]:
        """Return the length of each axis."""
        return {
            name: length
            for each in (*self.data_vars.values(), *self.coords.values())
            for name, length in zip(each.dims, each.values.shape, strict=True)
        }

    def assign(self, further: Mapping[str, tuple[Any, ...]]) -> Fields:
        """Return these fields and further ones, each (axes, values, attributes) by name."""
        return Fields({**self.data_vars, **_fields(further)}, self.coords)

    def to_xarray(self, **attributes: str) -> xarray.Dataset:
        """Return the data set of xarray."""
        import xarray

        parts = (
            {name: (each.dims, each.values, dict(each.attrs)) for name, each in group.items()}
            for group in (self.data_vars, self.coords)
        )
        return xarray.Dataset(*parts, attrs=attributes)

    def to_netcdf(self, path: Path, **attributes: str) -> None:
        """Write a netCDF 4 file, deflated; truth values as xarray writes and reads them."""
        import h5netcdf

        with h5netcdf.File(path, "w") as file:
            file.dimensions = self.sizes
            file.attrs.update(attributes)
            for name, each in (*self.coords.items(), *self.data_vars.items()):
                truth = each.dtype == bool
                values = each.values.astype(np.int8) if truth else each.values
                options = COMPRESSION if each.ndim else {}
                stored = file.create_variable(name, each.dims, values.dtype, values, **options)
                stored.attrs.update({**each.attrs, **({"dtype": "bool"} if truth else {})})


def labelled_fields(
    variables: Mapping[str, tuple[Any, ...]], coords: Mapping[str, tuple[Any, ...]]
) -> Fields:
    """Return fields of (axis or axes, values, attributes) by name."""
    return Fields(_fields(variables), _fields(coords))


def from_xarray(dataset: xarray.Dataset) -> Fields:
    """Return the fields of a data set of xarray."""
    data, coords = (
        {
            str(name): Field(tuple(map(str, each.dims)), each.values, dict(each.attrs))
            for name, each in group.items()
        }
        for group in (dataset.data_vars, dataset.coords)
    )
    return Fields(data, coords)


def _fields(given: Mapping[str, tuple[Any, ...]]) -> dict[str, Field]:
    return {
        name: Field((dims,) if isinstance(dims, str) else tuple(dims), np.asarray(values), *rest)
        for name, (dims, values, *rest) in given.items()
    }
