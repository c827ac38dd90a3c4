"""The table of file formats: how each is recognised, and what reads it.

A reader is one function and one entry; other packages add their own one by one
(``trial_readers``, ``docs/extending.md``).
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path
from typing import Any

from underfoot.core import DataError
from underfoot.core.remark import Message
from underfoot.core.text import utf16_of


@dataclass(frozen=True, slots=True)
class TrialReader:
    """One format of files.

    ``address``: the reader as "package.module:function"; it takes a ``Draft`` and returns a
    ``Trial`` or several, and is imported when a file of the format is read. Empty for a format
    that is known and not read; ``remedy`` then says what to do. ``marks``: regular expressions, one
    of which the first 4096 characters hold (casefolded, ``^`` at each line, ``\\A`` at the file).
    ``magic``: first bytes of a binary file. ``suffixes``: endings of names, which decide where no
    mark does.
    """

    name: str
    address: str
    marks: tuple[str, ...] = ()
    magic: tuple[bytes, ...] = ()
    suffixes: tuple[str, ...] = ()
    remedy: str = ""

    def recognises(self, data: bytes, text: str) -> bool:
        """True when the first bytes, or the first characters (casefolded), are of this format."""
        return data.startswith(self.magic or (b"\xff\xff\xff\xff none",)) or any(
            re.search(mark, text, re.MULTILINE) for mark in self.marks
        )

    def function(self, draft: Any) -> Any:
        """Return what the reader makes of a draft; a DataError for a format that is not read."""
        if not self.address:
            raise DataError(Message("{name} is not read", name=self.name), remedy=self.remedy)
        module, _, name = self.address.partition(":")
        return getattr(import_module(module), name)(draft)


_HERE = "underfoot.trials.readers."
C3D = TrialReader("C3D", _HERE + "c3d:read_c3d", suffixes=(".c3d",))
TABLE = TrialReader(
    "table", _HERE + "columns:read_columns", magic=(b"PK\x03\x04", b"\xd0\xcf\x11\xe0"),
    suffixes=(".txt", ".csv", ".tsv", ".dat", ".xlsx", ".xls", ".asc"),
)  # fmt: skip


_EXPORT = "Export the recording as C3D, or as text with column names"
_MARKERS = "Export the markers as C3D or TRC, and the forces of the plates"
_INSOLE = "It holds the load of insoles and no shear: RCOF needs a force plate (C3D, text)"
_SENSORS = (
    "Turns and accelerations hold no places: export C3D or MVNX, and the forces of the plates"
)
_EXPORTS = _HERE + "text_exports:"
READERS = (
    TrialReader("TRC", _EXPORTS + "read_trc", (r"\Apathfiletype",), suffixes=(".trc",)),
    TrialReader(
        "Cortex", _EXPORTS + "read_cortex_forces", (r"\A.{0,90}\[force data\]",),
        suffixes=(".forces",),
    ),
    TrialReader(
        "Qualisys", _EXPORTS + "read_qualisys", (r"\Ano_of_frames", r"\Ano_of_samples")
    ),
    TrialReader(
        "Vicon", _EXPORTS + "read_vicon_csv",
        (r'\A[ ,"]*(devices|trajectories|model outputs|joints)[ ,"]*$',),
    ),
    TrialReader(
        "motion", _EXPORTS + "read_motion", (r"^\s*endheader",), suffixes=(".mot", ".sto")
    ),
    TrialReader("BioWare", _EXPORTS + "read_bioware", (r"^abs time",)),
    TrialReader(
        "OptiTrack Motive", _HERE + "motive:read_motive",
        (r'\A"?format version"?,.*(take name|capture frame rate|export frame rate)',),
    ),
    TrialReader("D-Flow", _HERE + "dflow:read_dflow",
                (r"\A[% ]*timestamp\t[^\n]*\.posx",)),
    TrialReader("BTS", _HERE + "bts:read_bts", (r"\Abts ascii format",),
                suffixes=(".emt",)),
    TrialReader("Xsens", _HERE + "xsens:read_mvnx", (r"<mvnx[ >]",),
                suffixes=(".mvnx",)),
    TrialReader("XSENSOR", _HERE + "xsensor:read_xsensor",
                (r'^"?sensor:?"?,.*\n(.*\n)*?"?rows:?"?,', r'\A"?file ?name:?"?,.*\.xsn')),
    TrialReader("TDMS", _HERE + "tdms:read_tdms", magic=(b"TDSm",),
                suffixes=(".tdms",)),
    TrialReader("STM 603", _HERE + "satra:read_stm603", (r"\A.*\bstm ?603\b",
                r"^.*\bsatra\b.*(slip|stm)")),
    TrialReader("AMTI", _HERE + "amti:read_netforce",
                (r"\A.*(netforce|amti\b.*(force|acquisition))",), magic=(b"\x64\0\0\0",),
                suffixes=(".bsf",)),
    TrialReader("CETR", _HERE + "instrument_logs:read_cetr", (r"\A(.*\n){0,3}.*cetr",)),
    TrialReader("PCS", _HERE + "instrument_logs:read_pcs", (r"\A.*test data file",)),
    TrialReader("F-Scan", _HERE + "instrument_logs:read_fscan", (r"\Adata_type",),
                suffixes=(".asf",)),
    TrialReader("Pedar", _HERE + "instrument_logs:read_pedar", (r"^time\[secs\]",),
                suffixes=(".fgt",)),
    TrialReader("JSON", _HERE + "pose_json:read_pose_json", (r"\A\s*\{",),
                suffixes=(".json",)),
    TrialReader("MATLAB", _HERE + "matlab:read_matlab", suffixes=(".mat",),
                magic=(b"MATLAB 5.0", b"MATLAB 7.3", b"\x89HDF")),
    # known, and not read as something else
    TrialReader("BTS TDF", "", magic=(b"\x82K`A",), suffixes=(".tdf",), remedy=_EXPORT),
    TrialReader("MDF of Codamotion or BTS", "", suffixes=(".mdf",), remedy=_EXPORT),
    TrialReader("Delsys HPF", "", magic=(b"datx",), suffixes=(".hpf",), remedy=_EXPORT),
    TrialReader("NDI N3D", "", suffixes=(".n3d",), remedy=_EXPORT),
    TrialReader("Xsens MVN, not exported,", "", suffixes=(".mvn",), remedy="Export it as MVNX"),
    TrialReader("GAITRite", "", (r"\A.*gaitrite",), remedy="It holds footfalls, no forces"),
    TrialReader("Delsys", "", (r"\A.*(emgworks|delsys|trigno|x ?\[s\].*emg)",), remedy=_EXPORT),
    TrialReader("BVH (turns of joints)", "", (r"\A\s*hierarchy\s*$",), remedy=_MARKERS),
    TrialReader("Motion Analysis analog text (.anc: counts of a converter)", "",
                (r"\Afile_type:\s*analog r/c ascii",),
                remedy="In Cortex, export the forces (.forces) or C3D: they are calibrated"),
    TrialReader("Visual3D text", "", (r"^\s*item\t\s*[xyz0-9]",),
                remedy="Save the recording from Visual3D as C3D"),
    TrialReader("Moticon insole text", "", (r"\A.*moticon", r"^#.*moticon"), remedy=_INSOLE),
    TrialReader("novel loadsol text", "", (r"\A.*loadsol", r"^.*loadsol"), remedy=_INSOLE),
    TrialReader("Noraxon", "", (r"\A(.*\n){0,3}.*(noraxon|myoresearch|myomotion)",),
                remedy=_EXPORT),
    TrialReader("Movella DOT or Xsens sensors", "", (r"^packetcounter[,;\t]",), remedy=_SENSORS),
    TrialReader("APDM sensors", "", (r"\A.*apdm",), remedy=_SENSORS),
    TrialReader("Qualisys skeleton", "", (r"\A<\?xml[^>]*>\s*<(skeleton|qtm)",),
                remedy="Export the markers and forces as C3D or TSV"),
)  # fmt: skip


def trial_suffixes() -> tuple[str, ...]:
    """Return the endings of names by which a folder's trial files are found."""
    every = (C3D, *READERS, TABLE)
    return tuple(dict.fromkeys(suffix for reader in every for suffix in reader.suffixes))


def file_format(data: bytes, path: Path) -> TrialReader:
    """Return the format of a file from its first bytes; the name's ending only breaks ties."""
    head, suffix = data[:4096], path.suffix.casefold()
    # "P" as second letter happens in text too: a C3D header holds binary zeros.
    signed = len(data) > 1 and data[1] == 0x50 and 0 < data[0] < 128
    wide = utf16_of(data)
    if suffix == ".c3d" or (signed and b"\0" in head and not wide):
        return C3D
    if data.startswith(TABLE.magic):
        return TABLE
    text = head[: len(head) // 2 * 2].decode(wide or "latin-1", "replace")
    text = text.lstrip("\ufeffï»¿").casefold().replace("\r", "\n")
    trial_reader = next((reader for reader in READERS if reader.recognises(data, text)), None)
    return trial_reader or next((reader for reader in READERS if suffix in reader.suffixes), TABLE)


def nearest_format(header: Iterable[str]) -> str | None:
    """Return the format whose marks come nearest to words of a file's first lines, or None."""
    words = {
        word: reader.name
        for reader in READERS
        for mark in reader.marks
        for word in re.findall(r"[a-z_]{6,}", mark)
    }
    lines = [line.casefold() for line in header]
    parts = (part for line in lines for part in re.split(r"[,;:\t= ]", line) if len(part) > 5)
    found = next((near for part in parts if (near := get_close_matches(part, words, 1, 0.8))), None)
    return words[found[0]] if found else None
