"""The JSON Schema of case files: committed, up to date, with units; catalogue sections fit it."""

import json
from pathlib import Path

import pytest

from underfoot.case.parts import CATALOGUE_SECTIONS, field_at, fields, keys
from underfoot.case.schema import schema_text
from underfoot.case.section import quantity_of
from underfoot.case.versions import SHORT
from underfoot.core import to_si
from underfoot.core.catalogue import Catalogue

SCHEMA = Path(__file__).parents[2] / "schema" / "case.schema.json"
BOOK = Catalogue.load()


def test_the_committed_schema_is_up_to_date():
    assert SCHEMA.read_text() == schema_text(), "run: underfoot schema --out ... --overwrite"


def test_every_quantity_shows_its_unit_and_range():
    schema = json.loads(schema_text())
    speed = schema["$defs"]["HeldMotion"]["properties"]["speed"]
    assert speed["unit"] == "m/s"
    assert speed["maximum_si"] == 20
    assert speed["anyOf"][0] == {"type": ["string"]}
    assert schema["$defs"]["HeldMotion"]["properties"]["from"]["type"] == "string"
    assert schema["$defs"]["HeldMotion"]["properties"]["force_rise_time"]["default"] == "30 ms"
    assert schema["properties"]["floor"]["anyOf"][1]["type"] == "string"
    assert "required" not in schema["$defs"]["Shoe"]
    text = schema_text()
    units = {quantity.unit for _, f in fields().items() if (quantity := quantity_of(f))}
    assert all(f'"unit": "{unit}"' in text for unit in units)


ENTRIES = [
    pytest.param(section, kind, part, name, id=f"{section}-{name}")
    for section, (kind, part) in CATALOGUE_SECTIONS.items()
    for name in BOOK.names(kind)
    if not part or BOOK.entry(kind, name).under(part)
]


@pytest.mark.parametrize(("section", "kind", "part", "name"), ENTRIES)
def test_every_catalogue_value_fits_its_section_and_is_physical(section, kind, part, name):
    entry = BOOK.entry(kind, name)
    values = entry.under(part) if part else entry.values
    for path, leaf in values.items():
        if section == "shoe.material" and path.startswith("roughness."):
            continue
        full = SHORT.get(f"{section}.{path}", f"{section}.{path}")
        if full in keys():
            assert leaf.given in keys()[full].options()
            continue
        field = field_at(full)
        assert field is not None, f"{full} is no key of a case"
        quantity = quantity_of(field)
        if quantity is not None:
            value = to_si(leaf.given, quantity.unit, where=path)
            assert quantity.low <= value <= quantity.high
