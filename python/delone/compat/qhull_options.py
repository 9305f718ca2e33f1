"""The option strings that scipy.spatial hands to Qhull, as far as they mean something here.

Most of Qhull's options are about rounding: joggling, merging, tracing, precision constants. An
exact triangulation has no use for them, and accepts them without effect. A few say what is
reported, and those are obeyed. Those that ask for other triangles are refused by name rather than
ignored.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from delone.errors import DtypeError, InputError

__all__ = ["QhullOptions", "UnknownOptionError"]

_NUMBER = r"[-+.\de]*"
# Rounding, tracing and printing.
_WITHOUT_EFFECT = re.compile(
    rf"Qt|Qx|Qs|Qi|Qm|Qf|Qr|Qa|Qw|Q\d+|QJ{_NUMBER}|QR{_NUMBER}|C-?0|[EUVW]{_NUMBER}"
    rf"|Pp|Po|T\w+{_NUMBER}|F\w+|G\w+|[dfimnops]"
)
_OTHER_TRIANGLES = re.compile(r"Qu|Qg|Q[GV].*|Qb.+|QB.+|[AC].+|R.+|P[dDAFGMg].*|[vH].*")


class UnknownOptionError(InputError):
    """An option that Qhull does not know."""


@dataclass(frozen=True, kw_only=True)
class QhullOptions:
    """What a string of options asks for.

    Parameters
    ----------
    scaled : bool
        ``Qbb``: lifted points are scaled to the size of their coordinates.
    infinite_point : bool
        ``Qz``: a point above all others counts in that scaling.
    coplanar : bool
        ``Qc``: rows that are no vertices are listed.
    """

    scaled: bool
    infinite_point: bool
    coplanar: bool

    @classmethod
    def parse(cls, options: str | None, *, incremental: bool) -> QhullOptions:
        """Read a string of options.

        Parameters
        ----------
        options : str or None
            Separated by spaces. None stands for SciPy's defaults.
        incremental : bool
            Whether points can be added later.

        Returns
        -------
        QhullOptions
            What they ask for.

        Raises
        ------
        UnknownOptionError
            Qhull has no such option.
        InputError
            An option asks for other triangles than those of the Delaunay triangulation, or for
            what does not go with adding points.

        Examples
        --------
        >>> from delone.compat.qhull_options import QhullOptions
        >>> QhullOptions.parse("QJ Pp", incremental=False)
        QhullOptions(scaled=False, infinite_point=False, coplanar=False)
        """
        if options is None:
            options = "Qc Q12" if incremental else "Qbb Qc Qz Q12"
        if not isinstance(options, str):
            raise DtypeError(f"qhull_options must be a string, got {type(options).__name__}")
        given = options.split()
        _refuse(given, incremental)
        return cls(scaled="Qbb" in given, infinite_point="Qz" in given, coplanar="Qc" in given)


def _refuse(given: list[str], incremental: bool) -> None:
    for option in given:
        if option in ("Qbb", "Qz", "QbB") and incremental:
            raise InputError(f"option {option!r} does not go with incremental=True")
        if option in ("Qbb", "Qz", "Qc") or _WITHOUT_EFFECT.fullmatch(option):
            continue
        if _OTHER_TRIANGLES.fullmatch(option):
            hint = "; pass furthest_site=True" if option == "Qu" else ""
            raise InputError(
                f"option {option!r} asks for other triangles than those of the Delaunay "
                f"triangulation and is not supported{hint}"
            )
        raise UnknownOptionError(f"unknown Qhull option {option!r}")
