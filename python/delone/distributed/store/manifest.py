"""The manifest of a finished output. It is written last; without it there is no output."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from delone import _core
from delone.distributed.store.output import tile_names
from delone.distributed.store.schema import FORMAT, TIES, check_manifest

if TYPE_CHECKING:
    from collections.abc import Mapping

    from delone.distributed.pure.layout import Layout
    from delone.distributed.store.files import Store

__all__ = ["assemble", "manifest_of"]


def assemble(
    run: Mapping[str, Any],
    crs: str | None,
    layout: Layout,
    figures: Mapping[str, int],
    finished: Mapping[int, Mapping[str, Any]],
) -> dict[str, Any]:
    """Return the manifest of tiles that have all been written."""
    boxes = [finished[tile]["box"] for tile in sorted(finished)]
    tiles = []
    for tile in sorted(finished):
        own = {name: value for name, value in finished[tile].items() if name not in _PASSING}
        files = dict(zip(("vertices", "triangles"), tile_names(tile), strict=True))
        tiles.append({"tile": tile, "files": files, **own})
    return {
        "format": FORMAT,
        "delone": _core.__version__,
        "ties": TIES,
        "crs": crs,
        "bounds": [
            min(box[0] for box in boxes),
            min(box[1] for box in boxes),
            max(box[2] for box in boxes),
            max(box[3] for box in boxes),
        ],
        "triangles": sum(tile["triangles"] for tile in tiles),
        **figures,
        "heights": "z" in (layout.type.names or ()),
        "attributes": [n for n in layout.type.names or () if n not in ("id", "x", "y", "z")],
        "tree": {
            "axis": layout.tiles.axis.tolist(),
            "cut": layout.tiles.cut.tolist(),
            "children": layout.tiles.children.tolist(),
        },
        "run": dict(run),
        "tiles": tiles,
    }


# Fields of summaries about the task, not the tile.
_PASSING = ("seconds", "memory")


def manifest_of(store: Store) -> dict[str, Any]:
    """Return the manifest of an output; FileNotFoundError if there is none, or none finished."""
    found = store.noted("manifest.json")
    if found is None:
        if store.exists("work/run.json"):
            raise FileNotFoundError(
                f"{store.root} is not finished: run triangulate again with the same arguments"
            )
        raise FileNotFoundError(f"{store.root} does not contain a tiled triangulation")
    check_manifest(found, store.path("manifest.json"))
    manifest: dict[str, Any] = found
    return manifest
