"""Changes lines of the source one at a time and counts the changes that no quick test sees.

    python tests/mutants.py              all, by name: killed or ALIVE
    python tests/mutants.py draws wear   those rooms only
    python tests/mutants.py --jobs 4     more at once

A mutant is a text of one file and what replaces it. It runs the quick tests of its room alone, in a
copy of the repository, until the first that fails. Not part of ``make test``: it takes minutes.
"""

import os
import shutil
import subprocess
import sys
import tempfile
from argparse import ArgumentParser
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import Queue
from typing import NamedTuple

REPOSITORY = Path(__file__).resolve().parents[1]
PARTS = ("src", "tests", "examples", "schema", "docs", "pyproject.toml", "README.md")
TIMEOUT = 600  # s; a change that never ends is seen


class Mutant(NamedTuple):
    """One change: ``old`` stands once in the file."""

    room: str
    file: str
    old: str
    new: str


TESTS = {
    "draws": (
        "properties/test_friction_sampled.py",
        "analytic/test_friction_pair_contact.py",
    ),
    "treads": ("properties/test_friction_tread_error.py",),
    "lug edges": (
        "analytic/test_slip_lug_edges.py",
        "analytic/test_sole_contact_lug_edges.py",
    ),
    "wear": (
        "analytic/test_shoe_worn.py",
        "properties/test_shoe_worn_properties.py",
        "files/test_shoe_worn_landing.py",
    ),
    "trials": (
        "analytic/test_trials_friction_error.py",
        "analytic/test_trials_slips_exact.py",
    ),
    "film": ("analytic/test_film_pad_strike.py", "analytic/test_film_closures.py"),
    "walkers": (
        "properties/test_slip_people.py",
        "unit/test_slip_full.py",
        "analytic/test_slip_motion.py",
    ),
    "calibration": ("analytic/test_friction_pair_contact.py",),
}
SAMPLED, SPREAD = "friction/sampled_cof.py", "friction/propagation.py"
PAIR, EDGES = "friction/pair_contact.py", "sole_contact/lug_edges.py"
WORN, SLIDE = "shoe/worn/archard.py", "trials/machines/slip_friction.py"
SLIPS = "trials/walking/slips.py"
STRIKE, PATIR, WALKER = "film/pad_strike.py", "film/patir_cheng_1978.py", "slip/dynamics/walker.py"
LAW, TREADS = "studies/pair_law.py", "friction/tread_error.py"

# what earlier tests let pass
SURVIVORS = (
    Mutant("wear", WORN, "shape.land_height(grid_x, grid_y) * sine - origin",
           "-shape.land_height(grid_x, grid_y) * sine - origin"),
    Mutant("lug edges", EDGES, "-1 if forward else 1", "1 if forward else -1"),
    Mutant("draws", SAMPLED, "pull_share * (ratio - 1.0)", "pull_share * ratio"),
    Mutant("draws", PAIR, "np.minimum(dry, self.film)", "self.film"),
    Mutant("draws", PAIR, "low * (high / low) ** share", "low + (high - low) * share"),
    Mutant("trials", SLIDE, "(1.0 - correlation) / (1.0 + correlation)",
           "(1.0 + correlation) / (1.0 - correlation)"),
    Mutant("trials", SLIDE, "max(onset - contact, 0.0)", "max(contact - onset, 0.0)"),
    Mutant("calibration", LAW, "(spread.T[..., None, None]) ** 2", "spread.T[..., None, None]"),
    Mutant("calibration", LAW, "mean, sd = draws.mean(axis=0)",
           "mean, sd = np.median(draws, axis=0)"),
    Mutant("wear", WORN, "float(left.min())", "float(left.max())"),
    Mutant("walkers", WALKER, "brake_time=drawn(self.brake_time)",
           "brake_time=self.brake_time.mean"),
    Mutant("walkers", WALKER, "step.foot_angle) - step.foot_angle[0]", "step.foot_angle)"),
    Mutant("film", PATIR, "math.log(gamma / low) / math.log(high / low)",
           "(gamma - low) / (high - low)"),
    Mutant("film", STRIKE, "hydraulic = 2 * strike.groove", "hydraulic = strike.groove"),
    Mutant("film", STRIKE, "out**2 / 6", "out**2 / 2"),
    Mutant("trials", SLIPS, "cutoff) + 4.6)", "cutoff) - 4.6)"),
)  # fmt: skip
OTHERS = (
    Mutant("draws", SAMPLED, "np.exp(values.get(FILM, 0.0))",
           "np.exp(0.5 * values.get(FILM, 0.0))"),
    Mutant("calibration", LAW, "nearest - median", "nearest - mean"),
    Mutant("draws", SAMPLED, "values.get(MODEL, 0.0) * carried", "values.get(MODEL, 0.0)"),
    Mutant("draws", SAMPLED, "hysteresis = min(hysteresis, solid)", "hysteresis = hysteresis + 0"),
    Mutant("draws", SAMPLED, "solid, hysteresis = solid * share, hysteresis * share\n        hyst",
           "hyst"),
    Mutant("draws", SAMPLED, "min(max(values[SUCTION], 0.0), VACUUM)", "values[SUCTION]"),
    Mutant("draws", SAMPLED, "carried = solid_load / load", "carried = 1.0"),
    Mutant("draws", SAMPLED, "viscous * np.exp(values.get(SHEAR, 0.0))", "viscous"),
    Mutant("treads", TREADS, "return self.deviation * found", "return 0 * found"),
    Mutant("treads", TREADS, "phase = every @ _waves().T", "phase = 1e3 * every @ _waves().T"),
    Mutant("treads", TREADS, "if name.startswith(head)", "if not name.startswith(head)"),
    Mutant("treads", TREADS, "s**2 * apart + pair.sd**2", "1e-4 * apart + pair.sd**2 + 0 * s"),
    Mutant("treads", TREADS, "np.sqrt(np.average(s**2, weights=density))", "0.05"),
    Mutant("treads", "shoe/tread_place.py", "TURN * share * (x - y)", "TURN * share * 0 * (x - y)"),
    Mutant("draws", SAMPLED, "exact / np.where(coarse > 0, coarse, 1.0)", "1.0 + 0 * exact"),
    Mutant("draws", SPREAD, "width * (normal - 0.5 * width)", "width * normal"),
    Mutant("draws", SPREAD, "spread > LOGNORMAL_ABOVE * value", "spread < LOGNORMAL_ABOVE * value"),
    Mutant("draws", SPREAD, "tail = 0.5 * (1 - confidence)", "tail = 1 - confidence"),
    Mutant("draws", SPREAD, "generator.permutation(samples)", "np.arange(samples)"),
    Mutant("draws", SPREAD, "return value + spread * normal",
           "return value - spread * abs(normal)"),
    Mutant("draws", SPREAD, "[seed, zlib.crc32(name.encode())]", "[seed]"),
    Mutant("draws", SPREAD, "(a - b) / spread / math.sqrt(2.0)", "(a - b) / spread"),
    Mutant("draws", SPREAD, "0.5 * np.mean(draws_a == draws_b)",
           "0.0 * np.mean(draws_a == draws_b)"),
    Mutant("draws", PAIR, "self.shore_a_deviation * apart", "0.0 * apart"),
    Mutant("draws", PAIR, "draws.error(DRY_PART, draws.sd_dry_part, seed)",
           "draws.error(DRY_PART, draws.sd_pair, seed)"),
    Mutant("draws", PAIR, "np.exp(draws.error(self.compound_and_floor, draws.sd_pair, seed))",
           "np.exp(draws.error(LABORATORY, draws.sd_pair, seed))"),
    Mutant("draws", PAIR, "numbers[\"sole_rq\"]) * (1 - flat)", "numbers[\"sole_rq\"])"),
    Mutant("lug edges", EDGES, "** 0.6 * edges.edge**0.4", "** 0.4 * edges.edge**0.6"),
    Mutant("lug edges", EDGES, "(10 * most / modulus) ** 0.15", "(most / modulus) ** 0.15"),
    Mutant("lug edges", EDGES, "0.27 * mu * reach", "0.27 * reach"),
    Mutant("lug edges", EDGES, "np.minimum(edges.length, 2 * edges.height)", "edges.length"),
    Mutant("lug edges", EDGES, "(dry**4 + inlet**4) ** 0.25", "dry + inlet"),
    Mutant("lug edges", EDGES, "1 - (inlet / dry) ** 4", "1 - (inlet / dry) ** 2"),
    Mutant("lug edges", EDGES, "1 - back / edges.length", "1 - 0 * back / edges.length"),
    Mutant("lug edges", EDGES, "4 / 3 * np.sqrt(back * edges.length)",
           "np.sqrt(back * edges.length)"),
    Mutant("lug edges", EDGES, "6 * LACKING * max(drag", "6 * max(drag"),
    Mutant("lug edges", EDGES, "1 - LIFT * np.maximum(forward - LIFTING, 0.0)",
           "1 - LIFT * forward"),
    Mutant("lug edges", EDGES, "np.where(bears, edges.fed * each, 0.0)",
           "np.where(bears, each, 0.0)"),
    Mutant("lug edges", EDGES, "edge_radius - worn,", "edge_radius + 0 * worn,"),
    Mutant("lug edges", EDGES, "np.minimum(EXCESS * worn, worn_edge_radius)", "EXCESS * worn"),
    Mutant("lug edges", EDGES, "cells * sole.spacing**2 / length", "cells * sole.spacing / length"),
    Mutant("lug edges", EDGES, "_sums(numbers, count, from_groove) / faces",
           "np.ones(count) + 0 * _sums(numbers, count, from_groove)"),
    Mutant("lug edges", EDGES, "load / cells > IDLE", "load / cells < IDLE"),
    Mutant("lug edges", EDGES, "(lifted - 0.5 * emptied)", "(lifted + 0.5 * emptied)"),
    Mutant("wear", WORN, "pressure.max() > 0", "pressure.max() >= 0"),
    Mutant("wear", WORN, "x, y) / len(\n                angles\n            )", "x, y)"),
    Mutant("wear", WORN, "state.worn.removed + rate * way", "state.worn.removed + pressure * way"),
    Mutant("wear", WORN, "state.sliding_distance + way", "way"),
    Mutant("wear", WORN, "min(step / float(rate.max()), ", "min(2 * step / float(rate.max()), "),
    Mutant("wear", WORN, "grid_x * cosine", "grid_x / cosine"),
    Mutant("wear", WORN, "value = value[nearest_true(known)]", "value = value * 1.0"),
    Mutant("trials", SLIDE, "math.sqrt(power / (len(values) - 1) / independent)",
           "math.sqrt(power / (len(values) - 1))"),
    Mutant("trials", SLIDE, "np.clip(deviation[1:] @ deviation[:-1] / power, 0.0, 0.99)",
           "np.clip(deviation[1:] @ deviation[:-1] / power, 0.0, 0.0)"),
    Mutant("trials", SLIDE, "math.hypot(cof.uncertainty, *(cof.value * part for part in parts))",
           "math.hypot(cof.uncertainty, *parts)"),
    Mutant("trials", SLIDE, "part.min() < 0.2 * target", "part.min() < 0.02 * target"),
    Mutant("trials", SLIDE, "part.min() < 0.9 * target else ()",
           "part.min() < 0.5 * target else ()"),
    Mutant("trials", SLIDE, "start = int(reached[0])", "start = int(reached[0]) + 1"),
    Mutant("trials", SLIDE, "next(factors) * normal + next(factors) * (plate.force - normal)",
           "next(factors) * normal + (plate.force - normal)"),
    Mutant("trials", SLIPS, "length = 2 * _half_window", "length = 3 + 2 * _half_window"),
    Mutant("film", STRIKE, "strike.rib**2 / gap**3", "strike.rib**2 / gap**2"),
    Mutant("film", STRIKE, "0.5 * strike.load", "strike.load"),
    Mutant("film", STRIKE, "strike.depth * (1 - land)", "strike.depth"),
    Mutant("film", STRIKE, "loss = 0.25 +", "loss = 0.5 +"),
    Mutant("film", PATIR, "value in (gamma, 1 / gamma)", "value in (gamma, gamma)"),
    Mutant("film", PATIR, "0.5 * h * (1 + erf(", "0.5 * h * (1 - erf("),
    Mutant("walkers", WALKER, "self.history.duration * recorded_speed / self.walking_speed",
           "self.history.duration * self.walking_speed / recorded_speed"),
    Mutant("walkers", WALKER, "np.exp(-times / self.brake_time)",
           "np.exp(-times * self.brake_time)"),
    Mutant("walkers", WALKER, "self.mass * self.effective_mass", "self.mass"),
)  # fmt: skip


def copied(folder: Path) -> Path:
    """Return a copy of what tests read."""
    for part in PARTS:
        source = REPOSITORY / part
        (shutil.copytree if source.is_dir() else shutil.copy)(source, folder / part)
    return folder


def passes(folder: Path, tests: tuple[str, ...]) -> bool:
    """Return whether the quick tests of some files pass in a copy."""
    paths = [folder / "src", folder / "tests"]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, paths))}
    options = ["-x", "-q", "-p", "no:xdist", "-m", "not slow"]
    command = [sys.executable, "-m", "pytest", *options, *(f"tests/{name}" for name in tests)]
    try:
        done = subprocess.run(
            command, cwd=folder, env=environment, capture_output=True, timeout=TIMEOUT, check=False
        )
    except subprocess.TimeoutExpired:
        return False
    if done.returncode not in (0, 1):
        raise SystemExit(f"the tests of {tests} did not run:\n{done.stdout.decode()}")
    return done.returncode == 0


def survives(mutant: Mutant, folder: Path) -> bool:
    """Return whether the quick tests of its room pass with a mutant."""
    path = folder / "src" / "underfoot" / mutant.file
    text = path.read_text(encoding="utf-8")
    if text.count(mutant.old) != 1:
        raise SystemExit(f"{mutant.file}: {text.count(mutant.old)} times {mutant.old!r}")
    path.write_text(text.replace(mutant.old, mutant.new), encoding="utf-8")
    try:
        return passes(folder, TESTS[mutant.room])
    finally:
        path.write_text(text, encoding="utf-8")


def main() -> None:
    """Make, run and count."""
    parser = ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("rooms", nargs="*", help=", ".join(TESTS))
    parser.add_argument("--jobs", type=int, default=2)
    given = parser.parse_args()
    rooms = given.rooms or list(TESTS)
    chosen = [mutant for mutant in (*SURVIVORS, *OTHERS) if mutant.room in rooms]
    alive: list[Mutant] = []
    with tempfile.TemporaryDirectory() as made, ThreadPoolExecutor(given.jobs) as pool:
        copies: Queue[Path] = Queue()
        for number in range(given.jobs):
            copies.put(copied(Path(made, str(number))))

        def looked(mutant: Mutant) -> None:
            folder = copies.get()
            lives = survives(mutant, folder)
            copies.put(folder)
            print(f"{'ALIVE ' if lives else 'killed'} {mutant.room}: {mutant.new!r}", flush=True)
            if lives:
                alive.append(mutant)

        for room in dict.fromkeys(mutant.room for mutant in chosen):
            assert passes(Path(made, "0"), TESTS[room]), f"{room}: fails without a mutant"
        list(pool.map(looked, chosen))
    for group, name in ((SURVIVORS, "earlier survivors"), (OTHERS, "others")):
        count = sum(mutant in chosen for mutant in group)
        print(f"{name}: {count - sum(mutant in alive for mutant in group)} of {count} killed")


if __name__ == "__main__":
    main()
