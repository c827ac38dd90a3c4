"""Tables of a page of trials: what has no room is joined by its columns, not by their headings."""

from underfoot.trials.pages.report import _compact, page_table
from underfoot.trials.study.file_result import FileResult, Number
from underfoot.trials.study.tables import Table, file_table, finding, number_columns


def test_mean_sd_and_interval_of_several_quantities_share_a_cell():
    four, other = (tuple(number_columns(name)) for name in ("rcof", "acof"))
    row = ("soft", 0.2, 0.01, 0.19, 0.21, 0.3, None, None, None)
    table = Table("conditions", "", ("shoe", *four, *other), (row,), spreads=(four, other))
    shown = _compact(table)
    assert shown.columns == ("shoe", "RCOF: mean (SD), 95 %", "ACOF: mean (SD), 95 %")
    assert shown.rows == (("soft", "0.200 (0.010), 0.190 to 0.210", "0.300"),)
    one = table.only(range(7))  # no interval of the second is known
    assert _compact(one) == one


def test_a_condition_called_as_a_column_of_ours_stays_what_it_is():
    """ "p" was printed as a chance, "slip" as yes or no."""
    noted = {"p": 2.5, "p 1": 0.00001, "heel crossed the array": 0.25}
    files = [FileResult("a.c3d", numbers=(Number("slip", 1.0, main="slip"),), conditions=noted)]
    shown = page_table(file_table(files))
    (row,) = shown["rows"]
    cells = dict(zip(shown["columns"], row, strict=True))
    assert cells["p"] == "2.5"
    assert cells["p 1"] == "0.0000100"
    assert cells["heel crossed the array"] == "0.25"
    assert cells["slip"] == "yes"
    made = finding("t", "T", ("factor", "p", "p (Holm)"), (("shoe", 1e-6, 0.02),))
    assert page_table(made.table)["rows"] == [["shoe", "< 0.0001", "0.0200"]]
