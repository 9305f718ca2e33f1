"""The arrays of a fixed set of inputs are the same on every platform: their hashes are stored.

`same_arrays.json` holds one SHA-256 per input. After a change that is meant to change arrays, write
it again: ``python tests/platforms/test_same_arrays.py``.

Hashed are simplices, neighbors and what else is combinatorial, as 64-bit little-endian integers,
and the bits of the vertices that splitting crossing segments adds: these are exact intersections,
rounded once. Areas, circumcenters and measures are not hashed, nor are refined, conforming and
improved meshes: they call ``hypot``, ``log2`` and ``sin`` of the platform, whose last bit differs,
or sum in the order of the vector unit. No triangulation depends on either.

The inputs come from a generator written out here, because NumPy may change the numbers of its own.
"""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import (
    ConstrainedDelaunay,
    ConvexHull,
    Delaunay,
    PeriodicDelaunay,
    RegularTriangulation,
    Voronoi,
    _core,
    sphere,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import NDArray

STORED = Path(__file__).with_name("same_arrays.json")
CORPUS = Path(__file__).parents[1] / "corpus"


def unit(count: int, seed: int) -> NDArray[np.float64]:
    """Doubles in [0, 1), multiples of 2^-53: the generator SplitMix64."""
    with np.errstate(over="ignore"):
        z = np.uint64(seed) + np.arange(1, count + 1, dtype=np.uint64) * np.uint64(
            0x9E3779B97F4A7C15
        )
        z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return ((z ^ (z >> np.uint64(31))) >> np.uint64(11)).astype(np.float64) * 2.0**-53


def scattered(count: int, ndim: int, seed: int = 1) -> NDArray[np.float64]:
    return unit(count * ndim, seed).reshape(count, ndim)


def lattice(side: int, ndim: int) -> NDArray[np.float64]:
    """Points each of which ties with others, and the first hundred twice."""
    points = np.stack(np.meshgrid(*[np.arange(side)] * ndim), axis=-1).reshape(-1, ndim)
    mixed = points[np.argsort(unit(len(points), 7), kind="stable")]
    return np.concatenate([mixed, mixed[:100]]).astype(np.float64)


def rounded(count: int) -> NDArray[np.float64]:
    """Coordinates of a survey: large offsets, rounded to millimeters, with duplicates."""
    return np.array([500_000.0, 4_649_776.0]) + np.round(scattered(count, 2, 3) * 1e3) / 1e3


def corpus(folder: Path) -> list[tuple[str, Any]]:
    files = sorted(folder.glob("*.json"))
    return [(path.stem, json.loads(path.read_text(encoding="utf-8"))) for path in files]


def simplices(mesh: Any) -> list[Any]:
    return [mesh.simplices, mesh.neighbors]


def constrained(points: Any, segments: Any, **choices: Any) -> list[Any]:
    mesh = ConstrainedDelaunay(points, segments, **choices)
    parts = [mesh.segments, mesh.region, mesh.duplicate_of]
    return [*simplices(mesh), *parts, np.ascontiguousarray(mesh.points).view(np.int64)]


def ring(case: dict[str, Any]) -> list[Any]:
    """A polygon of the corpus, whose rings may touch and cross."""
    ends = [*case["rings"][1:], len(case["points"])]
    segments = [
        (i, i + 1 if i + 1 < end else start)
        for start, end in zip(case["rings"], ends, strict=True)
        for i in range(start, end)
    ]
    return constrained(case["points"], segments, crossing="split")


def hull(points: Any) -> list[Any]:
    found = ConvexHull(points)
    facets = [np.array(facet) for facet in found.facets]
    return [found.simplices, found.neighbors, found.vertices, *facets]


def periodic(points: Any, periods: Any) -> list[Any]:
    mesh = PeriodicDelaunay(points, periods)
    return [*simplices(mesh), mesh.offsets]


def cells(points: Any, **choices: Any) -> list[Any]:
    found = Voronoi(points, **choices)
    regions = [np.array(region) for region in found.regions]
    return [found.ridge_points, found.ridge_vertices, found.point_region, *regions]


def tetrahedral_cells(points: Any) -> list[Any]:
    found = Voronoi(points)
    ridges = [np.array(ridge) for ridge in found.ridge_vertices]
    return [found.ridge_points, found.point_region, *ridges]


def directions(**given: Any) -> list[Any]:
    """Triangles, and the bits of the vectors that longitudes and latitudes become."""
    mesh = sphere.Delaunay(**given)
    return [*simplices(mesh), mesh.duplicates, np.array(mesh.vectors).view(np.int64)]


def cases() -> dict[str, Callable[[], Iterable[Any]]]:
    """Every input by name, as a call that returns arrays of integers."""
    plane, space = scattered(5_000, 2), scattered(1_500, 3)
    angles = plane * [360.0, 180.0] - [180.0, 90.0]
    spokes = np.arange(60).reshape(30, 2)
    found: dict[str, Callable[[], Iterable[Any]]] = {
        "2-D scattered": lambda: simplices(Delaunay(plane)),
        "2-D, larger than a block": lambda: simplices(Delaunay(scattered(150_000, 2))),
        "2-D lattice": lambda: simplices(Delaunay(lattice(60, 2))),
        "2-D rounded": lambda: simplices(Delaunay(rounded(5_000))),
        "2-D tiny": lambda: simplices(Delaunay(plane[:500] * 1e-300)),
        "2-D huge": lambda: simplices(Delaunay(plane[:500] * 1e300)),
        "3-D scattered": lambda: simplices(Delaunay(space)),
        "3-D lattice": lambda: simplices(Delaunay(lattice(9, 3))),
        "constrained, segments that cross": lambda: constrained(
            plane[:60], spokes, crossing="split"
        ),
        "regular 2-D": lambda: simplices(RegularTriangulation(plane, unit(5_000, 5) * 1e-3)),
        "regular 3-D": lambda: simplices(RegularTriangulation(space, unit(1_500, 5) * 1e-2)),
        "periodic": lambda: periodic(plane[:2_000], (1.0, 1.0)),
        "hull 2-D": lambda: hull(rounded(2_000)),
        "hull 3-D": lambda: hull(lattice(7, 3)),
        "Voronoi 2-D": lambda: cells(plane[:2_000]),
        "Voronoi of a lattice": lambda: cells(lattice(20, 2)),
        "power diagram": lambda: cells(plane[:2_000], weights=unit(2_000, 9) * 1e-3),
        "sphere, degrees": lambda: directions(lonlat=angles),
        "sphere, radians": lambda: directions(lonlat=angles * 0.0174, degrees=False),
        "sphere, whole degrees": lambda: directions(lonlat=np.round(angles / 5) * 5),
        "sphere, lattice": lambda: directions(xyz=lattice(8, 3) - 3.5),
        "Voronoi 3-D": lambda: tetrahedral_cells(space[:500]),
    }
    for method in _core.methods2():
        found[f"2-D by {method}"] = lambda m=method: simplices(Delaunay(plane, method=m))
    for name, case in corpus(CORPUS):
        found[f"corpus {name}"] = lambda c=case: simplices(Delaunay(c["points"]))
        if "rings" in case and "bad" not in name:
            found[f"polygon {name}"] = lambda c=case: ring(c)
    for name, case in corpus(CORPUS / "space"):
        found[f"corpus 3-D {name}"] = lambda c=case: simplices(Delaunay(c["points"]))
    return found


def digest(arrays: Iterable[Any]) -> str:
    """A hash of shapes and numbers, independent of the platform's byte order and integers."""
    found = hashlib.sha256()
    for array in arrays:
        numbers = np.asarray(array)
        assert numbers.dtype.kind in "iub" or numbers.size == 0, numbers.dtype
        found.update(repr(numbers.shape).encode())
        found.update(np.ascontiguousarray(numbers, dtype="<i8").tobytes())
    return found.hexdigest()


CASES = cases()


@pytest.mark.parametrize("name", CASES)
def test_arrays_are_those_of_every_platform(name: str) -> None:
    assert digest(CASES[name]()) == json.loads(STORED.read_text(encoding="utf-8"))[name]


def test_every_stored_hash_is_compared() -> None:
    assert set(json.loads(STORED.read_text(encoding="utf-8"))) == set(CASES)


def test_another_array_has_another_hash() -> None:
    triangles = Delaunay(lattice(4, 2)).simplices
    turned = triangles[:, [1, 2, 0]]
    assert digest([triangles]) == digest([triangles.astype(">i4")])
    assert len({digest(a) for a in ([triangles], [turned], [triangles, triangles], [])}) == 4


if __name__ == "__main__":
    hashes = {name: digest(case()) for name, case in sorted(CASES.items())}
    STORED.write_text(json.dumps(hashes, indent=1) + "\n", encoding="utf-8")
