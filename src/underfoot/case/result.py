"""What every run returns: scalars with uncertainty, fields, status, breaches and provenance."""

from __future__ import annotations

import csv
import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from underfoot.core import DataError, Provenance, SourcedValue, Status
from underfoot.core.files import whole_folder

if TYPE_CHECKING:
    import xarray

FORMAT = 1


@dataclass(frozen=True, slots=True)
class Result:
    """A finished computation of one case.

    Attributes
    ----------
    name
        Name of the case.
    scalars
        Named values in SI with uncertainty (or the reason for its absence) and "assumed" marks.
    labels
        Named words, such as the lubrication regime.
    fields
        Maps and histories as a labelled data set, CF-style names and units.
    status
        How the computation ended; anything not ``usable`` is not a result.
    breaches
        Inputs outside the range on which a closure was tested, in words.
    assumptions
        What no measurement or publication stands behind, in words.
    provenance
        Case hash, versions, closures, citations, errata and timings.
    case_text
        The complete case as TOML.
    """

    name: str
    scalars: dict[str, SourcedValue]
    labels: dict[str, str]
    fields: xarray.Dataset
    status: Status
    breaches: tuple[str, ...]
    assumptions: tuple[str, ...]
    provenance: Provenance
    case_text: str

    def value(self, name: str) -> float:
        """Return a scalar's number; an error when it was not determined or is not a result."""
        scalar = self.scalars[name]
        if scalar.value is None:
            raise DataError(f"{name} was not determined: {scalar.reason}", where=self.name)
        if not self.status.usable:
            raise DataError(
                f"{name} is not a result: {self.status}", where=self.name, remedy=self.status.remedy
            )
        return scalar.value

    def as_dict(self) -> dict[str, Any]:
        """Return plain data: every scalar an object with value, unit, uncertainty, assumed."""
        scalars = {name: value.as_dict() for name, value in self.scalars.items()}
        status = {
            "value": str(self.status),
            "unit": None,
            "uncertainty": None,
            "reason": self.status.remedy,
            "assumed": False,
        }
        return {
            "format": FORMAT,
            "name": self.name,
            "status": status,
            **scalars,
            "labels": self.labels,
            "breaches": list(self.breaches),
            "assumptions": list(self.assumptions),
            "provenance": self.provenance.as_dict(),
        }

    def save(self, folder: Path | str, *, overwrite: bool = False) -> Path:
        """Write ``folder`` as a whole: case.toml, result.nc, summary.csv and result.json."""
        folder = Path(folder)
        with whole_folder(folder, overwrite=overwrite) as staging:
            self.write_files(staging)
        return folder

    def write_files(self, folder: Path) -> None:
        """Write the result's own files into an existing folder."""
        (folder / "case.toml").write_text(self.case_text, encoding="utf-8")
        text = json.dumps(self.as_dict(), indent=2, ensure_ascii=False)
        (folder / "result.json").write_text(text + "\n", encoding="utf-8")
        dataset = self.fields.assign_attrs(
            Conventions="CF-1.11",
            title=self.name,
            source=f"underfoot {self.provenance.versions.get('underfoot', '')}".strip(),
            history=f"{self.provenance.created} computed from case {self.provenance.case_hash}",
            status=str(self.status),
        )
        encoding: dict[Any, dict[str, Any]] = {
            name: {"zlib": True, "complevel": 4, "shuffle": True}
            for name, variable in dataset.data_vars.items()
            if variable.ndim
        }
        dataset.to_netcdf(folder / "result.nc", engine="h5netcdf", encoding=encoding)
        with (folder / "summary.csv").open("w", newline="", encoding="utf-8") as stream:
            table = csv.writer(stream)
            table.writerow("quantity value unit uncertainty low_95 high_95 assumed remark".split())
            table.writerow(["status", str(self.status), *[""] * 5, self.status.remedy])
            for name, scalar in self.scalars.items():
                remark = scalar.note or (scalar.reason if scalar.uncertainty is None else "")
                table.writerow(
                    [
                        name,
                        "" if scalar.value is None else repr(scalar.value),
                        scalar.unit,
                        "" if scalar.uncertainty is None else repr(scalar.uncertainty),
                        *(("", "") if scalar.interval is None else map(repr, scalar.interval)),
                        "yes" if scalar.assumed else "no",
                        remark,
                    ]
                )

    @classmethod
    def load(cls, folder: Path | str) -> Result:
        """Read a result folder back.

        Errors
        ------
        DataError
            The folder is no result, is damaged or was written by a newer version.
        """
        import xarray

        folder = Path(folder)
        try:
            stored = json.loads((folder / "result.json").read_text(encoding="utf-8"))
            case_text = (folder / "case.toml").read_text(encoding="utf-8")
            with xarray.open_dataset(folder / "result.nc", engine="h5netcdf") as dataset:
                fields = dataset.load()
            if stored["format"] > FORMAT:
                raise DataError(
                    f"written by a newer version (format {stored['format']})",
                    where=str(folder),
                    allowed=f"format {FORMAT} or older",
                    remedy="Update underfoot",
                )
            reserved = {"format", "name", "status", "labels", "breaches", "assumptions"}
            scalars = {
                name: SourcedValue(**entry)
                for name, entry in stored.items()
                if name not in reserved | {"provenance"}
            }
            provenance = dict(stored["provenance"])
            for key in ("citations", "errata"):
                provenance[key] = tuple(provenance[key])
            return cls(
                name=stored["name"],
                scalars=scalars,
                labels=stored["labels"],
                fields=fields,
                status=Status(stored["status"]["value"]),
                breaches=tuple(stored["breaches"]),
                assumptions=tuple(stored["assumptions"]),
                provenance=Provenance(**provenance),
                case_text=case_text,
            )
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise DataError(
                f"can't be read as a result ({error})",
                where=str(folder),
                allowed="a folder with case.toml, result.json and result.nc",
                remedy="Run the case again with --out",
            ) from error
