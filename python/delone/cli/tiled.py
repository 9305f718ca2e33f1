"""Folders of tiles, the output of ``delone tile``, as input of commands for surfaces."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any

from delone import distributed
from delone.cli.exits import Exit, Failure, reading
from delone.cli.surfaces import SurfaceOptions, surface
from delone.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from delone.cli.report import Stopwatch
    from delone.distributed import TiledDelaunay
    from delone.terrain import TIN

__all__ = ["refuse_for_tiles", "surface_or_tiles"]

# Options that are allowed with tiles.
_PRINTING = ("planar", "as_json", "quiet", "chord", "crs", "workers")
# Options that also apply to other files used with the tiles.
_OTHERS = ("layer", "step", "nodata", "window", "columns", "classes", "units")


def surface_or_tiles(
    source: Path,
    options: SurfaceOptions,
    watch: Stopwatch,
    say: Callable[[str], None],
    *,
    others: Sequence[Path] = (),
    aligned: bool = False,
) -> TIN | TiledDelaunay:
    """Return the surface of files, or the tiles in a folder."""
    if not source.is_dir():
        return surface(source, options, watch, say, others=others, aligned=aligned)
    allowed = (*_PRINTING, *_OTHERS) if others else _PRINTING
    refuse_for_tiles(vars(options), allowed)
    if options.crs is not None:
        raise Failure(
            "--crs: the tiles already have the reference system given to delone tile", Exit.USAGE
        )
    with reading(quiet=options.quiet), watch.stage("open"):
        found = distributed.open(source)
        if not found.manifest["heights"]:
            raise InputError(f"{source}: the points of these tiles have no heights")
    return found


def refuse_for_tiles(given: dict[str, Any], allowed: Sequence[str] = _PRINTING) -> None:
    """Reject options that change how a surface is made, because tiles exist already."""
    plain = {each.name: each.default for each in fields(SurfaceOptions)} | {"bounds": None}
    set_ = [
        name
        for name, default in plain.items()
        if name in given and given[name] != default and name not in allowed
    ]
    if set_:
        options = ", ".join(f"--{name.replace('_', '-')}" for name in set_)
        raise Failure(f"{options}: for files of points, not for folders of tiles", Exit.USAGE)
