"""The graphics card of this machine, and the memory that is free where an array lies."""

from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from .checks import choice
from .errors import InputError, MissingExtraError

DEVICES = ("auto", "cpu", "cuda")
_WORTH_IT = 512 * 512
"""Points from which "auto" takes the card (assumed): below, it mostly waits for its next call."""


def card() -> str | None:
    """Return the name of the card that PyTorch computes on; None without one, or without it."""
    if find_spec("torch") is None:
        return None
    torch = import_module("torch")
    return torch.cuda.get_device_name() if torch.cuda.is_available() else None


def described_card() -> str:
    """Return the card and its memory, or why there is none."""
    if find_spec("torch") is None:
        return 'none looked for; remedy: pip install "underfoot[accelerator]"'
    name = card()
    if name is None:
        return "none; rough contact runs on the processor"
    torch = import_module("torch")
    return f"{name}, {torch.cuda.get_device_properties(0).total_memory / 1e9:.0f} GB"


def on_card(device: str, points: int) -> bool:
    """Return whether an array of ``points`` goes to the card: as ``device`` of DEVICES says.

    Raises:
        InputError: An unknown device, or "cuda" where there is no card.
        MissingExtraError: "cuda" without PyTorch.
    """
    choice(device, DEVICES, "device")
    if device == "auto":
        return points >= _WORTH_IT and card() is not None
    if device == "cuda" and card() is None:
        if find_spec("torch") is None:
            raise MissingExtraError("torch", "accelerator", "rough contact on a graphics card")
        raise InputError(
            "no graphics card is there",
            where="device",
            allowed='"auto" or "cpu"',
            remedy="underfoot doctor names the card that PyTorch finds",
        )
    return device == "cuda"


def to_card(array: Any) -> Any:
    """Return an array of NumPy as a tensor on the card."""
    return import_module("torch").asarray(array, device="cuda")


def free_memory(array: Any) -> int | None:
    """Return the bytes free where ``array`` lies; None where the system doesn't tell."""
    place: Any = getattr(array, "device", "cpu")
    if getattr(place, "type", "") == "cuda":
        torch = import_module("torch")
        kept = torch.cuda.memory_reserved(place) - torch.cuda.memory_allocated(place)
        return torch.cuda.mem_get_info(place)[0] + kept
    if hasattr(place, "mem_info"):  # CuPy
        return int(place.mem_info[0])
    memory = Path("/proc/meminfo")
    if not memory.is_file():
        return None
    lines = memory.read_text().splitlines()
    return next((1024 * int(x.split()[1]) for x in lines if x.startswith("MemAvailable")), None)
