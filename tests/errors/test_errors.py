from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

from delone import errors

CASES = [
    errors.DeloneError("m"),
    errors.InputError("m"),
    errors.ShapeError("m"),
    errors.DtypeError("m"),
    errors.NonFiniteError("m", rows=[3, 5], count=12),
    errors.DegenerateInputError("m", reason="collinear", chain=[2, 0, 1]),
    errors.ConflictingValuesError("m", rows=[(2, 0)]),
    errors.CrossingSegmentsError("m", pairs=[(0, 2)], points=[(0.5, 1.5)]),
    errors.BudgetExceededError("m", limit=10, found=12),
    errors.BusyError("m", pid=7, host="here"),
    errors.LimitError("m"),
    errors.InternalError("m"),
    errors.FileFormatError("m"),
    errors.MissingExtraError("m", extra="las"),
]


def test_every_public_class_is_among_the_cases() -> None:
    assert {type(error).__name__ for error in CASES} == set(errors.__all__)


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
        (errors.ConflictingValuesError, ValueError),
        (errors.CrossingSegmentsError, ValueError),
        (errors.BudgetExceededError, RuntimeError),
        (errors.BusyError, RuntimeError),
        (errors.LimitError, ValueError),
        (errors.InternalError, RuntimeError),
        (errors.FileFormatError, ValueError),
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
