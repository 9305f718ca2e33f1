"""Tiers: what a run takes of the suite, and what a change touches."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

from structure import core_parts, python_parts
from tiers import Taken, Times, room, sample, seeds

TESTS = Path(__file__).parents[1]
SUITE = """
import pytest
from hypothesis import given, settings, strategies as st
from tiers import examples, seeds

COUNT = {"default": 0, "own": 0}

@pytest.mark.deep
def test_rare(): pass

@pytest.mark.parametrize("seed", seeds(2, deep=5))
def test_seeds(seed): pass

@pytest.mark.parametrize("size", [1, 600])
@pytest.mark.deep("600")
def test_sizes(size): pass

@pytest.mark.parametrize("a", range(6))
@pytest.mark.parametrize("b", range(4))
@pytest.mark.sampled(8)
def test_combinations(a, b): pass

@given(st.integers())
def test_default(x): COUNT["default"] += 1

@settings(max_examples=examples(7, deep=31))
@given(st.integers())
def test_own(x): COUNT["own"] += 1

def test_last(): print(COUNT)
"""


@pytest.fixture
def suite(tmp_path: Path) -> Path:
    (tmp_path / "conftest.py").write_text((TESTS / "conftest.py").read_text(encoding="utf-8"))
    (tmp_path / "test_a.py").write_text(SUITE)
    return tmp_path


def run(suite: Path, *options: str) -> tuple[list[str], str]:
    """The names of the tests that a run takes, and its output."""
    fixed = ["-p", "no:randomly", "-p", "no:cacheprovider", "--rootdir", ".", "-vs"]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", *fixed, "-o", f"pythonpath={TESTS / 'oracles'}", *options],
        cwd=suite,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    lines = [line for line in done.stdout.splitlines() if "PASSED" in line]
    return [line.partition("::")[2].split(" ")[0] for line in lines], done.stdout


def test_the_test_tier_and_the_deep_one(suite: Path) -> None:
    usual, out = run(suite)
    assert "{'default': 20, 'own': 7}" in out
    assert "test_rare" not in usual
    assert [name for name in usual if "seeds" in name] == ["test_seeds[0]", "test_seeds[1]"]
    assert [name for name in usual if "sizes" in name] == ["test_sizes[1]"]
    combined = {name for name in usual if "combinations" in name}
    assert len(combined) == 8
    assert {name[-4] for name in combined} == set("0123")
    assert {name[-2] for name in combined} == set("012345")
    everything, out = run(suite, "--tier=deep")
    assert "{'default': 150, 'own': 31}" in out
    assert len(everything) == 1 + 5 + 2 + 24 + 3
    parts = [run(suite, f"--tier={part}/3")[0] for part in (1, 2, 3)]
    properties = {"test_default", "test_own"}
    assert sorted(name for part in parts for name in part) == sorted(
        [*set(everything) - set(usual), *properties]
    )
    both, out = run(suite, "--tier=test+2/3")
    assert "{'default': 20, 'own': 7}" in out
    assert set(both) == set(usual) | set(parts[1])


@pytest.mark.parametrize("text", ["", "all", "0/5", "6/5", "2", "deep+1/5", "test+", "a/b"])
def test_what_is_no_tier_is_refused(text: str) -> None:
    with pytest.raises(pytest.UsageError, match="write test, deep"):
        Taken.read(text)


def test_a_sample_has_each_value_of_each_parameter() -> None:
    values = [{"a": a, "b": b, "c": c} for a in range(7) for b in range(5) for c in range(2)]
    keys = [str(each) for each in values]
    for count in (1, 12, 40, 70):
        chosen = [values[i] for i in sample(values, keys, count)]
        assert len(chosen) >= count
        for name, size in (("a", 7), ("b", 5), ("c", 2)):
            assert {each[name] for each in chosen} == set(range(size))
    assert len(sample(values, keys, 1)) < 15
    assert len(sample([{"a": i} for i in range(9)], list("abcdefghi"), 4)) == 4


def test_seeds_are_those_of_both_tiers() -> None:
    both = seeds(3, deep=5)
    assert both[:3] == [0, 1, 2]
    assert [(each.values, [m.name for m in each.marks]) for each in both[3:]] == [
        ((3,), ["deep"]),
        ((4,), ["deep"]),
    ]


def test_rooms_have_their_times(tmp_path: Path) -> None:
    times = Times(str(tmp_path / "times.json"))
    for name, seconds in (("tests/hull/test_a.py::test_b", 2.0), ("docs/guide/a.rst::a", 1.0)):
        times.seconds[name] += seconds
    assert times.rooms() == {"tests/hull": (2.0, 1), "docs/guide": (1.0, 1)}
    assert room("python/delone/hull.py::delone.hull.ConvexHull") == "python/delone/hull"


@pytest.fixture(scope="module")
def check() -> ModuleType:
    spec = importlib.util.spec_from_file_location("check", TESTS / "check.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["check"] = module
    spec.loader.exec_module(module)
    return module


def test_each_part_has_a_room(check: ModuleType) -> None:
    parts = {*core_parts(), *python_parts()}
    assert [part for part in sorted(parts) if not check.rooms_of(part)] == []
    assert set(check.ROOMS) <= parts | {"__init__", "_core"}


def test_a_change_touches_its_room_and_those_that_import_it(check: ModuleType) -> None:
    change = check.touched(["python/delone/terrain/heights.py"])
    assert change.rooms == ["tests/terrain", "tests/cli", "tests/distributed"]
    change = check.touched(["crates/core/src/locate/mod.rs", "tests/hull/test_hull.py"])
    assert change.rooms[:2] == ["tests/locate", "tests/hull"]
    assert "tests/interpolate" in change.rooms
    assert change.core == ["locate"]
    assert check.touched(["docs/guide/voronoi.rst"]).rooms == [
        "tests/pages",
        "docs/guide/voronoi.rst",
    ]


def test_the_nearest_room_is_always_run(check: ModuleType) -> None:
    now, later = check.within(["tests/distributed", "tests/cluster", "tests/errors"], 0.0)
    assert now == ["tests/distributed"]
    assert later == ["tests/cluster", "tests/errors"]
