"""Rounds of refinement, until no triangle is too large for its position.

Varying sizes are sampled, passed to the core as maximum areas, and sampled again at the new
triangles.
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
# Above this angle, refinement is not known to terminate on most inputs.
_LARGEST_USUAL = 33.0
# Each round makes triangles smaller by a factor of up to four; 80 rounds span the doubles.
_MOST_ROUNDS = 80


class Limits(NamedTuple):
    """The limits of a refinement."""

    min_angle: float
    max_points: int
    circles: bool
    progress: Callable[[int, float], object] | None
    workers: int | None
    # Whether sizes that need more points raise an error before refinement starts.
    refuse: bool = True
    # Whether sizes yield to lines that must not be split.
    sizes_yield: bool = False


def rounds(domain: Domain, sizes: tuple[Any, Any], limits: Limits) -> tuple[Domain, Counts]:
    """Refine a domain until no triangle is too large; `sizes` are `max_area`, `size` of `mesh`."""
    unit = domains.unit_of(domain.points)
    if unit != 1:
        # Compare areas in a unit in which they are doubles, whatever the lengths.
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
        progress = limits.progress
        domain, more = domains.refined(
            domain,
            caps,
            limits.min_angle,
            limits.max_points - before,
            circles=limits.circles,
            sizes_yield=limits.sizes_yield,
            progress=None if progress is None else _continued(progress, before),
        )
        counts = counts.plus(more)
        if counts.exhausted or not sizing.varies:
            break
    return domain, counts


def as_min_angle(min_angle: float) -> float:
    """Return a bound on angles in degrees, in [0, 60); a warning if it is above 33."""
    angle = as_number(min_angle, name="min_angle")
    if not 0 <= angle < 60:
        raise InputError(f"min_angle must be at least 0 and below 60 degrees, got {min_angle!r}")
    if angle > _LARGEST_USUAL:
        warnings.warn(
            f"min_angle={angle:g} is above {_LARGEST_USUAL:g} degrees: refinement is not proven to "
            "terminate, and may stop at max_points",
            UserWarning,
            stacklevel=3,
        )
    return angle


def _continued(progress: Progress, before: int) -> Progress:
    """Return a progress function that includes the points that were added before."""

    def report(added: int, angle: float) -> None:
        progress(before + added, angle)

    return report
