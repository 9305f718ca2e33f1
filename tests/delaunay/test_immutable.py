"""Nothing changes an object, and any number of threads may use it."""

from __future__ import annotations

import copy
import gc
import pickle
import threading
import weakref
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from delone import Delaunay, datasets

ARRAYS = [
    "points",
    "simplices",
    "neighbors",
    "edges",
    "convex_hull",
    "hull",
    "duplicate_of",
    "coplanar",
    "vertex_to_simplex",
    "transform",
    "areas",
    "circumcenters",
    "min_bound",
    "max_bound",
]
PUBLIC = [*ARRAYS, "vertex_neighbor_vertices", "ndim", "npoints", "nsimplex", "stages"]


@pytest.fixture
def mesh() -> Delaunay:
    return Delaunay(datasets.duplicates(80))


@pytest.mark.parametrize("name", [*PUBLIC, "validate", "_points", "something"])
def test_no_attribute_can_be_set_or_deleted(mesh: Delaunay, name: str) -> None:
    with pytest.raises(AttributeError):
        setattr(mesh, name, None)
    with pytest.raises(AttributeError):
        delattr(mesh, name)


@pytest.mark.parametrize("name", ARRAYS)
def test_arrays_are_read_only_and_kept(mesh: Delaunay, name: str) -> None:
    array = getattr(mesh, name)
    with pytest.raises(ValueError, match="read-only"):
        array[:] = 0
    with pytest.raises(ValueError, match="WRITEABLE"):
        array.flags.writeable = True
    assert getattr(mesh, name) is array


def test_compressed_rows_are_read_only(mesh: Delaunay) -> None:
    assert not any(array.flags.writeable for array in mesh.vertex_neighbor_vertices)


@pytest.mark.parametrize("order", ["C", "F"])
def test_the_input_stays_the_callers(order: str) -> None:
    points = np.array(datasets.uniform(50), order=order)
    before = points.copy()
    mesh = Delaunay(points)
    assert points.flags.writeable
    points[:] = 0
    assert np.array_equal(mesh.points, before)
    assert mesh.validate()


def test_what_gives_its_memory_away_is_copied_too() -> None:
    class Frame:
        def __init__(self) -> None:
            self.data = np.array(datasets.uniform(50))

        def __array__(self, dtype: object = None, copy: object = None) -> np.ndarray:
            return self.data

    frame = Frame()
    mesh = Delaunay(frame)
    frame.data[:] = 0
    assert mesh.points.any()


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_pickles(mesh: Delaunay, protocol: int) -> None:
    again = pickle.loads(pickle.dumps(mesh, protocol))
    for name in ARRAYS:
        assert np.array_equal(getattr(again, name), getattr(mesh, name)), name
        assert not getattr(again, name).flags.writeable, name
    assert again.stages == mesh.stages
    assert repr(again) == repr(mesh)
    with pytest.raises(AttributeError):
        again.points = None


def test_copies_are_the_object_itself(mesh: Delaunay) -> None:
    assert copy.copy(mesh) is mesh
    assert copy.deepcopy([mesh, mesh]) == [mesh, mesh]


def test_objects_compare_by_identity_and_hash(mesh: Delaunay) -> None:
    assert mesh == mesh  # noqa: PLR0124
    assert mesh != Delaunay(mesh.points)
    assert len({mesh, mesh}) == 1


def test_objects_are_freed(mesh: Delaunay) -> None:
    other = Delaunay(mesh.points)
    other.edges  # noqa: B018
    reference = weakref.ref(other)
    del other
    gc.collect()
    assert reference() is None


def test_threads_share_an_object() -> None:
    points = datasets.gaussian_clusters(4000)
    expected = Delaunay(points)
    queries = np.random.default_rng(0).normal(size=(3000, 2))
    found = expected.find_simplex(queries)
    for _ in range(5):
        mesh = Delaunay(points)
        start = threading.Barrier(8)

        def work(number: int, mesh: Delaunay = mesh, start: threading.Barrier = start) -> list[int]:
            start.wait()
            names = ARRAYS[number:] + ARRAYS[:number]
            identities = {name: id(getattr(mesh, name)) for name in names}
            assert np.array_equal(mesh.find_simplex(queries), found)
            assert mesh.validate()
            return [identities[name] for name in ARRAYS]

        with ThreadPoolExecutor(8) as pool:
            results = list(pool.map(work, range(8)))
        # Each thread got the very same arrays: they were computed once.
        assert all(result == results[0] for result in results)
        for name in ARRAYS:
            assert np.array_equal(getattr(mesh, name), getattr(expected, name)), name


def test_threads_make_their_own() -> None:
    sets = [datasets.GENERATORS[name](500) for name in sorted(datasets.GENERATORS)]
    expected = [Delaunay(points).simplices for points in sets]
    with ThreadPoolExecutor(8) as pool:
        for _ in range(3):
            for mesh, simplices in zip(pool.map(Delaunay, sets), expected, strict=True):
                assert np.array_equal(mesh.simplices, simplices)


def test_the_same_input_gives_the_same_arrays() -> None:
    points = datasets.uniform(2000)
    one, two = Delaunay(points), Delaunay(points.tolist())
    for name in ARRAYS:
        assert np.array_equal(getattr(one, name), getattr(two, name)), name


def test_the_constructor_does_not_run_twice() -> None:
    mesh = Delaunay([(0, 0), (1, 0), (0, 1)])
    with pytest.raises(AttributeError, match="never changes"):
        mesh.__init__([(0, 0), (2, 0), (0, 2)])  # type: ignore[misc]
    assert mesh.points[1, 0] == 1


def test_the_base_of_an_array_cannot_be_made_writeable_either(mesh: Delaunay) -> None:
    loaded = pickle.loads(pickle.dumps(mesh))
    for each in (mesh, loaded):
        arrays = [getattr(each, name) for name in ARRAYS] + [*each.vertex_neighbor_vertices]
        for array in arrays:
            base = array.base
            assert base is not None
            while base is not None:
                with pytest.raises((AttributeError, ValueError)):
                    base.flags.writeable = True
                with pytest.raises((TypeError, ValueError)):
                    base[(0,) * getattr(base, "ndim", 1)] = 0
                base = getattr(base, "base", None)


def test_what_has_no_triangles_yet_has_a_repr() -> None:
    assert repr(Delaunay.__new__(Delaunay)) == "<Delaunay of nothing yet>"
