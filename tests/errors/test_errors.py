from __future__ import annotations

import copy
import pickle
import re
from typing import TYPE_CHECKING

import numpy as np
import pytest

import delone
from delone import errors, interpolate, reference

if TYPE_CHECKING:
    from collections.abc import Callable

CASES = [
    errors.DeloneError("m"),
    errors.InputError("m"),
    errors.ShapeError("m"),
    errors.DtypeError("m"),
    errors.NonFiniteError("m", rows=[3, 5], count=12),
    errors.DegenerateInputError("m", reason="collinear", chain=[2, 0, 1]),
    errors.DirectionError("m", rows=[1, 4], count=11),
    errors.ConflictingValuesError("m", rows=[(2, 0)]),
    errors.CrossingSegmentsError("m", pairs=[(0, 2)], points=[(0.5, 1.5)]),
    errors.CrossingFacesError("m", pairs=[(0, 2)], kinds=["crossing"], count=4),
    errors.OpenSurfaceError("m", edges=[(0, 2), (2, 3)]),
    errors.CrowdedFacesError("m", faces=[3, 5]),
    errors.DanglingFacesError("m", faces=[3, 5]),
    errors.BudgetExceededError("m", limit=10, found=12, segments=[3, 1], place=(0.5, 2.0)),
    errors.BusyError("m", pid=7, host="here"),
    errors.LimitError("m"),
    delone.TooLargeError("m", simplices=5, nbytes=700, limit=600),
    errors.InternalError("m"),
    errors.OutputError("m"),
    errors.OutsideError("m", place=(1.0, 2.5)),
    errors.FileFormatError("m"),
    errors.HandleError("m", handles=[4, 9]),
    errors.EditConflictError("m"),
    errors.MissingExtraError("m", extra="las"),
]


def test_every_public_class_is_among_the_cases() -> None:
    assert {type(error).__name__ for error in CASES} == {*errors.__all__, "TooLargeError"}


@pytest.mark.parametrize("error", CASES, ids=lambda error: type(error).__name__)
@pytest.mark.parametrize("duplicate", [lambda e: pickle.loads(pickle.dumps(e)), copy.copy])
def test_survives_pickle_and_copy(error: errors.DeloneError, duplicate: object) -> None:
    again = duplicate(error)  # type: ignore[operator]
    assert type(again) is type(error)
    assert str(again) == str(error)
    assert vars(again).keys() == vars(error).keys()
    for key, value in vars(error).items():
        np.testing.assert_array_equal(vars(again)[key], value)


@pytest.mark.parametrize("error", CASES, ids=lambda error: type(error).__name__)
def test_is_made_by_the_method_that_tblib_calls(error: errors.DeloneError) -> None:
    # Dask copies errors with tblib, which sets the attributes afterwards.
    made = type(error).__new__(type(error))
    assert type(made) is type(error)


@pytest.mark.parametrize("error", CASES, ids=lambda error: type(error).__name__)
def test_constructs_from_a_message_alone(error: errors.DeloneError) -> None:
    assert "something" in str(type(error)("something"))


@pytest.mark.parametrize(
    ("cls", "bases"),
    [
        (errors.InputError, ValueError),
        (errors.ShapeError, ValueError),
        (errors.DtypeError, (ValueError, TypeError)),
        (errors.NonFiniteError, ValueError),
        (errors.DegenerateInputError, ValueError),
        (errors.DirectionError, ValueError),
        (errors.ConflictingValuesError, ValueError),
        (errors.CrossingSegmentsError, ValueError),
        (errors.BudgetExceededError, RuntimeError),
        (errors.BusyError, RuntimeError),
        (errors.LimitError, ValueError),
        (delone.TooLargeError, MemoryError),
        (errors.InternalError, RuntimeError),
        (errors.OutputError, OSError),
        (errors.OutsideError, ValueError),
        (errors.FileFormatError, ValueError),
        (errors.HandleError, KeyError),
        (errors.EditConflictError, RuntimeError),
        (errors.MissingExtraError, ImportError),
    ],
)
def test_derives_from_the_builtin_that_users_catch(
    cls: type, bases: type | tuple[type, ...]
) -> None:
    for base in bases if isinstance(bases, tuple) else (bases,):
        assert issubclass(cls, base)
    assert issubclass(cls, errors.DeloneError)


def test_non_finite_shows_ten_rows_and_counts_all() -> None:
    error = errors.NonFiniteError("m", rows=range(20), count=20)
    assert error.rows.tolist() == list(range(10))
    assert error.count == 20
    assert errors.NonFiniteError("m", rows=np.array([4])).count == 1


def test_internal_error_asks_for_a_report_once() -> None:
    error = errors.InternalError("m")
    assert str(error).count("please report it") == 1
    assert str(pickle.loads(pickle.dumps(error))) == str(error)


def test_missing_extra_says_what_to_install() -> None:
    error = errors.MissingExtraError(extra="plot")
    assert 'pip install "delone[plot]"' in str(error)
    assert error.extra == "plot"


def one_is_one() -> dict[str, Callable[[], object]]:
    """What goes wrong with one of something."""
    nan, inf = float("nan"), float("inf")
    three = [(0, 0), (1, 0), (0, 1)]
    survey = [*three, (1, 0)]
    line = {"type": "LineString", "coordinates": [(0, 0), (nan, 1)]}
    return {
        "1 row has a coordinate that is NaN or infinite: row 1; drop or repair it": lambda: (
            delone.Delaunay([(0, 0), (1, inf), (0, 1)])
        ),
        "1 distinct point is too few": lambda: delone.Delaunay([(0, 0), (0, 0)]),
        "1 duplicate has a different value": lambda: interpolate.Linear(survey, [0, 1, 2, 3]),
        "values: 1 of 3 rows holds NaN": lambda: interpolate.Linear(three, [0, nan, 0]),
        "xi: 1 of 1 query is outside the hull: row 0;": lambda: interpolate.Linear(
            three, [0, 1, 2], extrapolate="raise"
        )([(5, 5)]),
        "1 weight is NaN": lambda: delone.RegularTriangulation(three, [0, nan, 0]),
        "1 geometry has NaN": lambda: delone.from_geometry(line),
        "segments: 1 of 1 row has indices": lambda: delone.ConstrainedDelaunay(three, [(0, 7)]),
        "1 row holds NaN": lambda: reference.bowyer_watson([(0, 0), (1, 0), (nan, 1)]),
        "1 pair of segments crosses": lambda: reference.constrained_delaunay(
            [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 2), (1, 3)]
        ),
    }


@pytest.mark.parametrize("words", one_is_one())
def test_messages_do_not_speak_of_one_as_of_many(words: str) -> None:
    with pytest.raises(delone.DeloneError, match=re.escape(words)):
        one_is_one()[words]()
