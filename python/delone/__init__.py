"""Exact, canonical and fast Delaunay triangulation.

>>> from delone import Delaunay
>>> Delaunay([(0, 0), (4, 0), (4, 3), (0, 3), (2, 1)])
<Delaunay of 5 points: 4 triangles>
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from delone import predicates
from delone._core import __version__
from delone.delaunay import Delaunay
from delone.errors import (
    DegenerateInputError,
    DeloneError,
    DtypeError,
    FileFormatError,
    InputError,
    InternalError,
    LimitError,
    MissingExtraError,
    NonFiniteError,
    ShapeError,
)
from delone.lawson import LawsonResult, lawson
from delone.validation import ValidationReport

if TYPE_CHECKING:
    from delone import compat, datasets, io, plot, reference, testing

__all__ = [
    "DegenerateInputError",
    "Delaunay",
    "DeloneError",
    "DtypeError",
    "FileFormatError",
    "InputError",
    "InternalError",
    "LawsonResult",
    "LimitError",
    "MissingExtraError",
    "NonFiniteError",
    "ShapeError",
    "ValidationReport",
    "__version__",
    "compat",
    "datasets",
    "io",
    "lawson",
    "plot",
    "predicates",
    "reference",
    "testing",
]

# Modules that not every program needs; they are imported when they are first asked for.
_LATER = frozenset({"compat", "datasets", "io", "plot", "reference", "testing"})


def __getattr__(name: str) -> Any:
    if name in _LATER:
        return importlib.import_module(f"delone.{name}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *_LATER})
