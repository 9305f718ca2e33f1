"""What cannot be written to cannot be after a pickle or a deep copy either."""

from __future__ import annotations

import copy
import pickle
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone import datasets, errors, lawson
from delone.terrain import TIN

if TYPE_CHECKING:
    from collections.abc import Callable

FLAT, SOLID = datasets.uniform(30), datasets.uniform(30, ndim=3)
NEEDLE = [(0, 0), (10, 0), (10, 1)], [(0, 1), (1, 2), (2, 0)]
PLANE = [(0, 0, 0), (1, 0, 0), (1, 1, 1), (0, 1, 1)]
BOX = (0, 0, 1, 1)
HILL = [(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0), (2, 2, 3)]


def coplanar() -> Any:
    with pytest.raises(errors.DegenerateInputError) as caught:
        delone.Delaunay(PLANE)
    return caught.value.plane


def segments() -> delone.ConstrainedDelaunay:
    return delone.ConstrainedDelaunay(FLAT, [(0, 1), (2, 3)], crossing="split", conforming=True)


MADE: dict[str, Callable[[], Any]] = {
    "Delaunay": lambda: delone.Delaunay(FLAT),
    "Delaunay in space": lambda: delone.Delaunay(SOLID),
    "ConstrainedDelaunay": segments,
    "Mesh": lambda: delone.mesh(NEEDLE),
    "TetMesh": lambda: delone.improve(delone.Delaunay(SOLID)),
    "TIN": lambda: TIN.from_points(HILL, breaklines=[[(1, 1, 1), (3, 1, 1)]]),
    "Contours": lambda: TIN.from_points(HILL).contours(interval=1),
    "Bands": lambda: TIN.from_points(HILL).bands(interval=1),
    "Profile": lambda: TIN.from_points(HILL).profile([(0, 1), (4, 1)]),
    "Volume": lambda: TIN.from_points(HILL).volume_to(1),
    "Voronoi": lambda: delone.Voronoi(FLAT),
    "RegularTriangulation": lambda: delone.RegularTriangulation(FLAT, np.full(30, 0.01)),
    "PeriodicDelaunay": lambda: delone.PeriodicDelaunay(FLAT, (1.0, 1.0)),
    "ConvexHull": lambda: delone.ConvexHull(FLAT),
    "MeshReport": lambda: delone.mesh(NEEDLE).report,
    "ImproveReport": lambda: delone.improve(delone.Delaunay(SOLID)).report,
    "SurfaceCheck": lambda: delone.check_surface(SOLID, [(0, 1, 2), (2, 3, 4)]),
    "SegmentReport": lambda: segments().report,
    "ValidationReport": lambda: delone.Delaunay(FLAT).validate(),
    "SpaceReport": lambda: delone.Delaunay(SOLID).validate(),
    "ConstrainedReport": lambda: segments().validate(),
    "Quality": lambda: delone.Delaunay(FLAT).quality(),
    "TetQuality": lambda: delone.Delaunay(SOLID).quality(),
    "LawsonResult": lambda: lawson(FLAT, delone.Delaunay(FLAT).simplices, record=True),
    "LloydResult": lambda: delone.lloyd(FLAT, BOX, max_iter=2),
    "PolygonTriangles": lambda: delone.triangulate_polygon([(0, 0), (4, 0), (4, 3)]),
    "PlaneTriangulation": coplanar,
    "CrossingSegmentsError": lambda: errors.CrossingSegmentsError(pairs=[(0, 1)], points=[(1, 2)]),
    "ConflictingValuesError": lambda: errors.ConflictingValuesError(rows=[(1, 0)]),
    "NonFiniteError": lambda: errors.NonFiniteError("m", rows=[3], count=1),
    "DegenerateInputError": lambda: errors.DegenerateInputError("m", chain=[2, 0, 1]),
}


def arrays(thing: Any) -> dict[str, np.ndarray]:
    """The arrays among the public attributes of an object."""
    found = {}
    for name in dir(thing):
        value = None if name.startswith("_") else getattr(thing, name, None)
        if isinstance(value, np.ndarray):
            found[name] = value
    return found


@pytest.mark.parametrize("duplicate", [lambda o: pickle.loads(pickle.dumps(o)), copy.deepcopy])
@pytest.mark.parametrize("name", MADE)
def test_duplicates_are_as_immutable(name: str, duplicate: Callable[[Any], Any]) -> None:
    thing = MADE[name]()
    again, before = arrays(duplicate(thing)), arrays(thing)
    kept = {key for key, array in before.items() if not array.flags.writeable}
    assert kept
    assert {key for key in kept if again[key].flags.writeable} == set()
    for key in kept:
        np.testing.assert_array_equal(again[key], before[key])


def everything(thing: Any) -> dict[str, np.ndarray]:
    """The arrays of `arrays`, and those in tuples and lists."""
    found = arrays(thing)
    for name in dir(thing):
        value = None if name.startswith("_") else getattr(thing, name, None)
        if isinstance(value, tuple | list):
            parts = [part for part in value if isinstance(part, np.ndarray)]
            found |= {f"{name}[{i}]": part for i, part in enumerate(parts)}
    return found


@pytest.mark.parametrize("name", [name for name in MADE if not name.endswith("Error")])
def test_all_arrays_are_read_only(name: str) -> None:
    found = everything(MADE[name]())
    assert [each for each, array in found.items() if array.flags.writeable] == []


def test_reports_cannot_be_written_to_at_all() -> None:
    report = pickle.loads(pickle.dumps(delone.mesh(NEEDLE).report))
    with pytest.raises(ValueError, match="read-only"):
        report.below[:] = 0
