"""Optimisations of a noisy made-up peak: our proposals beside BoTorch's and evenly spread designs.

``python -m benchmarks noisy_optimisation``; UNDERFOOT_BENCH_SEEDS (8) and UNDERFOOT_BENCH_CASES (40
runs each) set its size. Prints how far the true COF of each chosen tread lies below the peak of
0.300, and CPU seconds. BoTorch (not a dependency) draws batches by noisy expected improvement
(``qLogNoisyExpectedImprovement`` on a ``SingleTaskGP``); all else of a study is the same.
"""

from __future__ import annotations

import os
import sys
import time
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np

from underfoot.explore import proposals
from underfoot.explore.result import StudyResult

SEEDS = int(os.environ.get("UNDERFOOT_BENCH_SEEDS", "8"))
BUDGET = int(os.environ.get("UNDERFOOT_BENCH_CASES", "40"))
Points = list[tuple[float, ...]]


def by_botorch(so_far: StudyResult, count: int) -> Points:
    """Return the next designs as BoTorch proposes them."""
    import torch
    from botorch.acquisition.logei import qLogNoisyExpectedImprovement
    from botorch.fit import fit_gpytorch_mll
    from botorch.models import SingleTaskGP
    from botorch.models.transforms import Standardize
    from botorch.optim import optimize_acqf
    from gpytorch import ExactMarginalLogLikelihood

    torch.set_num_threads(1)
    designs = [one for one in so_far.designs if one.usable]
    points = torch.tensor([one.point for one in designs], dtype=torch.double)
    values = torch.tensor(-so_far.goal_values(designs) * so_far.plan.signs)
    model = SingleTaskGP(points, values, outcome_transform=Standardize(1))
    fit_gpytorch_mll(ExactMarginalLogLikelihood(model.likelihood, model))
    size = points.shape[1]
    chosen, _ = optimize_acqf(
        qLogNoisyExpectedImprovement(model, points, prune_baseline=True),
        bounds=torch.tensor([[0.0] * size, [1.0] * size], dtype=torch.double),
        q=count,
        num_restarts=8,
        raw_samples=128,
        sequential=True,
    )
    return [tuple(map(float, row)) for row in chosen.numpy()]


def spread_evenly(so_far: StudyResult, count: int) -> Points:
    """Return the next designs of a Sobol sequence."""
    done = len(so_far.designs)
    return so_far.plan.sampled_points(done + count)[done:]


def main() -> None:
    """Print the shortfall of the chosen treads."""
    sys.path.insert(0, str(Path(__file__).parents[1]))
    from tests.properties.test_study_noise import peak, played

    ways: dict[str, Callable[[StudyResult, int], Points]] = {
        "ours": proposals._promising,
        "BoTorch": by_botorch,
        "spread evenly": spread_evenly,
    }
    for name, way in ways.items():
        proposals._promising, began, short = way, time.process_time(), []
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # of BoTorch's fits
                for seed in range(SEEDS):
                    (best,) = played(f"budget = {BUDGET}", seed).best(1)
                    short.append(0.3 - peak(best.point))
        except ImportError:
            print(f"{name}: not installed")
            continue
        finally:
            proposals._promising = ways["ours"]
        spent = (time.process_time() - began) / SEEDS
        print(
            f"{name}: {np.mean(short):.5f} below the peak in the mean, {np.median(short):.5f} in "
            f"the median, {np.max(short):.5f} at most; {spent:.1f} CPU s a study of {BUDGET} runs",
            flush=True,
        )


if __name__ == "__main__":
    main()
