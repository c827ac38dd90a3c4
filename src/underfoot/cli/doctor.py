"""``underfoot doctor``: what is installed, what computes, what is missing and the remedy."""

from __future__ import annotations


def doctor() -> None:
    """Print versions, solver, threads, cache and which optional packages are missing."""
    from underfoot.core.installation import installation

    for label, value in installation():
        print(f"{label:20} {value}")
