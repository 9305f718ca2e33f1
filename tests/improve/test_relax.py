"""Coarser and smoother tetrahedra, judged exactly: volumes, faces, angles, and what must stay."""

from __future__ import annotations

import itertools
import pickle
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import delone
from delone import DtypeError, InputError, ShapeError, TetMesh
from rational import exact, minus
from tetrahedra import determinant, sharpest, volume

CORNERS = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
METHODS = ["lloyd", "odt", "laplace"]


def boxes(size: float, **options: Any) -> TetMesh:
    """Two stacked boxes, regions 1 and 2, with a marker for each side."""
    low, high = CORNERS * [2, 2, 1], CORNERS * [2, 2, 1] + [0, 0, 1]
    points = np.unique(np.concatenate((low, high)), axis=0)
    row = {tuple(p): i for i, p in enumerate(points.tolist())}
    faces = np.concatenate(
        [
            np.array([[row[tuple(p)] for p in box[t].tolist()] for t in hull.simplices])
            for box in (low, high)
            for hull in [delone.ConvexHull(box)]
        ]
    )
    # The common side once.
    _, first = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
    faces = faces[np.sort(first)]
    return delone.tetrahedralize(
        points,
        faces,
        regions=[(1, 1, 0.5, 1), (1, 1, 1.5, 2)],
        face_markers=np.arange(len(faces)) + 1,
        boundary="surface",
        size=size,
        **options,
    )


MESH = boxes(0.5)


def angle(mesh: TetMesh) -> float:
    return float(mesh.quality().smallest_dihedral.min())


def on_faces(mesh: TetMesh) -> set[tuple[float, ...]]:
    return set(map(tuple, mesh.points[np.unique(mesh.input_faces)].tolist()))


def faces_of(mesh: TetMesh) -> list[tuple[Any, ...]]:
    """The input faces as coordinates, with source and marker."""
    corners = mesh.points[mesh.input_faces].tolist()
    return list(zip(map(str, corners), mesh.face_source, mesh.face_markers, strict=True))


def volumes(mesh: TetMesh) -> dict[int, Fraction]:
    return {
        region: volume(mesh.points, mesh.simplices[mesh.region == region])
        for region in np.unique(mesh.region).tolist()
    }


def test_a_coarser_mesh_fills_the_same_regions_with_the_same_faces() -> None:
    meshes = [MESH]
    while (coarser := meshes[-1].coarsen()) is not meshes[-1]:
        meshes.append(coarser)
    assert len(meshes) > 2
    given = MESH.npoints - MESH.nadded
    for before, after in itertools.pairwise(meshes):
        assert volumes(after) == volumes(MESH)
        assert faces_of(after) == faces_of(MESH)
        assert after.validate().ok
        removed = before.npoints - after.npoints
        assert removed == after.report.points_removed == before.nadded - after.nadded > 0
        assert np.array_equal(after.points[:given], MESH.points[:given])
        assert np.array_equal(np.unique(after.simplices), np.arange(after.npoints))
        assert set(map(tuple, after.points.tolist())) < set(map(tuple, before.points.tolist()))
        assert angle(after) >= min(angle(before), 20)
    # The report is of the last call, and the bound is the goal that the mesh was made for.
    assert meshes[-1].report.min_angle == 20


def test_no_two_neighbors_are_removed_in_one_call() -> None:
    left = set(map(tuple, MESH.coarsen().points.tolist()))
    lost = np.array([tuple(p) not in left for p in MESH.points.tolist()])
    assert lost.any()
    assert not lost[MESH.edges].all(axis=1).any()


def test_angles_below_the_bound_do_not_become_smaller() -> None:
    mesh = boxes(0.5, min_angle=0)
    assert angle(mesh) < 20
    coarser = mesh.coarsen(min_angle=30)
    assert coarser is not mesh
    assert sharpest(coarser.points, coarser.simplices) <= sharpest(mesh.points, mesh.simplices)
    # Whatever the bound is, more is removed with a lower one.
    assert mesh.coarsen(min_angle=5).npoints < coarser.npoints
    assert angle(mesh.coarsen(min_angle=5)) >= min(5, angle(mesh))


def test_points_are_removed_where_they_are_marked() -> None:
    center = MESH.points[MESH.simplices].mean(axis=1)
    marked = center[:, 2] > 1.2
    near = np.unique(MESH.simplices[marked])
    coarser = MESH.coarsen(marked)
    left = set(map(tuple, coarser.points.tolist()))
    lost = [i for i, p in enumerate(MESH.points.tolist()) if tuple(p) not in left]
    assert lost and set(lost) <= set(near.tolist())
    assert np.array_equal(MESH.coarsen(np.flatnonzero(marked)).points, coarser.points)
    assert MESH.coarsen([]) is MESH


def test_input_points_stay() -> None:
    random = np.random.default_rng(5)
    mesh = delone.improve(delone.Delaunay(random.random((300, 3))))
    assert mesh.coarsen(min_angle=0) is mesh
    inside = random.random((200, 3)) * 0.8 + 0.1
    hull = delone.ConvexHull(CORNERS)
    given = delone.tetrahedralize(hull.points, hull.simplices, extra_points=inside)
    coarser = given.coarsen(min_angle=0)
    assert np.array_equal(coarser.points[:208], given.points[:208])
    assert len(np.unique(coarser.simplices[coarser.simplices < 208])) == 208


@pytest.mark.parametrize("method", METHODS)
def test_smooth_meshes_have_the_same_regions_and_faces(method: str) -> None:
    better = MESH.smooth(3, method)
    assert volumes(better) == volumes(MESH)
    assert faces_of(better) == faces_of(MESH)
    assert better.validate().ok
    assert np.array_equal(better.region[np.lexsort(better.simplices.T)],
                          MESH.region[np.lexsort(MESH.simplices.T)])  # fmt: skip
    # The same tetrahedra: no edge is flipped.
    assert set(map(tuple, np.sort(better.simplices, axis=1).tolist())) == set(
        map(tuple, np.sort(MESH.simplices, axis=1).tolist())
    )
    assert better.report.moves > 0
    assert better.quality().radius_ratio.mean() > MESH.quality().radius_ratio.mean()
    assert angle(better) >= min(20, angle(MESH))
    moved = (better.points != MESH.points).any(axis=1)
    assert moved.any() and not moved[np.unique(MESH.input_faces)].any()


def one_inside(at: tuple[float, float, float]) -> TetMesh:
    """A cube around one point, which is not at the mean of its neighbors."""
    points = np.concatenate((CORNERS, [at]))
    return delone.improve(
        (points, delone.Delaunay(points).simplices), min_angle=0, flips=False, smooth=False
    )


def target(mesh: TetMesh, method: str) -> np.ndarray:
    """The target of the last point, in fractions."""
    p = exact(mesh.points)
    here = p[8]
    weight, total = Fraction(0), [Fraction(0)] * 3

    def add(w: Fraction, place: Any) -> None:
        nonlocal weight, total
        weight, total = weight + w, [t + w * x for t, x in zip(total, place, strict=True)]

    def center(corners: list[Any]) -> list[Fraction]:
        """The point at one distance of all corners, in their plane or space."""
        sides = [minus(c, corners[0]) for c in corners[1:]]
        if len(sides) == 2:
            (a, b, c), (d, e, f) = sides
            sides.append([b * f - c * e, c * d - a * f, a * e - b * d])
        right = [sum(x * x for x in s) / 2 for s in sides[: len(corners) - 1]]
        right += [Fraction(0)] * (3 - len(right))
        whole = determinant(*sides)
        columns = list(zip(*sides, strict=True))
        solved = [
            determinant(*zip(*[right if i == k else columns[i] for i in range(3)], strict=True))
            / whole
            for k in range(3)
        ]
        return [x + y for x, y in zip(corners[0], solved, strict=True)]

    neighbors = set()
    for v in mesh.simplices.tolist():
        if 8 not in v:
            continue
        others = [p[w] for w in v if w != 8]
        neighbors |= {w for w in v if w != 8}
        six = abs(determinant(*(minus(o, here) for o in others)))
        of_tetrahedron = center([here, *others])
        if method == "odt":
            add(six, of_tetrahedron)
        elif method == "lloyd":
            sign = 1 if determinant(*(minus(o, here) for o in others)) > 0 else -1
            for i in range(3):
                for j in ((i + 1) % 3, (i + 2) % 3):
                    middle = [(x + y) / 2 for x, y in zip(here, others[i], strict=True)]
                    face = center([here, others[i], others[j]])
                    even = 1 if j == (i + 1) % 3 else -1
                    part = (
                        sign
                        * even
                        * determinant(
                            minus(middle, here), minus(face, here), minus(of_tetrahedron, here)
                        )
                    )
                    corners = here, middle, face, of_tetrahedron
                    add(part, [sum(c[k] for c in corners) / 4 for k in range(3)])
    if method == "laplace":
        for w in neighbors:
            add(Fraction(1), p[w])
    return np.array([float(t / weight) for t in total])


@pytest.mark.parametrize("method", METHODS)
def test_a_point_moves_to_its_target(method: str) -> None:
    mesh = one_inside((0.4375, 0.53125, 0.5625))
    moved = mesh.smooth(1, method, min_angle=0)
    wanted = target(mesh, method)
    assert np.abs(wanted - mesh.points[8]).max() > 1e-3
    assert np.abs(moved.points[8] - wanted).max() < 1e-14
    assert np.array_equal(mesh.smooth(1, method, min_angle=0, fixed=[8]).points, mesh.points)
    assert np.array_equal(mesh.smooth(0, method).points, mesh.points)


def test_a_point_moves_all_or_part_of_the_way() -> None:
    cloud = delone.Delaunay(np.random.default_rng(8).random((200, 3)))
    mesh = delone.improve(cloud, max_iter=0)
    ends = np.concatenate((mesh.edges, mesh.edges[:, ::-1]))
    inside = np.setdiff1d(np.arange(200), mesh.boundary)
    shares = []
    for v in inside.tolist():
        target = mesh.points[ends[ends[:, 0] == v, 1]].mean(axis=0)
        others = np.arange(200) != v
        moved = mesh.smooth(1, "laplace", fixed=others, min_angle=70)
        assert np.array_equal(moved.points[others], mesh.points[others])
        step = np.linalg.norm(moved.points[v] - mesh.points[v])
        shares.append(step / np.linalg.norm(target - mesh.points[v]))
        # The angles around the point are all below the bound: none becomes smaller.
        near = (mesh.simplices == v).any(axis=1)
        before, after = (each.quality().smallest_dihedral for each in (mesh, moved))
        assert after[(moved.simplices == v).any(axis=1)].min() >= before[near].min()
    found = {round(float(np.log2(share)), 6) for share in shares if share}
    assert found <= {0, -1, -2, -3, -4} and len(found) > 2


@pytest.mark.parametrize("method", ["coarsen", *METHODS])
def test_the_result_is_independent_of_rows_and_powers_of_two(method: str) -> None:
    def changed(mesh: TetMesh) -> TetMesh:
        return mesh.coarsen() if method == "coarsen" else mesh.smooth(2, method)

    def positions(mesh: TetMesh, scale: float) -> set[Any]:
        corners = np.sort((mesh.points / scale)[mesh.simplices].view("c16,f8").reshape(-1, 4))
        return set(map(bytes, corners))

    expected = positions(changed(MESH), 1.0)
    order = np.random.default_rng(3).permutation(MESH.nsimplex)
    rows = np.random.default_rng(4).permutation(MESH.npoints)
    # Added points stay behind the given ones.
    given = rows < MESH.npoints - MESH.nadded
    rows = np.concatenate((rows[given], rows[~given]))
    back = np.argsort(rows).astype(np.int32)
    simplices = np.ascontiguousarray(back[MESH.simplices[order]][:, [1, 2, 0, 3]])
    for scale in (1.0, 2.0**-300, 2.0**300):
        arrays = MESH._arrays() | {
            "points": MESH.points[rows] * scale,
            "simplices": simplices,
            "neighbors": delone._core.facet_neighbors(simplices, MESH.npoints),
            "input_faces": back[MESH.input_faces],
            "region": MESH.region[order],
        }
        other = TetMesh._of(arrays, MESH.report, MESH.nadded)
        assert positions(changed(other), scale) == expected


def test_improvement_may_remove_points() -> None:
    mesh = boxes(0.3, min_angle=0, radius_edge=None)
    kept = delone.improve(mesh, min_angle=40, contract="none")
    assert kept.npoints == mesh.npoints and kept.report.points_removed == 0
    added = delone.improve(mesh, min_angle=40)
    assert added.report.points_removed == mesh.npoints - added.npoints > 0
    assert added.nadded == mesh.nadded - added.report.points_removed
    assert volumes(added) == volumes(mesh) and faces_of(added) == faces_of(mesh)
    assert added.validate().ok
    assert f"{added.report.points_removed} point" in str(added.report)
    random = np.random.default_rng(5)
    cloud = delone.Delaunay(random.random((300, 3)))
    every = delone.improve(cloud, contract="all")
    # Rows of input points stay.
    assert np.array_equal(every.points.shape, cloud.points.shape) and every.nadded == 0
    lost = cloud.npoints - len(np.unique(every.simplices))
    assert lost == every.report.points_removed > 0
    assert volume(every.points, every.simplices) == volume(cloud.points, cloud.simplices)


def test_fixed_points_behind_removed_ones_are_known_in_the_report() -> None:
    mesh = boxes(0.3, min_angle=0, radius_edge=None)
    fixed = np.arange(mesh.npoints) % 5 == 4
    better = delone.improve(mesh, min_angle=40, fixed=fixed)
    assert better.report.points_removed > 0
    held = on_faces(better) | set(map(tuple, mesh.points[fixed].tolist()))
    corners = better.points[better.simplices[better.report.below]].tolist()
    for cause, places in zip(better.report.cause, corners, strict=True):
        every = all(tuple(place) in held for place in places)
        assert every == (cause == "boundary") or cause in ("angle", "rounding", "face")


def test_saved_meshes_have_the_report(tmp_path: Path) -> None:
    coarser = MESH.coarsen()
    coarser.save(tmp_path / "a.npz")
    for other in (TetMesh.load(tmp_path / "a.npz"), pickle.loads(pickle.dumps(coarser))):
        assert other.report.points_removed == coarser.report.points_removed > 0
        assert np.array_equal(other.points, coarser.points) and other.nadded == coarser.nadded


def test_arguments_are_checked() -> None:
    with pytest.raises(InputError, match="method"):
        MESH.smooth(1, "mean")
    with pytest.raises(InputError, match="max_iter"):
        MESH.smooth(-1)
    with pytest.raises(ShapeError, match="fixed"):
        MESH.smooth(fixed=np.zeros(3, bool))
    with pytest.raises(DtypeError, match="fixed"):
        MESH.smooth(fixed=[0.5])
    with pytest.raises(InputError, match="min_angle"):
        MESH.coarsen(min_angle=80)
    with pytest.raises((InputError, ShapeError), match="tetrahedra"):
        MESH.coarsen([MESH.nsimplex])
    with pytest.raises(delone.ShapeError, match="marked has rows of unequal length"):
        MESH.coarsen([[1], [2, 3]])
    with pytest.raises(InputError, match="contract"):
        delone.improve(MESH, contract="some")
