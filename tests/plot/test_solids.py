"""3-D plots: what is drawn, and what is refused."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone import ConvexHull, Delaunay, InputError, Voronoi, datasets, lawson
from delone.plot import draw, image, plot

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

pyvista = pytest.importorskip("pyvista")


@pytest.fixture(autouse=True)
def _close() -> Iterator[None]:
    yield
    pyvista.close_all()


def solid() -> Delaunay:
    return Delaunay(datasets.uniform(40, ndim=3))


def drawn(shape: Any, **options: Any) -> list[Any]:
    """The meshes that were added to a new plotter, in their order."""
    return list(plot(shape, off_screen=True, **options).meshes)


def test_the_grid_has_what_the_triangulation_has() -> None:
    mesh = solid()
    (grid,) = drawn(mesh, values=mesh.volumes)
    assert (grid.n_points, grid.n_cells) == (mesh.npoints, mesh.nsimplex)
    assert np.array_equal(grid.points, mesh.points)
    assert np.array_equal(grid.cells_dict[10], mesh.simplices)
    assert np.array_equal(grid.cell_data["values"], mesh.volumes)
    sizes = grid.compute_cell_sizes(length=False, area=False)
    assert np.allclose(sizes.cell_data["Volume"], mesh.volumes)  # positive: VTK's orientation
    (grid,) = drawn(mesh, values=mesh.points[:, 2])
    assert np.array_equal(grid.point_data["values"], mesh.points[:, 2])


def test_a_hull_is_a_surface() -> None:
    hull = ConvexHull(datasets.uniform(60, ndim=3))
    assert hull.nsimplex != hull.npoints
    (surface,) = drawn(hull, values=hull.facet_of)
    assert np.array_equal(surface.regular_faces, hull.simplices)
    assert np.array_equal(surface.cell_data["values"], hull.facet_of)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_cut_leaves_the_nearer_half(axis: int) -> None:
    mesh = solid()
    (grid,) = drawn(mesh, values=np.arange(mesh.nsimplex), cut="xyz"[axis])
    middle = (mesh.min_bound + mesh.max_bound)[axis] / 2
    center = mesh.points[mesh.simplices].mean(axis=1)[:, axis]
    wanted = np.flatnonzero(center <= middle)
    assert 0 < len(wanted) < mesh.nsimplex
    assert grid.cell_data["values"].tolist() == wanted.tolist()


def test_small_dihedral_angles_are_drawn_in_the_surface() -> None:
    mesh = delone.improve(Delaunay(datasets.uniform(60, ndim=3)))
    angles = mesh.quality().smallest_dihedral
    bound = float(np.median(angles))
    surface, bad = drawn(mesh, below=bound)
    assert surface.n_cells == len(mesh.boundary)
    assert bad.active_scalars.tolist() == angles[angles < bound].tolist()
    assert bad.active_scalars_name == "smallest dihedral angle in degrees"
    (alone,) = drawn(mesh, below=0)
    assert alone.n_cells == len(mesh.boundary)
    plain = solid()
    assert drawn(plain, below=180, cut="x")[1].n_cells == drawn(plain, cut="x")[0].n_cells
    with pytest.raises(InputError, match="below is for tetrahedra"):
        drawn(ConvexHull(mesh.points), below=10)


def test_cells_are_polyhedra() -> None:
    diagram = Voronoi(datasets.uniform(9, ndim=3), clip="box")
    (grid,) = drawn(diagram)
    assert grid.n_cells == 9
    assert (image(diagram) != 255).any()


@pytest.mark.parametrize("sites", [4, 5, 9])
def test_sites_are_drawn_if_no_cell_is_bounded(sites: int) -> None:
    points = datasets.space.sphere(sites)
    diagram = Voronoi(points)
    assert diagram.to_pyvista().n_cells == 0
    (cloud,) = drawn(diagram)
    assert np.array_equal(np.unique(cloud.points, axis=0), np.unique(points, axis=0))
    assert (image(diagram) != 255).any()


def test_options_of_pyvista_apply_to_cells() -> None:
    diagram = Voronoi(datasets.uniform(9, ndim=3), clip="box")
    (grid,) = drawn(diagram, scalars="volume", cmap=["red", "blue"], opacity=0.5)
    assert grid.active_scalars_name == "volume"
    assert len(drawn(diagram, vertex_style="points", show_vertices=True)) == 2


@pytest.mark.parametrize("shape", [Delaunay, ConvexHull, Voronoi, "TetMesh"])
@pytest.mark.parametrize("name", ["z", "foo", "kwargs"])
def test_unknown_options_are_refused(shape: Any, name: str) -> None:
    points = datasets.uniform(9, ndim=3)
    mesh = delone.improve(Delaunay(points)) if shape == "TetMesh" else shape(points)
    with pytest.raises(InputError, match=f"^{name} is not an option of plotting"):
        mesh.plot(off_screen=True, **{name: 1})
    with pytest.raises(InputError, match="cmap must be"):
        mesh.plot(off_screen=True, cmap="nope")
    with pytest.raises(InputError, match=r"ax must be a PyVista plotter.* got int"):
        mesh.plot(5)


def test_values_are_no_option_of_cells() -> None:
    with pytest.raises(InputError, match=r"values is not an option .* pyvista\.Plotter\.add_mesh"):
        drawn(Voronoi(datasets.uniform(9, ndim=3)), values=np.arange(9))


def test_plotters_and_axes_are_told_apart() -> None:
    figure = pytest.importorskip("matplotlib.figure").Figure()
    with pytest.raises(InputError, match=r"ax must be a PyVista plotter.* got Axes"):
        plot(solid(), figure.add_subplot())
    with pytest.raises(InputError, match=r"ax must be matplotlib axes.* got Plotter"):
        plot(Delaunay(datasets.uniform(9)), pyvista.Plotter(off_screen=True))


@pytest.mark.parametrize("options", [{}, {"cut": "z"}, {"shrink": 0.5}, {"points": True}])
@pytest.mark.sampled(1)
def test_something_is_drawn(options: dict[str, Any]) -> None:
    mesh = solid()
    picture = image(mesh, values=mesh.volumes, colorbar=False, **options)
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 20
    hull = image(ConvexHull(mesh.points), **options)
    assert (hull != 255).any()


def test_files(tmp_path: Path) -> None:
    path = tmp_path / "a.png"
    draw(path, solid(), cut="x")
    assert path.read_bytes().startswith(b"\x89PNG")
    for name in ("a.xyz", "a"):
        with pytest.raises(InputError, match=r"path must end with \.png, "):
            draw(tmp_path / name, solid())
    assert [each.name for each in tmp_path.iterdir()] == ["a.png"]


def test_a_given_plotter_is_drawn_on() -> None:
    own = pyvista.Plotter(off_screen=True)
    assert plot(solid(), own) is own
    assert plot(Voronoi(solid().points, clip="box"), own) is own
    assert solid().plot(own) is own
    assert len(own.meshes) == 3
    with pytest.raises(InputError, match="new plotter"):
        plot(solid(), own, off_screen=True)


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ({"cut": "w"}, "cut"),
        ({"shrink": 0}, "shrink"),
        ({"shrink": "half"}, "shrink must be a real number"),
        ({"values": ["a"] * 40}, "values must hold real numbers"),
        ({"values": [1, 2, 3]}, "values"),
        ({"values": np.ones((40, 2))}, "values"),
        ({"z": [1, 2]}, "z is not an option .* values, cut"),
    ],
)
def test_wrong_options_are_refused(options: dict[str, Any], named: str) -> None:
    with pytest.raises(InputError, match=named):
        plot(solid(), off_screen=True, **options)


@pytest.mark.parametrize("function", [image, lambda mesh: draw("a.png", mesh)])
def test_images_in_3d_are_not_of_2d_objects(function: Any) -> None:
    points = datasets.uniform(20)
    for flat in (Delaunay(points), Voronoi(points), ConvexHull(points)):
        with pytest.raises(InputError, match="is 2-D"):
            function(flat)
    for other in (lawson(points, Delaunay(points).simplices), None):
        with pytest.raises(InputError, match="cannot be drawn"):
            function(other)
