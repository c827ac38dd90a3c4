"""Figures of the report that a model can show, and which of ours shows each."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ReportFigure:
    """One figure of the report: ``file`` of ours without its ending, or "" and why there is none.

    ``remark`` says what differs, or why it can't be had.
    """

    number: int
    shows: str
    study: str
    file: str
    remark: str = ""


_READINGS = "readings that are printed in the figure only"

FIGURES: tuple[ReportFigure, ...] = (
    ReportFigure(3, "forces and contact of the micro model in time", "g1", "fig03_history"),
    ReportFigure(4, "stress relaxation test", "g1", "",
                 "a measurement; `underfoot trials` fits such files"),
    ReportFigure(5, "hysteresis against roughness", "g1", "fig05_hysteresis_roughness"),
    ReportFigure(6, "hysteresis against speed", "g1", "fig06_hysteresis_speed"),
    ReportFigure(7, "contact area against speed", "g1", "fig07_area_speed"),
    ReportFigure(8, "contact area against roughness", "g1", "fig08_area_roughness"),
    ReportFigure(9, "hysteresis of model and experiment", "g1", "fig06_hysteresis_speed",
                 "the model's half (A) are curves of Fig. 6; the experiment's (B): " + _READINGS),
    ReportFigure(10, "contact area and adhesion of the experiment", "g1", "fig10_area_speed_own",
                 "the model's half (A)"),
    ReportFigure(11, "contact area and adhesion at the lowest speed", "g1",
                 "fig11_area_roughness_own", "the model's half (A)"),
    ReportFigure(14, "COF against speed, 25 % glycerol", "g2", "blind_predictions",
                 "its panel of 25 % glycerol: published fit and prediction; no single readings"),
    ReportFigure(15, "profile of a pin", "g2", "", "a measured profile; R' = 23.3 mm is used"),
    ReportFigure(16, "master curve of viscosity x speed", "g2", "fig16_master_curve"),
    ReportFigure(17, "fits of four fluids", "g2", "blind_predictions"),
    ReportFigure(18, "friction at rest by fluid", "g2", "fig18_20_levels"),
    ReportFigure(19, "film thickness against speed", "g2", "fig19_film"),
    ReportFigure(20, "decay speed by fluid", "g2", "fig18_20_levels"),
    ReportFigure(22, "dry adhesion by sole and floor", "g3", "fig22_contact_area",
                 "real contact area in its place: the readings are in the figure only"),
    ReportFigure(23, "hysteresis by sole and floor", "g3", "", _READINGS),
    ReportFigure(24, "adhesion by fluid and sole", "g3", "fig24_adhesion",
                 "by Eq. 26 at the dry adhesion that fits best"),
    ReportFigure(25, "adhesion by fluid and floor", "g3", "",
                 _READINGS + "; Eq. 26 knows no floor"),
    ReportFigure(29, "pressure maps under two shoes", "g4", "fig29"),
    ReportFigure(30, "fluid load by tread and fluid", "g4", "fig30"),
    ReportFigure(32, "a slip over the sensors", "g5", "fig32_slip"),
    ReportFigure(33, "peak speed against peak pressure", "g5", "fig33_speed_pressure"),
    ReportFigure(34, "speed, place and row against pressure", "g5", "fig34_effects"),
    ReportFigure(35, "wedge and squeeze: what raises the pressure", "g5", "fig35_wedge_squeeze",
                 "the concept, computed with the model of one film height"),
    ReportFigure(36, "risk and friction by outsole", "g6", "fig36_outsoles"),
    ReportFigure(37, "slips and logistic curves", "g6", "fig37_logistic",
                 "simulated steps; the persons' own are in the figure only"),
)  # fmt: skip


def figure_rows(names: dict[str, list[str]]) -> list[tuple[int, str, str, str]]:
    """Return (number, what it shows, our file or "-", remark) of every figure.

    ``names`` lists the figure files (without ending) that each study wrote; the one that begins
    with the listed name is taken.
    """
    rows = []
    for one in FIGURES:
        there = sorted(name for name in names.get(one.study, ()) if name.startswith(one.file))
        if not one.file:
            rows.append((one.number, one.shows, "-", one.remark))
        elif there:
            rows.append((one.number, one.shows, f"{one.study}/{there[0]}", one.remark))
        else:
            rows.append((one.number, one.shows, "-", "not written in this run"))
    return rows
