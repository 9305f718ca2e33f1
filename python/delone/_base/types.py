"""The types of arrays, by what they contain: one name each in all modules, for type checkers."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from typing import TypeAlias

    import numpy as np
    from numpy.typing import NDArray

    # Coordinates, weights and values.
    Floats: TypeAlias = NDArray[np.float64]
    # Rows of points and simplices as the core stores them; -1 for none.
    Indices: TypeAlias = NDArray[np.int32]
    # Rows as NumPy finds them, counts, and numbers that may exceed 32 bits.
    Rows: TypeAlias = NDArray[np.int64]
    Bools: TypeAlias = NDArray[np.bool_]
