"""The map in architecture/map.md is the one that the sources have."""

from __future__ import annotations

import pytest

from structure import (
    PAGE,
    core_graph,
    core_parts,
    drawn,
    levels,
    python_parts,
    sentence,
    with_map,
)


def test_the_map_is_that_of_the_sources() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert with_map(page, drawn(core_graph())) == page, "run `make map`"


def test_every_part_says_what_it_is() -> None:
    parts = core_parts() | python_parts()
    assert {name for name, part in parts.items() if len(part.summary) < 20} == set()
    assert len(core_parts()) > 20
    assert len(python_parts()) > 20


def test_layers_and_circles() -> None:
    graph = {"a": set[str](), "b": {"a"}, "c": {"b", "d"}, "d": {"c"}, "e": {"a", "c"}}
    assert levels(graph) == [["a"], ["b"], ["c", "d"], ["e"]]


@pytest.mark.parametrize(
    ("text", "first"),
    [("One.  Two.", "One"), ("From 1.5\nto 2. More", "From 1.5 to 2"), ("None", "None")],
)
def test_first_sentences(text: str, first: str) -> None:
    assert sentence(text) == first
