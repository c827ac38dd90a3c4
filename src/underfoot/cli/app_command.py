"""``underfoot app``: the local web app on a project's folder."""

from pathlib import Path
from typing import Annotated

import typer


def app(
    folder: Annotated[
        Path, typer.Argument(help="The project; it is made if it is missing.")
    ] = Path("underfoot-project"),
    port: Annotated[
        int, typer.Option("--port", help="0 takes any that is free.", min=0, max=65535)
    ] = 8642,
    host: Annotated[
        str,
        typer.Option("--host", help="0.0.0.0 lets a phone of the same network in, with a warning."),
    ] = "127.0.0.1",
    no_browser: Annotated[
        bool, typer.Option("--no-browser", help="Do not open the browser.")
    ] = False,
) -> None:
    """Open the app in the browser: design a sole, see its friction, compare, answer for safety.

    The folder holds plain files: variants as cases, results as `underfoot run` writes them.
    """
    from underfoot.core.optional import optional_module

    optional_module("nicegui", "app", "underfoot app")
    from underfoot.app.serve import serve

    serve(folder, host, port, not no_browser)
