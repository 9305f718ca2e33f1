"""SciPy's own tests of Voronoi and voronoi_plot_2d, as installed, run against the drop-ins.

As in ``test_scipy``: SciPy's test modules are loaded a second time, the names through which they
reach SciPy's classes are replaced, and each test that uses Voronoi in the plane or in space is run.
"""

from __future__ import annotations

import fnmatch
import importlib.util
import inspect
import re
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone.compat import scipy as drop_in

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from types import ModuleType

spatial = pytest.importorskip("scipy.spatial")

# Tests that cannot hold, by pattern, each with its reason. Every pattern must match a test, and
# every test that matches must fail.
CANNOT_HOLD = {
    "TestVoronoi::test_simple": (
        "compares the rows of `vertices` with Qhull's order, and regions by where they begin"
    ),
    "TestVoronoi::test_furthest_site": (
        "compares the rows of `vertices` with Qhull's order, and regions by where they begin"
    ),
    "TestVoronoi::test_ridges[[]pathological-2]": (
        "one coordinate of the grid is off by one eps; the exact diagram has a vertex as far away "
        "as its inverse, where the test's k-d tree cannot tell the sites apart; Qhull leaves it out"
    ),
    "TestVoronoi::test_incremental[[]pathological-2-*": (
        "takes vertices that are close for one; the exact diagram has ridges as short as the eps "
        "by which one coordinate of the grid is off, and Qhull merges them"
    ),
    "TestPlotting::test_gh_19653*": (
        "compares the unbounded ridges in Qhull's order; the same segments are drawn"
    ),
}


# SciPy's test of adding points returns at once in more dimensions, as it takes long.
RETURNS = re.compile(r"test_incremental.*-[4-9]d")


class NotReachedError(Exception):
    """Raised when a test ends without a diagram of delone."""


def load(name: str) -> ModuleType | None:
    """A copy of a test module of SciPy of our own, or None where it ships without tests."""
    try:
        spec = importlib.util.find_spec(f"scipy.spatial.tests.{name}")
    except ModuleNotFoundError:
        return None
    if spec is None or spec.loader is None:
        return None
    module = importlib.util.module_from_spec(spec)
    state = np.random.get_state()  # noqa: NPY002  (the module seeds it on import)
    try:
        spec.loader.exec_module(module)
    finally:
        np.random.set_state(state)  # noqa: NPY002
    return module


def runs(function: Callable[..., Any]) -> list[dict[str, Any]]:
    """Keyword arguments of each run of a test."""
    found: list[dict[str, Any]] = [{}]
    for mark in getattr(function, "pytestmark", []):
        if mark.name != "parametrize":
            continue
        names = (
            [name.strip() for name in mark.args[0].split(",")]
            if isinstance(mark.args[0], str)
            else list(mark.args[0])
        )
        rows = [row if len(names) > 1 else (row,) for row in mark.args[1]]
        found = [run | dict(zip(names, row, strict=True)) for run in found for row in rows]
    return found


def is_low(arguments: dict[str, Any]) -> bool:
    return arguments.get("ndim", 2) <= 8 and not any(
        f"{d}d" in str(value) for d in range(9, 12) for value in arguments.values()
    )


def uses_voronoi(function: Callable[..., Any]) -> bool:
    names = set(inspect.unwrap(function).__code__.co_names)
    return bool({"Voronoi", "_compare_qvoronoi"} & names)


def functions(module: ModuleType) -> Iterator[tuple[str, Any, Callable[[], Any]]]:
    """Name, function and what makes it callable, of all tests of a module."""
    for name, item in vars(module).items():
        if name.startswith("test_") and callable(item):
            yield name, item, lambda function=item: function
        elif name.startswith("Test") and inspect.isclass(item):
            for method, function in vars(item).items():
                if method.startswith("test_"):
                    yield (
                        f"{name}::{method}",
                        function,
                        lambda function=function, owner=item: function.__get__(owner()),
                    )


def cases() -> Iterator[Any]:
    for module_name in ("test_qhull", "test__plotutils"):
        module = load(module_name)
        if module is None:
            continue
        for name, function, bind in functions(module):
            for arguments in runs(function):
                by_parameter = any(value is spatial.Voronoi for value in arguments.values())
                if not is_low(arguments) or not (uses_voronoi(function) or by_parameter):
                    continue
                words = "-".join(str(getattr(v, "__name__", v)) for v in arguments.values())
                identifier = f"{name}[{words}]" if words else name
                if RETURNS.search(identifier):
                    continue
                reasons = [r for p, r in CANNOT_HOLD.items() if fnmatch.fnmatch(identifier, p)]
                marks = [
                    pytest.mark.xfail(reason=r, strict=True, raises=AssertionError) for r in reasons
                ]
                yield pytest.param(module, bind, arguments, id=identifier, marks=marks)


CASES = list(cases())


def replacement(calls: list[int]) -> type:
    class Voronoi(drop_in.Voronoi):
        def __new__(cls, points: Any, *args: Any, **options: Any) -> Any:
            shape = np.shape(points)
            if len(shape) == 2 and shape[1] > 8:
                return spatial.Voronoi(points, *args, **options)
            calls.append(len(shape))
            return super().__new__(cls)

    return Voronoi


@pytest.mark.skipif(not CASES, reason="SciPy is installed without its tests")
@pytest.mark.parametrize(("module", "bind", "arguments"), CASES)
@pytest.mark.deep(
    "TestVoronoi::test_incremental?random-3d-chunk-16?",
    "TestVoronoi::test_incremental?random-3d-chunk-1?",
    "TestVoronoi::test_incremental?random-3d-chunk-4?",
)
@pytest.mark.sampled(8)
def test_holds(
    module: ModuleType,
    bind: Callable[[], Callable[..., None]],
    arguments: dict[str, Any],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    calls: list[int] = []
    diagram = replacement(calls)
    monkeypatch.setattr(module, "Voronoi", diagram)
    if hasattr(module, "qhull"):
        names = vars(module.qhull) | {"Voronoi": diagram}
        monkeypatch.setattr(module, "qhull", SimpleNamespace(**names))
    if hasattr(module, "voronoi_plot_2d"):
        pytest.importorskip("matplotlib").use("Agg")
        monkeypatch.setattr(module, "voronoi_plot_2d", drop_in.voronoi_plot_2d)
    replaced = {n: diagram if v is spatial.Voronoi else v for n, v in arguments.items()}
    bind()(**replaced)
    if not calls:
        raise NotReachedError("the test never came to delone")


@pytest.mark.skipif(not CASES, reason="SciPy is installed without its tests")
def test_the_known_tests_are_there() -> None:
    names = [case.id for case in CASES]
    for pattern in CANNOT_HOLD:
        assert fnmatch.filter(names, pattern), f"{pattern} matches no test"
    assert sum(name.startswith("TestVoronoi::test_incremental") for name in names) >= 5
    for expected in ("TestVoronoi::test_ridges*", "TestPlotting::test_voronoi"):
        assert fnmatch.filter(names, expected)


@pytest.mark.skipif(not CASES, reason="SciPy is installed without its tests")
@pytest.mark.parametrize(
    "points",
    [
        [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (2, 0), (2, 1), (2, 2)],
        [(0, 0), (0, 1), (1, 0), (0.5, 0.5), (1.1, 1.1)],
    ],
)
@pytest.mark.parametrize("furthest_site", [False, True])
def test_but_for_the_order_the_diagram_is_that_of_scipy(
    points: list[tuple[float, float]], furthest_site: bool
) -> None:
    if furthest_site and len(points) == 9:
        points = [*points, (2.5, 0.25)]
    ours = drop_in.Voronoi(points, furthest_site=furthest_site)
    theirs = spatial.Voronoi(points, furthest_site=furthest_site)

    assert ridges(ours) == ridges(theirs)
    assert cells(ours) == cells(theirs)
    assert sorted(map(len, ours.regions)) == sorted(map(len, theirs.regions))


SPACE = {
    "random": np.random.default_rng(1).random((60, 3)),
    "grid": np.stack(np.meshgrid(*[np.arange(3.0)] * 3), axis=-1).reshape(-1, 3),
    "duplicates": np.random.default_rng(2).random((30, 3))[np.arange(40) % 30],
}


@pytest.mark.parametrize("incremental", [False, True])
@pytest.mark.parametrize("points", SPACE.values(), ids=SPACE)
def test_in_space_scipy_leaves_out_open_ridges_of_one_vertex(
    points: Any, incremental: bool
) -> None:
    ours = drop_in.Voronoi(points, incremental=incremental)
    theirs = spatial.Voronoi(points, incremental=incremental)
    # Vertices and sites by delone's numbers: each of SciPy's vertices is one of delone's.
    distance, same = spatial.KDTree(ours.vertices).query(theirs.vertices)
    assert distance.max() < 1e-9
    assert len(set(same.tolist())) == len(ours.vertices)
    own = np.arange(len(ours.vertices))
    first = np.unique(points, axis=0, return_index=True, return_inverse=True)
    sites = first[1][first[2]]
    found, expected = ridges(ours, own, sites), ridges(theirs, same, sites)
    assert expected < found
    assert all(len(vertices) == 2 and -1 in vertices for _, vertices in found - expected)
    assert cells(ours, own) == cells(theirs, same)
    for name in ("ridge_points", "point_region", "vertices"):
        assert getattr(ours, name).dtype == getattr(theirs, name).dtype
    assert ours.ndim == theirs.ndim == 3


def test_space_and_plane_do_not_mix() -> None:
    diagram = drop_in.Voronoi(SPACE["random"], incremental=True)
    with pytest.raises(ValueError, match="3 coordinates"):
        diagram.add_points([(1, 2)])
    diagram.add_points([(2, 2, 2), (2, 2, 2)])
    assert diagram.npoints == 62
    assert diagram.point_region[60] == diagram.point_region[61]
    with pytest.raises(drop_in.DimensionError):
        drop_in.Voronoi(SPACE["random"], furthest_site=True)
    with pytest.raises(drop_in.QhullError):
        drop_in.Voronoi(SPACE["random"] * [1, 1, 0])


def ridges(vor: Any, number: Any = None, site: Any = None) -> set[Any]:
    """Sites and vertices of each ridge: vertices by coordinates, or by other numbers."""
    name, row = names(vor, number), np.arange(vor.npoints) if site is None else site
    return {
        (frozenset(row[[*pair]].tolist()), frozenset(name[v] for v in ends))
        for pair, ends in zip(vor.ridge_points.tolist(), vor.ridge_vertices, strict=True)
    }


def cells(vor: Any, number: Any = None) -> list[Any]:
    name = names(vor, number)
    return [{name[v] for v in vor.regions[r]} for r in vor.point_region]


def names(vor: Any, number: Any) -> list[Any]:
    if number is None:
        return [*(tuple(np.round(v, 9).tolist()) for v in vor.vertices), "open"]
    return [*number.tolist(), -1]
