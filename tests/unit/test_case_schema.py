"""The JSON Schema of case files: committed, up to date, with units; catalogue sections fit it."""

import json
from pathlib import Path

import pytest

from underfoot.case import Case
from underfoot.case.quantity import Quantity
from underfoot.case.schema import CATALOGUE_SECTIONS, field_at, fields, marks_of, schema_text
from underfoot.core import to_si
from underfoot.core.catalogue import Catalogue

SCHEMA = Path(__file__).parents[2] / "schema" / "case.schema.json"
BOOK = Catalogue.load()


def test_the_committed_schema_is_up_to_date():
    assert SCHEMA.read_text() == schema_text(), "run: underfoot schema --out ... --overwrite"


def test_every_quantity_shows_its_unit_and_range():
    schema = json.loads(schema_text())
    speed = schema["$defs"]["Motion"]["properties"]["speed"]
    assert speed["unit"] == "m/s"
    assert speed["maximum_si"] == 20
    assert speed["anyOf"][0] == {"type": ["string"]}
    assert schema["$defs"]["Motion"]["properties"]["from"]["type"] == "string"
    assert schema["$defs"]["Motion"]["properties"]["force_rise_time"]["default"] == "30 ms"
    assert schema["properties"]["floor"]["anyOf"][1]["type"] == "string"
    assert "required" not in schema["$defs"]["Shoe"]
    text = schema_text()
    units = {m.unit for _, f in fields(Case) for m in marks_of(f) if isinstance(m, Quantity)}
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
        field = field_at(Case, f"{section}.{path}")
        assert field is not None, f"{section}.{path} is no key of a case"
        quantity = next((m for m in marks_of(field) if isinstance(m, Quantity)), None)
        if quantity is not None:
            value = to_si(leaf.given, quantity.unit, where=path)
            assert quantity.low <= value <= quantity.high
