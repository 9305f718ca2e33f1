"""Each bug of ``tests/mutants`` still fits the tree, so that `make mutants` can seed it."""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest

TOP = Path(__file__).parents[2]
LISTED = tomllib.loads((TOP / "tests/mutants/mutants.toml").read_text(encoding="utf-8"))["mutant"]


@pytest.mark.parametrize("mutant", LISTED, ids=lambda each: each["name"])
def test_a_bug_can_be_seeded(mutant: dict[str, Any]) -> None:
    assert (TOP / mutant["file"]).read_text(encoding="utf-8").count(mutant["old"]) == 1
    assert mutant["old"] != mutant["new"]
    rooms = [each for each in mutant.get("pytest", ()) if each.startswith("tests/")]
    assert rooms or mutant["cargo"]
    assert [each for each in rooms if not (TOP / each.partition("::")[0]).exists()] == []


def test_names_are_distinct() -> None:
    names = [each["name"] for each in LISTED]
    assert len(names) == len(set(names))


def test_the_list_is_read() -> None:
    sys.path.insert(0, str(TOP / "tests/mutants"))
    try:
        from run import read
    finally:
        sys.path.pop(0)
    assert len(read()) == len(LISTED)
