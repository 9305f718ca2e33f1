"""Public surfaces, where they are at hand: parts with large plane faces, of up to 2,400 points."""

from __future__ import annotations

from pathlib import Path

import pytest

import delone
import solids

SURFACES = Path(__file__).parents[3] / "shared" / "data" / "surfaces"
FOLDER = SURFACES / "tetgentests"
CROSSING = sorted((SURFACES / "refuse").glob("*.obj"))
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
@pytest.mark.sampled(3)
def test_parts_are_filled_with_few_points(name: str) -> None:
    mesh = delone.tetrahedralize(FOLDER / f"{name}.off")
    assert mesh.validate()
    assert mesh.nadded <= ADDED[name]
    check = delone.check_surface(mesh.points, mesh.input_faces)
    assert check.closed and check.oriented


@pytest.mark.parametrize("path", CROSSING, ids=lambda path: path.stem)
def test_crossing_faces_are_refused_with_all_pairs(path: Path) -> None:
    with pytest.raises(delone.CrossingFacesError) as caught:
        delone.tetrahedralize(path)
    assert caught.value.count == len(caught.value.pairs) == len(caught.value.kinds)
    assert caught.value.count > 0


@pytest.mark.parametrize(
    ("name", "fewer"), [("anchor", 22), ("pipe", 17), ("rotor_small", 2), ("joint", 4)]
)
@pytest.mark.deep
def test_plane_parts_that_are_cut_again_need_fewer_points(name: str, fewer: int) -> None:
    mesh = delone.tetrahedralize(FOLDER / f"{name}.off", boundary="surface")
    assert mesh.validate()
    assert mesh.nadded <= ADDED[name] - fewer
    given = delone.tetrahedralize(FOLDER / f"{name}.off")
    whole = solids.volume(given.points, given.input_faces)
    assert solids.volume(mesh.points, mesh.input_faces) == whole
