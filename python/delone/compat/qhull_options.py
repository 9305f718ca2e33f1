"""Parser of the option strings that scipy.spatial passes to Qhull.

Most of Qhull's options are about rounding: joggling, merging, tracing, precision constants. An
exact algorithm does not need them, and they are accepted without effect. A few determine what is
computed or reported, and those are obeyed. Options that require a different result raise an error
that names them.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from delone._base.arrays import as_text
from delone.errors import InputError

__all__ = ["DELAUNAY", "HALFSPACES", "HULL", "VORONOI", "QhullOptionError", "QhullOptions"]

DELAUNAY = "Delaunay triangulation"
VORONOI = "Voronoi diagram"
HULL = "convex hull"
HALFSPACES = "intersection of half-spaces"

_NUMBER = r"[-+.\de]*"
# Rounding, tracing and printing. QbB scales the points to a cube, which does not affect a
# triangulation, or the corners and measures of a hull. Coplanar facets are always merged (C-0,
#
_WITHOUT_EFFECT = re.compile(
    rf"Qbb|QbB|Qc|Qt|Qx|Qs|Qi|Qm|Qf|Qr|Qa|Qw|Q\d+|QJ{_NUMBER}|QR{_NUMBER}"
    rf"|C-?0(\.0*)?|A-?1(\.0*)?|[EUVW]{_NUMBER}|Pp|Po|T\w+{_NUMBER}|F\w+|G\w+|[dfimnops]"
)
# For triangulations and diagrams: a point at infinity, and the furthest site.
_OF_SITES = ("Qz", "Qu")
_REFUSED = (
    (r"[CA]-?\d.*", "merges facets within a tolerance, but delone merges only coplanar ones"),
    (r"Q[bB].+", "scales or drops single coordinates; transform the points instead"),
    (r"R.+", "rotates the points; transform the points instead"),
    (r"Qg|Q[GV].*|P[dDAFGMg].*", "omits part of the result"),
    (r"[vH].*", "requests a different result; use its class"),
    (r"[AC].*", "needs a number"),
)


class QhullOptionError(InputError):
    """An option that Qhull does not know, or not for this computation."""


@dataclass(frozen=True, kw_only=True)
class QhullOptions:
    """The contents of an option string."""

    # Qbb: lifted points are scaled to the size of their coordinates.
    scaled: bool
    # Qz: a point above all others is included in that scaling.
    infinite_point: bool
    # Qc: rows that are not vertices are listed.
    coplanar: bool
    # Qu: the furthest-site triangulation or diagram.
    furthest: bool
    # Qt: facets with more vertices than a simplex are triangulated.
    triangulated: bool

    @classmethod
    def parse(cls, options: str | None, *, incremental: bool, what: str = DELAUNAY) -> QhullOptions:
        """Parse options separated by spaces; None means SciPy's defaults for triangulations.

        InputError: an option requires a result other than the exact one, or is incompatible with
        adding points (`incremental`).
        """
        if options is None:
            options = "Qc Q12" if incremental else "Qbb Qc Qz Q12"
        given = as_text(options, name="qhull_options").split()
        for option in given:
            _check(option, incremental, what)
        if {*_OF_SITES} <= {*given}:
            raise QhullOptionError("option 'Qu' is incompatible with option 'Qz'")
        return cls(
            scaled="Qbb" in given,
            infinite_point="Qz" in given,
            coplanar="Qc" in given,
            furthest="Qu" in given,
            triangulated="Qt" in given,
        )


def _check(option: str, incremental: bool, what: str) -> None:
    """Reject unknown options and those that require a different result."""
    if option in ("Qbb", "Qz", "QbB") and incremental:
        raise InputError(f"option {option!r:.80} is incompatible with incremental=True")
    if option in _OF_SITES:
        if what in (DELAUNAY, VORONOI):
            return
        raise QhullOptionError(
            f"option {option!r:.80} is for Delaunay triangulations and Voronoi diagrams, "
            f"not for the {what}"
        )
    if _WITHOUT_EFFECT.fullmatch(option):
        return
    for pattern, reason in _REFUSED:
        if re.fullmatch(pattern, option):
            raise InputError(f"option {option!r:.80} is not supported for the {what}: it {reason}")
    raise QhullOptionError(f"unknown Qhull option {option!r:.80}")
