"""Which factors of a study can be told apart."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from underfoot.core.remark import Message

from .linear import design, predictor


@dataclass(frozen=True, slots=True)
class Confounded:
    """A factor that can't be told from ``others``, none of them where it is from the persons.

    ``same``: each level goes with one level of the other and back.
    """

    factor: str
    others: tuple[str, ...]
    same: bool

    def __str__(self) -> str:
        return self.message

    @property
    def message(self) -> Message:
        """What can't be told, and why."""
        others = [Message('"{name}"', name=name) for name in self.others]
        if not others:
            return Message(
                '"{factor}" can\'t be told from the persons: too few share a level',
                factor=self.factor,
            )
        if self.same:
            return Message(
                '"{factor}" can\'t be told from {others: and }: each level of one goes with one '
                "level of the other",
                factor=self.factor,
                others=others,
            )
        return Message(
            '"{factor}" can\'t be told from {others: and }: its levels go with theirs',
            factor=self.factor,
            others=others,
        )


def told_apart(
    factors: Mapping[str, Sequence[str]],
    person: Sequence[object] = (),
    *,
    last: Collection[str] = (),
) -> tuple[dict[str, Sequence[str]], list[Confounded]]:
    """Return the factors whose main effects can be told apart, and those left out with the reason.

    Of two that say the same the first stays, those named in ``last`` after all others. A factor
    that only differs between persons needs more persons than levels.

    ``factors``: columns of length n with two levels or more each. ``person``: whose each row is;
    each its own without.
    """
    order = sorted(factors, key=lambda name: name.casefold() in last)
    coded = {name: predictor(name, list(factors[name]), kind="factor") for name in order}
    people = list(dict.fromkeys(map(str, person)))
    who = np.array([people.index(str(one)) for one in person])
    first = np.array([np.flatnonzero(who == i)[0] for i in range(len(people))], dtype=int)

    def free(names: Sequence[str], rows: np.ndarray | slice = slice(None)) -> tuple[int, int]:
        matrix = design(coded, names).matrix[rows]
        return int(np.linalg.matrix_rank(matrix)), matrix.shape[1]

    kept: list[str] = []
    left: list[Confounded] = []
    for name in order:
        rank, needed = free([*kept, name])
        if rank < needed:
            alone = [(other,) for other in kept if len(set(free([other, name]))) > 1]
            others = alone[0] if alone else tuple(kept)
            pairs = set(zip(*(factors[one] for one in (*others, name)), strict=True))
            same = len(pairs) == len(set(factors[name])) == len(set(factors[others[0]]))
            left.append(Confounded(name, others, same and len(others) == 1))
            continue
        between = [
            one
            for one in (*kept, name)
            if len(people) < len(who)
            and len(set(zip(who.tolist(), factors[one], strict=True))) == len(people)
        ]
        if name in between and free(between, first)[1] >= len(people):
            left.append(Confounded(name, (), False))
            continue
        kept.append(name)
    return {name: levels for name, levels in factors.items() if name in kept}, left


def names_persons(levels: Sequence[object], persons: Sequence[object]) -> bool:
    """Return whether a factor has one level a person, another for each (who, in other words)."""
    several = len(set(persons))
    return 1 < several == len(set(levels)) == len(set(zip(levels, persons, strict=False)))
