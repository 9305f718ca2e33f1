"""Pictures in space: what is drawn, and what is refused."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from delone import ConvexHull, Delaunay, InputError, Voronoi, datasets, lawson, scene

if TYPE_CHECKING:
    from pathlib import Path

pytest.importorskip("pyvista")


def solid() -> Delaunay:
    return Delaunay(datasets.uniform(40, ndim=3))


def test_the_grid_has_what_the_triangulation_has() -> None:
    mesh = solid()
    grid = scene.unstructured(mesh, values=mesh.volumes, name="volume")
    assert (grid.n_points, grid.n_cells) == (mesh.npoints, mesh.nsimplex)
    assert np.array_equal(grid.points, mesh.points)
    assert np.array_equal(grid.cells_dict[10], mesh.simplices)
    assert np.array_equal(grid.cell_data["volume"], mesh.volumes)
    sizes = grid.compute_cell_sizes(length=False, area=False)
    assert np.allclose(sizes.cell_data["Volume"], mesh.volumes)  # positive: VTK's orientation
    heights = scene.unstructured(mesh, values=mesh.points[:, 2])
    assert "values" in heights.point_data


@pytest.mark.parametrize("options", [{}, {"cut": "z"}, {"shrink": 0.5}, {"points": True}])
def test_something_is_drawn(options: dict[str, object]) -> None:
    mesh = solid()
    picture = scene.image(mesh, values=mesh.volumes, bar=False, **options)
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 20
    hull = scene.image(ConvexHull(mesh.points), **options)
    assert (hull != 255).any()


def test_files(tmp_path: Path) -> None:
    path = tmp_path / "a.png"
    scene.draw(path, solid(), cut="x")
    assert path.read_bytes().startswith(b"\x89PNG")


def test_what_is_refused() -> None:
    mesh, flat = solid(), Delaunay(datasets.uniform(20))
    for draw in (scene.unstructured, scene.plot):
        with pytest.raises(InputError, match="in space"):
            draw(flat)
    for options in ({"cut": "w"}, {"shrink": 0}, {"values": [1, 2, 3]}):
        with pytest.raises(InputError):
            scene.plot(mesh, off_screen=True, **options)


def test_what_has_no_simplices_in_space_is_refused() -> None:
    flat = Delaunay(datasets.uniform(20))
    for other in (lawson(flat.points, flat.simplices), None):
        for draw in (scene.unstructured, scene.plot, scene.image):
            with pytest.raises(InputError, match="no triangulation in space"):
                draw(other)
    for draw in (scene.unstructured, scene.plot, scene.image):
        with pytest.raises(InputError, match="use its own plot"):
            draw(Voronoi(solid().points))
    with pytest.raises(InputError, match="no triangulation in space: "):
        scene.unstructured(ConvexHull(solid().points))
