"""The diagrams that the core takes back are checked when they are made, and when they are used."""

from __future__ import annotations

import inspect
import pickle
from typing import Any

import numpy as np
import pytest

from delone import _core
from delone.errors import ShapeError
from delone.voronoi import Voronoi

BOX = (0.0, 0.0, 1.0, 1.0)


def diagram(ndim: int) -> Any:
    return Voronoi(np.random.default_rng(ndim).random((20, ndim)))


def names(result: Any) -> list[str]:
    return [k for k, v in vars(type(result)).items() if inspect.isdatadescriptor(v)]


def replaced(result: Any, **changes: Any) -> Any:
    arrays = {name: getattr(result, name) for name in names(result)}
    return type(result)(**(arrays | changes))


@pytest.mark.parametrize("ndim", [2, 3])
def test_a_diagram_has_the_arrays_that_it_is_made_of(ndim: int) -> None:
    dual = diagram(ndim)._cells.dual
    again = pickle.loads(pickle.dumps(dual))
    copied = replaced(dual)
    assert len(names(dual)) == len(dual.arrays())
    for name in names(dual):
        assert getattr(copied, name) is getattr(dual, name)
        assert np.array_equal(getattr(again, name), getattr(dual, name), equal_nan=True)
        with pytest.raises(AttributeError):
            setattr(dual, name, None)


@pytest.mark.parametrize("ndim", [2, 3])
def test_arrays_of_other_shapes_are_refused(ndim: int) -> None:
    dual = diagram(ndim)._cells.dual
    for name in names(dual):
        array = getattr(dual, name)
        with pytest.raises(TypeError):
            replaced(dual, **{name: array.astype(np.float32)})
        if array.ndim == 2:
            with pytest.raises(ShapeError, match=f"{name} has 7 columns"):
                replaced(dual, **{name: np.zeros((len(array), 7), array.dtype)})
    with pytest.raises(ShapeError, match="differ in length"):
        replaced(dual, region_starts=dual.region_starts[:-1])
    with pytest.raises(ShapeError, match="differ in length"):
        replaced(dual, site=dual.site[:-1])


@pytest.mark.parametrize(
    ("ndim", "name"),
    [
        *((2, name) for name in ("sites", "region_vertices", "region_ridges")),
        *((3, name) for name in ("sites", "site", "ridge_entries", "region_ridges")),
    ],
)
def test_numbers_out_of_range_are_refused_where_they_are_used(ndim: int, name: str) -> None:
    made = diagram(ndim)
    wrong = replaced(made._cells.dual, **{name: getattr(made._cells.dual, name) + 10**6})
    with pytest.raises(ShapeError, match=name):
        if ndim == 2:
            _core.voronoi_clip2(made.points, None, wrong, BOX, 1)
        else:
            _core.measures3(made.points, None, wrong, 1)


def test_the_core_takes_no_dictionary() -> None:
    flat = diagram(2)
    arrays: Any = {name: getattr(flat._cells.dual, name) for name in names(flat._cells.dual)}
    with pytest.raises(TypeError):
        _core.voronoi_clip2(flat.points, None, arrays, BOX, 1)
