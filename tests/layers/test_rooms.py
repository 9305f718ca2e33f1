"""Files of Python import each other one way, imports inside functions and for types included."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from structure import knots, python_graph

if TYPE_CHECKING:
    from pathlib import Path

# What each room of `delone.distributed` may import of the others.
ROOMS = {
    "pure": set[str](),
    "store": {"pure"},
    "run": {"pure", "store"},
    "read": {"pure", "store"},
}


def room(file: str) -> str | None:
    """The room of a file of `delone.distributed`, None for any other file."""
    words = file.split(".")
    return words[2] if words[:2] == ["delone", "distributed"] and len(words) > 3 else None


def test_the_rooms_of_tiles_have_one_direction() -> None:
    found = {
        (file, to)
        for file, targets in python_graph().items()
        for to in targets
        if (here := room(file)) and room(to) not in {None, here, *ROOMS[here]}
    }
    assert found == set()


@pytest.mark.parametrize(
    "how",
    [
        "from delone.{other} import {Name}",
        "def f():\n    from delone import {other}",
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from delone import {Name}",
    ],
)
def test_a_circle_is_found_wherever_the_import_is(how: str, tmp_path: Path) -> None:
    package = tmp_path / "delone"
    package.mkdir()
    (package / "__init__.py").write_text("from delone.a import A\nfrom delone.b import B\n")
    (package / "a.py").write_text(how.format(other="b", Name="B"))
    (package / "b.py").write_text("import delone.c")
    (package / "c.py").write_text("from delone import A")
    assert knots(python_graph(package)) == [["delone.a", "delone.b", "delone.c"]]
    (package / "c.py").write_text("import numpy")
    assert knots(python_graph(package)) == []
