"""The catalogue: every value has a source and a sound unit; the user's folders and their rules."""

from pathlib import Path

import pytest

from underfoot.core import InputError
from underfoot.core.catalogue import KINDS, Catalogue, catalogue_folders
from underfoot.core.units import si_unit

BUILT_IN = Catalogue.load()
LEAVES = [
    (f"{kind}.{name}.{path}", entry, path)
    for (kind, name), entry in BUILT_IN.entries.items()
    for path in entry.values
]


def numbers(given):
    """Yield the texts and numbers of a leaf, lists and tables opened."""
    if isinstance(given, list):
        for item in given:
            yield from numbers(item)
    elif isinstance(given, dict):
        for item in given.values():
            yield from numbers(item)
    else:
        yield given


def written(folder: Path, text: str, name: str = "own.toml") -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_text(text)
    return folder


def test_every_value_has_a_source_and_a_readable_unit():
    assert len(LEAVES) > 700
    for where, entry, path in LEAVES:
        leaf = entry.leaf(path)
        assert leaf.source.strip(), where
        assert "no source" not in leaf.source, where
        for given in numbers(leaf.given):
            if isinstance(given, str) and given[:1] in "0123456789+-.":
                value = given.split()[0]
                assert float(value) == pytest.approx(float(value)), where
                si_unit(given, where=where)
        if leaf.uncertainty is not None:
            assert entry.sourced_value(path).uncertainty > 0, where
        if "assum" in leaf.source:
            assert leaf.assumed, where


def test_every_kind_has_entries_and_every_entry_a_title():
    for kind in KINDS:
        assert BUILT_IN.names(kind)
    assert all(entry.title != entry.name for entry in BUILT_IN.entries.values())


def test_a_number_comes_in_si_with_its_spread_and_source():
    cof = BUILT_IN.entry("fluid", "canola_oil").sourced_value("boundary.cof_bl")
    assert (cof.value, cof.uncertainty, cof.unit, cof.assumed) == (0.10, 0.02, "1", False)
    speeds = BUILT_IN.entry("setup", "pin_on_disk_g2").numbers("method.speeds", "m/s")
    assert speeds[:3] == (0.05, 0.1, 0.2)
    assert len(speeds) == 11


def test_values_from_memory_are_marked():
    entry = BUILT_IN.entry("setup", "en_iso_13287")
    assert not entry.leaf("motion.speed").verified
    assert "from memory" in entry.sourced_value("motion.speed").source
    assert entry.leaf("limits.heel_tile_detergent").verified


def test_an_unknown_name_gets_the_nearest():
    with pytest.raises(InputError) as caught:
        BUILT_IN.entry("fluid", "canola")
    assert caught.value.nearest == "canola_oil"
    with pytest.raises(InputError, match="kind of catalogue entry"):
        BUILT_IN.names("fluids")
    with pytest.raises(InputError) as caught:
        BUILT_IN.describe("work_sho_untreaded")
    assert caught.value.nearest == "work_shoe_untreaded"
    with pytest.raises(InputError) as caught:
        BUILT_IN.entry("fluid", "canola_oil").sourced_value("viscocity")
    assert caught.value.nearest == "viscosity"


def test_a_description_shows_values_sources_and_notes():
    text = BUILT_IN.describe("water_g2")
    assert "viscosity = 0.52 cP" in text
    assert "G.2.1" in text
    assert "0.89 to 1.00 cP" in text


def test_an_entry_takes_over_another_and_overrides_single_values(tmp_path):
    folder = written(
        tmp_path,
        '[fluid.cutting_oil]\ntitle = "Cutting oil"\nfrom = "canola_oil"\n'
        'source = "own viscometer"\nviscosity = {value = "60 cP", uncertainty = "2 cP"}\n',
    )
    entry = Catalogue.load([folder]).entry("fluid", "cutting_oil")
    assert entry.parents == ("canola_oil",)
    viscosity = entry.sourced_value("viscosity")
    assert viscosity.value == pytest.approx(0.06)
    assert viscosity.uncertainty == pytest.approx(0.002)
    assert viscosity.source == "own viscometer"
    assert entry.sourced_value("boundary.cof_bl").value == 0.10
    assert "G.2.2" in entry.sourced_value("boundary.cof_bl").source


def test_a_value_without_a_source_counts_as_assumed(tmp_path):
    folder = written(tmp_path, '[fluid.mystery]\nviscosity = "60 cP"\n')
    leaf = Catalogue.load([folder]).entry("fluid", "mystery").leaf("viscosity")
    assert leaf.assumed
    assert "no source given" in leaf.source


def test_a_name_clash_is_refused_unless_it_says_replaces(tmp_path):
    text = '[fluid.water]\nsource = "own"\nviscosity = "0.9 cP"\n'
    folder = written(tmp_path / "a", text)
    with pytest.raises(InputError, match=r"defined twice.*replaces = true"):
        Catalogue.load([folder])
    folder = written(tmp_path / "b", text.replace("source", "replaces = true\nsource"))
    assert (
        Catalogue.load([folder]).entry("fluid", "water").sourced_value("viscosity").value == 0.0009
    )
    assert BUILT_IN.entry("fluid", "water").sourced_value("viscosity").value == 0.0010016


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[fluid.a]\nviscosity = ", "is no TOML file"),
        ('[liquid.a]\nviscosity = "1 cP"', "unknown kind of catalogue entry"),
        ('[fluid.a]\nfrom = "watr"', 'Did you mean "water"'),
        ('[fluid.a]\nfrom = "b"\n[fluid.b]\nfrom = "a"', "in a circle: a -> b -> a"),
        ('fluid = "water"', "is no table of entries"),
        ('[fluid]\nwater = "1 cP"', "is no table"),
        ('[fluid.a]\nviscosity = {value = "1 cP", unsure = "x"}', 'unknown mark "unsure"'),
    ],
)
def test_bad_user_catalogues_are_refused_with_the_file(tmp_path, text, message):
    with pytest.raises(InputError, match=message) as caught:
        Catalogue.load([written(tmp_path, text)])
    assert "own.toml" in str(caught.value) or "viscosity" in str(caught.value)


def test_the_same_name_twice_in_one_folder_is_refused(tmp_path):
    written(tmp_path, '[fluid.a]\nviscosity = "1 cP"')
    written(tmp_path, '[fluid.a]\nreplaces = true\nviscosity = "1 cP"', "second.toml")
    with pytest.raises(InputError, match="defined twice"):
        Catalogue.load([tmp_path])


def test_a_missing_folder_is_refused(tmp_path):
    with pytest.raises(InputError, match="does not exist"):
        Catalogue.load([tmp_path / "nowhere"])


def test_folders_come_from_the_environment_beside_the_case_and_the_caller(tmp_path, monkeypatch):
    first, beside, last = tmp_path / "env", tmp_path / "here", tmp_path / "extra"
    (beside / "catalogue").mkdir(parents=True)
    monkeypatch.delenv("UNDERFOOT_CATALOGUE", raising=False)
    assert catalogue_folders(tmp_path) == []
    monkeypatch.setenv("UNDERFOOT_CATALOGUE", str(first))
    assert catalogue_folders(beside, [last]) == [first, beside / "catalogue", last]


def test_an_untouched_catalogue_is_loaded_once():
    assert Catalogue.load() is Catalogue.load()
