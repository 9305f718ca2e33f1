"""The layouts of files: for each class the arrays, and the check of their content."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from delone._tiling.archive import checks, directions
from delone._tiling.higher.dimension import HIGHER

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

__all__ = ["KINDS", "Kind"]


class Kind(NamedTuple):
    """A layout of arrays."""

    format: str
    # Names of the arrays, their dtypes and numbers of columns; 0 for arrays of one axis.
    layout: Mapping[str, tuple[str, int]]
    check: Callable[..., None]
    # Names of texts, which may be missing.
    texts: tuple[str, ...] = ("crs",)

    def fits(self, arrays: Mapping[str, NDArray[Any]]) -> bool:
        """Return whether all arrays are present and the points have the columns of this layout."""
        if not self.layout.keys() <= arrays.keys():
            return False
        name, (_, columns) = next(iter(self.layout.items()))
        shape = arrays[name].shape
        return columns == (int(shape[1]) if len(shape) > 1 else 0)


def _simplices(ndim: int) -> dict[str, tuple[str, int]]:
    return {
        "points": ("<f8", ndim),
        "simplices": ("<i4", ndim + 1),
        "neighbors": ("<i4", ndim + 1),
    }


def _delaunay(ndim: int) -> dict[str, tuple[str, int]]:
    return _simplices(ndim) | {"duplicates": ("<i4", 2)}


# Common areas of cells.
_AREAS = {
    "indptr": ("<i8", 0),
    "indices": ("<i4", 0),
    "areas": ("<f8", 0),
    "source_areas": ("<f8", 0),
    "target_areas": ("<f8", 0),
    "source_sums": ("<f8", 0),
    "target_sums": ("<f8", 0),
}
# Segments and their sources.
_ARCS = {
    "constrained": ("|b1", 3),
    "segments": ("<i4", 2),
    "source_start": ("<i8", 0),
    "source": ("<i4", 0),
    "forward": ("|b1", 0),
    "zero": ("<i4", 0),
    "through": ("<i4", 2),
    "crossings": ("<i4", 3),
    "input": ("<i4", 2),
    "geometries": ("<i4", 0),
    "rings": ("|b1", 0),
}
_CONSTRAINED = Kind(
    "delone.ConstrainedDelaunay",
    _delaunay(2)
    | _ARCS
    | {
        "added": ("<f8", 2),
        "parts": ("<i4", 0),
        "holes": ("<f8", 2),
        "regions": ("<f8", 2),
        "labels": ("<i4", 0),
        "options": ("<i8", 0),
    },
    checks.check_constrained,
    ("crs",),
)
_MESH = Kind(
    "delone.Mesh",
    _delaunay(2)
    | {
        "region": ("<i4", 0),
        "sides": ("<i4", 3),
        "on": ("<i4", 0),
        "point_source": ("<i4", 0),
        "point_markers": ("<i4", 0),
        "ends": ("<i4", 2),
        "start": ("<i8", 0),
        "source": ("<i4", 0),
        "forward": ("|b1", 0),
        "frozen": ("|b1", 0),
        "line_markers": ("<i4", 0),
        "line_geometries": ("<i4", 0),
        "bound": ("<f8", 0),
        "counts": ("<i8", 0),
    },
    checks.check_mesh,
)
_TET_MESH = Kind(
    "delone.TetMesh",
    _simplices(3)
    | {
        "region": ("<i4", 0),
        "input_faces": ("<i4", 3),
        "face_source": ("<i4", 0),
        "face_markers": ("<i4", 0),
        "holes": ("<f8", 3),
        "added": ("<i8", 0),
        # The reports of the recovery of faces, the improvement and the refinement, or nothing.
        "recovery": ("<i8", 0),
        "duplicate_points": ("<i8", 2),
        "subdivided": ("<i8", 0),
        "repeated": ("<i8", 0),
        "degenerate": ("<i8", 0),
        "dangling": ("<i8", 0),
        "outside": ("<i8", 0),
        "recut": ("<i8", 3),
        "recut_source": ("<i8", 2),
        "imprinted": ("<i8", 0),
        "imprint_distance": ("<f8", 0),
        "angles": ("<f8", 0),
        "surface_distance": ("<f8", 0),
        "counts": ("<i8", 0),
        "bounds": ("<f8", 0),
        "before": ("<i8", 0),
        "after": ("<i8", 0),
        "weights": ("<f8", 0),
        "below": ("<i8", 0),
        "cause": ("<i8", 0),
        "wall_edges": ("<i8", 2),
        "refinement": ("<i8", 0),
        "refinement_bounds": ("<f8", 0),
        "too_large": ("<i8", 0),
        "above_ratio": ("<i8", 0),
    },
    checks.check_tetrahedra,
)

_DIRECTIONS = {
    "vectors": ("<f8", 3),
    "simplices": ("<i4", 3),
    "neighbors": ("<i4", 3),
    "duplicates": ("<i4", 2),
}
_TIN = Kind(
    "delone.terrain.TIN",
    {
        "points": ("<f8", 2),
        "z": ("<f8", 0),
        "all_simplices": ("<i4", 3),
        "all_neighbors": ("<i4", 3),
        "kept": ("|b1", 0),
        "breaklines": ("<i4", 2),
        "soft": ("|b1", 0),
    },
    checks.check_surface,
    ("crs", "units", "adjustments"),
)


def _input(
    name: str,
    ndim: int,
    check: Callable[..., None] = checks.check_input,
    **further: tuple[str, int],
) -> Kind:
    """Return the layout of a class that is recomputed from its input."""
    return Kind(f"delone.{name} {ndim}-D", {"points": ("<f8", ndim)} | further, check)


def _graph(ndim: int) -> Kind:
    """Return the layout of a graph of points."""
    layout = {
        "points": ("<f8", ndim),
        "edges": ("<i4", 2),
        "duplicates": ("<i4", 2),
        "directed": ("|b1", 0),
    }
    return Kind(f"delone.graphs.Graph {ndim}-D", layout, checks.check_graph, ("kind", "crs"))


# Edges of columns and rows, mask and centers of a grid, which may be empty; its shape and a count.
_CELLS = {
    "columns": ("<f8", 0),
    "rows": ("<f8", 0),
    "mask": ("|b1", 0),
    "centers": ("<f8", 2),
    "shape": ("<i8", 0),
    "merged": ("<i8", 0),
}
_WEIGHTS, _PERIODS, _ALPHA = ("<f8", 0), ("<f8", 0), ("<f8", 0)
KINDS: Mapping[str, tuple[Kind, ...]] = {
    "Delaunay": (
        Kind("delone.Delaunay", _delaunay(2), checks.check_delaunay),
        Kind("delone.Delaunay of space", _delaunay(3), checks.check_delaunay),
        *(
            Kind(f"delone.Delaunay {ndim}-D", _delaunay(ndim), checks.check_delaunay)
            for ndim in HIGHER
        ),
        # In a flat of fewer dimensions, it is recomputed from the points.
        *(_input("Delaunay of a flat in", ndim) for ndim in HIGHER),
    ),
    "ConstrainedDelaunay": (_CONSTRAINED,),
    "Mesh": (_MESH,),
    "TetMesh": (_TET_MESH,),
    "RegularTriangulation": tuple(
        _input("RegularTriangulation", ndim, weights=_WEIGHTS) for ndim in (2, 3, *HIGHER)
    ),
    "PeriodicDelaunay": (_input("PeriodicDelaunay", 2, weights=_WEIGHTS, periods=_PERIODS),),
    "Voronoi": (
        # The clip is a box or an outline, as WKB; what does not exist is empty.
        _input(
            "Voronoi",
            2,
            checks.check_diagram,
            weights=_WEIGHTS,
            periods=_PERIODS,
            box=("<f8", 0),
            outline=("|u1", 0),
        ),
        # The clip is a box or a convex polyhedron.
        _input(
            "Voronoi",
            3,
            checks.check_diagram,
            weights=_WEIGHTS,
            periods=_PERIODS,
            box=("<f8", 0),
            corners=("<f8", 3),
            faces=("<i4", 0),
            starts=("<i4", 0),
            planes=("<f8", 4),
        ),
        # In more dimensions there is no clip.
        *(_input("Voronoi", ndim) for ndim in HIGHER),
    ),
    "Graph": (_graph(2), _graph(3)),
    "Dynamic": tuple(
        Kind(
            f"delone.Dynamic {ndim}-D",
            {
                "points": ("<f8", ndim),
                "handles": ("<i8", 0),
                # The next handle, whether crossings are split, the next handle of a segment.
                "numbers": ("<i8", 0),
                "segments": ("<i8", 0),
                "ends": ("<i8", 2),
                "added": ("<i8", 0),
            },
            checks.check_live,
        )
        for ndim in (2, 3)
    ),
    "AlphaComplex": (
        _input("AlphaComplex", 2, weights=_WEIGHTS, periods=_PERIODS),
        *(_input("AlphaComplex", ndim, weights=_WEIGHTS) for ndim in (3, *HIGHER)),
    ),
    "AlphaShape": (
        _input(
            "AlphaShape", 2, checks.check_shape, weights=_WEIGHTS, periods=_PERIODS, alpha=_ALPHA
        ),
        _input("AlphaShape", 3, checks.check_shape, weights=_WEIGHTS, alpha=_ALPHA),
    ),
    "ConcaveHull": tuple(
        Kind(f"delone.ConcaveHull {d}-D", _simplices(d) | {"kept": ("|b1", 0)}, checks.check_kept)
        for d in (2, 3)
    ),
    "ConvexHull": tuple(_input("ConvexHull", ndim) for ndim in (2, 3, *HIGHER)),
    "TIN": (_TIN,),
    "Contours": (
        Kind(
            "delone.terrain.Contours",
            {
                "points": ("<f8", 2),
                "starts": ("<i8", 0),
                "level": ("<f8", 0),
                "index": ("|b1", 0),
                "levels": ("<f8", 0),
                # Triangles, short lines, small lines and points of lines that are omitted.
                "counts": ("<i8", 0),
            },
            checks.check_contours,
            ("crs", "units"),
        ),
    ),
    "Bands": (
        Kind(
            "delone.terrain.Bands",
            {
                "points": ("<f8", 2),
                "ring_starts": ("<i8", 0),
                "polygon_starts": ("<i8", 0),
                "low": ("<f8", 0),
                "high": ("<f8", 0),
                # Triangles, small polygons, points of borders and flat polygons left out.
                "counts": ("<i8", 0),
            },
            checks.check_bands,
            ("crs", "units"),
        ),
    ),
    "sphere.Delaunay": (
        Kind(
            "delone.sphere.Delaunay",
            _DIRECTIONS | {"options": ("<i8", 0)},
            directions.check_delaunay,
        ),
    ),
    "sphere.ConstrainedDelaunay": (
        Kind(
            "delone.sphere.ConstrainedDelaunay",
            _DIRECTIONS | _ARCS | {"outer": ("|b1", 0), "options": ("<i8", 0)},
            directions.check_constrained,
        ),
    ),
    "sphere.Voronoi": (
        Kind(
            "delone.sphere.Voronoi",
            {
                "vectors": ("<f8", 3),
                "radius": ("<f8", 0),
                "degrees": ("|b1", 0),
                # The clip; without one these are empty.
                "corners": ("<f8", 3),
                "sides": ("<i4", 2),
                "geometries": ("<i4", 0),
                "outer": ("|b1", 0),
                "winding": ("<i8", 0),
            },
            directions.check_sites,
        ),
    ),
    "sphere.Overlaps": (
        Kind(
            "delone.sphere.Overlaps",
            _AREAS | {"source_shape": ("<i8", 0), "target_shape": ("<i8", 0)},
            directions.check_overlaps,
        ),
    ),
    "Overlaps": (
        Kind(
            "delone.Overlaps",
            _AREAS
            | {
                "source_shape": ("<i8", 0),
                "target_shape": ("<i8", 0),
                "source_reversed": ("<i8", 0),
                "target_reversed": ("<i8", 0),
            },
            directions.check_overlaps,
        ),
    ),
    # Cells between meridians and parallels, and polygons.
    "sphere.Grid": tuple(
        Kind(f"delone.sphere.Grid{sides}", layout | _CELLS, directions.check_grid)
        for sides, layout in (
            (
                "",
                {
                    "places": ("<f8", 3),
                    "rings": ("<i8", 0),
                    "cells": ("<i8", 0),
                    "holes": ("|b1", 0),
                },
            ),
            (
                " of parallels",
                {
                    "places": ("<f8", 2),
                    "starts": ("<i8", 0),
                    "meridians": ("<f8", 2),
                    "numbers": ("<i4", 0),
                },
            ),
        )
    ),
}
