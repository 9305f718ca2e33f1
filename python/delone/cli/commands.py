"""The list of commands: a command's module is imported when the command is called.

The list itself imports none of these modules, so ``delone --help`` is fast, and a command does not
wait for libraries that other commands need.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, NamedTuple

import typer
from typer.core import TyperGroup

from delone.cli.wording import Switch

if TYPE_CHECKING:
    from collections.abc import Sequence

    from click import Context, HelpFormatter

__all__ = ["COMMANDS", "TASKS", "Commands", "options_of"]

_EPILOG = "The table of exit codes is in: delone --help"


class Listed(NamedTuple):
    """Where a command is, and the first sentence of its help."""

    module: str
    function: str
    summary: str
    # Whether its rows correspond to lines of the file, so that errors can name lines.
    on_rows: bool = True


COMMANDS = {
    "triangulate": Listed(
        "triangulate",
        "triangulate",
        "Triangulate the points of a file, report, and write meshes and plots.",
    ),
    "sphere": Listed(
        "sphere",
        "globe",
        "Triangulate longitudes and latitudes on the sphere, report, and write meshes.",
    ),
    "regrid": Listed(
        "regrid",
        "regrid",
        "Regrid the fields of a NetCDF file by the areas that cells share, exactly.",
        on_rows=False,
    ),
    "areal": Listed(
        "areal",
        "areal",
        "Transfer columns between layers of polygons by the areas that they share, exactly.",
        on_rows=False,
    ),
    "check": Listed(
        "check",
        "check",
        "Prove exactly that triangles are Delaunay, or name the faults and exit with 1.",
    ),
    "info": Listed("info", "info", "Describe the contents of a file without triangulating it."),
    "explore": Listed(
        "explore",
        "explore",
        "Show the triangulation of a file in the browser, where points can be moved.",
    ),
    "graph": Listed(
        "graph",
        "graph",
        "Compute a graph of neighbors, such as a spanning tree, and write its edges as lines.",
    ),
    "interpolate": Listed(
        "interpolate",
        "interpolate",
        "Interpolate the values of points to a raster, and write it to files and plots.",
    ),
    "crossval": Listed(
        "interpolate",
        "crossval",
        "Predict each value from the others, and report the error of each method.",
    ),
    "voronoi": Listed(
        "voronoi",
        "voronoi",
        "Clip the Voronoi cells of sites to an outline, and write them with their attributes.",
    ),
    "tile": Listed(
        "tile",
        "tile",
        "Triangulate more points than fit in memory, in tiles that form one triangulation.",
    ),
    "dem": Listed(
        "dem",
        "dem",
        "Make a raster of the surface through points: its heights, slope, aspect or hillshade.",
    ),
    "ground": Listed(
        "ground",
        "find_ground",
        "Find the ground among lidar points, and write their classes.",
        on_rows=False,
    ),
    "terrain": Listed(
        "site",
        "terrain",
        "Make several products from one surface, and a page with pictures and numbers.",
    ),
    "contours": Listed(
        "terrain",
        "contours",
        "Compute contour lines, or the polygons between them, of points with heights.",
    ),
    "profile": Listed(
        "terrain",
        "profile",
        "Compute the heights of surfaces along a line, or in cross sections: a table or a drawing.",
    ),
    "volume": Listed(
        "terrain",
        "volume",
        "Compute the volumes to cut and to fill between a surface and a height or another surface.",
    ),
    "difference": Listed(
        "difference",
        "difference",
        "Subtract a raster, a surface or a height from a raster of heights, cell by cell.",
    ),
    "simplify": Listed(
        "simplify",
        "simplify",
        "Simplify a surface, with a bound on the error at each point that is left out.",
    ),
    "hull": Listed("hull", "hull", "Compute the outline of points, and write its polygons."),
    "mesh": Listed(
        "mesh",
        "make_mesh",
        "Mesh polygons, or areas enclosed by lines, with triangles that have no small angles.",
        on_rows=False,
    ),
    "tetrahedralize": Listed(
        "tetrahedralize",
        "fill",
        "Fill a closed surface with tetrahedra; by default, its triangles are kept exactly.",
        on_rows=False,
    ),
    "cluster": Listed(
        "cluster",
        "cluster_points",
        "Find clusters of points, and write the points with their labels; noise is -1.",
    ),
}


# The commands in the order in which users look for them.
TASKS = {
    "Look at a file": ("info", "explore"),
    "Triangulate": ("triangulate", "sphere", "tile", "check"),
    "Outlines, cells, neighbors": ("hull", "voronoi", "graph", "cluster"),
    "Interpolate": ("interpolate", "crossval", "regrid", "areal"),
    "Terrain": (
        "ground",
        "terrain",
        "dem",
        "contours",
        "profile",
        "volume",
        "difference",
        "simplify",
    ),
    "Mesh": ("mesh", "tetrahedralize"),
}


class _Loading(dict[str, Any]):
    """The commands by name, each loaded when it is requested."""

    def __getitem__(self, name: str) -> Any:
        if super().__getitem__(name) is None:
            self[name] = _loaded(name)
        return super().__getitem__(name)

    def get(self, name: str, default: Any = None) -> Any:
        return self[name] if name in self else default  # noqa: SIM401


class Commands(TyperGroup):  # type: ignore[misc]
    """The commands, each loaded when it is needed."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.commands = _Loading.fromkeys(COMMANDS)

    def format_commands(self, ctx: Context, formatter: HelpFormatter) -> None:
        """Write the commands by task, with complete summaries, without loading any of them."""
        del ctx
        width = max(map(len, COMMANDS))
        for task, names in TASKS.items():
            with formatter.section(task):
                # One width for all lists, so that all summaries begin in the same column.
                formatter.write_dl([(f"{name:{width}}", COMMANDS[name].summary) for name in names])


def _loaded(name: str) -> Any:
    from delone.cli.lines import naming_lines

    listed = COMMANDS[name]
    function = getattr(import_module(f"delone.cli.{listed.module}"), listed.function)
    alone = typer.Typer(add_completion=False, rich_markup_mode=None)
    alone.command(name=name, epilog=_EPILOG)(naming_lines(function) if listed.on_rows else function)
    return typer.main.get_command(alone)


def options_of(arguments: Sequence[str]) -> dict[str, Switch]:
    """Return the options of the command that is called, by the names of arguments in Python."""
    name = next((each for each in arguments if each in COMMANDS), None)
    if name is None:
        return {}
    found: dict[str, Switch] = {}
    for each in _loaded(name).params:
        long = [option for option in each.opts if option.startswith("--")]
        off = next(iter(each.secondary_opts), None)
        for option in long:
            plain = option[2:].replace("-", "_")
            if not getattr(each, "is_flag", False):
                found[plain] = Switch(option)
            elif plain.startswith("no_"):
                found[plain[3:]] = Switch(f"no {option}", option)
            else:
                found[plain] = Switch(option, off or f"no {option}")
    return found
