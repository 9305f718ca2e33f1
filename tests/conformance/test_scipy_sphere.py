"""SciPy's own tests of SphericalVoronoi, as installed, run against the drop-in.

SciPy's test module is loaded a second time, its SphericalVoronoi is replaced, and every test is
run; points that do not have three coordinates go to SciPy's class.
"""

from __future__ import annotations

import fnmatch
import importlib.util
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import NonFiniteError, sphere
from delone.compat import scipy as drop_in

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from types import ModuleType

spatial = pytest.importorskip("scipy.spatial")

# Tests that cannot hold, by pattern, each with its reason.
CANNOT_HOLD = {
    "test_sort_vertices_of_regions_flattened": "compares regions by Qhull's numbers of facets",
}


def load() -> ModuleType | None:
    """A copy of SciPy's test module of our own, or None where it ships without tests."""
    try:
        spec = importlib.util.find_spec("scipy.spatial.tests.test_spherical_voronoi")
    except ModuleNotFoundError:
        return None
    if spec is None or spec.loader is None:
        return None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def runs(function: Callable[..., Any]) -> list[dict[str, Any]]:
    """Keyword arguments of each run of a test."""
    found: list[dict[str, Any]] = [{}]
    for mark in getattr(function, "pytestmark", []):
        name, values = mark.args
        found = [run | {name: value} for run in found for value in values]
    return found


def is_spatial(arguments: dict[str, Any]) -> bool:
    """Whether a run has points with three coordinates."""
    return arguments.get("dim", 3) == 3 and arguments.get("poly") not in {"triangle", "dodecagon"}


def cases() -> Iterator[Any]:
    module = load()
    if module is None:
        return
    for name, function in vars(module.TestSphericalVoronoi).items():
        # One of them is about four dimensions alone.
        if not name.startswith("test_") or name == "test_area_unsupported_dimension":
            continue
        for arguments in filter(is_spatial, runs(function)):
            words = "-".join(map(str, arguments.values()))
            reasons = [r for p, r in CANNOT_HOLD.items() if fnmatch.fnmatch(name, p)]
            marks = [pytest.mark.xfail(reason=r, strict=True) for r in reasons]
            identifier = f"{name}[{words}]" if words else name
            yield pytest.param(module, name, arguments, id=identifier, marks=marks)


CASES = list(cases())


@pytest.mark.skipif(not CASES, reason="SciPy is installed without its tests")
@pytest.mark.parametrize(("module", "name", "arguments"), CASES)
def test_holds(
    module: ModuleType, name: str, arguments: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    calls = []

    def made(points: Any, *given: Any, **options: Any) -> Any:
        if np.shape(points)[1] != 3:
            return spatial.SphericalVoronoi(points, *given, **options)
        calls.append(1)
        return drop_in.SphericalVoronoi(points, *given, **options)

    monkeypatch.setattr(module, "SphericalVoronoi", made)
    tests = module.TestSphericalVoronoi()
    tests.setup_method()
    getattr(tests, name)(**arguments)
    assert calls or name == "test_sort_vertices_of_regions_dimensionality"


@pytest.mark.skipif(not CASES, reason="SciPy is installed without its tests")
def test_the_known_tests_are_there() -> None:
    names = [case.values[1] for case in CASES]
    for pattern in CANNOT_HOLD:
        assert fnmatch.filter(names, pattern)
    assert len(names) > 50


@pytest.mark.parametrize("half", [False, True])
def test_but_for_the_order_the_diagram_is_that_of_scipy(half: bool) -> None:
    rng = np.random.default_rng(2)
    points = rng.normal(size=(300, 3))
    if half:
        points[:, 1] = np.abs(points[:, 1])
    points *= 2.5 / np.linalg.norm(points, axis=1)[:, None]
    center = np.array([1.0, -2.0, 3.0])
    ours = drop_in.SphericalVoronoi(points + center, 2.5, center)
    theirs = spatial.SphericalVoronoi(points + center, 2.5, center)
    theirs.sort_vertices_of_regions()
    assert np.allclose(ours.calculate_areas(), theirs.calculate_areas(), atol=1e-9)
    for mine, other in zip(ours.regions, theirs.regions, strict=True):
        a, b = ours.vertices[mine], theirs.vertices[other]
        near = np.abs(a[:, None] - b).max(axis=2)
        assert len(a) == len(b)
        assert near.min(axis=1).max() < 1e-9


def test_points_in_the_plane_are_refused() -> None:
    with pytest.raises(drop_in.DimensionError, match="three coordinates"):
        drop_in.SphericalVoronoi([(1, 0), (0, 1), (-1, 0)])


@pytest.mark.parametrize("spread", [1e-2, 1e-4])
def test_areas_of_generators_close_together(spread: float) -> None:
    rng = np.random.default_rng(5)
    points = rng.normal(size=(300, 3))
    points[:150] = (1, 0, 0) + spread * rng.normal(size=(150, 3)) * (0, 1, 1)
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    areas = drop_in.SphericalVoronoi(points, threshold=1e-12).calculate_areas()
    expected = sphere.Voronoi(xyz=points).cell_areas
    assert np.allclose(areas, expected, rtol=1e-11, atol=0)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_points_that_are_not_finite_are_named(value):
    points = np.random.default_rng(0).normal(size=(20, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    points[3, 1] = value
    with pytest.raises(NonFiniteError, match="first: 3") as caught:
        drop_in.SphericalVoronoi(points)
    assert caught.value.rows.tolist() == [3]
    with pytest.raises(NonFiniteError, match="center"):
        drop_in.SphericalVoronoi(np.eye(3), center=[0, value, 0])
