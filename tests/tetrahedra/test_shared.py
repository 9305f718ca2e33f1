"""Public surfaces, where they are at hand: parts with large plane faces, of up to 2,400 points."""

from __future__ import annotations

from pathlib import Path

import pytest

import delone

FOLDER = Path(__file__).parents[3] / "shared" / "data" / "surfaces" / "tetgentests"
# The most points that may be added. Without flips that open the way for others, each of these has
# several times as many, or does not end.
ADDED = {
    "anchor": 30,
    "dragknob": 4,
    "eight": 0,
    "hand": 2,
    "joint": 6,
    "oblong": 10,
    "pipe": 19,
    "rotor_small": 20,
    "spool": 6,
}

pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason="needs public surfaces")


@pytest.mark.parametrize("name", sorted(ADDED))
def test_parts_are_filled_with_few_points(name: str) -> None:
    mesh = delone.tetrahedralize(FOLDER / f"{name}.off")
    assert mesh.validate()
    assert mesh.nadded <= ADDED[name]
    check = delone.check_surface(mesh.points, mesh.input_faces)
    assert check.closed and check.oriented
