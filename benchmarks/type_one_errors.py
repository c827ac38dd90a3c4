"""How often the tests of a study find a difference that is not there: it should be 5 of 100.

``python -m benchmarks type_one_errors`` prints the share of simulated studies without a difference
that each test calls significant at 5 %: twelve designs with one to three factors within persons, a
group, missing cells, and a person's own reaction to each level (times the residual SD).
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np

from underfoot.core import DataError
from underfoot.trials.statistics import mixed_model

PERSON, RESIDUAL = 0.02, 0.008  # SD of RCOF between persons, and of a person's condition or trial
STUDIES, SEED = 2000, 1


@dataclass(frozen=True, slots=True)
class Design:
    """One kind of study: ``levels`` of the factors within persons; ``own``: SD of reactions."""

    name: str
    persons: int
    levels: tuple[int, ...]
    own: float
    groups: int = 1
    missing: float = 0.0
    trials: int = 1
    label: bool = False

    def study(
        self, random: np.random.Generator
    ) -> tuple[np.ndarray, dict[str, list[str]], list[str]]:
        """Return responses, factors and persons of one study without a difference.

        ``label``: a column of two labels at random, which means nothing.
        """
        cells = list(product(range(self.persons), *map(range, self.levels)))
        rows = [
            cell for cell in cells if random.random() >= self.missing for _ in range(self.trials)
        ]
        who, *within = map(np.array, zip(*rows, strict=True))
        y = random.normal(0.2, PERSON, self.persons)[who] + random.normal(0, RESIDUAL, len(rows))
        for column, count in zip(within, self.levels, strict=True):
            own = random.normal(0, self.own * RESIDUAL, (self.persons, count))
            y += own[who, column]
        names = ("shoe", "floor", "side")[: len(within)]
        factors = {n: list(map(str, column)) for n, column in zip(names, within, strict=True)}
        if self.groups > 1:
            factors["group"] = list(map(str, who % self.groups))
        if self.label:
            factors["label"] = list(map(str, random.integers(0, 2, len(rows))))
        return y, factors, list(map(str, who))


DESIGNS = (
    Design("shoe", 8, (3,), 0.0),
    Design("shoe, trials repeated", 12, (3,), 1.0, trials=3),
    Design("shoe, cells missing", 12, (3,), 0.5, missing=0.2),
    Design("shoe and group", 12, (3,), 0.5, groups=2),
    Design("shoe and group, cells missing", 15, (3,), 1.0, groups=2, missing=0.15),
    Design("shoe, floor", 8, (3, 2), 0.0),
    Design("shoe, floor", 8, (3, 2), 1.0),
    Design("shoe, floor, cells missing", 12, (3, 2), 0.5, missing=0.15),
    Design("shoe, floor and group", 16, (3, 2), 0.5, groups=2),
    Design("shoe, floor, side", 8, (3, 2, 2), 0.5),
    Design("shoe, floor, side", 12, (3, 2, 2), 1.0),
    Design("shoe, floor, side, cells missing", 10, (3, 2, 2), 0.0, missing=0.1),
    Design("shoe, label at random", 10, (3,), 1.0, trials=4, label=True),
)


def shares(design: Design, studies: int = STUDIES, seed: int = SEED) -> dict[str, float]:
    """Return the share of studies in which each term is found at 5 %; "not done" beside it."""
    random = np.random.default_rng(seed)
    found: dict[str, int] = {}
    failed = 0
    for _ in range(studies):
        y, factors, who = design.study(random)
        try:
            tests = mixed_model(y, factors, who).tests
        except DataError:
            failed += 1
            continue
        for test in tests:
            found[test.term] = found.get(test.term, 0) + (test.p is not None and test.p < 0.05)
    done = studies - failed
    return {**{term: n / done for term, n in found.items()}, "not done": failed / studies}


def table(studies: int = STUDIES) -> Iterator[str]:
    """Return one line a design."""
    yield f"{studies} studies each; found at 5 %, in % (standard error {21.8 / studies**0.5:.2f})"
    for number, design in enumerate(DESIGNS):
        told = shares(design, studies, SEED + number)
        failed = told.pop("not done")
        words = ", ".join(f"{term} {100 * share:.1f}" for term, share in told.items())
        tail = f"; not done {100 * failed:.1f}" if failed else ""
        name = f"{design.persons:3} persons, {design.name}, own reaction {design.own:g}"
        yield f"{name}: {words}{tail}"


def main() -> None:
    """Print the table."""
    for line in table():
        print(line, flush=True)


if __name__ == "__main__":
    main()
