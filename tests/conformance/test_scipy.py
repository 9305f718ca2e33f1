"""SciPy's own tests of qhull's classes, as installed, run against the drop-ins.

Nothing of SciPy's text is here: its test module is loaded a second time, the name through which it
reaches SciPy's classes is replaced, and each test that uses one of them with two to eight
coordinates is run. Where a test also has more, SciPy does those; each test must have reached
delone. The guide to the drop-ins lists the tests that cannot hold.
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
    "TestUtilities::test_find_simplex": (
        "compares the rows of `simplices` with Qhull's order and its diagonal of a square; "
        "delone's diagonal begins at the lexicographically smallest corner"
    ),
    "TestUtilities::test_convex_hull": (
        "compares the rows of `convex_hull` with Qhull's order and its diagonal of a square"
    ),
    "TestUtilities::test_degenerate_barycentric_transforms": (
        "wants fewer than 23 nearly flat triangles, which Qhull attains by leaving points out "
        "along the hull; with every point a vertex there are 31"
    ),
    "TestDelaunay::test_2d_square": (
        "compares the rows of `simplices` with Qhull's order and its diagonal of a square"
    ),
    "TestDelaunay::test_joggle": (
        "wants duplicates as vertices of their own, which Qhull makes by moving the points; delone "
        "never moves a point, and lists duplicates in `coplanar`"
    ),
    "TestDelaunay::test_furthest_site": (
        "compares the rows of `simplices` with Qhull's order and clockwise orientation; delone's "
        "triangles are counter-clockwise, as SciPy's documentation says of them"
    ),
}

_ORDER = (
    "compares the rows of `good` with Qhull's order of facets; the set is checked in tests/compat"
)
CANNOT_HOLD |= {
    "TestConvexHull::test_good2d[[]*": _ORDER,
    "TestConvexHull::test_good3d[[]*": _ORDER,
    "TestConvexHull::test_good2d_incremental_changes[[]*-0.7*": _ORDER,
    "TestConvexHull::test_good2d_incremental_changes[[]*0.41*": _ORDER,
    "TestConvexHull::test_good2d_incremental_changes[[]*0.5 0.6*": _ORDER,
}

_ORDER = "compares the rows of corners with Qhull's order; the set is checked in tests/compat"
CANNOT_HOLD |= {
    "Test_HalfspaceIntersection::test_cube": _ORDER,
    "Test_HalfspaceIntersection::test_cube_halfspace_intersection*": _ORDER,
}

# Tests of SciPy with points or half-spaces in more dimensions than the drop-ins have.
OTHER_DIMENSION = re.compile(r"random-(9|1\d)d")


class NotReachedError(Exception):
    """Raised when a test ends without a call of delone."""


def load_tests() -> ModuleType | None:
    """A copy of SciPy's test module of our own, or None where SciPy ships without tests."""
    try:
        spec = importlib.util.find_spec("scipy.spatial.tests.test_qhull")
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


def uses_drop_ins(function: Callable[..., Any]) -> bool:
    names = {"Delaunay", "ConvexHull", "HalfspaceIntersection"}
    return bool(names & set(inspect.unwrap(function).__code__.co_names))


def parameters(function: Callable[..., Any]) -> list[tuple[str, dict[str, Any]]]:
    """Identifier and keyword arguments of each run of a test."""
    marks = [m for m in getattr(function, "pytestmark", []) if m.name == "parametrize"]
    runs: list[dict[str, Any]] = [{}]
    for mark in marks:
        names = [name.strip() for name in mark.args[0].split(",")]
        rows = [row if len(names) > 1 else (row,) for row in mark.args[1]]
        runs = [run | dict(zip(names, row, strict=True)) for run in runs for row in rows]
    words = [[str(getattr(v, "__name__", v)) for v in run.values()] for run in runs]
    return [(f"[{'-'.join(w)}]" if w else "", run) for w, run in zip(words, runs, strict=True)]


def cases(module: ModuleType) -> Iterator[Any]:
    """All tests of SciPy that call one of the drop-ins."""
    for name, item in vars(module).items():
        if name.startswith("test_") and callable(item):
            yield from _runs(name, item, lambda function: function)
        elif name.startswith("Test") and inspect.isclass(item):
            for method, function in vars(item).items():
                if method.startswith("test_"):
                    yield from _runs(
                        f"{name}::{method}",
                        function,
                        lambda function, owner=item: function.__get__(owner()),
                    )


def _runs(name: str, function: Any, bind: Callable[[Any], Any]) -> Iterator[Any]:
    for suffix, arguments in parameters(function):
        by_parameter = any(
            value in (spatial.Delaunay, spatial.ConvexHull)
            for value in arguments.values()
            if inspect.isclass(value)
        )
        if OTHER_DIMENSION.search(name + suffix) or not (uses_drop_ins(function) or by_parameter):
            continue
        reasons = [
            r for pattern, r in CANNOT_HOLD.items() if fnmatch.fnmatch(name + suffix, pattern)
        ]
        marks = [pytest.mark.xfail(reason=r, strict=True, raises=AssertionError) for r in reasons]
        yield pytest.param(bind(function), arguments, id=name + suffix, marks=marks)


MODULE = load_tests()
CASES = [] if MODULE is None else list(cases(MODULE))


def beyond_space(points: Any) -> bool:
    shape = np.shape(points)
    return len(shape) == 2 and shape[1] > 8


@pytest.fixture
def calls_of_delone(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Put the drop-in in the place of SciPy's class, and count its triangulations."""
    calls: list[int] = []

    class Delaunay(drop_in.Delaunay):
        def __new__(cls, points: Any, *args: Any, **options: Any) -> Any:
            if beyond_space(points):
                return spatial.Delaunay(points, *args, **options)
            calls.append(len(points))
            return super().__new__(cls)

    class ConvexHull(drop_in.ConvexHull):
        def __new__(cls, points: Any, *args: Any, **options: Any) -> Any:
            if beyond_space(points):
                return spatial.ConvexHull(points, *args, **options)
            calls.append(len(points))
            return super().__new__(cls)

    class HalfspaceIntersection(drop_in.HalfspaceIntersection):
        def __new__(cls, halfspaces: Any, *args: Any, **options: Any) -> Any:
            calls.append(len(halfspaces))
            return super().__new__(cls)

    replaced = SimpleNamespace(**vars(MODULE.qhull))
    replaced.HalfspaceIntersection = HalfspaceIntersection
    replaced.Delaunay = Delaunay
    replaced.ConvexHull = ConvexHull
    replaced.tsearch = drop_in.tsearch
    monkeypatch.setattr(MODULE, "qhull", replaced)
    return calls


@pytest.mark.skipif(MODULE is None, reason="SciPy is installed without its tests")
@pytest.mark.parametrize(("test", "arguments"), CASES)
@pytest.mark.deep("TestUtilities::test_more_barycentric_transforms")
def test_holds(
    test: Callable[..., None], arguments: dict[str, Any], calls_of_delone: list[int]
) -> None:
    classes = {
        spatial.Delaunay: MODULE.qhull.Delaunay,
        spatial.ConvexHull: MODULE.qhull.ConvexHull,
    }
    replaced = {
        name: classes.get(value, value) if inspect.isclass(value) else value
        for name, value in arguments.items()
    }
    test(**replaced)
    if not calls_of_delone:
        raise NotReachedError("the test never came to delone")


@pytest.mark.skipif(MODULE is None, reason="SciPy is installed without its tests")
def test_the_known_tests_are_there() -> None:
    names = [case.id for case in CASES]
    for pattern in CANNOT_HOLD:
        assert fnmatch.filter(names, pattern), f"{pattern} matches no test"
    assert sum(name.startswith("TestDelaunay::test_incremental") for name in names) >= 10
    for expected in ("TestUtilities::test_plane_distance", "TestDelaunay::test_coplanar"):
        assert expected in names
