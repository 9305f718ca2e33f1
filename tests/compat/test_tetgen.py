"""The names of the package tetgen."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
import solids
from delone.compat import tetgen

if TYPE_CHECKING:
    from pathlib import Path

CUBE = solids.box((0, 0, 0), (4, 4, 4))
SHELLS = solids.joined(CUBE, solids.box((1, 1, 1), (2, 2, 2)), solids.box((2.5, 1, 1), (3, 3, 3)))


def test_result_and_attributes() -> None:
    v, f = solids.schoenhardt()
    tet = tetgen.TetGen(v, f, np.arange(8) + 5)
    with pytest.raises(delone.InputError, match="call tetrahedralize"):
        assert tet.node is None
    nodes, elems, attributes, markers = tet.tetrahedralize(quality=False, nobisect=True)
    assert nodes is tet.node
    assert elems is tet.elem
    assert np.array_equal(nodes[:6], v)
    assert (len(nodes), tet.n_nodes, tet.n_cells) == (7, 7, len(elems))
    assert attributes.shape == tet.attributes.shape == (0, 0)
    assert np.array_equal(np.sort(markers), np.arange(8) + 5)
    assert np.array_equal(markers, tet.triface_markers)
    assert np.array_equal(f[markers - 5], tet.trifaces)
    assert solids.filled(nodes, elems) == solids.volume(v, f)
    assert repr(tet) == "<TetGen of 6 vertices and 8 triangles>"


def test_both_sides_of_faces() -> None:
    tet = tetgen.TetGen(*SHELLS)
    tet.tetrahedralize(quality=False, facesout=True)
    assert len(tet.trifaces) == len(tet.mesh.faces)
    assert np.array_equal(tet.trifaces[:36], tet.mesh.input_faces)
    assert len({frozenset(face) for face in tet.trifaces.tolist()}) == len(tet.trifaces)
    for face, pair in zip(tet.trifaces.tolist(), tet.face2tet.tolist(), strict=True):
        of = [t for t, row in enumerate(tet.elem.tolist()) if set(face) <= set(row)]
        assert sorted(of) == sorted(t for t in pair if t >= 0)
    assert (tet.face2tet[:, 0] >= 0).all()


def test_edges() -> None:
    tet = tetgen.TetGen(*CUBE)
    tet.tetrahedralize(switches="pYQ")
    assert len(tet.edge_markers) == len(tet.edges) == len(tet.mesh.edges)
    assert tet.edge_markers.sum() == 18


def test_regions_and_holes() -> None:
    tet = tetgen.TetGen(*SHELLS)
    tet.add_region(30, (1.5, 1.5, 1.25))
    _, elems, attributes, _ = tet.tetrahedralize(quality=False, regionattrib=True)
    assert attributes.shape == (len(elems), 1)
    volumes = {
        label: float(solids.filled(tet.node, elems[attributes[:, 0] == label]))
        for label in np.unique(attributes).tolist()
    }
    assert volumes[30] == 1
    assert sorted(volumes) == [30, 31, 32]
    assert sorted(volumes.values()) == [1, 2, 61]
    tet.add_hole((1.5, 1.25, 1.5))
    with pytest.raises(delone.InputError, match="left empty"):
        tet.tetrahedralize(quality=False)
    other = tetgen.TetGen(*SHELLS)
    other.add_hole([1.5, 1.25, 1.5])
    _, elems, attributes, _ = other.tetrahedralize(switches="pA")
    assert solids.filled(other.node, elems) == 63
    assert {*attributes[:, 0].tolist()} == {1, 2}


def test_inverted_surfaces_are_filled() -> None:
    v, f = CUBE
    turned = np.where(np.arange(12)[:, None] % 2, f, f[:, ::-1])
    assert len(tetgen.TetGen(v, turned).tetrahedralize(quality=False)[1]) == 6


def test_sources(tmp_path: Path) -> None:
    hull = delone.ConvexHull(np.random.default_rng(3).normal(size=(20, 3)))
    delone.io.write_mesh(tmp_path / "a.smesh", hull)
    for tet in (tetgen.TetGen(hull), tetgen.TetGen(str(tmp_path / "a.smesh"))):
        assert np.array_equal(tet.f, hull.simplices)
        assert len(tet.tetrahedralize(quality=False)[0]) == 20


def test_grid() -> None:
    pytest.importorskip("pyvista")
    tet = tetgen.TetGen(*CUBE)
    tet.tetrahedralize(quality=False)
    assert (tet.grid.n_cells, tet.grid.n_points) == (6, 8)


def test_make_manifold(capsys: pytest.CaptureFixture[str]) -> None:
    tetgen.TetGen(*CUBE).make_manifold(verbose=True)
    assert "closed, oriented, manifold" in capsys.readouterr().out
    with pytest.raises(delone.OpenSurfaceError):
        tetgen.TetGen(CUBE[0], CUBE[1][1:]).make_manifold()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({}, "quality=False"),
        ({"quality": False, "order": 2}, "second order"),
        ({"quality": False, "plc": False}, "plc must be True"),
        ({"quality": False, "bgmesh": object()}, "bgmesh"),
        ({"quality": False, "insertaddpoints": True}, "insertaddpoints is not supported"),
        ({"switches": "pq1.2"}, "quality=False"),
        ({"switches": "pq1.1/10Y"}, "switch q"),
        ({"switches": "pYa0.1"}, "switch a"),
        ({"switches": "po2"}, "second order"),
        ({"switches": "Y"}, "must contain p"),
        ({"switches": "p-"}, "'-'"),
        ({"switches": "pU"}, "U is not known"),
    ],
)
def test_what_is_not_supported(options: dict[str, Any], words: str) -> None:
    with pytest.raises(delone.InputError, match=words):
        tetgen.TetGen(*CUBE).tetrahedralize(**options)


def test_what_changes_nothing() -> None:
    tet = tetgen.TetGen(*CUBE)
    elems = tet.tetrahedralize(quality=False)[1]
    for switches in ("p", "pYMQ", "pO2/7S100", "pzCVAfen", "po1"):
        assert np.array_equal(tet.tetrahedralize(switches=switches)[1], elems)
    options = {"verbose": 0, "nomergefacet": False, "steinerleft": -1, "nobisect": True}
    assert np.array_equal(tet.tetrahedralize(quality=False, **options)[1], elems)


def test_limit_on_points() -> None:
    tet = tetgen.TetGen(*solids.schoenhardt())
    for options in ({"switches": "pS0"}, {"quality": False, "steinerleft": 0}):
        with pytest.raises(delone.BudgetExceededError):
            tet.tetrahedralize(**options)


def test_bad_arguments() -> None:
    with pytest.raises(delone.DtypeError, match="give a surface"):
        tetgen.TetGen()
    with pytest.raises(delone.ShapeError):
        tetgen.TetGen(*CUBE).add_hole((1, 2))
    with pytest.raises(delone.InputError, match="max_vol"):
        tetgen.TetGen(*CUBE).add_region(1, (1, 1, 1), 0.5)
