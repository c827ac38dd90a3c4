"""Element loops of a block as they are written, not compiled: all lanes at once, by arrays."""

from functools import cache
from typing import Any

import numpy as np

from underfoot.block._kernels.energy import element_energies
from underfoot.block._kernels.generate import LANES, source
from underfoot.block._kernels.motion import contact, move


def plain(kernel: Any) -> Any:
    """Return a kernel as it is written."""
    return getattr(kernel, "py_func", kernel)


@cache
def written_loops() -> dict[str, Any]:
    """Return the loops of all kinds of material by their names."""
    loops: dict[str, Any] = {
        "njit": lambda *_, **__: lambda kernel: kernel, "prefer_wide_registers": lambda: None,
        "element_energies": plain(element_energies), "contact": plain(contact),
        "move": plain(move), "EVERY": (np.arange(LANES),),
    }  # fmt: skip
    text = source().replace(f"for l in range({LANES}):", "for l in EVERY:")
    exec("\n".join(line for line in text.splitlines() if not line.startswith("from ")), loops)
    return loops
