"""Defaults of a case are the values of the texts that stand beside them."""

from importlib import import_module
from pathlib import Path

import pytest

from underfoot import case
from underfoot.case.quantity import Quantity, default_of
from underfoot.case.section import Section
from underfoot.core.units import to_si


def sections():
    """Yield the sections of a case by their names."""
    for path in sorted(Path(case.__file__).parent.glob("[!_]*.py")):
        for kind in vars(import_module(f"underfoot.case.{path.stem}")).values():
            if isinstance(kind, type) and issubclass(kind, Section):
                yield kind.__name__, kind


def test_the_text_of_a_default_is_its_value():
    defaults = [
        (f"{name}.{key}", field, default)
        for name, kind in sections()
        for key, field in kind.model_fields.items()
        if (default := default_of(field)) is not None
    ]
    assert len(defaults) > 100
    for name, field, default in defaults:
        quantity = next((one for one in field.metadata if isinstance(one, Quantity)), None)
        if quantity is None or default.text == field.default:
            assert field.default == default.text, name
        else:
            assert to_si(default.text, quantity.unit, where=name) == pytest.approx(field.default)
