"""What may be passed, and what is refused by name."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest

from delone import (
    DegenerateInputError,
    Delaunay,
    DeloneError,
    DtypeError,
    InputError,
    InternalError,
    NonFiniteError,
    ShapeError,
    datasets,
)

# Whole numbers that every dtype below holds.
POINTS = np.array([(0, 0), (7, 1), (6, 6), (1, 5), (3, 2), (4, 4)])


class Wrapped:
    """Anything with __array__."""

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        return POINTS.astype(np.float64)


class Subclass(np.ndarray):
    """An array of another class."""


def strided() -> Any:
    wide = np.zeros((12, 9))
    wide[::2, 1:8:6] = POINTS
    return wide[::2, 1:8:6]


def unaligned() -> Any:
    memory = np.zeros(POINTS.size * 8 + 1, dtype=np.uint8)
    array = memory[1:].view(np.float64).reshape(POINTS.shape)
    array[:] = POINTS
    return array


def read_only() -> Any:
    array = POINTS.astype(np.float64)
    array.flags.writeable = False
    return array


ZOO = {
    **{str(np.dtype(t)): POINTS.astype(t) for t in "bhilqBHILQefd"},
    "longdouble": POINTS.astype(np.longdouble),
    "big-endian": POINTS.astype(">f8"),
    "little-endian": POINTS.astype("<f4"),
    "big-endian int": POINTS.astype(">i8"),
    "fortran": np.asfortranarray(POINTS, dtype=np.float64),
    "strided": strided(),
    "reversed": POINTS[::-1].astype(np.float64)[::-1],
    "transposed": np.array(POINTS.T, dtype=np.float64, order="C").T,
    "unaligned": unaligned(),
    "read-only": read_only(),
    "list": POINTS.tolist(),
    "tuples": [tuple(p) for p in POINTS.tolist()],
    "tuple of arrays": tuple(POINTS.astype(float)),
    "mixed numbers": [[0, 0.0], [7, 1], [np.float32(6), 6], [True + 0, 5], [3, 2], [4, 4]],
    "__array__": Wrapped(),
    "subclass": POINTS.astype(np.float64).view(Subclass),
}


@pytest.mark.parametrize("name", ZOO)
def test_every_form_gives_the_same(name: str) -> None:
    mesh = Delaunay(ZOO[name])
    expected = Delaunay(POINTS.astype(np.float64))
    assert np.array_equal(mesh.simplices, expected.simplices)
    assert np.array_equal(mesh.neighbors, expected.neighbors)
    assert type(mesh.points) is np.ndarray
    assert mesh.points.dtype == np.float64
    assert mesh.points.flags.c_contiguous
    assert np.array_equal(mesh.points, POINTS)


def test_single_precision_widens_exactly() -> None:
    points = np.random.default_rng(0).random((200, 2)).astype(np.float32)
    mesh = Delaunay(points)
    assert np.array_equal(mesh.points, points.astype(np.float64))
    assert mesh.validate()


REFUSED: dict[str, tuple[Any, type[Exception]]] = {
    "none": (None, InputError),
    "number": (3.0, ShapeError),
    "flat": ([1.0, 2, 3, 4], ShapeError),
    "empty list": ([], ShapeError),
    "one column": (np.zeros((5, 1)), ShapeError),
    "nine columns": (np.random.default_rng(0).random((20, 9)), ShapeError),
    "two rows of many": (np.zeros((2, 5)), ShapeError),
    "three axes": (np.zeros((3, 2, 2)), ShapeError),
    "ragged": ([[0, 0], [1]], ShapeError),
    "complex": (POINTS + 0j, DtypeError),
    "object": (POINTS.astype(object), DtypeError),
    "bool": (POINTS > 2, DtypeError),
    "string": (POINTS.astype(str), DtypeError),
    "bytes": (POINTS.astype("S"), DtypeError),
    "dates": (POINTS.astype("M8[s]"), DtypeError),
    "records": (np.zeros(5, dtype=[("x", float), ("y", float)]), InputError),
    "masked": (np.ma.masked_array(POINTS, mask=POINTS[0] == POINTS), DtypeError),
    "large int": (POINTS + 2**53, DtypeError),
    "large uint": (POINTS.astype(np.uint64) + 2**63, DtypeError),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_has_no_exact_meaning_is_refused(name: str) -> None:
    points, error = REFUSED[name]
    with pytest.raises(error) as caught:
        Delaunay(points)
    assert isinstance(caught.value, DeloneError)
    assert isinstance(caught.value, ValueError)
    assert "points" in str(caught.value)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_rows_that_are_not_finite_are_listed(bad: float) -> None:
    points = np.array(datasets.uniform(1000))
    points[5, 1] = points[700, 0] = points[999, 0] = bad
    with pytest.raises(NonFiniteError) as caught:
        Delaunay(points)
    assert caught.value.rows.tolist() == [5, 700, 999]
    assert caught.value.count == 3
    points[20:60] = bad
    with pytest.raises(NonFiniteError) as caught:
        Delaunay(points)
    assert caught.value.rows.tolist() == [5, *range(20, 29)]
    assert caught.value.count == 43


def test_too_few_points() -> None:
    for points in (np.empty((0, 2)), [(1, 2)], [(1, 2)] * 9, [(1, 2), (3, 4), (1, 2)]):
        with pytest.raises(DegenerateInputError) as caught:
            Delaunay(points)
        assert caught.value.reason == "too few points"
        assert caught.value.chain.tolist() == list(range(len(np.unique(points, axis=0))))


def test_collinear_points_come_in_order() -> None:
    t = np.random.default_rng(1).permutation(50)
    points = np.column_stack((3 * t, 5 * t)) + np.array([1e6, -2e6])
    with pytest.raises(DegenerateInputError) as caught:
        Delaunay(np.concatenate((points, points)))
    assert caught.value.reason == "collinear"
    assert t[caught.value.chain].tolist() in (list(range(50)), list(range(49, -1, -1)))


def test_nearly_collinear_points_are_no_line() -> None:
    mesh = Delaunay([(0, 0), (1, 1), (2, np.nextafter(2, 3))])
    assert mesh.nsimplex == 1


@pytest.mark.parametrize("method", ["", "Auto", "delaunay", None, 3])
def test_an_unknown_method_is_answered_by_the_list(method: Any) -> None:
    with pytest.raises(ValueError, match="'auto', 'bowyer-watson', 'divide-and-conquer'"):
        Delaunay(POINTS, method=method)


@pytest.mark.parametrize("workers", [0, -1, 1.5, "2", True])
def test_workers_must_be_a_number_of_threads(workers: Any) -> None:
    with pytest.raises(InputError, match="workers"):
        Delaunay(POINTS, workers=workers)


def test_options_are_named() -> None:
    with pytest.raises(TypeError):
        Delaunay(POINTS, "auto")  # type: ignore[misc]


def test_a_bug_of_the_core_hands_its_points_over(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> None:
        raise InternalError("the hull does not close")

    monkeypatch.setattr("delone._core.triangulate2", broken)
    points = datasets.uniform(10)
    with pytest.raises(InternalError, match="report") as caught:
        Delaunay(points)
    assert np.array_equal(caught.value.points, points)
    assert np.array_equal(pickle.loads(pickle.dumps(caught.value)).points, points)


@pytest.mark.parametrize("name", ["qhull_options", "incremental", "furthest_site"])
def test_arguments_of_scipy_are_sent_to_the_drop_in(name: str) -> None:
    with pytest.raises(TypeError, match=rf"accept {name}.*delone\.compat\.scipy\.Delaunay"):
        Delaunay([(0, 0), (1, 0), (0, 1)], **{name: "Qz"})  # type: ignore[call-overload]
    with pytest.raises(TypeError, match="unexpected keyword argument 'metod'"):
        Delaunay([(0, 0), (1, 0), (0, 1)], metod="sweep")  # type: ignore[call-overload]


def test_geometries_are_told_from_coordinates() -> None:
    shapely = pytest.importorskip("shapely")
    geopandas = pytest.importorskip("geopandas")
    points = shapely.points([(0, 0), (1, 0), (0, 1)])
    series = geopandas.GeoSeries(points)
    lines = geopandas.GeoSeries(shapely.linestrings([[(0, 0), (1, 0)], [(0, 1), (2, 2)]]))
    for given in (lines, lines.tolist(), lines.to_frame("geometry"), lines.to_numpy()):
        with pytest.raises(
            DtypeError, match=r"contains geometries.*get_coordinates.*from_geometry"
        ):
            Delaunay(given)
    for given in (points, points.tolist(), series, series.to_frame("geometry")):
        assert Delaunay(given).nsimplex == 1
    assert Delaunay(shapely.get_coordinates(points)).nsimplex == 1
    assert Delaunay(series.get_coordinates().to_numpy()).nsimplex == 1
