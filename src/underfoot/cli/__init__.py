"""The command line: ``underfoot new | check | run | compare | explain | catalogue | ...``."""

from __future__ import annotations


def main() -> None:
    """Run the command line; what goes wrong is said in plain words on standard error."""
    import sys

    try:
        from .app import app

        app()
    except KeyboardInterrupt:
        print("stopped; nothing was written", file=sys.stderr)
        sys.exit(130)


__all__ = ["main"]
