"""A mesh as what other libraries take; each is imported when it is asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.extras import require

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.improve.tetmesh import TetMesh
    from delone.refine.meshed import Mesh

__all__ = [
    "tetrahedra_to_meshio",
    "tetrahedra_to_pyvista",
    "to_dolfinx_arrays",
    "to_matplotlib",
    "to_meshio",
    "to_pyvista",
    "to_skfem",
]

# The number of a tetrahedron among the cells of VTK.
_VTK_TETRA = 10


def to_meshio(mesh: Mesh) -> Any:
    """Return triangles and segments as a ``meshio.Mesh``; see ``Mesh.to_meshio``."""
    meshio = require("meshio", extra="mesh", what="to_meshio")
    markers = mesh.segment_markers
    cells = [("triangle", mesh.simplices), ("line", mesh.segments)]
    tags = [mesh.region.astype(np.int32), markers.astype(np.int32)]
    # Programs that read MSH know parts by these; 0 stands for none there.
    physical = [tags[0] - min(int(tags[0].min()), 0) + 1, markers.astype(np.int32)]
    return meshio.Mesh(
        np.column_stack((mesh.points, np.zeros(mesh.npoints))),
        cells,
        point_data={"marker": mesh.point_markers.copy()},
        cell_data={
            "region": [tags[0], np.full(len(markers), -1, dtype=np.int32)],
            "marker": [np.zeros(mesh.nsimplex, dtype=np.int32), tags[1]],
            "gmsh:physical": physical,
            "gmsh:geometrical": physical,
        },
    )


def to_skfem(mesh: Mesh) -> Any:
    """Return a ``skfem.MeshTri``; see ``Mesh.to_skfem``."""
    skfem = require("skfem", extra="fem", what="to_skfem")
    made = skfem.MeshTri(
        np.ascontiguousarray(mesh.points.T), np.ascontiguousarray(mesh.simplices.T.astype(np.int64))
    )
    named = {
        f"region {region}": np.flatnonzero(mesh.region == region)
        for region in np.unique(mesh.region).tolist()
    }
    found = made.with_subdomains(named)
    markers = mesh.segment_markers
    facets = _facets(found.facets, mesh.segments, mesh.npoints)
    boundaries = {
        f"marker {marker}": facets[markers == marker] for marker in np.unique(markers).tolist()
    }
    return found.with_boundaries(boundaries)


def _facets(facets: NDArray[Any], segments: NDArray[np.int32], npoints: int) -> NDArray[np.int64]:
    """Return the number of the facet that each subsegment is."""
    keys = np.min(facets, axis=0).astype(np.int64) * npoints + np.max(facets, axis=0)
    wanted = segments.min(axis=1).astype(np.int64) * npoints + segments.max(axis=1)
    order = np.argsort(keys)
    found: NDArray[np.int64] = order[np.searchsorted(keys, wanted, sorter=order)]
    return found


def to_dolfinx_arrays(mesh: Mesh) -> dict[str, NDArray[Any]]:
    """Return the arrays of which DOLFINx makes a mesh; see ``Mesh.to_dolfinx_arrays``."""
    return {
        "cells": mesh.simplices.astype(np.int64),
        "x": mesh.points.copy(),
        "cell_tags": mesh.region.astype(np.int32),
        "facets": mesh.segments.astype(np.int64),
        "facet_tags": mesh.segment_markers.astype(np.int32),
    }


def to_pyvista(mesh: Mesh) -> Any:
    """Return a ``pyvista.PolyData``; see ``Mesh.to_pyvista``."""
    pyvista = require("pyvista", extra="pyvista", what="to_pyvista")
    faces = np.column_stack((np.full(mesh.nsimplex, 3), mesh.simplices)).ravel()
    found = pyvista.PolyData(np.column_stack((mesh.points, np.zeros(mesh.npoints))), faces)
    found.cell_data["region"] = mesh.region
    found.point_data["marker"] = mesh.point_markers
    return found


def to_matplotlib(mesh: Mesh) -> Any:
    """Return a ``matplotlib.tri.Triangulation``; see ``Mesh.to_matplotlib``."""
    tri = require("matplotlib.tri", extra="plot", what="to_matplotlib")
    return tri.Triangulation(*mesh.points.T, triangles=mesh.simplices)


def tetrahedra_to_meshio(mesh: TetMesh) -> Any:
    """Return tetrahedra as a ``meshio.Mesh``; see ``TetMesh.to_meshio``."""
    meshio = require("meshio", extra="mesh", what="to_meshio")
    return meshio.Mesh(
        mesh.points,
        [("tetra", mesh.simplices)],
        cell_data={
            "region": [mesh.region],
            "smallest_dihedral": [mesh.quality().smallest_dihedral],
        },
    )


def tetrahedra_to_pyvista(mesh: TetMesh) -> Any:
    """Return a ``pyvista.UnstructuredGrid``; see ``TetMesh.to_pyvista``."""
    pyvista = require("pyvista", extra="pyvista", what="to_pyvista")
    cells = np.column_stack((np.full(mesh.nsimplex, 4), mesh.simplices)).ravel()
    kinds = np.full(mesh.nsimplex, _VTK_TETRA, dtype=np.uint8)
    found = pyvista.UnstructuredGrid(cells, kinds, mesh.points)
    found.cell_data["region"] = mesh.region
    found.cell_data["smallest_dihedral"] = mesh.quality().smallest_dihedral
    return found
