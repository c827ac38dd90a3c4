"""Each fault of mutants.toml stands in the source: where its line moves on, it goes with it."""

from mutants import named_faults


def test_every_named_fault_can_still_be_planted():
    faults = list(named_faults())
    assert len({(one.file, one.start, one.new) for one in faults}) == len(faults) > 0
