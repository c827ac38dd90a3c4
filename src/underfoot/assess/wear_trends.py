"""Published findings on worn shoes beside a wear series: trends with their source."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .wear import WearSeries

WORN_REGION = (
    "Beschorner et al., worn region size, 57 shoes (abstract; doi 10.5061/dryad.vmcvdncsk)"
)
REPORT = "final progress report on shoe-floor friction, G.4.3"


@dataclass(frozen=True, slots=True)
class Trend:
    """A published direction and ours: rank correlation over the states of the series.

    ``correlation`` is None where the series can't say: fewer than 3 states, or no change.
    """

    finding: str
    source: str
    correlation: float | None
    agrees: bool | None


def trends(series: WearSeries) -> list[Trend]:
    """Return published trends with worn shoes beside those of the series."""
    lost = series.measured("removed_volume")
    peak = series.values("peak_fluid_pressure_sensor")
    friction = series.values("cof")
    new, worn = series.values("fluid_load_sensor")[[0, -1]]
    half = series.values("fluid_load_sensor")[: max(2, (len(series.points) + 1) // 2)]
    found = [
        _rank("a larger worn region goes with a higher peak fluid pressure", lost, peak, 1),
        _rank("a higher peak fluid pressure goes with less available friction", peak, friction, -1),
    ]
    late = None
    if np.isfinite([new, worn]).all() and worn > new:
        # the rise over the first half of the wear against that over all of it
        late = bool(np.nanmax(half) - new < 0.5 * (worn - new))
    finding = "little changes until a threshold of wear, then fluid pressure rises steeply"
    found.append(Trend(finding, REPORT, None, late))
    return found


def _rank(finding: str, x: np.ndarray, y: np.ndarray, sign: int) -> Trend:
    from scipy.stats import spearmanr

    known = np.isfinite(x) & np.isfinite(y)
    if known.sum() < 3 or np.ptp(x[known]) == 0 or np.ptp(y[known]) == 0:
        return Trend(finding, WORN_REGION, None, None)
    value = float(np.asarray(spearmanr(x[known], y[known]))[0])
    return Trend(finding, WORN_REGION, value, value * sign > 0)
