"""SciPy's own tests of its interpolators, as installed, run against the drop-ins.

Nothing of SciPy's text is here: its test modules are loaded a second time, the names through which
they reach SciPy's classes are replaced, and each test is run; each must reach delone.
"""

from __future__ import annotations

import fnmatch
import importlib.util
import inspect
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone.compat import interpolate as drop_in
from delone.compat import scipy as names

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from types import ModuleType

interpolate = pytest.importorskip("scipy.interpolate")

# Tests that cannot hold, by pattern, each with its reason. Every pattern must match a test, and
# every test that matches must fail.
CANNOT_HOLD = {
    "TestLinearNDInterpolation::test_square": (
        "wants Qhull's diagonal of a square; delone's begins at the lexicographically smallest "
        "corner"
    ),
}

# Tests of one dimension, or that ask for more than a test may take.
LEFT_OUT = {
    "TestGriddata::test_1d*": "points on a line",
    "TestLinearNDInterpolation::test_threading": "asks for 10 GB of free memory",
}

REPLACED = (
    "CloughTocher2DInterpolator",
    "LinearNDInterpolator",
    "NearestNDInterpolator",
    "estimate_gradients_2d_global",
    "griddata",
)


def load(name: str) -> ModuleType | None:
    """A copy of a test module of SciPy of our own, or None where SciPy ships without tests."""
    try:
        spec = importlib.util.find_spec(f"scipy.interpolate.tests.{name}")
    except ModuleNotFoundError:
        return None
    if spec is None or spec.loader is None:
        return None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def parameters(function: Callable[..., Any]) -> list[tuple[str, dict[str, Any]]]:
    """Identifier and keyword arguments of each run of a test."""
    runs: list[dict[str, Any]] = [{}]
    for mark in getattr(function, "pytestmark", []):
        if mark.name == "parametrize":
            runs = [run | {mark.args[0]: value} for run in runs for value in mark.args[1]]
    words = ["-".join(str(getattr(v, "__name__", v)) for v in run.values()) for run in runs]
    return [(f"[{word}]" if word else "", run) for word, run in zip(words, runs, strict=True)]


def cases(module: ModuleType) -> Iterator[Any]:
    for name, owner in vars(module).items():
        if not (name.startswith("Test") and inspect.isclass(owner)):
            continue
        for method, function in vars(owner).items():
            full = f"{name}::{method}"
            if not method.startswith("test_") or matching(full, LEFT_OUT):
                continue
            for suffix, arguments in parameters(function):
                reasons = matching(full + suffix, CANNOT_HOLD)
                marks = [
                    pytest.mark.xfail(reason=reason, strict=True, raises=AssertionError)
                    for reason in reasons
                ]
                test = (module, function.__get__(owner()), arguments)
                yield pytest.param(*test, True, id=full + suffix, marks=marks)
                if "qhull" in function.__code__.co_names:
                    theirs = f"{full}{suffix} on a triangulation of SciPy"
                    yield pytest.param(*test, False, id=theirs, marks=marks)


def matching(name: str, table: dict[str, str]) -> list[str]:
    return [reason for pattern, reason in table.items() if fnmatch.fnmatch(name, pattern)]


MODULES = [module for name in ("test_interpnd", "test_ndgriddata") if (module := load(name))]
CASES = [case for module in MODULES for case in cases(module)]


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Count what is made of delone's drop-ins."""
    found: list[str] = []

    def counted(owner: Any, method: str) -> None:
        plain = getattr(owner, method)

        def call(self: Any, *args: Any, **options: Any) -> Any:
            found.append(type(self).__name__)
            return plain(self, *args, **options)

        monkeypatch.setattr(owner, method, call)

    counted(drop_in._Triangulated, "_set")
    counted(drop_in.NearestNDInterpolator, "__init__")
    return found


@pytest.mark.skipif(not MODULES, reason="SciPy is installed without its tests")
@pytest.mark.parametrize(("module", "test", "arguments", "our_mesh"), CASES)
def test_holds(  # noqa: PLR0917
    module: ModuleType,
    test: Callable[..., None],
    arguments: dict[str, Any],
    our_mesh: bool,
    calls: list[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ours = {name: getattr(drop_in, name) for name in REPLACED}
    if hasattr(module, "interpnd"):
        replaced = SimpleNamespace(**(vars(module.interpnd) | ours))
        monkeypatch.setattr(module, "interpnd", replaced)
        if our_mesh:
            replaced = SimpleNamespace(**(vars(module.qhull) | vars(names)))
            monkeypatch.setattr(module, "qhull", replaced)
    for name, replacement in ours.items():
        if hasattr(module, name):
            monkeypatch.setattr(module, name, replacement)
    by_name = {getattr(interpolate, name, None): ours[name] for name in REPLACED}
    test(**{key: by_name.get(value, value) for key, value in arguments.items()})
    assert calls, "the test never came to delone"


@pytest.mark.skipif(not MODULES, reason="SciPy is installed without its tests")
def test_the_known_tests_are_there() -> None:
    names = [case.id for case in CASES]
    for pattern in CANNOT_HOLD:
        assert fnmatch.filter(names, pattern), f"{pattern} matches no test"
    for expected in (
        "TestLinearNDInterpolation::test_square",
        "TestCloughTocher2DInterpolator::test_dense",
        "TestEstimateGradients2DGlobal::test_regression_2359",
        "TestGriddata::test_fill_value",
        "TestNDInterpolators::test_broadcastable_input[NearestNDInterpolator]",
    ):
        assert expected in names


def test_general_positions_agree() -> None:
    rng = np.random.default_rng(8)
    points, queries = rng.random((400, 2)), rng.random((1000, 2)) * 1.2 - 0.1
    values = np.cos(3 * points[:, 0]) + points[:, 1] ** 2
    for name in ("LinearNDInterpolator", "NearestNDInterpolator", "CloughTocher2DInterpolator"):
        theirs = getattr(interpolate, name)(points, values)(queries)
        ours = getattr(drop_in, name)(points, values)(queries)
        np.testing.assert_allclose(ours, theirs, rtol=1e-9, atol=1e-9)
