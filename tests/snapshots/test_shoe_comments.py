"""Comments in a 3MF file: what stands in them is no part of the sole."""

import numpy as np
import pytest

import sole_forms as made
from underfoot.shoe.files.threemf import read_3mf

WHOLE = made.whole()
OTHER = made.whole(scale=2.0)


def read_mesh(tmp_path, text):
    path = tmp_path / "a.3mf"
    path.write_bytes(made.package(text))
    (body,) = read_3mf(path).bodies
    return body.vertices, body.faces


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("<vertices>", '<!-- <vertices><vertex x="1" y="2" z="3"/></vertices> --><vertices>'),
        ("<vertices>", '<vertices><!-- <vertex x="1" y="2" z="3"/> -->'),
        ("</triangles>", '<!-- <triangle v1="0" v2="1" v3="2"/> --></triangles>'),
        ("<resources>", f"<!-- {OTHER}\n{OTHER} --><resources>"),
        ("</build>", "<!-- -- not the end\n --></build><!-- -->"),
    ],
)
def test_a_comment_says_nothing(tmp_path, old, new):
    plain = made.model(WHOLE, made.item(1))
    assert plain.count(old) == 1
    expected, found = (read_mesh(tmp_path, text) for text in (plain, plain.replace(old, new)))
    assert all(np.array_equal(*pair) for pair in zip(found, expected, strict=True))
    assert len(expected[1]) > 20
