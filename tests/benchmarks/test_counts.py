"""Counts of instructions: what is compared with what, and which jobs have one."""

from __future__ import annotations

import importlib.util
import json
import re
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
COUNTS = ROOT / "benchmarks" / "counts.py"


@pytest.fixture(scope="module")
def counts() -> Any:
    """`benchmarks/counts.py` as a module; it imports no other program."""
    spec = importlib.util.spec_from_file_location("counts_of_instructions", COUNTS)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_each_job_has_a_count() -> None:
    program = (ROOT / "crates" / "core" / "examples" / "counts.rs").read_text(encoding="utf-8")
    listed = program[program.index("const JOBS") : program.index("fn main")]
    jobs = re.findall(r'^    \("(\w+)", ', listed, re.MULTILINE)
    stored = json.loads(COUNTS.with_suffix(".json").read_text(encoding="utf-8"))
    assert jobs
    assert list(stored["counts"]) == jobs


@pytest.mark.parametrize(
    ("now", "same", "code"),
    [(1020, True, 0), (1021, True, 1), (900, True, 0), (2000, False, 0)],
)
def test_only_more_than_the_tolerance_fails(
    counts: Any, capsys: pytest.CaptureFixture[str], now: int, same: bool, code: int
) -> None:
    assert counts.compare({"a": 500, "b": now}, {"a": 500, "b": 1000}, same=same) == code
    told = capsys.readouterr().out
    assert ("make counts" in told) == (code == 1)
    assert f"{now:,}" in told
    assert "+0.00 %" in told


@pytest.mark.parametrize(("now", "named"), [(989, True), (990, False), (1010, False), (1011, True)])
@pytest.mark.parametrize("same", [True, False])
def test_changes_above_one_percent_are_named(
    counts: Any, capsys: pytest.CaptureFixture[str], now: int, named: bool, same: bool
) -> None:
    assert counts.compare({"a": 500, "b": now}, {"a": 500, "b": 1000}, same=same) == 0
    assert ("changed by more than 1%: b\n" in capsys.readouterr().out) == named


def test_each_room_has_a_job() -> None:
    program = (ROOT / "crates" / "core" / "examples" / "counts.rs").read_text(encoding="utf-8")
    used = set(re.findall(r"\b(\w+)::", program))
    rooms = ["delaunay", "constrained", "locate", "sphere", "live", "graphs"]
    assert used.issuperset([*rooms, "alpha", "contour", "recover", "volume"])


def test_a_new_job_fails_nothing(counts: Any, capsys: pytest.CaptureFixture[str]) -> None:
    assert counts.compare({"a": 500}, {}, same=True) == 0
    assert "new" in capsys.readouterr().out


def test_without_valgrind_nothing_is_built(
    counts: Any, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(counts.shutil, "which", lambda _: None)
    monkeypatch.setattr(counts.sys, "argv", ["counts.py"])
    monkeypatch.setattr(counts, "build", lambda: pytest.fail("it is built"))
    assert counts.main() == 0
    assert "valgrind is not installed" in capsys.readouterr().out
