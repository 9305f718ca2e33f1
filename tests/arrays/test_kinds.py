"""Words that are arrays, rows that are ragged, numbers that are none: refused by name."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from delone import (
    Delaunay,
    DtypeError,
    InputError,
    RegularTriangulation,
    ShapeError,
    Voronoi,
    datasets,
    improve,
    interpolate,
    io,
    mesh,
)

FLAT, SPACE = datasets.uniform(12), datasets.uniform(12, ndim=3)
SQUARE = {"type": "Polygon", "coordinates": [[(0, 0), (1, 0), (1, 1), (0, 1)]]}
RAGGED: Any = [[1, 2], [3]]
WORDS: Any = np.ones(3)


@pytest.mark.parametrize("points", [FLAT, SPACE])
def test_a_choice_is_a_word(points: Any) -> None:
    with pytest.raises(InputError, match="method must be one of"):
        Delaunay(points, method=WORDS)
    for name in ("extrapolate", "duplicates", "nan"):
        with pytest.raises(InputError, match=f"{name} must be one of"):
            interpolate.Linear(points, points[:, 0], **{name: WORDS})
    for name in ("kind", "gradients"):
        with pytest.raises(InputError, match=f"{name} must be one of"):
            interpolate.NaturalNeighbor(FLAT, FLAT[:, 0], **{name: WORDS})


@pytest.mark.parametrize("points", [FLAT, SPACE])
def test_rows_are_of_equal_length(points: Any) -> None:
    for call in (
        lambda: RegularTriangulation(points, RAGGED),
        lambda: Voronoi(points, weights=RAGGED),
        lambda: interpolate.Linear(points, RAGGED),
        lambda: interpolate.Linear(points, points[:, 0])(points[:1], values=RAGGED),
        lambda: improve(Delaunay(SPACE), fixed=RAGGED),
        lambda: improve(Delaunay(SPACE), region=RAGGED),
        lambda: mesh(SQUARE, fixed=RAGGED),
        lambda: mesh(SQUARE, segment_markers=RAGGED),
        lambda: io.write_mesh("never.csv.vtu", Delaunay(FLAT), z=RAGGED),
    ):
        with pytest.raises(ShapeError, match="rows of unequal length"):
            call()


@pytest.mark.parametrize("points", [FLAT, SPACE])
def test_a_cell_is_that_of_a_row(points: Any) -> None:
    cells = Voronoi(points)
    for bad in (1.5, "a", None, [1, 2]):
        with pytest.raises(DtypeError, match="i must be the row of a site"):
            cells.cell(bad)
    assert cells.cell(np.int64(3)).site == 3


def test_an_empty_table_fixes_nothing_by_mistake() -> None:
    with pytest.raises((DtypeError, ShapeError), match="fixed"):
        improve(Delaunay(SPACE), fixed=np.zeros((0, 3)))
    assert improve(Delaunay(SPACE), fixed=[]).npoints == 12
