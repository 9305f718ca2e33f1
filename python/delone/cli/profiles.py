"""What ``profile`` computes and writes: profiles and cross sections as tables and drawings."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.atomic import check_target, replacing
from delone._base.extras import require
from delone.cli.exits import Exit, Failure, protect_inputs, writing
from delone.io import write_drawing
from delone.terrain import CrossSections

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from delone.cli.report import Stopwatch
    from delone.io import GeometrySet
    from delone.terrain import TIN, Profile, Profiles

    Found = Profile | Profiles | CrossSections

__all__ = [
    "PROFILE_SUFFIXES",
    "SectionOptions",
    "name_of",
    "named_files",
    "profile_figures",
    "ready_profile",
    "write_profile",
]

_PICTURES = (".png", ".svg", ".pdf")
PROFILE_SUFFIXES = (".csv", ".dxf", *_PICTURES)


@dataclass(frozen=True, kw_only=True)
class SectionOptions:
    """What to compute along a line, and how to draw it."""

    interval: float | None
    left: float | None
    right: float | None
    start: float
    exaggeration: float | None
    text_height: float | None

    @classmethod
    def among(cls, given: dict[str, Any]) -> SectionOptions:
        """Select the options among the arguments of the command."""
        found = cls(**{each.name: given[each.name] for each in fields(cls)})
        across = found.left is not None or found.right is not None or bool(found.start)
        if found.interval is None and across:
            raise Failure("--left, --right and --start need --interval", Exit.USAGE)
        if found.interval is not None and found.left is None:
            raise Failure("--interval needs --left, the width of cross sections", Exit.USAGE)
        return found

    def of(self, tin: TIN, line: GeometrySet, others: dict[str, TIN], name: str) -> Found:
        """Compute a profile of one surface or of several, or cross sections."""
        if self.interval is None or self.left is None:
            return tin.profiles(line, others, name=name) if others else tin.profile(line)
        return tin.cross_sections(
            line,
            interval=self.interval,
            start=self.start,
            left=self.left,
            right=self.right,
            others=others,
            name=name,
        )


def name_of(path: Path, layer: str | None = None) -> str:
    """Return the name of the surface in a file: that of its layer or, without one, of the file."""
    return layer or path.stem


def named_files(
    source: Path, others: Sequence[Path], layers: Sequence[str]
) -> Iterator[tuple[str, Path, str | None]]:
    """Yield unique names of the other surfaces, with their files and layers."""
    if layers and len(layers) != len(others):
        raise Failure("give --other-layer once for each --other, or not at all", Exit.USAGE)
    taken = {name_of(source)}
    for k, path in enumerate(others):
        layer = layers[k] if layers else None
        plain = name = name_of(path, layer)
        number = 2
        # Terminates, because there are finitely many names.
        while name in taken:
            name, number = f"{plain} {number}", number + 1
        taken.add(name)
        yield name, path, layer


def ready_profile(output: Sequence[Path], inputs: Sequence[Path], options: SectionOptions) -> None:
    """Check that files can be written before any work is done."""
    for path in output:
        if path.suffix.lower() not in PROFILE_SUFFIXES:
            suffixes = " ".join(PROFILE_SUFFIXES)
            raise Failure(f"{path}: a profile can be written to {suffixes}", Exit.USAGE)
    drawn = any(path.suffix.lower() == ".dxf" for path in output)
    if not drawn and (options.exaggeration is not None or options.text_height is not None):
        raise Failure("--exaggeration and --text-height are for DXF drawings", Exit.USAGE)
    if drawn:
        require("ezdxf", extra="dxf", what="writing DXF")
    with writing():
        protect_inputs(list(output), *inputs)
        for path in output:
            check_target(path)


def write_profile(
    found: Found, output: Sequence[Path], watch: Stopwatch, options: SectionOptions
) -> None:
    """Write tables and drawings."""
    with writing(), ExitStack() as stack:
        for path in output:
            suffix = path.suffix.lower()
            with watch.stage(f"write {path.name}"):
                target = stack.enter_context(replacing(path))
                if suffix == ".dxf":
                    factor = 1.0 if options.exaggeration is None else options.exaggeration
                    height = options.text_height
                    write_drawing(target, found, exaggeration=factor, text_height=height)
                elif suffix == ".csv":
                    _write_csv(found, target)
                else:
                    _draw(found, target, suffix[1:])


def _write_csv(found: Found, target: Path) -> None:
    if isinstance(found, CrossSections):
        offsets = [found.offsets_of(row) for row in range(len(found))]
        sizes = [len(each) for each in offsets]
        first = [np.repeat(found.stations, sizes), np.concatenate(offsets)]
        z = np.concatenate([one.z for one in found.sections])
        points = np.concatenate([one.points for one in found.sections])
        names = ("station", "offset", *found.sections[0].names)
    else:
        first, z, points = [found.distances], found.z, found.points
        names = ("distance", *getattr(found, "names", ("z",)))
    table = np.column_stack((*first, z, points))
    header = ",".join(_quoted(name) for name in (*names, "x", "y"))
    with target.open("w", encoding="utf-8", newline="\n") as file:
        np.savetxt(file, table, fmt="%.17g", delimiter=",", header=header, comments="")


def _quoted(name: str) -> str:
    """Return the name of a column as it is written in CSV."""
    return '"' + name.replace('"', '""') + '"' if set(name) & set(',"\n\r') else name


def _draw(found: Found, target: Path, kind: str) -> None:
    pyplot = require("matplotlib.pyplot", extra="plot", what="drawing")
    if isinstance(found, CrossSections):
        figure = found.figure()
    else:
        figure, ax = pyplot.subplots(figsize=(9, 3), layout="constrained")
        found.plot(ax)
    figure.savefig(target, format=kind)
    pyplot.close(figure)


def profile_figures(found: Found) -> dict[str, Any]:
    """Return the figures of a profile, or of all cross sections."""
    several = found.sections if isinstance(found, CrossSections) else (found,)
    z = np.concatenate([one.z.ravel() for one in several])
    known = z[~np.isnan(z)]
    heights = {
        "profile_points": sum(map(len, several)),
        "lowest": float(known.min()) if len(known) else None,
        "highest": float(known.max()) if len(known) else None,
    }
    if isinstance(found, CrossSections):
        without = sum(bool(np.isnan(one.z).all()) for one in several)
        length = float(found.stations[-1] - found.stations[0])
        counts = {"stations": len(found), "stations_without_heights": without or None}
        return {"length": length, **counts, **heights}
    length = float(found.distances[-1]) if len(found) else 0.0
    gaps = int(np.isnan(z).sum()) if z.ndim == 1 and not hasattr(found, "names") else 0
    return {"length": length, **heights, "gaps": gaps or None}
