"""CityJSON 2.0: a surface with heights as the relief of a terrain (TINRelief).

CityJSON coordinates are integers with a scale and a translation. The scale is the largest of
0.001, 0.0001 and so on, in the unit of the points, at which no two points become one and no
triangle flips over or loses its area, which is decided exactly. So each coordinate is off by at
most half of the scale. The format is that of https://www.cityjson.org.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.georeference import parsed
from delone.errors import FileFormatError
from delone.io.content import content, require_finite_heights
from delone.io.systems import check_system
from delone.predicates import orient2d

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices
    from delone.exchange.parts import HasParts
    from delone.io.content import Wanted

__all__ = ["write_mesh"]

# The first is the accuracy of surveys; smaller ones are tried if points are closer.
_DIGITS = range(3, 16)
# The largest integers that readers can store in doubles.
_LARGEST = 2.0**53
# Number of triangles or points that become text at a time.
_BLOCK = 1 << 16


def write_mesh(path: Path, triangulation: HasParts, wanted: Wanted) -> None:
    """Write one object of the type TINRelief."""
    files, crs = f"{path.suffix} files of CityJSON", wanted.crs
    wanted.refuse(files, "edges", "attributes")
    wanted.require_heights(files, also="; GeoJSON is .geojson")
    check_system(crs, path.suffix)
    found = content(triangulation, z=wanted.z).bare()
    used, inverse = np.unique(found.simplices, return_inverse=True)
    rows: Indices = inverse.reshape(found.simplices.shape).astype(np.int32)
    points = found.points[used]
    require_finite_heights(points, files)
    if not len(rows):
        raise FileFormatError(f"{files} need a triangle")
    digits, origin, whole = _rounded(points, rows)
    with path.open("w", encoding="utf-8", newline="\n") as file:
        file.write(_head(points, crs, digits, origin))
        file.write('"CityObjects":{"terrain":{"type":"TINRelief","geometry":[')
        file.write('{"type":"CompositeSurface","lod":"1","boundaries":[\n')
        file.writelines(_lists(rows[:, None, :]))
        file.write(']}]}},\n"vertices":[\n')
        file.writelines(_lists(whole))
        file.write("]}\n")


def _rounded(points: Floats, rows: Indices) -> tuple[int, Floats, NDArray[np.int64]]:
    """Return the digits of the scale, the translation, and coordinates as integers."""
    origin = np.floor(points.min(axis=0))
    for digits in _DIGITS:
        scaled = np.rint((points - origin) * 10.0**digits)
        if not (scaled < _LARGEST).all():
            break
        a, b, c = (scaled[rows[:, k], :2] for k in range(3))
        if (orient2d(a, b, c) > 0).all():
            return digits, origin, scaled.astype(np.int64)
    raise FileFormatError(
        "triangles are so thin that CityJSON coordinates, integers of up to 53 bits, flip some of "
        "them over: simplify the surface, or merge close points with snap"
    )


def _head(points: Floats, crs: str | None, digits: int, origin: Floats) -> str:
    """Return the beginning of a file, up to its objects."""
    low, high = points.min(axis=0), points.max(axis=0)
    metadata: dict[str, Any] = {"geographicalExtent": [*low.tolist(), *high.tolist()]}
    system = None if crs is None else parsed(crs)
    named = None if system is None else system.to_authority()
    if named is not None:
        metadata["referenceSystem"] = f"https://www.opengis.net/def/crs/{named[0]}/0/{named[1]}"
    head = {
        "type": "CityJSON",
        "version": "2.0",
        "transform": {"scale": [float(f"1e-{digits}")] * 3, "translate": origin.tolist()},
        "metadata": metadata,
    }
    return json.dumps(head, separators=(",", ":"), allow_nan=False)[:-1] + ",\n"


def _lists(array: NDArray[Any]) -> Iterator[str]:
    """Yield the rows of an array as JSON lists, with commas between them."""
    for start in range(0, len(array), _BLOCK):
        text = json.dumps(array[start : start + _BLOCK].tolist(), separators=(",", ":"))
        yield ("" if start == 0 else ",\n") + text[1:-1]
