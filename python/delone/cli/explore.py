"""The command ``explore``: a triangulation in the browser, served by this process."""

from __future__ import annotations

import threading
import webbrowser
from pathlib import Path
from typing import Annotated

import typer

from delone.cli.constraints import Constraints, read_input, triangulated
from delone.cli.exits import Exit, Failure, reading
from delone.cli.options import Classes, Layer, Workers, class_numbers, split
from delone.cli.referenced import Crs, Planar, referenced, require_known
from delone.cli.show import print_text, spinner
from delone.io import input_suffixes

__all__ = ["explore"]

# How often the server checks for Ctrl-C where that does not interrupt it.
_LOOK = 0.1  # seconds


def explore(
    source: Annotated[
        Path,
        typer.Argument(
            metavar="INPUT",
            help="File of points, lines or polygons: " + " ".join(input_suffixes()),
        ),
    ],
    *,
    columns: Annotated[
        str | None,
        typer.Option(help="Columns of x, y and z, by name or by number from 0."),
    ] = None,
    classes: Classes = None,
    layer: Layer = None,
    crossing: Annotated[
        str | None,
        typer.Option(help="Where lines cross: split (the default) or raise (an error)."),
    ] = None,
    outline: Annotated[
        bool,
        typer.Option(
            "--outline", help="Remove triangles outside polygons, or outside closed lines."
        ),
    ] = False,
    quality: Annotated[
        str,
        typer.Option(
            help="What triangles can be colored by: smallest_angle, largest_angle, area, "
            "radius_ratio or edge_ratio."
        ),
    ] = "smallest_angle",
    port: Annotated[
        int, typer.Option(min=0, max=65535, help="Port; by default the system chooses one.")
    ] = 0,
    no_browser: Annotated[
        bool, typer.Option("--no-browser", help="Print the address without opening it.")
    ] = False,
    crs: Crs = None,
    planar: Planar = False,
    workers: Workers = None,
) -> None:
    """Show the triangulation of a file in the browser, where points can be moved.

    The page is served only to this machine, at an address with a random token, until Ctrl-C.
    Nothing is written. Heights are values at the points.
    """
    # Imported here, because other commands do not need the modules of a server.
    from delone.explorer.server import ExploreServer
    from delone.explorer.state import Exploration

    require_known(crs)
    with spinner(False) as say:
        say(f"reading {source.name}")
        with reading():
            survey = read_input(
                source, columns=split(columns), classes=class_numbers(classes), layer=layer
            )
        survey = referenced(survey, crs, planar=planar, quiet=False)
        say(f"triangulating {source.name}")
        constraints = Constraints(crossing, outline, False, None)
        mesh, heights = triangulated(survey, constraints, workers=workers)
        state = Exploration(mesh, values=heights, quality=quality)
    try:
        server = ExploreServer(state, name=source.name, port=port)
    except OSError as error:
        raise Failure(f"--port {port}: {error.strerror}", Exit.OUTPUT) from error
    with server:
        print_text(f"{server.address}\nCtrl-C ends the command")
        if not no_browser:
            # Some browsers do not return until they are closed.
            threading.Thread(target=webbrowser.open, args=[server.address], daemon=True).start()
        server.serve_forever(poll_interval=_LOOK)
