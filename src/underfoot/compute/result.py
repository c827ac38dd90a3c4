"""What every run returns: scalars with uncertainty, fields, status, breaches and provenance."""

from __future__ import annotations

import csv
import json
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from underfoot.core import DataError, Provenance, SourcedValue, Status, UnderfootError, unknown_name
from underfoot.core.fields import Fields, from_xarray
from underfoot.core.files import checksum, whole_folder
from underfoot.core.presentation import Presentable, Table, value_text
from underfoot.core.remark import NOTHING, Message, Remark, from_stored, stored_form

from . import summary

if TYPE_CHECKING:
    import pandas
    import xarray

FORMAT = 1
FIELDS_FILE = "result.nc"


class IncompleteOutput(UserWarning):
    """A file of a result could not be written; the others are on disk."""


@dataclass(frozen=True, slots=True)
class Result(Presentable):
    """A finished computation of one case.

    Attributes:
        name: Name of the case.
        scalars: Named values in SI with uncertainty (or the reason for its absence) and "assumed"
            marks.
        labels: Named words, such as the lubrication regime.
        data: Maps and histories with axes, CF-style names and units; ``fields`` is their data set.
        status: How the computation ended; anything not ``usable`` is not a result.
        breaches: Inputs outside the range on which a closure was tested, in words.
        assumptions: What no measurement or publication stands behind, in words.
        provenance: Case hash, versions, closures, citations, errata and timings.
        case_text: The complete case as TOML.
    """

    kind: ClassVar[str] = "result"

    name: str
    scalars: dict[str, SourcedValue]
    labels: dict[str, str]
    data: Fields
    status: Status
    breaches: tuple[Remark, ...]
    assumptions: tuple[Remark, ...]
    provenance: Provenance
    case_text: str

    def __repr__(self) -> str:
        cof = value_text("cof", self.scalars["cof"])
        slots = ", ".join(self.provenance.objects)
        marks = f", {slots} given as object" if slots else ""
        return f"<Result {self.name!r:.80}: COF {cof:.60}, {self.status}{marks:.40}>"

    @property
    def usable(self) -> bool:
        return self.status.usable

    @property
    def fields(self) -> xarray.Dataset:
        """Return maps and histories as a labelled data set of xarray."""
        return self.data.to_xarray()

    def headline(self) -> tuple[Message, ...]:
        return summary.headline(self.status, self.scalars, self.labels)

    def verdict(self) -> tuple[str, Message]:
        """Return "grips", "doubtful" or "slips", and what it means for steps; empty if unknown."""
        return summary.verdict_sentence(self.scalars, self.labels) if self.usable else ("", NOTHING)

    def cautions(self) -> tuple[str, ...]:
        slip_model = self.provenance.closures.get("slip", "")
        inputs = (self.breaches, self.assumptions, slip_model, self.labels)
        return summary.cautions(self.status, self.scalars, *inputs)

    def table(self) -> Table:
        return summary.table(self.scalars, self.labels)

    def tables(self) -> tuple[Table, ...]:
        """Return the table of a usable result; numbers that are no result are not printed."""
        if not self.usable:
            return ()
        drainage = (summary.drainage_table(self.data),) if "drainage" in self.labels else ()
        return (self.table(), *drainage)

    def remarks(self) -> dict[str, Sequence[str]]:
        """Return notes, tested ranges that were left, and assumptions, the decisive ones first."""
        return {
            "Notes": summary.notes(self.labels),
            "Outside the tested range": summary.in_words(self.breaches),
            "Assumptions": summary.ranked_assumptions(self.assumptions),
        }

    def __str__(self) -> str:
        return self.summary()

    def __getitem__(self, name: str) -> SourcedValue:
        """Return a scalar with its unit, uncertainty, interval and source.

        Raises:
            InputError: No scalar of this name; the nearest one is named.
        """
        if name not in self.scalars:
            raise unknown_name("quantity", name, self.scalars, where=self.name)
        return self.scalars[name]

    def to_frame(self) -> pandas.DataFrame:
        """Return every scalar as numbers in SI, a row each.

        Returns:
            Index: name of the scalar. Columns: ``value``, ``unit`` (SI), ``uncertainty`` (one
            standard deviation), ``low`` and ``high`` (ends of the central 95 %), nan where not
            known, ``assumed``, ``source`` and ``note`` (the reason where there is no number).
        """
        import pandas

        rows = {}
        for name, scalar in self.scalars.items():
            low, high = scalar.interval or (None, None)
            rows[name] = {
                "value": scalar.value,
                "unit": scalar.unit,
                "uncertainty": scalar.uncertainty,
                "low": low,
                "high": high,
                "assumed": scalar.assumed,
                "source": scalar.source,
                "note": scalar.note or (scalar.reason if scalar.uncertainty is None else ""),
            }
        frame = pandas.DataFrame.from_dict(rows, orient="index").rename_axis("quantity")
        numbers = ["value", "uncertainty", "low", "high"]
        return frame.astype(dict.fromkeys(numbers, float))

    def value(self, name: str) -> float:
        """Return a scalar's number in SI.

        Raises:
            InputError: No scalar of this name.
            DataError: It was not determined, or the computation is no result.
        """
        scalar = self[name]
        if scalar.value is None:
            raise DataError(
                Message("{name} was not determined: {reason}", name=name, reason=scalar.reason),
                where=self.name,
            )
        if not self.status.usable:
            raise DataError(
                Message("{name} is not a result: {status}", name=name, status=self.status),
                where=self.name,
                remedy=self.status.remedy,
            )
        return scalar.value

    def to_dict(self) -> dict[str, Any]:
        """Return plain data: every scalar an object with value, unit, uncertainty, assumed."""
        scalars = {name: value.to_dict() for name, value in self.scalars.items()}
        status = {"value": str(self.status), "unit": None, "uncertainty": None}
        status |= {"reason": self.status.remedy, "assumed": False}
        return {
            "format": FORMAT,
            "name": self.name,
            "status": status,
            **scalars,
            "labels": stored_form(self.labels),
            "breaches": stored_form(self.breaches),
            "assumptions": stored_form(self.assumptions),
            "provenance": self.provenance.to_dict(),
        }

    def save(self, folder: Path | str, *, overwrite: bool = False) -> Path:
        """Write ``folder`` as a whole: case.toml, result.json, summary.csv and result.nc.

        A file that can't be written (a missing package, a full disk) costs no other: a warning
        says what is missing and why, and the folder holds the rest.
        """
        folder = Path(folder)
        with whole_folder(folder, overwrite=overwrite) as staging:
            self.write_files(staging)
        return folder

    def write_files(self, folder: Path) -> None:
        """Write the result's own files into an existing folder."""
        failures: dict[str, Exception] = {}
        writers = self.writers()
        for name, write in writers.items():
            try:
                write(folder / name)
            except (ImportError, OSError, ValueError) as error:
                (folder / name).unlink(missing_ok=True)
                failures[name] = error
        if len(failures) == len(writers):
            raise next(iter(failures.values()))
        for name, error in failures.items():
            remedy = "Free some space or choose another folder"
            if isinstance(error, ImportError | ValueError):
                remedy = "Install the missing package (pip install h5netcdf h5py)"
            message = f"{name} of {self.name} was not written: {error}. {remedy}, and save again."
            warnings.warn(message, IncompleteOutput, stacklevel=3)

    def writers(self) -> dict[str, Callable[[Path], None]]:
        """Return the function that writes each of the result's own files."""
        return {
            "case.toml": lambda path: _write_text(path, self.case_text),
            FIELDS_FILE: self._write_fields,
            "result.json": self._write_numbers,  # with the checksum of the fields
            "summary.csv": self._write_summary,
        }

    def _write_numbers(self, path: Path) -> None:
        fields = path.with_name(FIELDS_FILE)
        known = {"fields_sha256": checksum(fields)} if fields.exists() else {}
        text = json.dumps(self.to_dict() | known, indent=2, ensure_ascii=False)
        _write_text(path, text + "\n")

    def _write_fields(self, path: Path) -> None:
        self.data.to_netcdf(
            path,
            Conventions="CF-1.11",
            title=self.name,
            source=f"underfoot {self.provenance.versions.get('underfoot', '')}".strip(),
            history=f"{self.provenance.created} computed from case {self.provenance.case_hash}",
            status=str(self.status),
        )

    def _write_summary(self, path: Path) -> None:
        with path.open("w", newline="", encoding="utf-8") as stream:
            table = csv.writer(stream)
            table.writerow("quantity value unit uncertainty low_95 high_95 assumed remark".split())
            table.writerow(["status", str(self.status), *[""] * 5, self.status.remedy])
            for name, scalar in self.scalars.items():
                remark = scalar.note or (scalar.reason if scalar.uncertainty is None else "")
                low, high = scalar.interval or (None, None)
                value, *spread = (
                    "" if number is None else repr(number)
                    for number in (scalar.value, scalar.uncertainty, low, high)
                )
                assumed = "yes" if scalar.assumed else "no"
                table.writerow([name, value, scalar.unit, *spread, assumed, remark])

    @classmethod
    def load(cls, folder: Path | str, *, with_fields: bool = True) -> Result:
        """Read a result folder back; without its maps and histories in a hundredth of the time.

        Raises:
            DataError: The folder is no result, is damaged or was written by a newer version.
        """
        import h5py
        import xarray

        folder = Path(folder)
        try:
            stored = json.loads((folder / "result.json").read_text(encoding="utf-8"))
            case_text = (folder / "case.toml").read_text(encoding="utf-8")
            fields = Fields()
            if with_fields and (folder / FIELDS_FILE).exists():
                digest = stored.get("fields_sha256")
                if digest and checksum(folder / FIELDS_FILE) != digest:  # HDF5 may read for ever
                    raise DataError(
                        f"{FIELDS_FILE} is not the file that was written: damaged or changed",
                        where=str(folder),
                        remedy="Run the case again with --out",
                    )
                h5py.File(folder / FIELDS_FILE).close()  # refuses a damaged one without a trace
                with xarray.open_dataset(folder / FIELDS_FILE, engine="h5netcdf") as dataset:
                    fields = from_xarray(dataset)
            if stored["format"] > FORMAT:
                raise DataError(
                    Message(
                        "written by a newer version (format {format})", format=stored["format"]
                    ),
                    where=str(folder),
                    allowed=Message("format {format} or older", format=FORMAT),
                    remedy="Update underfoot",
                )
            reserved = "format name status labels breaches assumptions provenance".split()
            scalars = {
                name: _from_known_fields(SourcedValue, entry)
                for name, entry in stored.items()
                if name not in reserved and isinstance(entry, dict) and "value" in entry
            }
            provenance = dict(stored["provenance"])
            for key in ("citations", "errata"):
                provenance[key] = tuple(provenance.get(key, ()))
            return cls(
                name=stored["name"],
                scalars=scalars,
                labels=from_stored(stored["labels"]),
                data=fields,
                status=Status(stored["status"]["value"]),
                breaches=tuple(map(Remark.from_stored, stored["breaches"])),
                assumptions=tuple(map(Remark.from_stored, stored["assumptions"])),
                provenance=_from_known_fields(Provenance, provenance),
                case_text=case_text,
            )
        except UnderfootError:
            raise
        except Exception as error:  # of JSON, netCDF and HDF5, whatever a damaged byte meets
            raise DataError(
                "can't be read as a result: a file is missing or damaged",
                where=str(folder),
                allowed="a folder with case.toml, result.json and result.nc",
                remedy="Run the case again with --out",
            ) from error


def _from_known_fields(cls: Any, entry: dict[str, Any]) -> Any:
    """Return an object of what it knows in an entry, which another version may have written."""
    return cls(**{field.name: entry[field.name] for field in fields(cls) if field.name in entry})


def _write_text(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8")
