"""What laws of lugs with edges take where nothing is said."""

from types import SimpleNamespace
from typing import Any

from underfoot.sole_contact.lug_edges import EdgedLaw


def test_lugs_without_a_rate_of_drying_stay_in_one_mean_state():
    law: Any = SimpleNamespace(full_contact=7e5)
    nothing: Any = None
    plain = EdgedLaw(law, nothing, nothing, 3e6, 0.1, 70e3)
    assert (plain.dewetting, plain.film_load) == (0.0, 0.0)
    assert plain._full_contact is None
    assert EdgedLaw(law, nothing, nothing, 3e6, 0.1, 70e3, 0.2)._full_contact == 7e5
    other: Any = SimpleNamespace()
    assert EdgedLaw(other, nothing, nothing, 3e6, 0.1, 70e3, 0.2)._full_contact is None
