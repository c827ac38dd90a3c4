"""Readers of rarer recordings, found by the registry of formats of the core.

Each reader is one function and one entry below, as in any other package that adds formats.
"""

from underfoot.trials.readers.formats import TrialReader

_EXPORT = "Export the recording as C3D, or as text with column names"
_EXPORTS = "underfoot_readers.text_exports:"
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
        "OptiTrack Motive", "underfoot_readers.motive:read_motive",
        (r'\A"?format version"?,.*(take name|capture frame rate|export frame rate)',),
    ),
    TrialReader("D-Flow", "underfoot_readers.dflow:read_dflow",
                (r"\A[% ]*timestamp\t[^\n]*\.posx",)),
    TrialReader("BTS", "underfoot_readers.bts:read_bts", (r"\Abts ascii format",),
                suffixes=(".emt",)),
    TrialReader("Xsens", "underfoot_readers.xsens:read_mvnx", (r"<mvnx[ >]",),
                suffixes=(".mvnx",)),
    TrialReader("XSENSOR", "underfoot_readers.xsensor:read_xsensor",
                (r'^"?sensor:?"?,.*\n(.*\n)*?"?rows:?"?,', r'\A"?file ?name:?"?,.*\.xsn')),
    TrialReader("TDMS", "underfoot_readers.tdms:read_tdms", magic=(b"TDSm",),
                suffixes=(".tdms",)),
    TrialReader("STM 603", "underfoot_readers.satra:read_stm603", (r"\A.*\bstm ?603\b",
                r"^.*\bsatra\b.*(slip|stm)")),
    TrialReader("AMTI", "underfoot_readers.amti:read_netforce",
                (r"\A.*(netforce|amti\b.*(force|acquisition))",), magic=(b"\x64\0\0\0",),
                suffixes=(".bsf",)),
    TrialReader("CETR", "underfoot_readers.instrument_logs:read_cetr", (r"\A(.*\n){0,3}.*cetr",)),
    TrialReader("PCS", "underfoot_readers.instrument_logs:read_pcs", (r"\A.*test data file",)),
    TrialReader("F-Scan", "underfoot_readers.instrument_logs:read_fscan", (r"\Adata_type",),
                suffixes=(".asf",)),
    TrialReader("Pedar", "underfoot_readers.instrument_logs:read_pedar", (r"^time\[secs\]",),
                suffixes=(".fgt",)),
    TrialReader("JSON", "underfoot_readers.pose_json:read_pose_json", (r"\A\s*\{",),
                suffixes=(".json",)),
    TrialReader("MATLAB", "underfoot_readers.matlab:read_matlab", suffixes=(".mat",),
                magic=(b"MATLAB 5.0", b"MATLAB 7.3", b"\x89HDF")),
    # known, and not read as something else
    TrialReader("BTS TDF", "", magic=(b"\x82K`A",), suffixes=(".tdf",), remedy=_EXPORT),
    TrialReader("MDF of Codamotion or BTS", "", suffixes=(".mdf",), remedy=_EXPORT),
    TrialReader("Delsys HPF", "", magic=(b"datx",), suffixes=(".hpf",), remedy=_EXPORT),
    TrialReader("NDI N3D", "", suffixes=(".n3d",), remedy=_EXPORT),
    TrialReader("Xsens MVN, not exported,", "", suffixes=(".mvn",), remedy="Export it as MVNX"),
    TrialReader("GAITRite", "", (r"\A.*gaitrite",), remedy="It holds footfalls, no forces"),
    TrialReader("Delsys EMGworks", "", (r"\A.*(emgworks|x\[s\].*emg)",), remedy=_EXPORT),
)  # fmt: skip
