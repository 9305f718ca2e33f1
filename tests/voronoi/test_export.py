"""Cells as meshes of PyVista and meshio: their places, their measures, and what is left out."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import Voronoi

if TYPE_CHECKING:
    from pathlib import Path

pyvista = pytest.importorskip("pyvista")
meshio = pytest.importorskip("meshio")
shapely = pytest.importorskip("shapely")

FLAT = np.random.default_rng(1).random((40, 2))
SOLID = np.random.default_rng(2).random((40, 3))
RING = shapely.Point(0.5, 0.5).buffer(0.4) - shapely.box(0.4, 0.4, 0.6, 0.6)
# Two islands and a lake within one cell of the first two sites.
PARTS = shapely.box(0.01, 0, 0.1, 0.1) | (
    shapely.box(0.2, 0, 0.5, 1) - shapely.box(0.3, 0, 0.4, 0.5)
)
LAKE = PARTS - shapely.box(0.22, 0.7, 0.28, 0.8)

FLAT_ONES = {
    "whole": lambda: Voronoi(FLAT),
    "box": lambda: Voronoi(np.concatenate((FLAT, FLAT[:3])), clip="box"),
    "ring": lambda: Voronoi(FLAT, clip=RING),
    "parts and holes": lambda: Voronoi([(0, 0.5), (2, 0.5)], clip=LAKE),
    "two periods": lambda: Voronoi(FLAT, periods=(1, 1)),
    "unbounded": lambda: Voronoi([(0, 0), (1, 0)]),
    "nothing left": lambda: Voronoi(FLAT, clip=(5, 5, 6, 6)),
}


def surface_cells(surface: Any) -> list[Any]:
    """The polygons of a surface."""
    return [surface.points[face][:, :2] for face in surface.irregular_faces]


def by_site(polygons: Any, sites: Any, count: int) -> Any:
    """The area of all polygons of each site."""
    areas = shapely.area([shapely.Polygon(each) for each in polygons]) if len(polygons) else []
    return np.bincount(np.asarray(sites, dtype=int), areas, minlength=count)


@pytest.mark.parametrize("name", FLAT_ONES)
def test_polygons_cover_the_cells(name: str) -> None:
    diagram = FLAT_ONES[name]()
    found = diagram.to_pyvista()
    assert (found.points[:, 2] == 0).all()
    first = np.unique(diagram.duplicate_of)
    wanted = np.zeros(diagram.npoints)
    wanted[first] = np.where(np.isfinite(diagram.cell_areas), diagram.cell_areas, 0)[first]
    polygons = surface_cells(found)
    areas = by_site(polygons, found.cell_data["site"], diagram.npoints)
    # PyVista keeps coordinates in double precision.
    assert areas == pytest.approx(wanted, rel=1e-12, abs=1e-15)
    whole = diagram.cell_areas[found.cell_data["site"]]
    assert np.array_equal(found.cell_data["area"], whole)
    for polygon in polygons:
        assert shapely.Polygon(polygon).exterior.is_ccw
    mesh = diagram.to_meshio()
    blocks = [mesh.points[block.data][:, :, :2] for block in mesh.cells]
    flat = [each for block in blocks for each in block]
    sites = [site for block in mesh.cell_data["site"] for site in block] if blocks else []
    assert by_site(flat, sites, diagram.npoints) == pytest.approx(wanted, rel=1e-12, abs=1e-15)
    assert sorted(len(each) for each in flat) == sorted(len(each) for each in polygons)


def test_holes_become_triangles_and_nothing_else_does() -> None:
    found = FLAT_ONES["parts and holes"]().to_pyvista()
    sizes = sorted(len(face) for face in found.irregular_faces)
    assert sizes[-1] == 4  # the island is one polygon
    assert sizes.count(3) == len(sizes) - 1 > 4
    assert set(found.cell_data["site"].tolist()) == {0}


def volumes(grid: Any) -> list[float]:
    """The volumes of polyhedra by their faces; those of VTK are off by up to several times."""
    found = []
    for row in range(grid.n_cells):
        faces = [face.points for face in grid.get_cell(row).faces]
        middle = np.concatenate(faces).mean(axis=0)
        total = 0.0
        for face in faces:
            a, b, c = face[0] - middle, face[1:-1] - middle, face[2:] - middle
            total += float((np.cross(b, c) @ a).sum()) / 6
        found.append(total)
    return found


SOLID_ONES = {
    "whole": lambda: Voronoi(SOLID),
    "box": lambda: Voronoi(SOLID, clip="box"),
    "hull": lambda: Voronoi(SOLID, clip=SOLID),
    "weights": lambda: Voronoi(SOLID, weights=np.linspace(0, 0.3, 40), clip="box"),
}


@pytest.mark.parametrize("name", SOLID_ONES)
def test_polyhedra_have_the_volumes_of_cells(name: str, tmp_path: Path) -> None:
    diagram = SOLID_ONES[name]()
    finite = np.isfinite(diagram.cell_volumes) & (diagram.cell_volumes > 0)
    found = diagram.to_pyvista()
    sites = found.cell_data["site"]
    assert sites.tolist() == np.flatnonzero(finite).tolist()
    assert np.array_equal(found.cell_data["volume"], diagram.cell_volumes[sites])
    assert volumes(found) == pytest.approx(diagram.cell_volumes[sites], rel=1e-9)
    mesh = diagram.to_meshio()
    rows = np.concatenate(mesh.cell_data["site"])
    assert sorted(rows.tolist()) == sites.tolist()
    assert [block.type for block in mesh.cells] == sorted(
        {f"polyhedron{len(diagram.cell(site).vertices)}" for site in sites.tolist()},
        key=lambda text: int(text[10:]),
    )
    mesh.write(tmp_path / "a.vtu")
    again = pyvista.read(tmp_path / "a.vtu")
    assert volumes(again) == pytest.approx(diagram.cell_volumes[rows], rel=1e-9)


def test_polygons_are_written_by_meshio(tmp_path: Path) -> None:
    diagram = FLAT_ONES["ring"]()
    diagram.to_meshio().write(tmp_path / "a.vtu")
    again = pyvista.read(tmp_path / "a.vtu")
    polygons = [again.get_cell(row).points[:, :2] for row in range(again.n_cells)]
    found = by_site(polygons, again.cell_data["site"], 40)
    assert found == pytest.approx(diagram.cell_areas, rel=1e-12, abs=1e-15)


@pytest.mark.parametrize("periods", [(1, None), (None, 1.5), (1, 1)])
def test_periodic_diagrams_are_drawn(periods: Any) -> None:
    axes = pytest.importorskip("matplotlib.figure").Figure().add_subplot()
    Voronoi(FLAT, periods=periods).plot(axes, colorbar=False)
    assert len(axes.collections[0].get_paths()) == 40


def test_diagrams_in_3d_are_drawn() -> None:
    plotter = Voronoi(SOLID, clip="box").plot(off_screen=True)
    assert len(plotter.actors) >= 1
    plotter.close()
