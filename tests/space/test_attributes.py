"""What follows from tetrahedra: attributes, location, files; what there is in the plane only."""

from __future__ import annotations

import copy
import pickle
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import Delaunay, _core, datasets, predicates
from delone._tiling.space import topology
from delone.errors import FileFormatError, ShapeError
from delone.validation import validate
from rational import cross, dot

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

GENERATORS = sorted(datasets.GENERATORS3)


def mesh_of(name: str, n: int = 150) -> Delaunay:
    return Delaunay(datasets.GENERATORS3[name](n, seed=3))


@pytest.mark.parametrize("name", GENERATORS)
def test_topology_by_definition(name: str) -> None:
    mesh = mesh_of(name)
    tetrahedra = mesh.simplices.tolist()
    edges = {tuple(sorted((t[i], t[j]))) for t in tetrahedra for i in range(4) for j in range(i)}
    assert [tuple(e) for e in mesh.edges.tolist()] == sorted(edges)
    faces = {tuple(sorted(t[:k] + t[k + 1 :])) for t in tetrahedra for k in range(4)}
    assert [tuple(f) for f in mesh.faces.tolist()] == sorted(faces)
    distinct = len(np.unique(mesh.duplicate_of))
    assert distinct - len(edges) + len(faces) - mesh.nsimplex == 1
    indptr, indices = mesh.vertex_neighbor_vertices
    for v in range(0, mesh.npoints, 17):
        around = {a for e in edges if v in e for a in e if a != v}
        assert indices[indptr[v] : indptr[v + 1]].tolist() == sorted(around)
    assert (topology.neighbors(mesh.simplices) == mesh.neighbors).all()
    assert _core.fault(mesh.points, mesh.simplices, mesh.neighbors, 1) is None
    first = mesh.vertex_to_simplex
    assert (mesh.simplices[first] == mesh.duplicate_of[:, None]).any(axis=1).all()
    assert (mesh.coplanar[:, 2] == mesh.duplicate_of[mesh.coplanar[:, 0]]).all()


@pytest.mark.parametrize("name", GENERATORS)
def test_the_hull_looks_outward(name: str) -> None:
    mesh = mesh_of(name)
    a, b, c = (mesh.points[mesh.convex_hull[:, k]] for k in range(3))
    for point in mesh.points:
        assert (predicates.orient3d(a, b, c, point[None]) <= 0).all()
    assert (mesh.hull == np.unique(mesh.convex_hull)).all()


def rounded(number: Fraction) -> float:
    try:
        return float(number)
    except OverflowError:
        return np.inf


def fractions(corners: NDArray[np.float64]) -> tuple[list[list[Fraction]], list[Fraction]]:
    *three, last = ([Fraction(x) for x in corner] for corner in corners.tolist())
    return [[x - y for x, y in zip(p, last, strict=True)] for p in three], last


@pytest.mark.parametrize("name", GENERATORS)
def test_measures_by_fractions(name: str) -> None:
    mesh = mesh_of(name, 40)
    for t in range(0, mesh.nsimplex, 5):
        vectors, last = fractions(mesh.points[mesh.simplices[t]])
        # Seen from the last corner, the others go round clockwise.
        volume = dot(vectors[0], cross(vectors[2], vectors[1])) / 6
        assert volume > 0
        assert mesh.volumes[t] == pytest.approx(rounded(volume), rel=1e-13, abs=5e-324)
        if not np.isfinite(mesh.circumcenters[t]).all():
            continue
        at = [Fraction(x) for x in mesh.circumcenters[t].tolist()]
        centre = [x - y for x, y in zip(at, last, strict=True)]
        squares = [sum((c - x) ** 2 for c, x in zip(centre, p, strict=True)) for p in vectors]
        radius = sum(c * c for c in centre)
        # The centre errs by a share of the radius, and by the rounding of its coordinates.
        error = (radius / 10**26 + max(x * x for x in at) / 2**104 + Fraction(2) ** -2140) * 16
        assert all((s - radius) ** 2 <= 4 * error * max(radius, s) for s in squares)


def test_transforms_give_barycentric_coordinates() -> None:
    mesh = mesh_of("uniform")
    x = np.random.default_rng(0).random((50, 3)) / 2 + 0.25
    place = mesh.locate(x)
    assert (place.simplex >= 0).all()
    inverse, origin = mesh.transform[place.simplex, :3], mesh.transform[place.simplex, 3]
    weights = np.einsum("ijk,ik->ij", inverse, x - origin)
    assert np.allclose(weights, place.barycentric[:, :3], atol=1e-12)
    assert np.allclose(place.barycentric.sum(axis=1), 1)


@pytest.mark.parametrize("name", GENERATORS)
@pytest.mark.parametrize("workers", [1, 3])
@pytest.mark.deep("3-mixed_exponents")
@pytest.mark.sampled(4)
def test_find_simplex_by_definition(name: str, workers: int) -> None:
    points = datasets.GENERATORS3[name](60, seed=5)
    mesh = Delaunay(points, workers=workers)
    corners = points[mesh.simplices]
    with np.errstate(over="ignore"):
        queries = np.concatenate(
            (
                points,
                points[::-1] / 2 + points / 2,
                corners[:40].sum(axis=1) / 4,
                corners[:40, :3].mean(axis=1),
                1.5 * points[:9],
                [(np.nan, 0, 0), (np.inf, 0, 0)],
            )
        )
    for query, found in zip(queries, mesh.find_simplex(queries).tolist(), strict=True):
        holds = np.zeros(mesh.nsimplex, dtype=bool)
        if np.isfinite(query).all():
            signs = [
                predicates.orient3d(*(query[None] if j == k else corners[:, j] for j in range(4)))
                for k in range(4)
            ]
            holds = (np.array(signs) >= 0).all(axis=0)
        assert found == (int(holds.argmax()) if holds.any() else -1)
        assert mesh.find_simplex(query) == found


@pytest.mark.parametrize("name", GENERATORS)
def test_nearest_by_definition(name: str) -> None:
    points = datasets.GENERATORS3[name](40, seed=5)
    mesh = Delaunay(points)
    exact = [[Fraction(x) for x in p] for p in points.tolist()]
    with np.errstate(over="ignore"):
        beyond = points[:5] * 1.25
    beyond = beyond[np.isfinite(beyond).all(axis=1)]
    queries = np.concatenate((points[:10] / 2 + points[10:20] / 2, beyond, points[20:25]))
    for query, found in zip(queries, mesh.nearest(queries).tolist(), strict=True):
        q = [Fraction(x) for x in query.tolist()]
        squares = [sum((x - y) ** 2 for x, y in zip(p, q, strict=True)) for p in exact]
        assert found == squares.index(min(squares))
    assert mesh.nearest((np.nan, 0, 0)) == -1


def test_large_batches_agree_with_single_queries() -> None:
    mesh = Delaunay(datasets.GENERATORS3["uniform"](3000))
    queries = np.random.default_rng(9).uniform(-0.1, 1.1, (5000, 3))
    found = mesh.find_simplex(queries)
    assert (mesh.find_simplex(queries[::-1])[::-1] == found).all()
    assert [int(mesh.find_simplex(q)) for q in queries[:200]] == found[:200].tolist()
    assert mesh.find_simplex(queries.reshape(50, 100, 3)).shape == (50, 100)
    place = mesh.locate(queries)
    assert (place.simplex == found).all()
    inside = found >= 0
    rebuilt = np.einsum(
        "ij,ijk->ik", place.barycentric[inside], mesh.points[mesh.simplices[found[inside]]]
    )
    assert np.abs(rebuilt - queries[inside]).max() < 1e-14
    assert (place.barycentric[inside] >= 0).all()
    assert np.isnan(place.barycentric[~inside]).all()


@pytest.mark.parametrize("name", GENERATORS)
def test_files_and_copies(name: str, tmp_path: Path) -> None:
    mesh = mesh_of(name, 60)
    path = tmp_path / "mesh.npz"
    mesh.save(path)
    for other in (Delaunay.load(path), pickle.loads(pickle.dumps(mesh))):
        assert (other.points == mesh.points).all()
        assert (other.simplices == mesh.simplices).all()
        assert (other.neighbors == mesh.neighbors).all()
        assert (other.coplanar == mesh.coplanar).all()
        assert other.validate()
    assert copy.copy(mesh) is mesh


def test_files_that_contradict_themselves(tmp_path: Path) -> None:
    mesh = mesh_of("uniform", 30)
    path = tmp_path / "mesh.npz"
    mesh.save(path)
    with np.load(path) as archive:
        arrays = dict(archive)
    turned = arrays["simplices"][:, [1, 0, 2, 3]]
    swapped = arrays["neighbors"][::-1]
    missing = arrays["simplices"][1:]
    for change in (
        {"simplices": turned},
        {"neighbors": swapped},
        {"simplices": missing},
        {"simplices": arrays["simplices"] + 1},
        {"points": arrays["points"] * np.nan},
    ):
        np.savez(path, **(arrays | change))
        with pytest.raises(FileFormatError):
            Delaunay.load(path)


def test_what_is_there_in_one_dimension_only() -> None:
    solid, flat = mesh_of("uniform", 20), Delaunay(datasets.uniform(20))
    for name in ("areas", "walk"):
        assert hasattr(flat, name)
    with pytest.raises(AttributeError, match="volumes"):
        _ = solid.areas
    with pytest.raises(AttributeError, match="2-D"):
        solid.walk((0, 0), (1, 1))
    assert not hasattr(solid, "walk")
    for name in ("volumes",):
        assert not hasattr(flat, name)
    with pytest.raises(ShapeError):
        solid.find_simplex((0, 0))
    assert (solid.ndim, flat.ndim) == (3, 2)
    assert repr(Delaunay(np.eye(4, 3))) == "<Delaunay of 4 points: 1 tetrahedron>"


def test_arrays_cannot_be_written() -> None:
    mesh = mesh_of("uniform", 20)
    arrays: list[Any] = [mesh.points, mesh.simplices, mesh.neighbors, mesh.faces, mesh.volumes]
    for array in (*arrays, mesh.transform, mesh.edges, mesh.convex_hull):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    with pytest.raises(AttributeError):
        mesh.points = mesh.points  # type: ignore[misc]


def test_reports_name_culprits() -> None:
    mesh = mesh_of("grid", 27)
    assert validate(mesh.points, mesh.simplices)
    report = validate(mesh.points, mesh.simplices[:, [1, 0, 2, 3]])
    assert not report
    assert len(report.orientation) == mesh.nsimplex
    assert "tetrahedra are not positively oriented" in str(report)
