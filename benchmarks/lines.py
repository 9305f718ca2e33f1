"""Points and segments to triangulate under constraints, and polygons to fill: pure functions.

Generators take a seed and give the same coordinates everywhere up to the last bits of sine and
cosine. Large data is not part of the project: `coastline` reads the land polygons of Natural Earth
(``ne_10m_land.geojson``, plain or gzipped, public domain, naturalearthdata.com).
"""

import gzip
import json
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Segments = NDArray[np.int32]

SEED = 2026
SIDES, LEVELS = 7, 12
STEEPEST = np.radians(30)


class Lines(NamedTuple):
    """Points, and segments as pairs of their rows."""

    points: Points
    segments: Segments


class Rings(NamedTuple):
    """A polygon: ring i is ``points[starts[i]:starts[i + 1]]``, not closed, the outer one first."""

    points: Points
    starts: NDArray[np.int32]

    def split(self) -> list[Points]:
        """Return the rings one by one."""
        return np.split(self.points, self.starts[1:-1])


def save(lines: Lines, file: Path) -> None:
    """Write lines as an npz file."""
    np.savez(file, points=lines.points, segments=lines.segments)


def load(file: str | Path) -> Lines:
    """Read what `save` wrote."""
    with np.load(file) as arrays:
        return Lines(arrays["points"], arrays["segments"])


def _polygons(geometry: dict[str, Any]) -> list[Any]:
    several = geometry["type"] == "MultiPolygon"
    return list(geometry["coordinates"]) if several else [geometry["coordinates"]]


def coastline(file: Path) -> Lines:
    """Return all vertices of the polygons of a GeoJSON file, closing ones too, and their edges."""
    data = file.read_bytes()
    text = gzip.decompress(data) if data[:2] == b"\x1f\x8b" else data
    features = json.loads(text)["features"]
    polygons = [p for feature in features for p in _polygons(feature["geometry"])]
    rings = [np.array(ring, dtype=np.float64)[:, :2] for p in polygons for ring in p]
    ends = np.cumsum([len(ring) for ring in rings])
    first = np.delete(np.arange(ends[-1], dtype=np.int32), ends - 1)
    return Lines(np.concatenate(rings), np.column_stack((first, first + 1)))


def fractal_ring(*, sides: int = SIDES, levels: int = LEVELS, seed: int = SEED) -> Points:
    """Return a Koch-like ring of ``sides * 2**levels`` vertices that does not cross itself.

    Each side of a regular polygon gets an apex, outward; both new sides get theirs on the inner
    side of the triangle just made, and so on. A base angle is at most 30 degrees and at most that
    of the triangle before, hence triangles lie in one another or apart, and no two sides cross.
    """
    rng = np.random.default_rng(seed)
    turn = 2 * np.pi * np.arange(sides) / sides
    ring = 0.5 + 0.35 * np.column_stack((np.cos(turn), np.sin(turn)))
    angle = STEEPEST * rng.uniform(0.9, 1.0, sides)
    side = -1.0
    for _ in range(levels):
        along = np.roll(ring, -1, axis=0) - ring
        across = side * np.column_stack((-along[:, 1], along[:, 0]))
        apex = ring + along / 2 + across * (np.tan(angle) / 2)[:, None]
        ring = np.stack((ring, apex), axis=1).reshape(-1, 2)
        angle = np.repeat(angle, 2) * rng.uniform(0.96, 1.0, len(ring))
        side = -side
    return ring


def _closed(first: int, count: int) -> Segments:
    """Return the sides of a ring that is rows `first` to ``first + count - 1``."""
    rows = np.arange(count, dtype=np.int32)
    return first + np.column_stack((rows, np.roll(rows, -1)))


def points_and_ring(n: int, *, levels: int = LEVELS, seed: int = SEED) -> Lines:
    """Return `n` uniform points of the unit square, then a fractal ring and its sides."""
    ring = fractal_ring(levels=levels, seed=seed)
    points = np.random.default_rng(seed).random((n, 2))
    return Lines(np.concatenate((points, ring)), _closed(n, len(ring)))


def long_segments(count: int, *, seed: int = SEED) -> Lines:
    """Return segments from the left side of the unit square to its right: half of all pairs cross.

    Their ends lie on the two sides, at random heights.
    """
    points = np.empty((2 * count, 2))
    points[:, 0] = np.tile([0.0, 1.0], count)
    points[:, 1] = np.random.default_rng(seed).random(2 * count)
    return Lines(points, np.arange(2 * count, dtype=np.int32).reshape(-1, 2))


def star_ring(count: int, *, seed: int = SEED) -> Rings:
    """Return a ring around the origin whose radius is at random, counter-clockwise."""
    turn = 2 * np.pi * np.arange(count) / count
    radius = np.random.default_rng(seed).uniform(0.5, 1.0, count)
    points = radius[:, None] * np.column_stack((np.cos(turn), np.sin(turn)))
    return Rings(points, np.array([0, count], dtype=np.int32))


def corpus_polygon(file: Path) -> Rings:
    """Read a polygon of the corpus: the rows at which rings start stand in ``rings``."""
    case = json.loads(file.read_text(encoding="utf-8"))
    points = np.array(case["points"], dtype=np.float64)
    return Rings(points, np.array([*case["rings"], len(points)], dtype=np.int32))
