"""Each fault of mutants.toml stands in the source: where its line moves on, it goes with it."""

from mutants import REPOSITORY, SOURCE, Faults, may_live, named_faults


def test_every_named_fault_can_still_be_planted():
    faults = list(named_faults())
    assert len({(one.file, one.start, one.new) for one in faults}) == len(faults) > 0


def test_every_fault_that_may_live_can_still_be_made_and_has_its_reason():
    for (file, fault), why in may_live().items():
        text = (REPOSITORY / SOURCE / file).read_text(encoding="utf-8")
        made = {one.shown.partition(": ")[2] for one in Faults(file, text).found}
        assert fault in made, (file, fault)
        assert len(why) > 10
