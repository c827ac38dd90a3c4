"""The command line: ``underfoot new | check | run | compare | explain | catalogue | ...``."""


def main() -> None:
    """Run the command line; errors are plain sentences on standard error."""
    import os
    import sys

    # read once, when NumPy is loaded: threads cost more than they spare on matrices this small
    for name in ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ.setdefault(name, "1")
    from .guard import INTERRUPTED, TERMINATED, Terminated, end_cleanly_on_sigterm, say

    try:
        end_cleanly_on_sigterm()
        from .app import app

        app()
    except KeyboardInterrupt as stop:
        say("stopped; nothing was written")
        sys.exit(TERMINATED if isinstance(stop, Terminated) else INTERRUPTED)


__all__ = ["main"]
