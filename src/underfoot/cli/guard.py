"""Errors as plain sentences and exit codes; a traceback only on request."""

import errno
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
_FILE_ERRORS = {
    errno.ENOENT: "{} does not exist",
    errno.EISDIR: "{} is a folder; a file is needed",
    errno.ENOTDIR: "a part of {} is a file, not a folder",
    errno.EACCES: "no permission to use {}",
    errno.EPERM: "no permission to use {}",
    errno.EROFS: "{} can't be written: the disk is read-only",
    errno.ENOSPC: "no space left on the disk for {}",
    errno.EEXIST: "{} exists already",
    errno.ENAMETOOLONG: "the name {} is too long",
}


class Terminated(KeyboardInterrupt):
    """The process was asked to end (SIGTERM); it cleans up as after Ctrl-C."""


def guarded(command: Callable[..., None]) -> Callable[..., None]:
    """Return the command with its errors on standard error; UNDERFOOT_DEBUG=1 shows tracebacks."""

    @functools.wraps(command)
    def run(*args: Any, **kwargs: Any) -> None:
        from underfoot.core.errors import Cancelled, UnderfootError

        if os.environ.get("UNDERFOOT_DEBUG") == "1":
            return command(*args, **kwargs)
        try:
            return command(*args, **kwargs)
        except typer.Exit:
            raise
        except Terminated as stop:
            text, code = f"terminated; {stop or KEPT}", TERMINATED
        except KeyboardInterrupt as stop:
            text, code = f"stopped; {stop or KEPT}", INTERRUPTED
        except Cancelled:
            text, code = f"stopped; {KEPT}", INTERRUPTED
        except UnderfootError as error:
            text, code = f"error: {error}", error.exit_code
        except BrokenPipeError:
            # the reader of a pipe (head, less) closed it: not an error
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            raise typer.Exit(0) from None
        except OSError as error:
            text, code = f"error: {file_trouble(error)}", 1
        except MemoryError:
            text, code = "error: not enough memory. Choose a coarser numerics.grid_spacing.", 1
        except Exception as error:
            text, code = f"internal error: {type(error).__name__}: {error}\n", INTERNAL
            text += "Please report it with the case file; UNDERFOOT_DEBUG=1 shows the traceback."
        say(text)
        raise typer.Exit(code)

    return run


def end_cleanly_on_sigterm() -> None:
    """Turn SIGTERM into an exception, so that workers and partial output are removed."""

    def end(number: int, frame: FrameType | None) -> None:
        raise Terminated

    if signal.getsignal(signal.SIGTERM) is signal.SIG_DFL:
        signal.signal(signal.SIGTERM, end)


def file_trouble(error: OSError) -> str:
    """Return what went wrong with a file, with its name."""
    name = str(error.filename or "")
    text = _FILE_ERRORS.get(error.errno or 0)
    if text is None:
        return f"{error.strerror or error}: {name}".rstrip(": ") + "."
    return text.format(name or "the file") + "."


def say(text: str) -> None:
    """Print one message on standard error."""
    print(text, file=sys.stderr)
