"""What `tetrahedralize` accepts: arrays, files, and surfaces from other libraries; all checked."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._base.arrays import as_limit, as_plain_array, as_points, as_workers, require_finite
from delone._base.values import as_labels
from delone.errors import DtypeError, FileFormatError, InputError
from delone.io import read_mesh
from delone.solids.surface.check import as_faces
from delone.solids.tetrahedra.seeds import as_hole_seeds, as_region_seeds

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices
    from delone.solids.surface import ImprintedSurface

__all__ = ["Given", "Task", "given", "task"]

_ACCEPTED = (
    "points and faces, a file, or a surface of triangles: a trimesh, PyVista, meshio or delone "
    "object"
)

# Files of TetGen, which does not require oriented faces.
_UNORIENTED = (".smesh", ".poly", ".face")
# Names of cell data that are markers of faces.
_MARKERS = ("marker", "gmsh:physical")
# VTK's number of the type of a triangle.
_VTK_TRIANGLE = 5
# Points that may be added by default: far more than any valid surface of a survey needed.
_LEAST_LIMIT = 1_000_000
_LIMIT_PER_FACE = 10


class Given(NamedTuple):
    """A surface with what belongs to it, not checked."""

    points: ArrayLike
    faces: ArrayLike
    markers: ArrayLike | None = None
    holes: ArrayLike | None = None
    regions: ArrayLike | None = None
    # What is inside if the caller does not say: faces of some formats have no orientation.
    rule: str = "winding"


def given(
    points: Any,
    faces: ArrayLike | None,
    markers: ArrayLike | None,
    holes: ArrayLike | None,
    regions: ArrayLike | None,
) -> Given:
    """Return the surface of the arguments; markers, holes and regions replace those of a file."""
    found = Given(points, faces) if faces is not None else _of(points)
    further: dict[str, Any] = {"markers": markers, "holes": holes, "regions": regions}
    return found._replace(**{name: value for name, value in further.items() if value is not None})


def _of(surface: Any) -> Given:
    if isinstance(surface, str | os.PathLike):
        return _of_file(surface)
    # trimesh.Trimesh, and objects with the same attributes
    if hasattr(surface, "vertices") and hasattr(surface, "faces"):
        return Given(np.asarray(surface.vertices), np.asarray(surface.faces))
    if hasattr(surface, "celltypes") and hasattr(surface, "cells_dict"):
        return _of_grid(surface)
    if hasattr(surface, "cells_dict"):
        return _of_meshio(surface)
    if hasattr(surface, "points") and hasattr(surface, "simplices"):
        return _of_simplices(surface)
    if hasattr(surface, "points") and hasattr(surface, "faces"):
        return _of_pyvista(surface)
    raise DtypeError(f"{_ACCEPTED} are needed, got {type(surface).__name__} without faces")


def _of_file(path: str | os.PathLike[str]) -> Given:
    found = read_mesh(path, polygons="split")
    if found.simplices.shape[1] != 3:
        raise FileFormatError(f"{os.fspath(path)} contains tetrahedra, not a surface of triangles")
    points = found.points
    if points.shape[1] == 2:
        z = np.zeros(len(points)) if found.z is None else found.z
        points = np.column_stack((points, z))
    rule = "enclosed" if Path(path).suffix.lower() in _UNORIENTED else "winding"
    return Given(points, found.simplices, found.markers, found.holes, found.regions, rule)


def _of_meshio(mesh: Any) -> Given:
    kinds = sorted({block.type for block in mesh.cells} - {"triangle", "vertex", "line"})
    if kinds:
        raise InputError(f"the mesh has {', '.join(kinds)} cells: a surface of triangles is needed")
    if "triangle" not in mesh.cells_dict:
        raise InputError("the mesh has no triangles")
    markers = None
    for name in _MARKERS:
        if name in mesh.cell_data:
            own = zip(mesh.cells, mesh.cell_data[name], strict=True)
            rows = [values for block, values in own if block.type == "triangle"]
            markers = _whole(np.concatenate(rows))
            break
    return Given(np.asarray(mesh.points), mesh.cells_dict["triangle"], markers)


def _of_grid(grid: Any) -> Given:
    """The triangles of a PyVista UnstructuredGrid, whose cell types are VTK's."""
    kinds = set(np.unique(np.asarray(grid.celltypes)).tolist())
    if kinds != {_VTK_TRIANGLE}:
        raise InputError(
            "the UnstructuredGrid contains cells that are not triangles: pass "
            "grid.extract_surface().triangulate(), its boundary"
        )
    faces = np.asarray(grid.cells_dict[_VTK_TRIANGLE])
    return Given(np.asarray(grid.points), faces, _values(grid))


def _of_simplices(surface: Any) -> Given:
    if np.shape(surface.simplices)[1:] != (3,) or np.shape(surface.points)[1:] != (3,):
        name = type(surface).__name__
        raise InputError(f"a surface of triangles in 3-D is needed, not this {name}")
    return Given(surface.points, surface.simplices)


def _of_pyvista(surface: Any) -> Given:
    flat: NDArray[Any] = np.asarray(surface.faces).reshape(-1)
    if len(flat) % 4 or (flat[::4] != 3).any():
        raise InputError(
            "the surface contains cells that are not triangles: call its method triangulate() first"
        )
    return Given(np.asarray(surface.points), flat.reshape(-1, 4)[:, 1:], _values(surface))


def _values(surface: Any) -> NDArray[Any] | None:
    """The markers of the triangles of a PyVista surface, which follow its vertices and lines."""
    for name in _MARKERS:
        if name in getattr(surface, "cell_data", ()):
            before = getattr(surface, "n_verts", 0) + getattr(surface, "n_lines", 0)
            return _whole(np.asarray(surface.cell_data[name])[before:])
    return None


def _whole(values: NDArray[Any]) -> NDArray[Any]:
    """Return whole numbers as integers, and others unchanged, to be rejected."""
    numbers = values.dtype.kind == "f" and (values == np.floor(values)).all()
    return values.astype(np.int64) if numbers else values


class Task(NamedTuple):
    """A surface to be filled, and options."""

    points: Floats
    faces: Indices
    markers: Indices
    holes: Floats
    regions: Floats
    labels: Indices
    extra: Floats
    limit: int
    workers: int | None

    def imprinted(self, cut: ImprintedSurface) -> Task:
        """Return the task with the surface cut at itself; parts inherit markers."""
        return self._replace(points=cut.points, faces=cut.faces, markers=self.markers[cut.source])


def task(
    surface: Given, extra_points: ArrayLike | None, max_points: int | None, workers: int | None
) -> Task:
    """Return checked arguments."""
    points, faces = as_faces(surface.points, surface.faces)
    require_finite(points)
    as_workers(workers)
    most = max(_LEAST_LIMIT, _LIMIT_PER_FACE * len(faces))
    regions, labels = as_region_seeds(surface.regions)
    return Task(
        points=points,
        faces=faces,
        markers=as_labels(surface.markers, len(faces), name="face_markers"),
        holes=as_hole_seeds(surface.holes),
        regions=regions,
        labels=labels,
        extra=_as_extra(extra_points),
        limit=as_limit(most if max_points is None else max_points, name="max_points"),
        workers=workers,
    )


def _as_extra(points: ArrayLike | None) -> Floats:
    array = np.empty((0, 3)) if points is None else as_plain_array(points, "extra_points")
    if array.size == 0 and array.ndim <= 2:
        return np.empty((0, 3))
    found = as_points(array, ndim=3, name="extra_points")
    require_finite(found, name="extra_points")
    return found
