"""Tables of a page of trials: what has no room is joined by its columns, not by their headings."""

from underfoot.trials.pages.report import _compact
from underfoot.trials.study.tables import Table, number_columns


def test_mean_sd_and_interval_of_several_quantities_share_a_cell():
    four, other = (tuple(number_columns(name)) for name in ("rcof", "acof"))
    row = ("soft", 0.2, 0.01, 0.19, 0.21, 0.3, None, None, None)
    table = Table("conditions", "", ("shoe", *four, *other), (row,), spreads=(four, other))
    shown = _compact(table)
    assert shown.columns == ("shoe", "RCOF: mean (SD), 95 %", "ACOF: mean (SD), 95 %")
    assert shown.rows == (("soft", "0.200 (0.010), 0.190 to 0.210", "0.300"),)
    one = table.only(range(7))  # no interval of the second is known
    assert _compact(one) == one
