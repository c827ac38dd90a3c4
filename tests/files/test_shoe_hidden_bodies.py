"""Bodies that a 3MF file holds but does not print are read as hidden ones, whoever says so."""

import pytest

import sole_forms as made
from underfoot.shoe.files.threemf import read_3mf


def said_by_the_slicer(word):
    text = made.model(
        made.whole() + made.thing(2, made.mesh_xml([made.tall_last()])), made.item(1) + made.item(2)
    )
    config = f'<config><object id="2"><metadata key="printable" value="{word}"/></object></config>'
    return made.package(text, **{"Metadata/Slic3r_PE_model.config": config})


@pytest.mark.parametrize(
    ("data", "seen"),
    [
        (lambda: made.beside(), [True, True]),
        (lambda: made.beside(more=' printable="1"'), [True, True]),
        (lambda: made.beside(more=' printable="0"'), [True, False]),
        (lambda: made.beside(more=' printable="false"'), [True, False]),
        (lambda: said_by_the_slicer("1"), [True, True]),
        (lambda: said_by_the_slicer("0"), [True, False]),
    ],
    ids=["plain", "item 1", "item 0", "item false", "slicer 1", "slicer 0"],
)
def test_only_what_is_printed_is_seen(tmp_path, data, seen):
    (tmp_path / "sole.3mf").write_bytes(data())
    bodies = read_3mf(tmp_path / "sole.3mf").bodies
    assert [body.visible for body in bodies] == seen
