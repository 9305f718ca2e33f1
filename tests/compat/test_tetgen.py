"""The names of the package tetgen."""

from __future__ import annotations

import inspect
import itertools
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
import solids
from delone.compat import tetgen
from delone.compat.tetgen_sizes import background

if TYPE_CHECKING:
    from pathlib import Path

CUBE = solids.box((0, 0, 0), (4, 4, 4))
SHELLS = solids.joined(CUBE, solids.box((1, 1, 1), (2, 2, 2)), solids.box((2.5, 1, 1), (3, 3, 3)))


LATER = (
    *("node", "elem", "n_nodes", "n_cells", "trifaces", "triface_markers", "face2tet"),
    *("edges", "edge_markers", "grid"),
)


def test_result_and_attributes() -> None:
    v, f = solids.schoenhardt()
    tet = tetgen.TetGen(v, f, np.arange(8) + 5)
    for name in LATER:
        with pytest.raises(tetgen.MeshNotTetrahedralizedError, match="call tetrahedralize"):
            getattr(tet, name)
    assert issubclass(tetgen.MeshNotTetrahedralizedError, RuntimeError)
    assert not tet.is_tetrahedralized
    assert tet.tetmesh is None
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
    assert tet.is_tetrahedralized
    assert repr(tet) == "<TetGen of 6 vertices and 8 triangles>"


def test_both_sides_of_faces() -> None:
    tet = tetgen.TetGen(*SHELLS)
    tet.tetrahedralize(quality=False, facesout=True)
    assert len(tet.trifaces) == len(tet.tetmesh.faces)
    assert np.array_equal(tet.trifaces[:36], tet.tetmesh.input_faces)
    assert len({frozenset(face) for face in tet.trifaces.tolist()}) == len(tet.trifaces)
    for face, pair in zip(tet.trifaces.tolist(), tet.face2tet.tolist(), strict=True):
        of = [t for t, row in enumerate(tet.elem.tolist()) if set(face) <= set(row)]
        assert sorted(of) == sorted(t for t in pair if t >= 0)
    assert (tet.face2tet[:, 0] >= 0).all()


def test_edges() -> None:
    tet = tetgen.TetGen(*CUBE)
    tet.tetrahedralize(switches="pYQ")
    assert tet.edges.shape == (18, 2)
    assert tet.edge_markers.tolist() == [-1] * 18
    of_faces = {
        frozenset(pair) for face in CUBE[1].tolist() for pair in itertools.combinations(face, 2)
    }
    assert {frozenset(pair) for pair in tet.edges.tolist()} == of_faces
    for options in ({"switches": "pYe"}, {"quality": False, "edgesout": True, "nobisect": True}):
        tet.tetrahedralize(**options)
        assert np.array_equal(tet.edges, tet.tetmesh.edges)
        inner = [frozenset(pair) not in of_faces for pair in tet.edges.tolist()]
        assert tet.edge_markers.tolist() == [0 if each else -1 for each in inner]


def test_markers_of_faces_that_have_none() -> None:
    v, f = SHELLS
    tet = tetgen.TetGen(v, f)
    assert (tet.tetrahedralize(switches="pY")[3] == -1).all()
    faces, markers = tet.tetrahedralize(switches="pYf")[3], tet.triface_markers
    assert np.array_equal(faces, markers)
    assert (markers[: len(f)] == -1).all()
    assert len(markers) > len(f)
    assert (markers[len(f) :] == 0).all()
    given = np.where(np.arange(len(f)) < 12, 0, np.arange(len(f)))
    tet = tetgen.TetGen(v, f, given)
    markers = tet.tetrahedralize(switches="pY")[3]
    assert np.array_equal(np.sort(markers), np.sort(given))


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


@pytest.mark.parametrize("order", [1, 2])
def test_grid_and_files(order: int, tmp_path: Path) -> None:
    pyvista = pytest.importorskip("pyvista")
    tet = tetgen.TetGen(*SHELLS)
    nodes, elems, _, _ = tet.tetrahedralize(quality=False, order=order)
    grid = tet.grid
    assert (grid.n_cells, grid.n_points) == (tet.n_cells, tet.n_nodes) == (len(elems), len(nodes))
    assert grid.compute_cell_sizes()["Volume"].sum() == pytest.approx(64)
    for name, binary in (("a.vtk", True), ("a.vtk", False), ("a.vtu", True)):
        tet.write(tmp_path / name, binary=binary)
        found = pyvista.read(tmp_path / name)
        assert np.array_equal(found.points, grid.points) or not binary
        assert np.array_equal(found.cells, grid.cells)
    with pytest.raises(delone.FileFormatError, match=r"write writes \.vtk and \.vtu"):
        tet.write(tmp_path / "a.stl")
    with pytest.raises(FileNotFoundError, match="folder"):
        tet.write(tmp_path / "missing" / "a.vtk")


# The middles of edges as TetGen has them, by corners.
TETGEN = ((2, 3), (0, 3), (0, 1), (1, 2), (1, 3), (0, 2))


@pytest.mark.parametrize("options", [{"quality": False, "order": 2}, {"switches": "po2"}])
def test_second_order(options: dict[str, Any]) -> None:
    tet = tetgen.TetGen(*SHELLS)
    nodes, elems, _, markers = tet.tetrahedralize(**options)
    plain = tet.tetmesh
    assert np.array_equal(nodes[: plain.npoints], plain.points)
    assert len(nodes) == plain.npoints + len(plain.edges) == tet.n_nodes
    assert np.array_equal(elems[:, :4], plain.simplices)
    for k, (a, b) in enumerate(TETGEN):
        assert np.array_equal(nodes[elems[:, 4 + k]], nodes[elems[:, [a, b]]].mean(axis=1))
    assert tet.trifaces.shape == (len(markers), 3)
    tet.tetrahedralize(switches="p")
    assert tet.elem.shape[1] == 4


def test_the_surface_that_was_given() -> None:
    pyvista = pytest.importorskip("pyvista")
    surface = pyvista.Sphere(theta_resolution=8, phi_resolution=8)
    for tet in (tetgen.TetGen(surface), tetgen.TetGen(surface.points, surface.regular_faces)):
        assert isinstance(tet.mesh, pyvista.PolyData)
        assert np.array_equal(tet.mesh.points, surface.points)
        assert np.array_equal(tet.mesh.faces, surface.faces)
        shown = tet.plot(off_screen=True, return_viewer=False, show_edges=True)
        assert shown is None


def test_make_manifold(capsys: pytest.CaptureFixture[str]) -> None:
    tetgen.TetGen(*CUBE).make_manifold(verbose=True)
    assert "closed, oriented, manifold" in capsys.readouterr().out
    with pytest.raises(delone.OpenSurfaceError):
        tetgen.TetGen(CUBE[0], CUBE[1][1:]).make_manifold()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"quality": False, "order": 3}, "order must be 1 or 2"),
        ({"quality": False, "plc": False}, "plc must be True"),
        ({"quality": False, "bgmesh": object()}, "bgmesh must be a pyvista"),
        ({"quality": False, "metric": True}, "metric=True needs sizes"),
        ({"quality": False, "fixedvolume": True}, "needs maxvolume"),
        ({"quality": False, "insertaddpoints": True}, "insertaddpoints is not supported"),
        ({"quality": False, "refine": True}, "refine is not supported"),
        ({"quality": False, "reversetetori": 1}, "positively oriented"),
        ({"quality": False, "qualtiy": True}, "no argument qualtiy"),
        ({"switches": "pm"}, "the switch m needs sizes"),
        ({"switches": "po3"}, "o1 or o2"),
        ({"switches": "Y"}, "must contain p"),
        ({"switches": "p-"}, "'-'"),
        ({"switches": "pH"}, "H is not known"),
    ],
)
def test_what_is_not_supported(options: dict[str, Any], words: str) -> None:
    with pytest.raises(delone.InputError, match=words):
        tetgen.TetGen(*CUBE).tetrahedralize(**options)


def test_what_changes_nothing() -> None:
    tet = tetgen.TetGen(*CUBE)
    elems = tet.tetrahedralize(quality=False)[1]
    for switches in ("p", "pYMQ", "pO2/7S100", "pzCVAfen", "po1", "pT1e-8X", "pY/2Wx100b"):
        assert np.array_equal(tet.tetrahedralize(switches=switches)[1], elems)
    options = {
        **{"verbose": 2, "quiet": False, "nomergefacet": True, "steinerleft": -1},
        **{"zeroindex": True, "neighout": True, "docheck": True, "brio_hilbert": False},
        **{"epsilon": 1e-6, "opt_scheme": 0, "optmaxdihedral": 165.0, "maxvolume": -1.0},
    }
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
        tetgen.TetGen(*CUBE).add_region(1, (1, 1, 1), -0.5)


@pytest.mark.parametrize(
    ("options", "most"),
    [
        ({"order": 1, "mindihedral": 20, "minratio": 1.5}, 64.0),
        ({"maxvolume": 0.5}, 0.5),
        ({"quality": False, "fixedvolume": True, "maxvolume": 0.5}, 0.5),
        ({"nobisect": True, "maxvolume": 12.0}, 12.0),
        ({"switches": "pq1.4/15a0.5"}, 0.5),
        ({"switches": "pa2"}, 2.0),
        ({"switches": "pqY"}, 64.0),
    ],
    ids=str,
)
def test_quality_and_volumes(options: dict[str, Any], most: float) -> None:
    tet = tetgen.TetGen(*CUBE)
    tet.tetrahedralize(**options)
    assert tet.tetmesh is not None
    assert tet.tetmesh.volumes.max() <= most * (1 + 1e-9)
    assert abs(tet.tetmesh.volumes.sum() - 64) < 1e-9
    if most < 12:
        assert tet.tetmesh.report.on_facets > 0
    else:
        assert len(tet.tetmesh.input_faces) == 12


@pytest.mark.parametrize("options", [{}, {"switches": "pA"}, {"switches": "pAa"}], ids=str)
def test_volumes_of_regions(options: dict[str, Any]) -> None:
    tet = tetgen.TetGen(*solids.joined(CUBE, solids.box((4, 0, 0), (8, 4, 4))))
    tet.add_region(1, (1, 1, 1))
    tet.add_region(2, (5, 1, 1), 0.5)
    tet.tetrahedralize(**options)
    assert tet.tetmesh is not None
    own = tet.tetmesh.region == 2
    bounded = options != {"switches": "pA"}
    assert (tet.tetmesh.volumes[own].max() <= 0.5 * (1 + 1e-9)) == bounded
    assert tet.tetmesh.volumes[~own].max() > 0.5


# Calls of the package without quality, on which both agree in all but the tetrahedra.
CALLS: list[dict[str, Any]] = [
    {"switches": "pYQ"},
    {"switches": "pYQfe"},
    {"switches": "pYQA"},
    {"switches": "pYMQe"},
    {"switches": "pYQo2"},
    {"quality": False, "nobisect": True},
    {"quality": False, "nobisect": True, "facesout": True, "edgesout": True},
    {"quality": False, "nobisect": True, "regionattrib": True},
    {"quality": False, "nobisect": True, "order": 2},
]


@pytest.mark.parametrize("options", CALLS, ids=str)
@pytest.mark.parametrize("marked", [False, True])
def test_the_package_returns_the_same_kinds_of_arrays(options: Any, marked: bool) -> None:
    package = pytest.importorskip("tetgen")
    v, f = SHELLS
    given = (v, f, np.arange(len(f), dtype=np.int32) + 5) if marked else (v, f)
    both = package.TetGen(*given), tetgen.TetGen(*given)
    assert both[0].is_tetrahedralized == both[1].is_tetrahedralized is False
    assert np.array_equal(both[0].mesh.faces, both[1].mesh.faces)
    for tet in both:
        with pytest.raises(RuntimeError):
            _ = tet.node
        tet.add_region(30, (1.5, 1.5, 1.25))
    returned = [tet.tetrahedralize(**options) for tet in both]
    names = ("node", "elem", "attributes", "trifaces", "triface_markers", "edges", "edge_markers")
    for theirs, ours in [
        *zip(*returned, strict=True),
        *((getattr(both[0], name), getattr(both[1], name)) for name in names),
    ]:
        assert theirs.dtype == ours.dtype
        assert theirs.ndim == ours.ndim
        assert theirs.shape[1:] == ours.shape[1:]
    theirs, ours = both
    assert theirs.is_tetrahedralized == ours.is_tetrahedralized is True
    assert np.array_equal(theirs.node[: len(v)], ours.node[: len(v)])
    for name in ("attributes", "triface_markers", "edge_markers"):
        assert set(np.unique(getattr(theirs, name))) == set(np.unique(getattr(ours, name)))
    faces = [
        {
            frozenset(face): marker
            for face, marker in zip(
                tet.trifaces.tolist(), tet.triface_markers.tolist(), strict=True
            )
            if marker
        }
        for tet in both
    ]
    assert faces[0] == faces[1]
    if ours.elem.shape[1] == 10:
        for tet in both:
            for k, (a, b) in enumerate(TETGEN):
                middle = tet.node[tet.elem[:, [a, b]]].mean(axis=1)
                assert np.array_equal(tet.node[tet.elem[:, 4 + k]], middle)
    assert set(theirs.grid.celltypes) == set(ours.grid.celltypes)
    for tet in both:
        assert tet.grid.compute_cell_sizes()["Volume"].sum() == pytest.approx(64)


def test_all_names_of_the_package() -> None:
    package = pytest.importorskip("tetgen")
    for name in dir(package.TetGen):
        assert name.startswith("_") or hasattr(tetgen.TetGen, name), name
    theirs = inspect.signature(package.TetGen.tetrahedralize).parameters
    ours = tetgen.TetGen(*CUBE)
    for name, each in theirs.items():
        if name != "self":
            # Its defaults change nothing.
            options = {"quality": False, name: each.default} | {"quality": False}
            assert len(ours.tetrahedralize(**options)[1]) == 6


def lattice(side: int) -> tuple[np.ndarray, np.ndarray]:
    """A lattice over the cube and a little more, in tetrahedra of both orientations."""
    steps = np.linspace(-0.5, 4.5, side)
    points = np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1).reshape(-1, 3)
    simplices = delone.Delaunay(points).simplices.copy()
    simplices[::2] = simplices[::2, [1, 0, 2, 3]]
    return points, simplices


def wanted(points: np.ndarray) -> np.ndarray:
    """Small near one corner; linear, so that every mesh interpolates it exactly."""
    return 0.3 + 0.1 * points.sum(axis=1)


@pytest.mark.parametrize("how", ["arrays", "grid", "files"])
def test_a_background_mesh_has_sizes(how: str, tmp_path: Path) -> None:
    points, simplices = lattice(5)
    lengths = wanted(points)
    options: dict[str, Any] = {"bgmesh": (points, simplices, lengths)}
    if how == "grid":
        pyvista = pytest.importorskip("pyvista")
        grid = pyvista.UnstructuredGrid({10: simplices}, points)
        grid.point_data["target_size"] = lengths
        options = {"bgmesh": grid}
    elif how == "files":
        node = [f"{len(points)} 3 0 0", *(f"{i} {x!r} {y!r} {z!r}" for i, (x, y, z) in
                                          enumerate(points.tolist()))]  # fmt: skip
        ele = [f"{len(simplices)} 4 0", *(f"{i} {a} {b} {c} {d}" for i, (a, b, c, d) in
                                          enumerate(simplices.tolist()))]  # fmt: skip
        mtr = [f"{len(points)} 1", *map(repr, lengths.tolist())]
        for ending, lines in (("node", node), ("ele", ele), ("mtr", mtr)):
            (tmp_path / f"sizes.b.{ending}").write_text("\n".join(lines) + "\n")
        options = {"bgmeshfilename": str(tmp_path / "sizes.b")}
    tet = tetgen.TetGen(*CUBE)
    tet.tetrahedralize(order=1, mindihedral=20, minratio=1.5, **options)
    mesh = tet.tetmesh
    assert mesh is not None and mesh.validate().ok
    # The same as with a function, up to the roundings of sizes.
    exact = delone.tetrahedralize(
        *CUBE, boundary="surface", inside="enclosed", size=wanted, radius_edge=1.5, min_angle=20
    )
    assert abs(mesh.nsimplex - exact.nsimplex) < 0.05 * exact.nsimplex
    assert mesh.report.largest_size_ratio <= 1
    centers = mesh.points[mesh.simplices].mean(axis=1)
    near, far = (centers.sum(axis=1) < 3), (centers.sum(axis=1) > 9)
    assert 3 * mesh.volumes[near].mean() < mesh.volumes[far].mean()
    # Switches: m asks for the sizes, and without it they are not used.
    by_switches = tet.tetrahedralize(switches="pq1.5/20m", **options)[1]
    assert np.array_equal(by_switches, mesh.simplices)
    assert len(tet.tetrahedralize(switches="p", **options)[1]) < 20


def test_all_tetrahedra_of_a_background_mesh_count() -> None:
    points, simplices = lattice(4)
    mesh, lengths = background((points, simplices, wanted(points)), "")
    assert mesh.nsimplex == len(simplices) and len(lengths) == len(points)
    flat = np.concatenate((simplices, [[0, 1, 2, 3]]))
    assert background((points, flat, wanted(points)), "")[0].nsimplex == len(simplices)


def test_what_is_no_background_mesh(tmp_path: Path) -> None:
    points, simplices = lattice(3)
    lengths = wanted(points)
    cases: list[tuple[Any, type[Exception], str]] = [
        ((points, simplices, -lengths), delone.InputError, "must be above 0"),
        ((points, simplices, lengths[1:]), delone.InputError, "values of shape"),
        ((points, simplices, lengths.astype(str)), delone.DtypeError, "real numbers as values"),
        ((points, simplices, lengths + 1j), delone.DtypeError, "real numbers as values"),
        ((points, simplices, [10**400] * len(points)), delone.DtypeError, "real numbers as values"),
        ((points, simplices, [[1], [2, 3]]), delone.ShapeError, "rows of unequal length"),
        (
            (points, simplices, np.ma.masked_less(lengths, 0.5)),
            delone.DtypeError,
            "size is a masked array",
        ),
        ((points, simplices), delone.InputError, "got 2 items"),
        ((points, simplices + 1, lengths), delone.InputError, "simplices"),
        ((points[:, :2], simplices, lengths), delone.ShapeError, "points"),
        ((points * [1, 1, 0], simplices, lengths), delone.InputError, "no tetrahedron with"),
        ((points, np.repeat(simplices, 3, axis=0), lengths), delone.InputError, "bgmesh: "),
    ]
    for given, error, words in cases:
        with pytest.raises(error, match=words):
            tetgen.TetGen(*CUBE).tetrahedralize(bgmesh=given)
    with pytest.raises(delone.InputError, match="not both"):
        tetgen.TetGen(*CUBE).tetrahedralize(bgmesh=cases[0][0], bgmeshfilename="a.b")
    with pytest.raises(FileNotFoundError):
        tetgen.TetGen(*CUBE).tetrahedralize(bgmeshfilename=str(tmp_path / "none.b"))
    for name in (3, b"sizes.b"):
        with pytest.raises(delone.DtypeError, match="bgmeshfilename must be a path"):
            tetgen.TetGen(*CUBE).tetrahedralize(bgmeshfilename=name)
    with pytest.raises(delone.InputError, match="must end with the name of files"):
        tetgen.TetGen(*CUBE).tetrahedralize(bgmeshfilename=".")
    for ending, text in (
        ("node", "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1"),
        ("ele", "1 4 0\n0 0 1 2 3"),
        # With numbers of points, which the format lacks.
        ("mtr", "4 1\n0 1.5\n1 1.5\n2 1.5\n3 1.5"),
    ):
        (tmp_path / f"numbered.{ending}").write_text(text)
    with pytest.raises(delone.FileFormatError, match="more than one number for each of its 4"):
        tetgen.TetGen(*CUBE).tetrahedralize(bgmeshfilename=tmp_path / "numbered")
    pyvista = pytest.importorskip("pyvista")
    grid = pyvista.UnstructuredGrid({10: simplices}, points)
    with pytest.raises(delone.InputError, match="target_size"):
        tetgen.TetGen(*CUBE).tetrahedralize(bgmesh=grid)
    voxels = pyvista.ImageData(dimensions=(2, 2, 2)).cast_to_unstructured_grid()
    with pytest.raises(delone.InputError, match="tetrahedra only"):
        tetgen.TetGen(*CUBE).tetrahedralize(bgmesh=voxels)
