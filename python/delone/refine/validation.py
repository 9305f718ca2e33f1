"""Validation of meshes: triangles that fit together and are Delaunay except across segments."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from delone import _core
from delone._tiling.plane.topology import boundary_edges, unjoined
from delone.validation import ValidationReport, not_across

if TYPE_CHECKING:
    from delone._base.types import Bools, Floats, Indices
    from delone.validation import Sentences

__all__ = ["MeshValidation", "validate"]


@dataclass(frozen=True, eq=False, kw_only=True)
class MeshValidation(ValidationReport):
    """The result of ``Mesh.validate()``: truthy if the mesh is correct.

    The fields are those of `ValidationReport`, but `hull` contains the boundary edges that are not
    part of a segment, `delaunay` and `ties` leave out pairs of triangles with a segment between
    them, and `count` is always empty.

    Examples
    --------
    >>> import delone
    >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
    >>> print(delone.mesh(square, max_area=0.1).validate())
    a constrained Delaunay mesh
    """

    _SUBJECT: ClassVar[str] = "a constrained Delaunay mesh"
    _SAID: ClassVar[Sentences] = {
        "hull": ("boundary edge is not on a segment", "boundary edges are not on a segment")
    }


def validate(
    points: Floats, simplices: Indices, neighbors: Indices, constrained: Bools
) -> MeshValidation:
    """Check the triangles of a mesh; `constrained` says which edges are part of a segment."""
    found = _core.validate(points, simplices, neighbors)
    used = np.zeros(len(points), dtype=bool)
    used[simplices] = True
    return MeshValidation(
        orientation=found.orientation,
        edges=found.edges,
        neighbors=np.union1d(found.neighbors, unjoined(simplices, neighbors)),
        hull=boundary_edges(simplices, np.where(constrained, 0, neighbors)),
        missing=np.flatnonzero(~used),
        delaunay=not_across(found.delaunay, neighbors, constrained),
        ties=not_across(found.ties, neighbors, constrained),
    )
