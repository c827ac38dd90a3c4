"""Ask LLVM for whole 512-bit registers where the processor has them.

For most Intel processors LLVM's default is 256 bits; the element loops run a third faster with 512
(measured), and where there are none the request has no effect.
"""

from __future__ import annotations

from typing import Any

from numba import types
from numba.extending import intrinsic

REQUEST = '"prefer-vector-width"="512"'


@intrinsic
def prefer_wide_registers(typing_context: Any) -> Any:
    """Mark the function it stands in; costs nothing when run."""

    def marked(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        attributes = builder.function.attributes
        # llvmlite checks names against a list that has no text attributes; the set itself takes it.
        if isinstance(attributes, set):
            set.add(attributes, REQUEST)
        return context.get_dummy_value()

    return types.void(), marked
