"""How well two classifications of the same points agree: Cohen's kappa, errors of type I and II."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from delone._base.immutable import ReadOnly
from delone.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Bools

__all__ = ["Agreement", "agreement"]


@dataclass(frozen=True, eq=False, kw_only=True)
class Agreement(ReadOnly):
    """How well a classification agrees with a reference.

    Parameters
    ----------
    kappa : float
        Cohen's kappa: 1 if both are the same, 0 if they agree no more than by chance; NaN if all
        points have the same class in both.
    type_1 : float
        The share of ground points that are classified as something else; NaN if there are none.
    type_2 : float
        The share of other points that are classified as ground; NaN if there are none.

    Notes
    -----
    G. Sithole and G. Vosselman use these measures in their comparison of filters (ISPRS Journal of
    Photogrammetry and Remote Sensing 59, 2004).

    Examples
    --------
    See `Ground.compare`.
    """

    kappa: float
    type_1: float
    type_2: float

    def __repr__(self) -> str:
        return (
            f"<Agreement: kappa {self.kappa:.3f}, type I {self.type_1:.1%}, "
            f"type II {self.type_2:.1%}>"
        ).replace("%", " %")


def agreement(found: Bools, reference: ArrayLike) -> Agreement:
    """Return how well the ground that was found agrees with a reference."""
    truth = np.asarray(reference)
    if truth.dtype != bool or truth.shape != found.shape:
        raise InputError(
            f"reference must have a boolean for each of {len(found)} points, got an array of "
            f"shape {truth.shape} and type {truth.dtype}: compare classes, as in classes == 2"
        )
    total = len(truth)
    table = np.bincount(2 * truth + found, minlength=4).astype(np.int64)
    other_kept, taken, missed, right = table.tolist()
    ground, rest = missed + right, other_kept + taken
    # In integers, so that kappa of equal classifications is exactly 1.
    observed = (other_kept + right) * total
    chance = ground * (taken + right) + rest * (other_kept + missed)
    whole = total * total - chance
    return Agreement(
        kappa=(observed - chance) / whole if whole else float("nan"),
        type_1=missed / ground if ground else float("nan"),
        type_2=taken / rest if rest else float("nan"),
    )
