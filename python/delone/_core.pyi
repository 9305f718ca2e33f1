"""The compiled core. All arrays are C-contiguous; inputs must be of the dtypes given here."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "__version__",
    "find_simplex2",
    "incircle",
    "insphere",
    "lawson2",
    "methods2",
    "neighbors2",
    "orient2d",
    "orient3d",
    "triangulate2",
    "validate2",
]

__version__: Final[str]

def methods2() -> list[str]: ...
def triangulate2(
    points: NDArray[np.float64], method: str, workers: int
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32], list[tuple[str, float]]]: ...
def validate2(
    points: NDArray[np.float64], simplices: NDArray[np.int32], neighbors: NDArray[np.int32]
) -> dict[str, NDArray[np.int32]]: ...
def find_simplex2(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    xi: NDArray[np.float64],
    workers: int,
) -> NDArray[np.int32]: ...
def lawson2(
    points: NDArray[np.float64], simplices: NDArray[np.int32], record: bool
) -> tuple[NDArray[np.int32], NDArray[np.int32], int, NDArray[np.int32] | None]: ...
def neighbors2(simplices: NDArray[np.int32], npoints: int) -> NDArray[np.int32]: ...
def orient2d(
    a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64]
) -> NDArray[np.int8]: ...
def incircle(
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    c: NDArray[np.float64],
    d: NDArray[np.float64],
    canonical: bool,
) -> NDArray[np.int8]: ...
def orient3d(
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    c: NDArray[np.float64],
    d: NDArray[np.float64],
) -> NDArray[np.int8]: ...
def insphere(
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    c: NDArray[np.float64],
    d: NDArray[np.float64],
    e: NDArray[np.float64],
    canonical: bool,
) -> NDArray[np.int8]: ...
