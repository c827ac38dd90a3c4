"""The command line: ``underfoot new | check | run | compare | explain | catalogue | ...``."""


def main() -> None:
    """Run the command line; errors are plain sentences on standard error."""
    import sys

    from .guard import INTERRUPTED, TERMINATED, Terminated, end_cleanly_on_sigterm, say

    try:
        end_cleanly_on_sigterm()
        from .app import app

        app()
    except KeyboardInterrupt as stop:
        say("stopped; nothing was written")
        sys.exit(TERMINATED if isinstance(stop, Terminated) else INTERRUPTED)


__all__ = ["main"]
