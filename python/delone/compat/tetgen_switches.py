"""The arguments and switches of the package ``tetgen``: what each requests, and what is rejected.

Nothing that would change the result is ignored. What is accepted without effect requests output,
silence or checks, chooses between algorithms with the same result, or bounds errors that do not
occur in exact arithmetic.
"""

from __future__ import annotations

import re
from typing import Any, NamedTuple

import numpy as np

from delone._base.arrays import as_count, as_flag, as_number
from delone.errors import DtypeError, InputError

__all__ = ["Wishes", "of_arguments", "of_switches"]

_SIZES = (
    "needs sizes: pass bgmesh or bgmeshfilename, or use tet.tetmesh.refine(size=...), which takes "
    "functions, too"
)
_SWITCH = re.compile(r"([a-zA-Z])((?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?(?:/[\d.]*)*|/[\d./]+)?")
# Numbers from zero, silence, checks, files, neighbors, unused vertices, the tolerance of coplanar
# points, and what TetGen later does to tetrahedra: they do not affect the guarantees.
_WITHOUT_EFFECT = "zQVCFIJNEgkBOnTWxbUX"
_REFUSED = {
    "r": "use tet.tetmesh.refine, or delone.improve for other tetrahedra",
    "i": "use extra_points of delone.tetrahedralize",
    "c": "the convex hull is not kept: use delone.Delaunay(points)",
    "D": "segments are not split to make tetrahedra Delaunay",
    "w": "use delone.RegularTriangulation",
    "v": "use delone.Voronoi",
    "d": "use delone.check_surface",
    "R": "use tet.tetmesh.coarsen",
    "L": "flips have no levels",
    "K": "the format is written by delone.io.write_mesh",
    "P": "boundary facets are always returned",
    "l": "there is one algorithm",
    "s": "there is one algorithm",
}
# Arguments of the package that are not in the signature, their defaults, and the switch whose
# reason applies when another value is rejected; "" if any value is accepted.
_FURTHER: dict[str, tuple[Any, str]] = {
    **{"psc": (False, "s"), "refine": (False, "r"), "cdt": (False, "D"), "cdtrefine": (7, "")},
    **{"coarsen": (False, "R"), "weighted": (False, "w"), "flipinsert": (False, "L")},
    **{"insertaddpoints": (False, "i"), "diagnose": (False, "d"), "convex": (False, "c")},
    **{"voroout": (False, "v"), "maxvolume_length": (None, "")},
    **{"metric_scale": (1.0, "m"), "elem_growth_ratio": (0.0, "r")},
    **{"reversetetori": (0, "o"), "coarsen_param": (0, ""), "coarsen_percent": (1.0, "")},
    **dict.fromkeys(
        (
            *("brio_hilbert", "nomergevertex", "noexact", "nostaticfilter", "zeroindex"),
            *("neighout", "meditview", "vtkview", "vtksurfview", "nobound", "nonodewritten"),
            *("noelewritten", "nofacewritten", "noiterationnum", "nojettison", "docheck"),
            *("quiet", "nowarning", "verbose", "vertexperblock", "tetrahedraperblock"),
            *("shellfaceperblock", "supsteiner_level", "addsteiner_algo", "weighted_param"),
            *("fliplinklevel", "flipstarsize", "fliplinklevelinc", "opt_max_flip_level"),
            *("opt_scheme", "opt_iterations", "smooth_cirterion", "smooth_maxiter"),
            *("delmaxfliplevel", "unflip_queue_limit", "no_sort", "hilbert_order"),
            *("hilbert_limit", "brio_threshold", "brio_ratio", "epsilon"),
            *("facet_separate_ang_tol", "collinear_ang_tol", "facet_small_ang_tol"),
            *("opt_max_asp_ratio", "opt_max_edge_ratio", "optmaxdihedral", "smooth_alpha"),
            "refine_progress_ratio",
        ),
        (None, ""),
    ),
}
_REVERSED = "tetrahedra are positively oriented"


class Wishes(NamedTuple):
    """What is requested."""

    limit: int | None  # points that may be added
    regions: bool  # labels of regions
    faces: bool  # all faces, besides those of the input
    edges: bool  # all edges
    whole: bool  # all triangles as they are
    quality: bool  # bounds on shapes
    ratio: float  # of the circumradius and the shortest edge
    angle: float  # the goal for dihedral angles, 0 for the default
    volume: float  # the largest volume, 0 for none
    by_region: bool  # largest volumes of regions
    second: bool  # elements of second order
    sized: bool  # sizes of a background mesh


def of_arguments(
    *,
    plc: Any,
    quality: Any,
    minratio: Any,
    mindihedral: Any,
    nobisect: Any,
    steinerleft: Any,
    order: Any,
    regionattrib: Any,
    facesout: Any,
    edgesout: Any,
    sized: bool,
    nomergefacet: Any,
    others: dict[str, Any],
) -> Wishes:
    """Return what arguments request, or reject them."""
    wanted = as_flag(quality, name="quality")
    rest = dict(others)
    metric = as_flag(rest.pop("metric", False), name="metric")
    if metric and not sized:
        raise InputError(f"metric=True {_SIZES}")
    fixed = as_flag(rest.pop("fixedvolume", False), name="fixedvolume")
    by_region = as_flag(rest.pop("varvolume", False), name="varvolume")
    volume = as_number(rest.pop("maxvolume", -1.0), name="maxvolume")
    if fixed and volume <= 0:
        raise InputError("fixedvolume=True needs maxvolume, the largest volume, above 0")
    for name, value in rest.items():
        _check(name, value)
    if not as_flag(plc, name="plc"):
        raise InputError("plc must be True: delone.Delaunay triangulates points alone")
    if order not in (1, 2):
        raise InputError(f"order must be 1 or 2, got {order!r:.60}")
    kept = as_flag(nobisect, name="nobisect") or as_flag(nomergefacet, name="nomergefacet")
    return Wishes(
        limit=None if steinerleft < 0 else as_count(steinerleft, name="steinerleft"),
        regions=as_flag(regionattrib, name="regionattrib"),
        faces=as_flag(facesout, name="facesout"),
        edges=as_flag(edgesout, name="edgesout"),
        whole=kept,
        quality=wanted,
        ratio=as_number(minratio, name="minratio"),
        angle=as_number(mindihedral, name="mindihedral"),
        volume=max(volume, 0.0),
        by_region=by_region,
        second=order == 2,
        sized=sized,
    )


def _check(name: str, value: Any) -> None:
    """Reject an argument that is unknown, or requests what is not supported."""
    if name not in _FURTHER:
        raise DtypeError(f"tetrahedralize has no argument {name}")
    default, switch = _FURTHER[name]
    if switch and (np.ndim(value) or value != default):
        reason = _REVERSED if switch == "o" else _REFUSED[switch]
        raise InputError(f"the argument {name} is not supported: {reason}")


def of_switches(switches: str, *, sized: bool) -> Wishes:
    """Return what a string of switches requests, or reject it; `sized` if there are sizes."""
    rest = _SWITCH.sub("", switches)
    if rest:
        raise InputError(f"switches has {rest!r:.80}, which is not a switch")
    found = dict(_SWITCH.findall(switches))
    for letter, number in found.items():
        if letter in _REFUSED:
            raise InputError(f"the switch {letter} is not supported: {_REFUSED[letter]}")
        if letter == "o" and number not in ("", "1", "2"):
            raise InputError(f"the switch o is o1 or o2, not o{number}: {_REVERSED}")
        if letter not in "pYASMofeqam" + _WITHOUT_EFFECT:
            raise InputError(f"the switch {letter} is not known")
    if "p" not in found:
        raise InputError("switches must contain p: delone.Delaunay triangulates points alone")
    if "m" in found and not sized:
        raise InputError(f"the switch m {_SIZES}")
    # q has a ratio and, after a slash, an angle.
    ratio, _, angle = found.get("q", "").partition("/")
    return Wishes(
        limit=as_count(int(float(found["S"] or 0)), name="S") if "S" in found else None,
        regions="A" in found,
        faces="f" in found,
        edges="e" in found,
        # M: facets in one plane are not merged.
        whole="Y" in found or "M" in found,
        quality="q" in found,
        ratio=_number(ratio, 2.0, "q"),
        angle=_number(angle.split("/")[0], 0.0, "q"),
        volume=_number(found.get("a", ""), 0.0, "a"),
        by_region="a" in found and not found["a"],
        second=found.get("o") == "2",
        sized="m" in found,
    )


def _number(text: str, default: float, letter: str) -> float:
    """Return the number after a switch, or the default if there is none."""
    if not text:
        return default
    try:
        return float(text)
    except ValueError:
        raise InputError(f"the switch {letter} has {text!r:.80}, which is not a number") from None
