"""Errors as plain words and exit codes; a traceback only on request."""

from __future__ import annotations

import errno
import functools
import os
import sys
from collections.abc import Callable
from typing import ParamSpec, TypeVar

import typer

P = ParamSpec("P")
R = TypeVar("R")
STOPPED = 130
FAULT = 70


def guarded(command: Callable[P, R]) -> Callable[P, R]:
    """Return the command with its errors told on standard error; UNDERFOOT_DEBUG=1 shows all."""

    @functools.wraps(command)
    def told(*args: P.args, **kwargs: P.kwargs) -> R:
        from underfoot.core.errors import Cancelled, UnderfootError

        if os.environ.get("UNDERFOOT_DEBUG") == "1":
            return command(*args, **kwargs)
        try:
            return command(*args, **kwargs)
        except (KeyboardInterrupt, Cancelled):
            say("stopped; nothing half-written was left behind")
            raise typer.Exit(STOPPED) from None
        except UnderfootError as error:
            say(f"error: {error}")
            raise typer.Exit(error.exit_code) from None
        except BrokenPipeError:
            # the reader of a pipe (head, less) closed it: that is no error of ours
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            raise typer.Exit(0) from None
        except OSError as error:
            say(f"error: {file_trouble(error)}")
            raise typer.Exit(1) from None
        except MemoryError:
            say("error: not enough memory. Choose a coarser numerics.grid_spacing.")
            raise typer.Exit(1) from None
        except typer.Exit:
            raise
        except Exception as error:
            say(f"fault of the program: {type(error).__name__}: {error}")
            say("UNDERFOOT_DEBUG=1 shows where; please report it with the case file.")
            raise typer.Exit(FAULT) from None

    return told


def file_trouble(error: OSError) -> str:
    """Return what went wrong with a file, in words and with its name."""
    name = str(error.filename or "")
    words = {
        errno.ENOENT: "there is no {}",
        errno.EISDIR: "{} is a folder; a file is needed",
        errno.ENOTDIR: "a part of {} is a file, not a folder",
        errno.EACCES: "no permission to use {}",
        errno.EPERM: "no permission to use {}",
        errno.EROFS: "{} can't be written: the disk is read-only",
        errno.ENOSPC: "no space left on the disk for {}",
        errno.EEXIST: "{} exists already",
        errno.ENAMETOOLONG: "the name {} is too long",
    }.get(error.errno or 0)
    if words is None:
        return f"{error.strerror or error}: {name}".rstrip(": ") + "."
    return words.format(name or "the file") + "."


def say(text: str) -> None:
    """Print one message on standard error."""
    print(text, file=sys.stderr)
