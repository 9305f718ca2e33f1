"""Lidar points in a folder: Entwine Point Tiles, version 1, an octree with a file for each node.

The named file is ``ept.json``. Next to it, pages in ``ept-hierarchy`` contain the number of points
of each node, and ``ept-data`` contains the points: LAZ files (laspy and lazrs, extra ``las``), or
records of the schema. File names are built only from node numbers, and links are not followed. The
page of a node lists that node and nodes below it, each with its parent; a count of -1 means that
the node has its own page. So each page is read once, and no node is listed twice.

The number of points of a node is compared with its file before memory is allocated for them.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import pairwise
from math import isfinite
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.files import loaded
from delone.errors import FileFormatError
from delone.io import las
from delone.io.dem import as_bounds
from delone.io.pointset import PointSet
from delone.io.systems import check_system

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats

    Box = tuple[float, float, float, float]
    Key = tuple[int, int, int, int]

__all__ = ["describe", "read_points"]

_KEY = re.compile("-".join(["(0|[1-9][0-9]{0,15})"] * 4))
# The deepest level at which doubles can still distinguish the cubes.
_DEEPEST = 50
# The largest number of points, and the largest coordinate that doubles do not round.
_MOST, _LARGEST = (1 << 64) - 1, 1 << 53
_KINDS = {"signed": "i", "unsigned": "u", "float": "f"}
_SIZES = {"signed": (1, 2, 4, 8), "unsigned": (1, 2, 4, 8), "float": (4, 8)}
_ENDINGS = {"laszip": ".laz", "binary": ".bin"}
# What laspy calls the dimensions of a schema; others keep their names.
_NAMES = {
    "Intensity": "intensity",
    "ReturnNumber": "return_number",
    "NumberOfReturns": "number_of_returns",
    "ScanDirectionFlag": "scan_direction_flag",
    "EdgeOfFlightLine": "edge_of_flight_line",
    "Classification": "classification",
    "ScanAngleRank": "scan_angle_rank",
    "UserData": "user_data",
    "PointSourceId": "point_source_id",
    "GpsTime": "gps_time",
    "Red": "red",
    "Green": "green",
    "Blue": "blue",
}


@dataclass(frozen=True, eq=False, kw_only=True)
class _Tree:
    """The contents of ``ept.json``, with the scale and the offset of each dimension."""

    path: Path
    data: str
    count: int
    low: tuple[float, ...]
    high: tuple[float, ...]
    record: np.dtype[Any]
    scaling: dict[str, tuple[float, float]]
    crs: str | None

    def beside(self, folder: str, name: str) -> Path:
        """Return a file of the octree; a link is rejected, unless it is ``ept.json`` itself."""
        found = self.path.resolve().parent / folder / name
        if found.resolve() != found:
            raise FileFormatError(f"{found} is a link to another file, which is not followed")
        if not found.is_file():
            raise FileFormatError(f"{self.path} is incomplete: there is no file {folder}/{name}")
        return found

    def meets(self, key: Key, box: Box | None) -> bool:
        """Return whether a node may have points inside a box."""
        if box is None:
            return True
        for axis in range(2):
            size = self.high[axis] - self.low[axis]
            side = size / 2.0 ** key[0]
            start = self.low[axis] + key[1 + axis] * side
            # Coordinates are rounded to a multiple of the scale.
            slack = abs(self.scaling["XY"[axis]][0]) + 1e-9 * size
            if start + side + slack < box[axis] or start - slack > box[2 + axis]:
                return False
        return True


def read_points(
    path: Path,
    *,
    columns: Sequence[str | int] | None,
    attributes: Sequence[str],
    classes: Sequence[int] | None,
    everything: bool = False,
    bounds: Sequence[float] | None = None,
) -> PointSet:
    """Read points of an octree, node by node; see `delone.io.read_points`."""
    box = as_bounds(bounds)
    if columns is not None:
        raise FileFormatError(
            f"{path}: point tiles always have the coordinates x, y and z; columns cannot be chosen"
        )
    tree = _tree(path)
    nodes = sorted(_nodes(tree, box).items())
    total = sum(count for _, count in nodes)
    if box is None and total != tree.count:
        raise FileFormatError(
            f"{path} declares {tree.count} points, and its nodes have {total}: give bounds to read "
            "the points of the nodes"
        )
    read = _read_packed if tree.data == "laszip" else _read_records
    parts = [
        read(tree, key, count, attributes, classes, box, everything=everything)
        for key, count in nodes
        if count
    ]
    las.require_some(path, sum(map(len, parts)), classes, box)
    return _joined(tree, parts)


def describe(path: Path) -> dict[str, Any]:
    """Return the type and number of nodes, the size of all point files, and the dimensions."""
    tree = _tree(path)
    nodes = [key for key, count in _nodes(tree, None).items() if count]
    files = (tree.beside("ept-data", _name(key) + _ENDINGS[tree.data]) for key in nodes)
    return {
        "ept_data": tree.data,
        "ept_nodes": len(nodes),
        "file_bytes": sum(file.stat().st_size for file in files),
        "dimensions": [_NAMES.get(name, name) for name in tree.record.names or ()],
    }


def _joined(tree: _Tree, parts: list[PointSet]) -> PointSet:
    """Return the points of all nodes, one after another."""
    names = [tuple(part.attributes) for part in parts]
    if any(a != b for a, b in pairwise(names)):
        raise FileFormatError(f"{tree.path} is corrupt: its nodes have different dimensions")
    heights = [part.z for part in parts if part.z is not None]
    return PointSet(
        points=np.concatenate([np.empty((0, 2)), *(part.points for part in parts)]),
        z=np.concatenate([np.empty(0), *heights]),
        attributes={
            name: np.concatenate([part.attributes[name] for part in parts])
            for name in (names[0] if names else ())
        },
        crs=tree.crs or next((part.crs for part in parts), None),
        source=str(tree.path),
    )


def _read_packed(  # noqa: PLR0917
    tree: _Tree,
    key: Key,
    count: int,
    attributes: Sequence[str],
    classes: Sequence[int] | None,
    box: Box | None,
    *,
    everything: bool,
) -> PointSet:
    """Read a node that is a LAZ file."""
    file = tree.beside("ept-data", _name(key) + _ENDINGS[tree.data])
    return las.read_within(file, attributes, classes, box, everything=everything, count=count)


def _read_records(  # noqa: PLR0917
    tree: _Tree,
    key: Key,
    count: int,
    attributes: Sequence[str],
    classes: Sequence[int] | None,
    box: Box | None,
    *,
    everything: bool,
) -> PointSet:
    """Read a node whose file contains records of the schema."""
    file = tree.beside("ept-data", _name(key) + _ENDINGS[tree.data])
    size = file.stat().st_size
    if size != count * tree.record.itemsize:
        raise FileFormatError(
            f"{file} has {size} bytes, and {count} points take {count * tree.record.itemsize}"
        )
    records = np.fromfile(file, dtype=tree.record)
    names = {_NAMES.get(name, name): name for name in tree.record.names or ()}
    wanted = [name for name in names if name not in {"X", "Y", "Z"}] if everything else attributes
    needed = [*wanted, *(["classification"] if classes is not None else [])]
    unknown = [name for name in needed if name not in names]
    if unknown:
        raise FileFormatError(
            f"{tree.path} has no dimension {unknown[0]!r:.80}; it has {', '.join(sorted(names))}"
        )
    x, y, z = (_scaled(file, records[axis], axis, tree.scaling[axis]) for axis in "XYZ")
    keep: Bools = np.ones(len(records), dtype=bool)
    if classes is not None:
        keep &= np.isin(_values(tree, file, records, names["classification"]), list(classes))
    if box is not None:
        left, bottom, right, top = box
        keep &= (x >= left) & (x <= right) & (y >= bottom) & (y <= top)
    further = {name: _values(tree, file, records, names[name])[keep] for name in wanted}
    return PointSet(points=np.column_stack((x, y))[keep], z=z[keep], attributes=further)


def _values(tree: _Tree, file: Path, records: NDArray[Any], name: str) -> NDArray[Any]:
    """Return the values of a dimension: those of the records, unless the schema scales them."""
    if tree.scaling[name] == (1, 0):
        return records[name]
    return _scaled(file, records[name], name, tree.scaling[name])


def _scaled(file: Path, values: NDArray[Any], name: str, scaling: tuple[float, float]) -> Floats:
    """Return scaled numbers; finite ones that would become infinite are rejected."""
    if values.dtype.kind in "iu" and values.dtype.itemsize == 8:
        # What is rounded up to the end of the range cannot be converted back.
        lowest, highest = (int(end) for end in (values.min(initial=0), values.max(initial=0)))
        if max(-lowest, highest) > _LARGEST:
            raise FileFormatError(
                f"{file} has values of {name} beyond 2**53, which doubles would round"
            )
    scale, offset = scaling
    with np.errstate(over="ignore", invalid="ignore"):
        found: Floats = values.astype(np.float64) * scale + offset
    lost = np.flatnonzero(np.isfinite(values) & ~np.isfinite(found))
    if len(lost):
        raise FileFormatError(
            f"{file} has {name}={values[lost[0]]} in record {lost[0]}, which the scale {scale} "
            f"and the offset {offset} of the schema make infinite"
        )
    return found


def _nodes(tree: _Tree, box: Box | None) -> dict[Key, int]:
    """Return the number of points of each node that may have points inside a box."""
    found: dict[Key, int] = {}
    pages: list[Key] = [(0, 0, 0, 0)]
    # A page only refers to pages of nodes below it, so each is read once.
    while pages:
        for key, count in _page(tree, pages.pop()).items():
            if not tree.meets(key, box):
                continue
            if count == -1:
                pages.append(key)
            else:
                found[key] = count
    return found


def _page(tree: _Tree, root: Key) -> dict[Key, int]:
    """Return the counts of a page by node: -1 for a node that has its own page."""
    file = tree.beside("ept-hierarchy", f"{_name(root)}.json")
    content = _loaded(file)
    if not isinstance(content, dict):
        raise FileFormatError(f"{file} is corrupt: it has no numbers of points by node")
    page: dict[Key, int] = {}
    for name, count in content.items():
        key = _key(name)
        if key is None or _ancestor(key, root[0]) != root:
            raise FileFormatError(f"{file} is corrupt: {name!r:.80} is not in the octree below it")
        if not _is_whole(count) or not -1 <= count <= _MOST:
            raise FileFormatError(f"{file} is corrupt: node {name} has {count!r:.40} points")
        page[key] = count
    if page.get(root, -1) == -1:
        raise FileFormatError(f"{file} is corrupt: it does not have its own node {_name(root)}")
    for key in page:
        above = _ancestor(key, key[0] - 1)
        if key != root and (above is None or page.get(above, -1) == -1):
            raise FileFormatError(f"{file} is corrupt: it has node {_name(key)} without its parent")
    return page


def _name(key: Key) -> str:
    return "-".join(map(str, key))


def _key(name: str) -> Key | None:
    """Return the level and the position of a node; None if there is no such node."""
    found = _KEY.fullmatch(name)
    if not found:
        return None
    level, x, y, z = map(int, found.groups())
    return (level, x, y, z) if level <= _DEEPEST and max(x, y, z) < 1 << level else None


def _ancestor(key: Key, level: int) -> Key | None:
    """Return the node at a level that contains a node; None if the level is below it."""
    up = key[0] - level
    return None if up < 0 else (level, key[1] >> up, key[2] >> up, key[3] >> up)


def _tree(path: Path) -> _Tree:
    """Read and check ``ept.json``."""
    content = _loaded(path)
    if not isinstance(content, dict) or "dataType" not in content:
        raise FileFormatError(f"{path} does not describe point tiles: it has no dataType")
    version = content.get("version")
    if not (isinstance(version, str) and version.startswith("1.")):
        raise FileFormatError(f"{path}: point tiles of version {version!r:.40}; 1.0.0 is read")
    data = content["dataType"]
    if not (isinstance(data, str) and data in _ENDINGS):
        raise FileFormatError(
            f"{path}: nodes of type {data!r:.40} are not read, only laszip and binary: convert it, "
            "for example with Entwine"
        )
    if content.get("hierarchyType", "json") != "json":
        raise FileFormatError(
            f"{path}: a hierarchy of type {content['hierarchyType']!r:.40} is not read, only json"
        )
    count = content.get("points")
    if not isinstance(count, int) or not _is_whole(count) or not 0 <= count <= _MOST:
        raise FileFormatError(f"{path} is corrupt: it declares {count!r:.40} points")
    low, high = _bounds(path, content.get("bounds"))
    record, scaling = _schema(path, content.get("schema"))
    return _Tree(
        path=path,
        data=data,
        count=count,
        low=low,
        high=high,
        record=record,
        scaling=scaling,
        crs=_system(path, content.get("srs")),
    )


def _bounds(path: Path, given: Any) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return the lower and the upper corner of the root."""
    if isinstance(given, list) and len(given) == 6 and all(map(_is_finite, given)):
        low, high = tuple(map(float, given[:3])), tuple(map(float, given[3:]))
        if all(a < b and isfinite(b - a) for a, b in zip(low, high, strict=True)):
            return low, high
    raise FileFormatError(f"{path} is corrupt: its bounds {given!r:.80} are not those of a cube")


def _schema(path: Path, given: Any) -> tuple[np.dtype[Any], dict[str, tuple[float, float]]]:
    """Return the dimensions of a record, and the scale and the offset of each."""
    fields: dict[str, str] = {}
    scaling: dict[str, tuple[float, float]] = {}
    for each in _dimensions(path, given):
        name, kind, size = each.get("name"), each.get("type"), each.get("size")
        scale, offset = each.get("scale", 1), each.get("offset", 0)
        if (
            not (isinstance(name, str) and name and name not in fields)
            or not (isinstance(kind, str) and _is_whole(size) and size in _SIZES.get(kind, ()))
            or not (_is_finite(scale) and scale and _is_finite(offset))
        ):
            raise FileFormatError(f"{path} is corrupt: a dimension of its schema is {each!r:.120}")
        fields[name] = f"<{_KINDS[kind]}{size}"
        scaling[name] = float(scale), float(offset)
    if len({_NAMES.get(name, name) for name in fields}) < len(fields):
        raise FileFormatError(f"{path} is corrupt: its schema has a dimension twice")
    missing = [axis for axis in "XYZ" if axis not in fields]
    if missing:
        raise FileFormatError(f"{path} is corrupt: its schema has no {missing[0]}")
    return np.dtype(list(fields.items())), scaling


def _dimensions(path: Path, given: Any) -> Iterator[dict[str, Any]]:
    if not isinstance(given, list) or not all(isinstance(each, dict) for each in given):
        raise FileFormatError(f"{path} is corrupt: it has no schema")
    return iter(given)


def _system(path: Path, given: Any) -> str | None:
    """Return the reference system as authority and code, or as WKT if there are two codes."""
    srs = given if isinstance(given, dict) else {}
    authority, code, wkt = (srs.get(name) for name in ("authority", "horizontal", "wkt"))
    plain = all(isinstance(s, str) and s.isascii() and s.isalnum() for s in (authority, code))
    if plain and not (srs.get("vertical") and wkt):
        return f"{authority}:{code}"
    if not isinstance(wkt, str) or not wkt:
        return None
    check_system(wkt, str(path))
    return wkt


def _is_whole(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def _is_finite(value: Any) -> bool:
    """Return whether a number of a JSON file is finite as a double."""
    try:
        return (_is_whole(value) or isinstance(value, float)) and isfinite(value)
    except OverflowError:
        return False


def _loaded(path: Path) -> Any:
    """Return the contents of a JSON file; names that occur twice are an error."""

    def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        found = dict(pairs)
        if len(found) < len(pairs):
            raise FileFormatError(f"{path} is corrupt: it has a name twice")
        return found

    return loaded(path.read_bytes(), path, once)
