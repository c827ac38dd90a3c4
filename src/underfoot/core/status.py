"""Outcome of a computation as data: each status carries its remedy."""

from enum import StrEnum


class Status(StrEnum):
    """How a computation ended. Anything but CONVERGED must never be shown as a plain number."""

    CONVERGED = "converged"
    NOT_CONVERGED = "not converged"
    OUT_OF_RANGE = "converged, outside a tested range"
    CANCELLED = "cancelled"
    PREVIEW = "preview"

    @property
    def usable(self) -> bool:
        """True when the numbers may be shown as a result."""
        return self in (Status.CONVERGED, Status.OUT_OF_RANGE)

    @property
    def remedy(self) -> str:
        """Return what to do about it."""
        return {
            Status.CONVERGED: "",
            Status.NOT_CONVERGED: (
                "The numbers are not a result. Refine the grid, start from a thicker film or "
                "loosen an extreme input; the residual history tells where it stopped."
            ),
            Status.OUT_OF_RANGE: "Read the list of breaches before using the numbers.",
            Status.CANCELLED: "Run it again; finished parts are taken from the cache.",
            Status.PREVIEW: "Its error is an estimate. Run the case in full for a result.",
        }[self]


def worst(*statuses: Status) -> Status:
    """Return the most serious of several statuses."""
    order = [Status.CONVERGED, Status.OUT_OF_RANGE, Status.PREVIEW]
    order += [Status.NOT_CONVERGED, Status.CANCELLED]
    return max(statuses, key=order.index, default=Status.CONVERGED)
