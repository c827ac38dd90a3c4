"""The element loops as a module: written by ``generate`` once a version, then imported."""

import sys
import warnings
from functools import cache
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path
from types import ModuleType
from typing import Any

from numba import types
from numba.extending import intrinsic

from underfoot.core import content_hash
from underfoot.core.cache import default_folder
from underfoot.core.files import whole_file

from . import generate

HERE = Path(__file__).parent
WIDE = '"prefer-vector-width"="512"'
"""Request to LLVM: for most Intel processors its default is 256 bits, and the loops run a third
faster with 512 (measured); where there are no such registers it has no effect."""


@cache
def element_loops() -> ModuleType:
    """Return the module with one ``advance_...`` function for each kind of material.

    Its source lies where Python keeps compiled files, ``__pycache__``, or in the user's cache
    folder where the package is read-only, so that Numba can keep the machine code beside it. The
    file's name holds a hash of every kernel that is compiled into it: a changed program never
    meets old machine code. Where nothing can be written, each process compiles anew and a
    ``RuntimeWarning`` says so.
    """
    text = generate.source()
    kernels = [path.read_text("utf-8") for path in sorted(HERE.glob("*.py"))]
    name = f"underfoot_element_loops_{content_hash(text, kernels)[:16]}"
    for folder in (HERE / "__pycache__", default_folder() / "kernels"):
        path = folder / f"{name}.generated"  # not .py: no part of the source
        if _write_if_new(path, text):
            loader = SourceFileLoader(name, str(path))
            spec = spec_from_loader(name, loader)
            assert spec is not None
            module = module_from_spec(spec)
            sys.modules[name] = module  # where Numba looks when it reads its cache
            loader.exec_module(module)
            return module
    warnings.warn(
        f"no cache folder can be written ({HERE / '__pycache__'}, {default_folder()}): the "
        "element loops are compiled again in every process, about half a minute each; set "
        "UNDERFOOT_CACHE to a folder that can be written",
        RuntimeWarning,
        stacklevel=2,
    )
    module = ModuleType(name)
    sys.modules[name] = module
    exec(compile(text.replace("cache=True, ", ""), name, "exec"), module.__dict__)
    return module


def _write_if_new(path: Path, text: str) -> bool:
    """Return whether ``path`` holds ``text``, written now if need be; whole at every moment."""
    try:
        if path.is_file() and path.read_text("utf-8") == text:
            return True
        with whole_file(path) as part:
            part.write_text(text, encoding="utf-8")
    except OSError:
        return False
    return True


@intrinsic
def prefer_wide_registers(typing_context: Any) -> Any:
    """Mark the function it stands in; costs nothing when run."""

    def mark_function(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        attributes = builder.function.attributes
        # llvmlite checks names against a list that has no text attributes; the set itself takes it.
        if isinstance(attributes, set):
            set.add(attributes, WIDE)
        return context.get_dummy_value()

    return types.void(), mark_function
