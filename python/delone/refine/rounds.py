"""Rounds of refinement, until no triangle is too large for its position.

Varying sizes are sampled, passed to the core as maximum areas, and sampled at the new triangles of
each round.
"""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._base.arrays import as_number, as_workers
from delone.errors import InputError
from delone.refine import domains
from delone.refine.domains import Counts, Domain
from delone.refine.sizing import Samples, Sizing

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
        # Compare areas in a unit in which they are in the range of doubles, whatever the lengths.
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
    if samples is not None:
        return _sampled(domain, sizing, samples, limits)
    return domains.refined(
        domain,
        sizing.caps(domain),
        limits.min_angle,
        limits.max_points,
        circles=limits.circles,
        sizes_yield=limits.sizes_yield,
        progress=limits.progress,
    )


def _sampled(
    domain: Domain, sizing: Sizing, samples: Samples, limits: Limits
) -> tuple[Domain, Counts]:
    """Refine by sizes that vary. The mesh stays in the core, which returns the new triangles."""
    workers, progress = as_workers(limits.workers), limits.progress
    kinds = limits.circles, limits.sizes_yield
    at = samples.positions, samples.areas
    refinement = domains.started(domain, at, limits.min_angle, kinds)
    added = 0
    for turn in range(_MOST_ROUNDS):
        complies = refinement.comply(sizing.at(*refinement.fresh(workers)))
        if turn and complies:
            break
        told = None if progress is None else _continued(progress, added)
        enough, added = refinement.refine(limits.max_points - added, told)
        if not enough:
            break
    return domains.extended(domain, refinement.export())


def as_min_angle(min_angle: float) -> float:
    """Return a bound on angles in degrees, in [0, 60); a warning if it is above 33."""
    angle = as_number(min_angle, name="min_angle")
    if not 0 <= angle < 60:
        raise InputError(
            f"min_angle must be at least 0 and below 60 degrees, got {min_angle!r:.80}"
        )
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
