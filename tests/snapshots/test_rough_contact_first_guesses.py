"""A contact is the same from any first guess: of no point, of all, of the wrong ones."""

import numpy as np
import pytest

from underfoot.rough_contact._kernels.complementarity import Search, solved_contacts
from underfoot.rough_contact._kernels.krylov import Workspace
from underfoot.rough_contact._kernels.operators import ElasticBody, Operators
from underfoot.rough_contact._kernels.periodic import unit_compliance

SHAPE = (16, 12)
rng = np.random.default_rng(5)
X, Y = np.meshgrid(*(2 * np.pi * np.arange(n) / n for n in SHAPE), indexing="ij")
HEIGHT = np.cos(X + 0.3) + 0.5 * np.cos(2 * X - Y) + 0.4 * np.cos(3 * Y + X)
GUESSES = {
    "hills": np.maximum(HEIGHT, 0), "none": np.zeros(SHAPE), "all": np.ones(SHAPE),
    "valleys": np.maximum(-HEIGHT, 0), "one": np.eye(*SHAPE) * (X == 0) * (Y == 0),
}  # fmt: skip


def operators(count: int) -> Operators:
    many = [count] if count > 1 else []  # one member has no axis of its own
    body = ElasticBody(
        moduli=lambda qx: np.ones((*many, *qx.shape)),
        unit=lambda q: unit_compliance(q, None, 0.5),
        spacing=(1.0, 1.0),
        scale=np.ones((count, 1, 1)) if many else 1.0,
        threads=1,
        library="scipy",
    )
    return Operators(body, (count, *SHAPE))


@pytest.mark.parametrize("mean", [0.01, 0.2])
def test_every_first_guess_ends_at_one_contact(mean):
    found = {}
    for exact in (False, True):
        for name, guess in GUESSES.items():
            search = Search(1e-5, 60, exact)
            (made,) = solved_contacts(
                operators(1), HEIGHT[None].astype(np.float32), guess[None].astype(np.float32),
                [mean], Workspace(10, np), search,
            )  # fmt: skip
            assert made.converged
            pressure, gap = np.asarray(made.pressure)[0], np.asarray(made.gap)[0]
            assert pressure.min() >= 0
            assert pressure.mean() == pytest.approx(mean, rel=1e-4)
            assert gap[pressure == 0].min() > -1e-4
            assert abs(gap[pressure > 0]).max() < 1e-3
            found[name, exact] = pressure
    first = found["hills", True]
    assert 0 < (first > 0).mean() < 1
    for other in found.values():
        np.testing.assert_allclose(other, first, atol=2e-3 * first.max())


def test_members_of_a_batch_end_each_at_its_own_contact():
    loads = [0.01, 0.2, 0.6]
    guesses = np.stack([GUESSES[name] for name in ("none", "hills", "all")]).astype(np.float32)
    search = Search(1e-5, 60, True)
    batch = solved_contacts(
        operators(3), HEIGHT[None].astype(np.float32), guesses, loads, Workspace(10, np), search
    )
    for load, one in zip(loads, batch, strict=True):
        assert one.converged
        assert float(np.mean(one.pressure)) == pytest.approx(load, rel=1e-4)
        (alone,) = solved_contacts(
            operators(1), HEIGHT[None].astype(np.float32),
            GUESSES["hills"][None].astype(np.float32), [load], Workspace(10, np), search,
        )  # fmt: skip
        np.testing.assert_allclose(one.pressure, alone.pressure, atol=2e-3 * load)
