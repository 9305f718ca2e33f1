"""3D Tiles 1.1: a surface for globes, in levels of detail that replace each other.

Points are placed on the ellipsoid of WGS 84 (pyproj), so a level is neither on a map nor on a
plane, and each file has 32-bit coordinates (east, north and up) around a local origin. The effects
of map projection, curvature and rounding are part of the error of a level: the largest distance of
a point of the survey from the point of the level at its x and y. The format is that of OGC
22-025r4.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_plain_array
from delone._base.atomic import replacing
from delone._base.extras import require
from delone._base.units import METERS
from delone.errors import InputError
from delone.io.gltf import write_local

if TYPE_CHECKING:
    import os

    from numpy.typing import ArrayLike

    from delone._base.types import Floats

__all__ = ["placed", "write_tileset"]

# The maximum number of levels in a tileset.
_MOST = 32


def write_tileset(
    folder: str | os.PathLike[str], tin: Any, *, errors: ArrayLike
) -> tuple[float, ...]:
    """Write a surface as 3D Tiles, for Cesium and other globes (extra ``geo``).

    Parameters
    ----------
    folder : str or path-like
        The folder of ``tileset.json`` and of one GLB file for each level. It is created if it does
        not exist; files with the same names are replaced.
    tin : TIN
        The surface, with a known reference system. Heights are in its `units`, or in meters if
        these are unknown, and are treated as heights above the ellipsoid: no geoid is applied.
    errors : array_like of float, shape (k,)
        For each level, the largest vertical distance of a point from its surface, coarsest first,
        as `max_error` of `TIN.simplify`; 0 for a level with all points that are not redundant.

    Returns
    -------
    tuple of float
        The error of each level in meters: the largest distance in space of a point of the survey
        from the level, including what curvature, map projection and rounding contribute. These are
        the geometric errors of the tiles.

    Raises
    ------
    InputError
        The reference system is unknown, or has no transformation to WGS 84 everywhere; or `errors`
        are not finite, at least 0 and descending.
    MissingExtraError
        pyproj is not installed.
    OutputError
        A file cannot be written.

    Notes
    -----
    Each level is one file of the whole surface, and a finer one replaces it as the camera comes
    closer. All levels come from one run of the simplification. ``tileset.json`` is written last.

    Examples
    --------
    >>> import tempfile
    >>> import numpy as np
    >>> from pathlib import Path
    >>> from delone.io import write_tileset
    >>> from delone.terrain import TIN
    >>> x, y = (axis.ravel() for axis in np.meshgrid(np.arange(33.0), np.arange(33.0)))
    >>> hill = np.column_stack((x + 155000, y + 463000, 9 - np.hypot(x - 16, y - 16) / 3))
    >>> tin = TIN.from_points(hill, crs="EPSG:28992", units="m")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     found = write_tileset(folder, tin, errors=[2, 0.5, 0])
    ...     sorted(path.name for path in Path(folder).iterdir())
    ['level-0.glb', 'level-1.glb', 'level-2.glb', 'tileset.json']
    >>> [round(error, 1) for error in found]
    [1.6, 0.5, 0.0]
    """
    wanted = _as_errors(errors)
    target = Path(folder)
    degrees, space = placed(tin)
    frame = _Frame(degrees, space)
    exact = frame.local(space)
    target.mkdir(exist_ok=True)
    levels = tin.simplification(max_error=float(wanted[-1]))
    found = []
    for number, error in enumerate(wanted.tolist()):
        surface = levels.surface(max_error=error)
        # Its points are among those of the survey, in a different order.
        own = frame.local(placed(surface)[1]).astype(np.float32).astype(np.float64)
        found.append(_distance(tin, exact, surface, own))
        with replacing(target / f"level-{number}.glb") as temporary:
            write_local(temporary, own, surface.simplices)
    document = _document(frame, exact, tuple(found))
    with replacing(target / "tileset.json") as temporary:
        text = json.dumps(document, indent=1, allow_nan=False) + "\n"
        temporary.write_text(text, encoding="utf-8", newline="\n")
    return tuple(found)


def _as_errors(errors: ArrayLike) -> Floats:
    """Return the errors of levels."""
    given = as_plain_array(errors, "errors")
    if given.ndim != 1 or given.dtype.kind not in "iuf" or not 1 <= len(given) <= _MOST:
        raise InputError(f"errors must be 1 to {_MOST} numbers, coarsest first; got {errors!r:.60}")
    found = given.astype(np.float64)
    if not (np.isfinite(found).all() and (found >= 0).all() and (np.diff(found) < 0).all()):
        raise InputError(f"errors must be at least 0 and descend; got {errors!r:.60}")
    return found


def _heights(tin: Any) -> Floats:
    """Return heights in meters."""
    meters: float = METERS[tin.units or "m"]
    found: Floats = tin.z * meters
    return found


def placed(tin: Any) -> tuple[Floats, Floats]:
    """Return longitudes and latitudes, (n, 2), and positions around the center of the earth."""
    pyproj = require("pyproj", extra="geo", what="placing a surface on the globe")
    if tin.crs is None:
        raise InputError(
            "the reference system of the surface is unknown, so its position on the globe is "
            "unknown, too: give crs to TIN.from_points (--crs)"
        )
    # Without heights: even those of compound systems are not transformed.
    to_degrees = pyproj.Transformer.from_crs(tin.crs, "EPSG:4326", always_xy=True)
    degrees = np.column_stack(to_degrees.transform(*tin.points.T))
    to_space = pyproj.Transformer.from_crs("EPSG:4979", "EPSG:4978", always_xy=True)
    space = np.column_stack(to_space.transform(*degrees.T, _heights(tin)))
    bad = np.flatnonzero(~np.isfinite(space).all(axis=1))
    if len(bad):
        x, y = tin.points[bad[0]].tolist()
        raise InputError(
            f"({x:.10g}, {y:.10g}) has no place on the globe in {tin.crs:.60}: is it the reference "
            "system of the points?"
        )
    return degrees, space


class _Frame:
    """East, north and up at a place, in meters."""

    def __init__(self, degrees: Floats, space: Floats) -> None:
        middle = (degrees.min(axis=0) + degrees.max(axis=0)) / 2
        lon, lat = np.radians(middle)
        east = (-np.sin(lon), np.cos(lon), 0.0)
        up = (np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat))
        self.axes = np.array((east, np.cross(up, east), up))
        self.origin = (space.min(axis=0) + space.max(axis=0)) / 2

    def local(self, space: Floats) -> Floats:
        """Return positions in the frame."""
        found: Floats = (space - self.origin) @ self.axes.T
        return found

    def matrix(self) -> list[float]:
        """Return the transform to the center of the earth, column by column."""
        found = np.eye(4)
        found[:3, :3] = self.axes.T
        found[:3, 3] = self.origin
        return [float(each) for each in found.T.ravel()]


def _distance(tin: Any, exact: Floats, surface: Any, own: Floats) -> float:
    """Return the largest distance of points from a level where it has their x and y."""
    used = np.unique(tin.simplices)
    place = surface.locate(tin.points[used])
    inside = place.simplex >= 0
    # On the outline, rounding may put a point outside a coarser level.
    corners = np.where(inside[:, None], surface.simplices[place.simplex], place.facet[:, [0, 1, 1]])
    weights = np.where(inside[:, None], place.barycentric, np.pad(place.weights, ((0, 0), (0, 1))))
    there = (weights[..., None] * own[corners]).sum(axis=1)
    return float(np.linalg.norm(there - exact[used], axis=1).max())


def _document(frame: _Frame, exact: Floats, errors: tuple[float, ...]) -> dict[str, Any]:
    """Return the contents of tileset.json."""
    # All levels are within their errors of the points.
    low, high = exact.min(axis=0) - max(errors), exact.max(axis=0) + max(errors)
    box = [*((low + high) / 2).tolist(), *np.diag((high - low) / 2).ravel().tolist()]
    tile: dict[str, Any] = {}
    for number in reversed(range(len(errors))):
        tile = {
            "boundingVolume": {"box": box},
            "geometricError": errors[number],
            "refine": "REPLACE",
            "content": {"uri": f"level-{number}.glb"},
            **({"children": [tile]} if tile else {}),
        }
    tile["transform"] = frame.matrix()
    return {
        "asset": {"version": "1.1", "generator": "delone"},
        "geometricError": float(np.linalg.norm(high - low)),
        "root": tile,
    }
