"""What solving a case takes, told before it starts."""

from underfoot.case import Case
from underfoot.sole_contact.cost import Cost, solution_cost

from .sole import file_sole_map


def cost(case: Case, spacing: float) -> Cost:
    """Return what solving the case on cells of ``spacing`` (m) will take."""
    if case.shoe.heel is None:
        area = file_sole_map(case, case.numerics.quick_grid_spacing).plan_area
    else:
        area = case.shoe.heel.length * case.shoe.heel.width
    return solution_cost(area, spacing)
