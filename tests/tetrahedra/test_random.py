"""Random surfaces: hulls of boxes, each square cut by chance, for both kinds of boundary."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

import delone
import solids

lattice = st.tuples(*3 * [st.integers(0, 3)])
boxes = st.lists(st.tuples(lattice, lattice), min_size=1, max_size=4)


def cells_of(pairs: list[tuple[Any, Any]]) -> set[tuple[int, ...]]:
    """The cells of a lattice in the boxes between two corners."""
    cells = set()
    for one, other in pairs:
        low, high = np.minimum(one, other), np.maximum(one, other) + 1
        ranges = [range(a, b) for a, b in zip(low.tolist(), high.tolist(), strict=True)]
        cells |= {(i, j, k) for i in ranges[0] for j in ranges[1] for k in ranges[2]}
    return cells


def hull(cells: set[tuple[int, ...]], data: Any) -> tuple[Any, Any, int]:
    """The squares between cells and what is none, each with one of its diagonals by chance."""
    number: dict[tuple[int, ...], int] = {}
    faces = []
    for cell in sorted(cells):
        for axis in range(3):
            for side in (0, 1):
                beyond = list(cell)
                beyond[axis] += 2 * side - 1
                if tuple(beyond) in cells:
                    continue
                corners = []
                for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    corner = list(cell)
                    corner[axis] += side
                    corner[(axis + 1) % 3] += u
                    corner[(axis + 2) % 3] += v
                    corners.append(number.setdefault(tuple(corner), len(number)))
                a, b, c, d = corners if side else corners[::-1]
                cut = data.draw(st.booleans())
                faces += [(a, b, c), (a, c, d)] if cut else [(a, b, d), (b, c, d)]
    return np.array(list(number), dtype=float), np.array(faces), len(cells)


@given(boxes, st.data())
def test_hulls_of_boxes(pairs: list[tuple[Any, Any]], data: Any) -> None:
    points, faces, volume = hull(cells_of(pairs), data)
    assert solids.volume(points, faces) == volume
    for boundary in ("faces", "surface"):
        mesh = delone.tetrahedralize(points, faces, boundary=boundary)
        assert mesh.validate(), str(mesh.validate())
        assert solids.filled(mesh.points, mesh.simplices) == volume
        kept = {frozenset(face) for face in mesh.input_faces.tolist()}
        if boundary == "faces":
            assert kept == {frozenset(face) for face in faces.tolist()}
        assert solids.volume(mesh.points, mesh.input_faces) == volume


@given(boxes, st.data())
def test_one_surface_of_any_diagonals(pairs: list[tuple[Any, Any]], data: Any) -> None:
    """What is cut again does not depend on how it was cut."""
    found = []
    for _ in range(2):
        points, faces, _ = hull(cells_of(pairs), data)
        mesh = delone.tetrahedralize(points, faces, boundary="surface")
        found.append({frozenset(map(tuple, points[face])) for face in mesh.input_faces.tolist()})
    assert found[0] == found[1]
