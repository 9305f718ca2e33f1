"""What all tests share: the tier of the run, the corpus of hard inputs, expected skips.

The tests run in random order (pytest-randomly); the last lines of a run say how to repeat it.
"""

from __future__ import annotations

import importlib.util
import json
import os
from fnmatch import fnmatch
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pytest

from tiers import MARKERS, Tiers, Times

if TYPE_CHECKING:
    from numpy.typing import NDArray

CORPUS = Path(__file__).parent / "corpus"


class CorpusCase(NamedTuple):
    """A hard input that must triangulate."""

    name: str
    points: NDArray[np.float64]
    sentence: str


class DegenerateCase(NamedTuple):
    """An input that must raise DegenerateInputError for the reason given."""

    name: str
    points: NDArray[np.float64]
    sentence: str
    reason: str


def _read(path: Path) -> tuple[NDArray[np.float64], dict[str, Any]]:
    case = json.loads(path.read_text(encoding="utf-8"))
    return np.array(case["points"], dtype=np.float64).reshape(-1, 2), case


def _files(folder: Path) -> list[Any]:
    return [pytest.param(path, id=path.stem) for path in sorted(folder.glob("*.json"))]


@pytest.fixture(params=_files(CORPUS))
def corpus_case(request: pytest.FixtureRequest) -> CorpusCase:
    """One hard input after the other: name, points, and a sentence why it is hard."""
    points, case = _read(request.param)
    return CorpusCase(request.param.stem, points, case["sentence"])


@pytest.fixture(params=_files(CORPUS / "degenerate"))
def degenerate_case(request: pytest.FixtureRequest) -> DegenerateCase:
    """One input without any triangle after the other, and the reason to be raised."""
    points, case = _read(request.param)
    return DegenerateCase(request.param.stem, points, case["sentence"], case["reason"])


# Skips of a full environment, as `make test` has it: test, reason, and where that happens. All
# others fail the run.
EXPECTED_SKIPS = {
    ("tests/conformance/test_triangle.py*", "could not import 'triangle'*"): (
        "the package, whose license is not free, is needed by benchmarks alone"
    ),
    ("tests/alpha/*", "could not import 'gudhi'*"): "needed by tests alone, and not everywhere",
    ("tests/io/*", "could not import 'gmsh'*"): "needed by benchmarks and a few tests of files",
    ("tests/exchange/*", "could not import 'gmsh'*"): "needed by benchmarks and these tests",
    ("tests/exchange/*", "could not import 'dolfinx'*"): "not a package of PyPI",
    ("tests/compat/*", "could not import 'tetgen'*"): "the package that is replaced, with the AGPL",
    ("tests/sphere/test_map_files.py*", "could not import 'uxarray'*"): "it has many requirements",
    ("tests/sphere/test_map_files.py*", "could not import 'xesmf'*"): "it needs ESMF, of no index",
    ("tests/sphere/test_map_files.py*", "could not find the program ncks"): "NCO is on no index",
    ("tests/sphere/test_map_files.py*", "could not find the program cdo"): "CDO is on no index",
    ("tests/sphere/test_map_files.py*", "could not import 'yac.core'*"): "it needs an MPI library",
    ("tests/distributed/test_resume.py*", "root may write anywhere"): "containers run as root",
    (
        "tests/conformance/*",
        "SciPy is installed without its tests",
    ): "as packages of systems have it",
    ("tests/refine/test_gaps.py*", "needs the countries*"): "data that are not shipped",
    ("tests/sphere/*", "needs the countries*"): "data that are not shipped",
    ("tests/sphere/*", "needs the grids of models"): "data that are not shipped",
    ("tests/surface/*", "needs public surfaces"): "data that are not shipped",
    ("tests/tetrahedra/*", "needs public surfaces"): "data that are not shipped",
    ("tests/terrain/test_delft.py*", "needs lidar and the map*"): "data that are not shipped",
    ("tests/terrain/test_ground.py*", "needs lidar of Delft*"): "data that are not shipped",
    ("tests/explore/*", "no Chromium is installed"): "a browser is not a package of Python",
    ("tests/learn/*", "no Chromium is installed"): "a browser is not a package of Python",
    ("tests/learn/*", "points do not move without the core"): "stored steps cannot be dragged",
    (
        "tests/learn/*",
        "the module for pages is not built",
    ): "it needs a compiler for WebAssembly: make web",
    ("tests/try_it/*", "no Chromium is installed"): "a browser is not a package of Python",
    (
        "tests/try_it/*",
        "the module for pages is not built",
    ): "it needs a compiler for WebAssembly: make web",
    ("tests/web/*", "no Chromium is installed"): "a browser is not a package of Python",
    ("tests/web/*", "no Node is installed"): "Node is not a package of Python",
    (
        "tests/web/*",
        "the module for pages is not built",
    ): "it needs a compiler for WebAssembly: make web",
    ("*", "*POSIX*"): "Windows",
    ("*", "RLIMIT_AS is kept on Linux alone"): "macOS and Windows",
    ("*", "prctl and limits of Linux alone"): "macOS and Windows",
    ("*", "links need a privilege on Windows"): "Windows",
    ("*", "pipes of 64 KiB that open both ways"): "macOS and Windows",
    ("*", "longdouble is float64 on this platform"): "Windows, and macOS on ARM",
    ("*", "processes are killed *"): "Windows",
    ("*", "the process is killed by a signal"): "Windows",
}
# Set where extras are missing on purpose: then every skip is expected.
ANY_SKIP = "DELONE_ANY_SKIP"

# What `pytest --quick` runs: a minute of tests that cover each part of the core, for wheels in
# fresh environments and for emulated processors; and the library without which a file is left out.
QUICK = {
    "arrays/test_arrays.py": None,
    "compat/test_scipy.py": "scipy",
    "constrained/test_constrained.py": None,
    "delaunay/test_archive.py": None,
    "delaunay/test_attributes.py": "scipy",
    "delaunay/test_find_simplex.py": None,
    "delaunay/test_immutable.py": None,
    "delaunay/test_input.py": "pandas",
    "delaunay/test_triangles.py": None,
    "environments/*": None,
    "errors/*": None,
    "hull/test_hull.py": "scipy",
    "lawson/*": None,
    "locate/test_locator.py": None,
    "parallel/test_shared_meshes.py": None,
    "platforms/*": None,
    "predicates/*": None,
    "refine/test_report.py": None,
    "space/test_degenerate.py": None,
    "space/test_tetrahedra.py": None,
    "voronoi/test_diagram.py": "scipy",
}


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--quick", action="store_true", help="only the files listed in QUICK")
    parser.addoption("--tier", default="test", help="test, deep, or a part of the rest: 2/5")
    parser.addoption("--times", action="store_true", help="end with the slowest tests and rooms")
    parser.addoption("--times-to", metavar="FILE", help="the same, and write the times of rooms")


def pytest_configure(config: pytest.Config) -> None:
    for marker in MARKERS:
        config.addinivalue_line("markers", marker)
    config.pluginmanager.register(Tiers(config.getoption("tier")), "tiers")
    file = config.getoption("times_to")
    if file or config.getoption("times"):
        config.pluginmanager.register(Times(file), "times")


def _is_quick(name: str, *, folder: bool) -> bool:
    """Whether a file, or anything in a folder, is listed and has the library that it needs."""
    found = {
        pattern: library
        for pattern, library in QUICK.items()
        if (pattern.startswith(f"{name}/") if folder else fnmatch(name, pattern))
    }
    return any(lib is None or importlib.util.find_spec(lib) is not None for lib in found.values())


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    folder = Path(__file__).parent
    if not config.getoption("quick") or folder not in collection_path.parents:
        return None
    name = collection_path.relative_to(folder).as_posix()
    # None: pytest decides.
    return None if _is_quick(name, folder=collection_path.is_dir()) else True


_unexpected: list[pytest.CollectReport | pytest.TestReport] = []


def _note(report: pytest.CollectReport | pytest.TestReport) -> None:
    if report.skipped and not hasattr(report, "wasxfail") and not os.environ.get(ANY_SKIP):
        reason = _reason(report)
        known = (fnmatch(report.nodeid, t) and fnmatch(reason, r) for t, r in EXPECTED_SKIPS)
        if not any(known):
            _unexpected.append(report)


def _reason(report: pytest.CollectReport | pytest.TestReport) -> str:
    where = report.longrepr
    return (where[2] if isinstance(where, tuple) else str(where)).removeprefix("Skipped: ")


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    _note(report)


def pytest_collectreport(report: pytest.CollectReport) -> None:
    _note(report)


def pytest_sessionfinish(session: pytest.Session) -> None:
    if _unexpected and session.exitstatus in (
        pytest.ExitCode.OK,
        pytest.ExitCode.NO_TESTS_COLLECTED,
    ):
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    if _unexpected:
        terminalreporter.section("skips that nobody expects", red=True)
        for report in _unexpected:
            terminalreporter.write_line(f"{report.nodeid}: {_reason(report)}")
        terminalreporter.write_line(
            f"Install what is missing, list the skip in {Path(__file__).name}, or set {ANY_SKIP}=1."
        )
        # The closing line counts them.
        terminalreporter.stats.setdefault("error", []).extend(_unexpected)
    seed = getattr(config.option, "randomly_seed", None)
    if isinstance(seed, int) and config.pluginmanager.hasplugin("randomly"):
        terminalreporter.write_line(f"order of the tests: --randomly-seed={seed}")
