"""Errors as plain sentences and exit codes; a traceback only on request."""

import functools
import os
import signal
import sys
from collections.abc import Callable
from types import FrameType
from typing import Any

import typer

INTERRUPTED, TERMINATED, INTERNAL = 130, 143, 70
"""Exit codes after Ctrl-C, after SIGTERM and after an error of the program itself."""
KEPT = "no partial output was left behind"
"""What is said of a stopped command that says nothing else."""


class Terminated(KeyboardInterrupt):
    """The process was asked to end (SIGTERM); it cleans up as after Ctrl-C."""


def guard_command(command: Callable[..., None]) -> Callable[..., None]:
    """Return the command with its errors on standard error; UNDERFOOT_DEBUG=1 shows tracebacks."""

    @functools.wraps(command)
    def run(*args: Any, **kwargs: Any) -> None:
        from underfoot.core.errors import Cancelled, UnderfootError, error_text

        if os.environ.get("UNDERFOOT_DEBUG") == "1":
            return command(*args, **kwargs)
        try:
            return command(*args, **kwargs)
        except typer.Exit:
            raise
        except Terminated as stop:
            text, code = f"terminated; {str(stop) or KEPT}", TERMINATED
        except KeyboardInterrupt as stop:
            text, code = f"stopped; {str(stop) or KEPT}", INTERRUPTED
        except Cancelled as stop:
            text, code = f"stopped; {stop.remedy or KEPT}", INTERRUPTED
        except (UnderfootError, MemoryError) as error:
            text, code = f"error: {error_text(error)}", getattr(error, "exit_code", 1)
        except BrokenPipeError:
            # the reader of a pipe (head, less) closed it: not an error
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            raise typer.Exit(0) from None
        except OSError as error:
            text, code = f"error: {error_text(error)}", 1
        except Exception as error:
            text, code = f"{error_text(error)}; UNDERFOOT_DEBUG=1 shows the traceback.", INTERNAL
        say(text)
        raise typer.Exit(code)

    return run


def end_cleanly_on_sigterm() -> None:
    """Turn SIGTERM into an exception, so that workers and partial output are removed."""

    def end(number: int, frame: FrameType | None) -> None:
        raise Terminated

    if signal.getsignal(signal.SIGTERM) is signal.SIG_DFL:
        signal.signal(signal.SIGTERM, end)


def say(text: str) -> None:
    """Print one message on standard error."""
    print(text, file=sys.stderr)
