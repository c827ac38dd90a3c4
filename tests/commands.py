"""The command line as a person meets it: as a process of its own, or called in this one."""

import os
import subprocess
import sys
from contextlib import chdir
from functools import cache
from subprocess import CompletedProcess

import typer.main
from typer.testing import CliRunner

# Typer reads the signature of every command anew for each call
typer.main.get_params_from_function = cache(typer.main.get_params_from_function)
COMMAND = [sys.executable, "-c", "from underfoot.cli import main; main()"]


def process(*words, folder=".", **settings):
    """Return the ended process of a command; ``settings`` are variables of its environment."""
    return subprocess.run(
        [*COMMAND, *map(str, words)],
        cwd=folder, env={**os.environ, **settings},
        capture_output=True, text=True, timeout=300, check=False,
    )  # fmt: skip


def called(*words, folder="."):
    """Return what the process of a command would; called here, it spares a CPU second of start."""
    from underfoot.cli.app import app

    with chdir(folder):
        done = CliRunner().invoke(app, [str(word) for word in words])
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception
    return CompletedProcess(words, done.exit_code, done.stdout, done.stderr)


def said(folder, *words):
    """Return how a command ended and what it printed, without the name of its folder."""
    done = called(*words, folder=folder)
    printed = (text.replace(str(folder), "HERE") for text in (done.stdout, done.stderr))
    return [done.returncode, *printed]
