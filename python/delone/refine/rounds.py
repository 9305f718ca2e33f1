"""Rounds of refinement: triangles are refined until none is too large for its place.

Sizes that vary are sampled, given to the core as caps of areas, and sampled again where the new
triangles are.
"""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._arrays import as_number
from delone.errors import InputError
from delone.refine import domains
from delone.refine.domains import Counts, Domain
from delone.refine.sizing import Sizing

if TYPE_CHECKING:
    from collections.abc import Callable

    from delone.refine.domains import Progress

__all__ = ["MOST_ADDED", "Limits", "as_min_angle", "rounds"]

# Ten million triangles, in about 4 GB.
MOST_ADDED = 5_000_000
# Above this refinement is not known to end on most inputs.
_DARING = 33.0
# Each round that asks for sizes makes triangles smaller by up to four; 80 span the doubles.
_MOST_ROUNDS = 80


class Limits(NamedTuple):
    """How far a refinement goes."""

    min_angle: float
    max_points: int
    circles: bool
    progress: Callable[[int, float], object] | None
    workers: int | None
    # Whether sizes that need more points are an error before the work starts.
    refuse: bool = True
    # Whether sizes yield to lines that may not be split.
    sizes_yield: bool = False


def rounds(domain: Domain, sizes: tuple[Any, Any], limits: Limits) -> tuple[Domain, Counts]:
    """Refine a domain until no triangle is too large for where it is.

    Parameters
    ----------
    domain : Domain
        What is refined.
    sizes : tuple
        How large triangles may be: `max_area` and `size` of `mesh`.
    limits : Limits
        The bound of angles and the limit on points.

    Returns
    -------
    domain : Domain
        The refined one.
    counts : Counts
        The points added.
    """
    unit = domains.unit_of(domain.points)
    if unit != 1:
        # Areas are compared where they are doubles, whatever the lengths are.
        scaled = domain._replace(points=domain.points / unit)
        found, counts = _rounds(scaled, Sizing(*sizes, domain.regions, unit), limits)
        points = found.points * unit
        if np.array_equal(points / unit, found.points):
            return found._replace(points=points), counts
    return _rounds(domain, Sizing(*sizes, domain.regions), limits)


def _rounds(domain: Domain, sizing: Sizing, limits: Limits) -> tuple[Domain, Counts]:
    samples = sizing.samples(domain, limits.workers)
    if limits.refuse:
        sizing.require_within(domain, samples, limits.max_points)
    counts = Counts()
    for turn in range(_MOST_ROUNDS):
        caps, done = sizing.caps(domain, samples)
        if turn and done:
            break
        before = counts.total
        tell = limits.progress
        domain, more = domains.refined(
            domain,
            caps,
            limits.min_angle,
            limits.max_points - before,
            circles=limits.circles,
            sizes_yield=limits.sizes_yield,
            progress=None if tell is None else _after(before, tell),
        )
        counts = counts.plus(more)
        if counts.exhausted or not sizing.varies:
            break
    return domain, counts


def as_min_angle(min_angle: float) -> float:
    """Return an angle that meshes can be asked for.

    Parameters
    ----------
    min_angle : float
        In degrees.

    Returns
    -------
    float
        The angle.

    Raises
    ------
    InputError
        It is not in [0, 60).

    Warns
    -----
    UserWarning
        It is above 33.

    Examples
    --------
    >>> from delone.refine.rounds import as_min_angle
    >>> as_min_angle(20)
    20.0
    """
    angle = as_number(min_angle, name="min_angle")
    if not 0 <= angle < 60:
        raise InputError(f"min_angle must be at least 0 and below 60 degrees, got {min_angle!r}")
    if angle > _DARING:
        warnings.warn(
            f"refinement to {angle:g} degrees is not proven to end: above {_DARING:g} degrees "
            "max_points may end it",
            UserWarning,
            stacklevel=3,
        )
    return angle


def _after(before: int, tell: Progress) -> Progress:
    """Return a progress that counts from what was added before."""

    def told(added: int, angle: float) -> None:
        tell(before + added, angle)

    return told
