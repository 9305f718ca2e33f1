"""Arguments, errors, seeds, and what becomes of a mesh afterwards."""

from __future__ import annotations

import pickle
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
import solids
from delone import TetMesh, tetrahedralize
from delone.solids.tetrahedra import filling

if TYPE_CHECKING:
    from pathlib import Path

CUBE = solids.box((0, 0, 0), (4, 4, 4))
SHELLS = solids.joined(CUBE, solids.box((1, 1, 1), (2, 2, 2)), solids.box((2.5, 1, 1), (3, 3, 3)))


def test_faces_that_cross() -> None:
    points, faces = solids.joined(CUBE, solids.box((3, 3, 3), (5, 5, 5)))
    with pytest.raises(delone.CrossingFacesError, match="cross") as caught:
        tetrahedralize(points, faces)
    assert len(caught.value.pairs) == caught.value.count > 0
    assert set(caught.value.kinds) <= {"crossing", "edge on edge"}


def test_open_surfaces() -> None:
    points, faces = CUBE
    with pytest.raises(delone.OpenSurfaceError) as caught:
        tetrahedralize(points, faces[1:])
    assert {tuple(edge) for edge in caught.value.edges.tolist()} == {(0, 1), (1, 3), (0, 3)}


def test_flat_surfaces() -> None:
    with pytest.raises(delone.DegenerateInputError) as caught:
        tetrahedralize([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)])
    assert caught.value.reason == "coplanar"


def test_dangling_faces_that_need_points() -> None:
    """They are refused by name, or there."""
    points, faces = CUBE
    points = np.concatenate((points, [(1, 1, 2), (3, 1, 2), (3, 3, 2.5), (1, 3, 2.5)]))
    faces = np.concatenate((faces, [(8, 9, 10), (8, 10, 11)]))
    extra = [(2, 1.9, 2.05), (2, 1.9, 2.3), (1.5, 2, 2.1), (2, 2.5, 2.5), (2.1, 2.5, 2.2)]
    try:
        mesh = tetrahedralize(points, faces, extra_points=extra)
    except delone.DanglingFacesError as error:
        assert {12, 13} == set(error.faces.tolist())
    else:
        assert bool(mesh.validate())
        assert mesh.report.dangling.tolist() == [12, 13]


def test_budget() -> None:
    points, faces = solids.schoenhardt()
    with pytest.raises(delone.BudgetExceededError) as caught:
        tetrahedralize(points, faces, max_points=0)
    assert caught.value.limit == 0
    assert caught.value.found > 0


@pytest.mark.parametrize("ulps", [1, 2])
def test_no_room_for_a_double(ulps: int) -> None:
    """A prism that is so flat that no double lies inside where the one point is needed."""
    points, faces = solids.schoenhardt()
    points[:, 2] = np.where(points[:, 2] == 0, 1.0, 1.0 + ulps * 2.0**-52)
    if ulps == 1:
        with pytest.raises(delone.CrowdedFacesError) as caught:
            tetrahedralize(points, faces)
        assert len(caught.value.faces)
        assert set(caught.value.faces.tolist()) <= set(range(8))
    else:
        assert bool(tetrahedralize(points, faces).validate())


@pytest.mark.parametrize(
    ("change", "error", "words"),
    [
        ({"boundary": "edges"}, delone.InputError, "boundary must be one of 'faces', 'surface'"),
        ({"inside": "odd"}, delone.InputError, "inside must be one of"),
        ({"holes": [(9, 9, 9)]}, delone.InputError, "holes: 1 seed outside"),
        ({"holes": [(1, 1, 4)]}, delone.InputError, "holes: 1 seed on a face"),
        ({"holes": [(0, 0, 2)]}, delone.InputError, "holes: 1 seed on a face"),
        ({"holes": [(4, 4, 4)]}, delone.InputError, "holes: 1 seed on a face"),
        ({"holes": [(1, 1)]}, delone.ShapeError, r"holes must have shape \(k, 3\)"),
        ({"holes": [(1, 1, np.nan)]}, delone.NonFiniteError, "holes"),
        ({"holes": [(1, 1, 1)]}, delone.InputError, "nothing is left inside"),
        ({"regions": [(1, 1, 1, 0.5)]}, delone.InputError, "fourth column"),
        ({"regions": [(1, 1, 1, 0), (2, 2, 2, 1)]}, delone.InputError, "has the label 1"),
        ({"extra_points": [(5, 1, 1)]}, delone.InputError, "extra_points: 1 point outside"),
        ({"extra_points": [(4, 1, 1)]}, delone.InputError, "extra_points: 1 point on a face"),
        ({"extra_points": [(1, 1, 1)] * 2}, delone.InputError, "rows repeat others"),
        ({"face_markers": [1]}, delone.ShapeError, "face_markers must have shape"),
        ({"face_markers": [0.5] * 12}, delone.DtypeError, "face_markers must hold integers"),
        ({"face_markers": [2**40] * 12}, delone.InputError, "32-bit"),
        ({"max_points": -1}, delone.InputError, "max_points"),
        ({"progress": 3}, delone.DtypeError, "progress"),
        ({"workers": 0}, delone.InputError, "workers"),
    ],
)
def test_arguments(change: dict[str, Any], error: type[Exception], words: str) -> None:
    with pytest.raises(error, match=words):
        tetrahedralize(*CUBE, **change)


@pytest.mark.parametrize(
    ("points", "error"),
    [
        (np.where(CUBE[0] == 4, np.nan, CUBE[0]), delone.NonFiniteError),
        (CUBE[0][:, :2], delone.ShapeError),
        (CUBE[0][:7], delone.InputError),
    ],
)
def test_points(points: Any, error: type[Exception]) -> None:
    with pytest.raises(error):
        tetrahedralize(points, CUBE[1])


def test_faces_that_contradict_each_other() -> None:
    points, faces = CUBE
    turned = np.where(np.arange(12)[:, None] == 5, faces[:, ::-1], faces)
    with pytest.raises(delone.InputError, match="not oriented alike"):
        tetrahedralize(points, turned)
    assert tetrahedralize(points, turned, inside="parity").nsimplex


def test_holes_and_regions() -> None:
    points, faces = SHELLS
    assert solids.filled(points, tetrahedralize(points, faces).simplices) == 64
    mesh = tetrahedralize(points, faces, holes=[(1.25, 1.5, 1.5)], regions=[(0.5, 0.5, 0.5, 7)])
    assert solids.filled(mesh.points, mesh.simplices) == 63
    assert {*mesh.region.tolist()} == {7, -1}
    assert solids.filled(points, mesh.simplices[mesh.region == 7]) == 64 - 1 - 2
    with pytest.raises(delone.InputError, match="left empty"):
        tetrahedralize(points, faces, holes=[(1.5, 1.5, 1.5)], regions=[(1.5, 1.25, 1.5)])
    numbered = tetrahedralize(points, faces, regions=[(0.5, 0.5, 0.5), (1.5, 1.5, 1.25)])
    assert {*numbered.region.tolist()} == {0, 1, -1}


def test_pairs_beyond_the_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    """Faces that overlap count, however many pairs there are."""
    void = solids.box((0, 0, 0), (1, 1, 1))
    points, faces = solids.joined(CUBE, (void[0], void[1][:, ::-1]))
    monkeypatch.setattr("delone.solids.tetrahedra.filling._LISTED", 1)
    mesh = tetrahedralize(points, faces)
    assert solids.filled(mesh.points, mesh.simplices) == 63


def test_markers_follow_their_faces() -> None:
    points, faces = solids.joined(CUBE, solids.box((1, 1, 4), (2, 2, 6)))
    mesh = tetrahedralize(points, faces, face_markers=np.arange(24) * 10)
    assert np.array_equal(mesh.face_markers, mesh.face_source * 10)
    assert len(np.unique(mesh.face_source)) == 22


def test_extra_points_are_vertices() -> None:
    extra = [(1.0, 1, 1), (2, 2, 2), (3, 1, 2)]
    mesh = tetrahedralize(*CUBE, extra_points=extra)
    assert np.array_equal(mesh.points[8:], extra)
    assert np.isin([8, 9, 10], mesh.simplices).all()
    assert mesh.nadded == 0
    assert bool(mesh.validate())
    assert solids.filled(mesh.points, mesh.simplices) == 64


@pytest.mark.parametrize("kind", ["outside", "far", "corner", "edge", "face", "repeated"])
def test_extra_points_that_are_wrong_among_many(kind: str) -> None:
    """The core gets them together with the faces, unless they are far; the message is the same."""
    inside = np.random.default_rng(4).uniform(0.1, 2.5, (40, 3))
    wrong = {
        "outside": (4, 4, 4),
        "far": (1e300, -1e300, 1),
        "corner": (0, 0, 0),
        "edge": (0, 2.5, 0),
        "face": (0.5, 0, 4),
        "repeated": inside[7],
    }
    points = [(0, 0, 0), (8, 0, 0), (0, 8, 0), (0, 0, 8)]
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    extra = np.insert(inside, 20, wrong[kind], axis=0)
    message = {"repeated": "rows repeat others: 20", "outside": "1 point outside all"}
    message["far"] = message["outside"]
    with pytest.raises(delone.InputError, match=message.get(kind, "1 point on a face .* row 20;")):
        tetrahedralize(points, faces, extra_points=extra)


def test_faces_are_recovered_once(monkeypatch: pytest.MonkeyPatch) -> None:
    calls = []
    recover = filling._core.recover_faces
    spy = SimpleNamespace(recover_faces=lambda *given: calls.append(given) or recover(*given))
    monkeypatch.setattr(filling, "_core", spy)
    tetrahedralize(*CUBE, extra_points=[(1, 1, 1)])
    assert len(calls) == 1


def test_unused_rows_are_no_vertices() -> None:
    points = np.concatenate((CUBE[0], [(1, 1, 1), (9, 9, 9)]))
    mesh = tetrahedralize(points, CUBE[1])
    assert np.array_equal(mesh.points, points)
    assert mesh.simplices.max() == 7


def test_progress() -> None:
    told: list[tuple[str, float]] = []
    tetrahedralize(*CUBE, progress=lambda stage, done: told.append((stage, done)))
    assert [stage for stage, _ in told] == ["check", "recover", "select", "done"]
    fractions = [done for _, done in told]
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1


def equal(one: TetMesh, other: TetMesh) -> None:
    for name in ("points", "simplices", "neighbors", "region"):
        assert np.array_equal(getattr(one, name), getattr(other, name))
    for name in ("input_faces", "face_source", "face_markers", "nadded"):
        assert np.array_equal(getattr(one, name), getattr(other, name))
    assert type(one.report) is type(other.report)
    assert str(one.report) == str(other.report)


@pytest.mark.parametrize("improved", [False, True])
def test_files_and_pickles(tmp_path: Path, *, improved: bool) -> None:
    points, faces = solids.joined(CUBE, solids.box((1, 1, 4), (2, 2, 6)))
    mesh = tetrahedralize(points, faces, face_markers=np.arange(24))
    if improved:
        mesh = delone.improve(mesh)
    mesh.save(tmp_path / "mesh.npz")
    equal(TetMesh.load(tmp_path / "mesh.npz"), mesh)
    equal(pickle.loads(pickle.dumps(mesh)), mesh)
    assert not mesh.input_faces.flags.writeable


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("input_faces", lambda rows: np.where(rows == 0, 99, rows)),
        ("input_faces", lambda rows: np.roll(rows, 1, axis=0)[:, ::-1] * 0 + [0, 1, 7]),
        ("face_source", lambda rows: rows[1:]),
        ("face_markers", lambda rows: rows[1:]),
        ("added", lambda rows: rows + 100),
        ("added", lambda rows: rows - 1),
        ("recovery", lambda rows: rows[:-1]),
        ("recovery", lambda rows: rows + 1),
        ("duplicate_points", lambda rows: rows - 9),
        ("repeated", lambda rows: rows[::-1]),
    ],
)
def test_files_that_contradict_themselves(tmp_path: Path, name: str, change: Any) -> None:
    points, faces = solids.joined(CUBE, solids.box((1, 1, 4), (2, 2, 6)))
    points = np.concatenate((points, points[:1]))
    faces[0][faces[0] == 0] = len(points) - 1
    tetrahedralize(points, faces).save(tmp_path / "mesh.npz")
    with np.load(tmp_path / "mesh.npz") as file:
        arrays = dict(file)
    arrays[name] = change(arrays[name]).astype(arrays[name].dtype)
    np.savez(tmp_path / "other.npz", **arrays)
    with pytest.raises(delone.FileFormatError):
        TetMesh.load(tmp_path / "other.npz")


def test_improve_keeps_all_faces() -> None:
    """A sheet inside one region, too, on both sides of which improve may change everything."""
    points, faces = CUBE
    wall = [(1, 1, 2), (3, 1, 2), (3, 3, 2.5), (1, 3, 2.5)]
    points = np.concatenate((points, wall))
    faces = np.concatenate((faces, [(8, 9, 10), (8, 10, 11)]))
    extra = np.random.default_rng(5).uniform(0.2, 3.8, (90, 3))
    extra = extra[np.abs(extra[:, 2] - 2.25) > 0.8]
    mesh = tetrahedralize(points, faces, extra_points=extra)
    better = delone.improve(mesh, min_angle=30)
    assert better.report.moves > 0
    assert np.array_equal(better.input_faces, mesh.input_faces)
    assert np.array_equal(better.region, np.zeros(better.nsimplex))
    assert bool(better.validate()), str(better.validate())
    assert solids.filled(better.points, better.simplices) == 64
    assert not len(delone.improve(mesh, boundary="surface").input_faces)


def test_validation_finds_faults() -> None:
    mesh = tetrahedralize(*solids.torus())
    arrays = mesh._arrays()
    fewer = TetMesh._of(arrays | {"input_faces": mesh.input_faces[1:]}, mesh.report)
    assert len(fewer.validate().walls) == 1
    lost = mesh.input_faces.copy()
    lost[3] = (0, 1, 21)
    report = TetMesh._of(arrays | {"input_faces": lost}, mesh.report).validate()
    assert report.lost.tolist() == [3]
    assert "input face is not a face" in str(report)
    moved = mesh.points.copy()
    moved[0] *= -2.0
    bad = TetMesh._of(arrays | {"points": moved}, mesh.report).validate()
    assert len(bad.orientation)
    assert len(bad.touching)


def test_six_volumes_of_many(monkeypatch: pytest.MonkeyPatch) -> None:
    """Beyond the first block, too."""
    from delone.solids.tetmesh import validation

    mesh = tetrahedralize(*solids.torus())
    whole = validation.six_volumes(mesh.points, mesh.simplices)
    assert whole == validation.six_volumes(mesh.points, mesh.boundary) > 0
    monkeypatch.setattr("delone._base.blocks.ROWS", 7)
    assert validation.six_volumes(mesh.points, mesh.simplices) == whole


def test_six_volumes_of_extreme_coordinates() -> None:
    from delone.solids.tetmesh.validation import six_volumes

    points, faces = solids.box((5e-324, -1e300, 1e-300), (1e-10, 1e300, 3e-300))
    mesh = tetrahedralize(points, faces)
    assert six_volumes(mesh.points, mesh.simplices) == six_volumes(mesh.points, mesh.boundary) > 0
    assert solids.filled(mesh.points, mesh.simplices) == solids.volume(points, faces)
