"""Numbers as unevaluated sums of two doubles, in arrays: about 106 bits where doubles have 53.

T. J. Dekker, "A floating-point technique for extending the available precision", Numerische
Mathematik 18 (1971); D. E. Knuth's two-sum. Assumed is that nothing over- or underflows.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

__all__ = ["Pair"]

# 2**27 + 1 splits a double into two halves whose products are exact.
_SPLITTER = 134217729.0


@dataclass(frozen=True, slots=True, eq=False)
class Pair:
    """Arrays of sums ``high + low``.

    Parameters
    ----------
    high, low : ndarray of float64
        The sum rounded, and what rounding took away.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.space.pairs import Pair
    >>> third = Pair.difference(np.array([1e16]), np.array([-1.0]))
    >>> (third - Pair.difference(np.array([1e16]), np.array([0.0]))).value()
    array([1.])
    """

    high: Floats
    low: Floats

    @classmethod
    def difference(cls, a: Floats, b: Floats) -> Pair:
        """Return a - b, without rounding."""
        high = a - b
        virtual = a - high
        return cls(high, (a - (high + virtual)) + (virtual - b))

    def value(self) -> Floats:
        """Return the sum, rounded."""
        return self.high + self.low

    def __getitem__(self, key: Any) -> Pair:
        return Pair(self.high[key], self.low[key])

    def __neg__(self) -> Pair:
        return Pair(-self.high, -self.low)

    def __add__(self, other: Pair) -> Pair:
        high, error = _sum(self.high, other.high)
        return Pair(*_sum(high, error + (self.low + other.low)))

    def __sub__(self, other: Pair) -> Pair:
        return self + -other

    def __mul__(self, other: Pair) -> Pair:
        high = self.high * other.high
        (a, b), (c, d) = _split(self.high), _split(other.high)
        error = b * d - (((high - a * c) - b * c) - a * d)
        return Pair(*_sum(high, error + (self.high * other.low + self.low * other.high)))


def _sum(a: Floats, b: Floats) -> tuple[Floats, Floats]:
    high = a + b
    virtual = high - a
    return high, (a - (high - virtual)) + (b - virtual)


def _split(a: Floats) -> tuple[Floats, Floats]:
    large = _SPLITTER * a
    high = large - (large - a)
    return high, a - high
