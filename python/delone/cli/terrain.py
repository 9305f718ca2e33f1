"""The commands ``contours``, ``profile`` and ``volume``, for surfaces of points with heights."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import replace
from functools import partial
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple, Self

import numpy as np
import typer

from delone import distributed
from delone._base.atomic import check_target, replacing
from delone._base.extras import require
from delone._base.numbers import as_positive
from delone.cli.constraints import geometries_of
from delone.cli.exits import Exit, Failure, protect_inputs, reading, writing
from delone.cli.notes import noting
from delone.cli.options import numbers, outputs
from delone.cli.profiles import (
    PROFILE_SUFFIXES,
    SectionOptions,
    name_of,
    named_files,
    profile_figures,
    ready_profile,
    write_profile,
)
from delone.cli.quantities import (
    ROW_SUFFIXES,
    read_regions,
    ready_rows,
    volume_figures,
    volume_rows,
    write_rows,
)
from delone.cli.referenced import require_known
from delone.cli.report import Stopwatch
from delone.cli.show import spinner
from delone.cli.surfaces import (
    SurfaceOptions,
    Survey,
    curves_of,
    figures_of,
    height_of,
    is_landxml,
    other_surface,
    print_figures,
    with_surface,
)
from delone.cli.tables import APPENDED, TABLE_SUFFIXES, ready_table, write_table
from delone.cli.tiled import surface_or_tiles
from delone.io import write_drawing
from delone.io.lines import LineBlock, write_line_layer
from delone.terrain import TIN, Contours, Volumes
from delone.terrain.contouring import MOST

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from delone.distributed import TiledDelaunay
    from delone.terrain import Bands, Volume

__all__ = ["contours", "profile", "volume", "write_lines"]


@with_surface
def contours(
    source: Survey,
    *,
    interval: Annotated[float | None, typer.Option(help="Difference between levels.")] = None,
    levels: Annotated[
        str | None, typer.Option(help="Levels, instead of an interval, such as 10,12.5,15.")
    ] = None,
    base: Annotated[
        float | None, typer.Option(help="Level from which intervals are counted; by default 0.")
    ] = None,
    index: Annotated[
        int | None,
        typer.Option(
            help="Mark every n-th level as an index contour; by default every 5th; 0 marks none."
        ),
    ] = None,
    smooth: Annotated[int, typer.Option(help="Number of corner-cutting rounds, 0 to 5.")] = 0,
    min_length: Annotated[
        float, typer.Option(help="Leave out lines shorter than this, in units of the points.")
    ] = 0.0,
    min_area: Annotated[
        float,
        typer.Option(
            help="Leave out closed lines that enclose less than this; such polygons become part "
            "of the polygon around them."
        ),
    ] = 0.0,
    simplify: Annotated[
        float,
        typer.Option(
            help="Leave out points of lines that are within this distance of the rest; lines stay "
            "on the same side of each other, and adjacent polygons keep the same border."
        ),
    ] = 0.0,
    bands: Annotated[
        bool, typer.Option("--bands", help="Write polygons between levels instead of lines.")
    ] = False,
    labels: Annotated[
        Path | None,
        typer.Option(
            help="File for labels along the lines, as points with text and angle: "
            + " ".join(TABLE_SUFFIXES)
        ),
    ] = None,
    label_length: Annotated[
        float | None, typer.Option(help="Length of a label, in units of the points.")
    ] = None,
    max_points: Annotated[
        int, typer.Option(help="Maximum total number of points of all contours.")
    ] = MOST,
    output: Annotated[
        list[Path] | None, outputs("File to write", [*TABLE_SUFFIXES, ".dxf"])
    ] = None,
    options: SurfaceOptions,
) -> None:
    """Compute contour lines, or the polygons between them, of points with heights."""
    wanted = None if levels is None else numbers(levels, "--levels")
    of_lines: dict[str, Any] = {"index": 5 if index is None else index, "min_length": min_length}
    if bands:
        own = {"smooth": smooth or None, "min_length": min_length or None, "labels": labels}
        _refuse("is for lines, not for --bands", index=index, **own)
    if wanted is not None:
        _refuse("is for --interval, not for --levels", base=base, index=index)
    if labels is None and label_length is not None:
        raise Failure("--label-length needs --labels", Exit.USAGE)
    if label_length is not None:
        with reading():
            as_positive(label_length, name="--label-length", finite=True)
    _check(output or [], source, options, bands=bands)
    if labels is not None:
        with writing():
            protect_inputs([labels, *(output or [])], source, *options.inputs())
            ready_table(labels, "labels")
    watch = Stopwatch()
    how: dict[str, Any] = {"interval": interval, "base": base or 0.0, "min_area": min_area}
    how["max_points"] = max_points
    with spinner(options.silent) as say:
        tin = surface_or_tiles(source, options, watch, say)
        say("computing contours")
        draw: Any
        if not bands:
            draw = partial(tin.contours, smooth=smooth, **of_lines)
        elif isinstance(tin, TIN):
            draw = tin.bands
        else:
            raise Failure("--bands is for files of points, not for folders of tiles", Exit.USAGE)
        texts = None
        in_parts = labels is None and not (smooth or simplify) and _appended(output or [])
        if in_parts and not isinstance(tin, TIN):
            parts = tin.contour_parts(wanted, **how, **of_lines)
            found = _write_parts(parts, output or [], watch, say)
        else:
            with watch.stage("contours"):
                made = draw(wanted, simplify=simplify, **how)
            say(f"writing {len(made):,} {'polygons' if bands else 'lines'}")
            layers: list[tuple[Any, list[Path], str]] = [
                (made, output or [], "bands" if bands else "contours")
            ]
            if labels is not None:
                texts = made.labels(length=label_length)
                layers.append((texts, [labels], "labels"))
            write_lines(layers, watch)
            found = _Drawn.of(made)
    what = "polygons" if bands else "lines"
    written = [*(output or []), *([] if labels is None else [labels])]
    figures = figures_of(source, tin, written) | {
        what: found.number,
        "levels": len(found.levels),
        "coordinates": found.points,
        "triangles_left_out": found.left_out or None,
        "short_lines_left_out": found.short if min_length else None,
        f"small_{what}_left_out": found.small if min_area else None,
        "points_of_lines_left_out": found.straightened if simplify else None,
        "flat_polygons_left_out": found.flattened if bands and simplify else None,
        "labels": None if texts is None else len(texts),
        "lines_too_short_for_a_label": None if texts is None else texts.short,
        "stages": watch.rows(tin.npoints),
    }
    print_figures(source, figures, as_json=options.as_json, quiet=options.quiet)


class _Drawn(NamedTuple):
    """What is reported about contours or bands."""

    number: int = 0
    levels: frozenset[float] = frozenset()
    points: int = 0
    left_out: int = 0
    short: int = 0
    small: int = 0
    straightened: int = 0
    flattened: int = 0

    @classmethod
    def of(cls, made: Contours | Bands) -> Self:
        """Return the figures of contours or bands."""
        if isinstance(made, Contours):
            of, own = made.level, {"short": made.short}
        else:
            of, own = made.low, {"flattened": made.flattened}
        return cls(
            number=len(made),
            levels=frozenset(np.unique(of).tolist()),
            points=len(made.points),
            left_out=made.left_out,
            small=made.small,
            straightened=made.straightened,
            **own,
        )

    def plus(self, part: Contours) -> Self:
        """Return the sums with the figures of more lines; `left_out` of a part covers all parts."""
        more = self.of(part)
        return self._replace(
            number=self.number + more.number,
            levels=self.levels | more.levels,
            points=self.points + more.points,
            left_out=more.left_out,
            short=self.short + more.short,
            small=self.small + more.small,
        )


@with_surface
def profile(
    source: Survey,
    line: Annotated[
        Path,
        typer.Argument(metavar="LINE", help="File with one line; a polygon is the line around it."),
    ],
    *,
    other: Annotated[
        list[Path] | None,
        typer.Option(help="File of another surface, such as a design; can be repeated."),
    ] = None,
    other_layer: Annotated[
        list[str] | None,
        typer.Option(help="Layer or surface of each --other, if not that of --layer."),
    ] = None,
    interval: Annotated[
        float | None,
        typer.Option(help="Cross sections at this interval along the line, and at its end."),
    ] = None,
    left: Annotated[
        float | None, typer.Option(help="How far cross sections reach to the left of the line.")
    ] = None,
    right: Annotated[
        float | None, typer.Option(help="How far to the right; by default as far as to the left.")
    ] = None,
    start: Annotated[float, typer.Option(help="Station at the start of the line.")] = 0.0,
    exaggeration: Annotated[
        float | None, typer.Option(help="Factor for heights in DXF drawings; by default 1.")
    ] = None,
    text_height: Annotated[
        float | None, typer.Option(help="Height of text in DXF drawings, in drawing units.")
    ] = None,
    output: Annotated[list[Path] | None, outputs("File to write", PROFILE_SUFFIXES)] = None,
    options: SurfaceOptions,
) -> None:
    """Compute the heights of surfaces along a line, or in cross sections: a table or a drawing.

    Lines and a boundary belong to the first surface.
    """
    wanted = SectionOptions.among(locals())
    require_known(options.crs)
    ready_profile(output or [], [source, line, *(other or []), *options.inputs()], wanted)
    watch = Stopwatch()
    with spinner(options.silent) as say:
        with reading(quiet=options.quiet, layer=None):
            along = geometries_of(line, **curves_of(line, options.chord, aligned=True))
        files, aligned = [line, *(other or [])], is_landxml(line)
        tin = surface_or_tiles(source, options, watch, say, others=files, aligned=aligned)
        others = {
            name: _another(path, replace(options, layer=own or options.layer), watch, say)
            for name, path, own in named_files(source, other or [], other_layer or [])
        }
        say("computing the profile")
        with watch.stage("profile"), noting(quiet=options.quiet):
            if isinstance(tin, TIN):
                found = wanted.of(tin, along, others, name_of(source))
            elif others or wanted.interval is not None:
                raise Failure(
                    "--other and --interval are for files of points, not for folders of tiles",
                    Exit.USAGE,
                )
            else:
                found = tin.profile(along)
        write_profile(found, output or [], watch, wanted)
    figures = figures_of(source, tin, output) | profile_figures(found)
    figures["stages"] = watch.rows(tin.npoints)
    print_figures(source, figures, as_json=options.as_json, quiet=options.quiet)


@with_surface
def volume(
    source: Survey,
    other: Annotated[
        str, typer.Argument(metavar="OTHER", help="File of the surface to reach, or a height.")
    ],
    *,
    region: Annotated[
        Path | None, typer.Option(help="File of polygons that limit the volume.")
    ] = None,
    regions: Annotated[
        Path | None, typer.Option(help="File of polygons; the output has a row for each.")
    ] = None,
    regions_layer: Annotated[
        str | None, typer.Option(help="Layer of the file of --regions, if it has several.")
    ] = None,
    output: Annotated[
        list[Path] | None, outputs("File for the rows of --regions", ROW_SUFFIXES)
    ] = None,
    other_layer: Annotated[
        str | None, typer.Option(help="Layer or surface of OTHER, if not that of --layer.")
    ] = None,
    options: SurfaceOptions,
) -> None:
    """Compute the volumes to cut and to fill between a surface and a height or another surface.

    Lines and a boundary belong to the first surface.
    """
    if region is not None and regions is not None:
        raise Failure("--region is one volume, --regions has a row for each: give one", Exit.USAGE)
    if regions is None and (output or regions_layer is not None):
        raise Failure("--output and --regions-layer need --regions", Exit.USAGE)
    if other_layer is not None and height_of(other) is not None:
        raise Failure("--other-layer is for a file, not for a height", Exit.USAGE)
    require_known(options.crs)
    polygons = [path for path in (region, regions) if path is not None]
    ready_rows(output or [], [source, Path(other), *polygons, *options.inputs()])
    watch = Stopwatch()
    with spinner(options.silent) as say:
        with reading(quiet=options.quiet, layer=None):
            within = (
                None
                if region is None
                else geometries_of(region, **curves_of(region, options.chord))
            )
        with reading(quiet=options.quiet, layer="--regions-layer"):
            lots = None if regions is None else read_regions(regions, regions_layer, options)
        tin = surface_or_tiles(source, options, watch, say, others=[Path(other), *polygons])
        within_other = replace(options, layer=other_layer or options.layer)
        goal = _goal(other, within_other, watch, say)
        if isinstance(tin, TIN) and isinstance(goal, distributed.TiledDelaunay):
            raise Failure("a folder of tiles must be the first surface: swap the two", Exit.USAGE)
        say("computing volumes")
        with watch.stage("volume"), noting(quiet=options.quiet):
            found: Volume | Volumes
            if lots is None:
                found = tin.volume_to(goal, region=within)
            elif isinstance(tin, TIN) and not isinstance(goal, distributed.TiledDelaunay):
                found = tin.volumes_to(goal, lots)
            else:
                raise Failure("--regions is for files, not for folders of tiles", Exit.USAGE)
        if isinstance(found, Volumes) and lots is not None:
            write_rows(found, lots, output or [], watch, quiet=options.quiet)
    figures = figures_of(source, tin, output) | volume_figures(found)
    figures["stages"] = watch.rows(tin.npoints)
    units_of = dict.fromkeys(("cut", "fill", "net"), found.volume_units)
    units_of |= dict.fromkeys(("cut_area", "fill_area", "area"), found.area_units)
    more = volume_rows(found, lots)
    print_figures(
        source, figures, as_json=options.as_json, quiet=options.quiet, of=units_of, more=more
    )


def _refuse(why: str, **given: object) -> None:
    """Reject options that would have no effect; those that are not given are None."""
    for name, value in given.items():
        if value is not None:
            raise Failure(f"--{name.replace('_', '-')} {why}", Exit.USAGE)


def _check(output: list[Path], source: Path, options: SurfaceOptions, *, bands: bool) -> None:
    require_known(options.crs)
    with writing():
        protect_inputs(output, source, *options.inputs())
        for path in output:
            if path.suffix.lower() != ".dxf":
                ready_table(path, "contours", also=".dxf")
            elif bands:
                raise Failure(
                    f"{path}: drawings contain contours, not the areas between them", Exit.USAGE
                )
            else:
                require("ezdxf", extra="dxf", what="writing DXF")
                check_target(path)


def _goal(
    other: str, options: SurfaceOptions, watch: Stopwatch, say: Callable[[str], None]
) -> float | TIN | TiledDelaunay:
    """Return the height or surface to reach."""
    if (height := height_of(other)) is not None:
        return height
    if Path(other).is_dir():
        with reading(quiet=options.quiet):
            return distributed.open(Path(other))
    return _another(Path(other), options, watch, say)


# For errors: the layer of another file has an option of its own.
_another = partial(other_surface, layer="--other-layer")


def _appended(output: list[Path]) -> bool:
    """Return whether rows can be added to all files."""
    return all(path.suffix.lower() in APPENDED for path in output)


def _write_parts(
    parts: Iterable[Contours], output: list[Path], watch: Stopwatch, say: Callable[[str], None]
) -> _Drawn:
    """Write contours as they are computed, so that only some of them are in memory at a time."""
    tally, begun = _Tally(parts, watch, say), False
    with ExitStack() as stack:
        with writing():
            targets = [stack.enter_context(replacing(path)) for path in output]
        if len(output) == 1 and _takes_arrays(output[0]):
            stage = f"write {output[0].name}"
            with writing(), watch.stage(stage):
                write_contours(targets[0], tally, "contours")
            # The parts are computed while the file is written.
            watch.seconds[stage] -= watch.seconds["contours"]
        else:
            for part in tally:
                rows = part.to_geopandas() if output else None
                for path, target in zip(output, targets, strict=True):
                    with writing(), watch.stage(f"write {path.name}"):
                        write_table(rows, target, layer="contours", append=begun)
                begun = True
        with writing():
            stack.close()
    return tally.found


class _Tally:
    """Parts of contours, and the sums of their figures; computing them is a stage of its own."""

    def __init__(
        self, parts: Iterable[Contours], watch: Stopwatch, say: Callable[[str], None]
    ) -> None:
        self.found, self._parts, self._watch, self._say = _Drawn(), parts, watch, say

    def __iter__(self) -> Iterator[Contours]:
        waiting = iter(self._parts)
        while True:
            with self._watch.stage("contours"):
                part = next(waiting, None)
            if part is None:
                return
            self.found = self.found.plus(part)
            self._say(f"writing lines: {self.found.number:,}")
            yield part


def _takes_arrays(path: Path) -> bool:
    """Return whether contours are written to a file without a table of geometries."""
    return path.suffix.lower() == ".gpkg"


def write_contours(target: Path, parts: Iterable[Contours], layer: str) -> None:
    """Write contours to a GeoPackage from their arrays."""
    waiting = iter(parts)
    first = next(waiting)
    blocks = (
        LineBlock(part.points, part.starts, part.level, part._fields())
        for part in chain([first], waiting)
    )
    dtypes = {name: str(values.dtype) for name, values in first._fields().items()}
    write_line_layer(target, blocks, layer=layer, crs=first.crs, dtypes=dtypes)


def write_lines(layers: Sequence[tuple[Any, list[Path], str]], watch: Stopwatch) -> None:
    """Write contours, bands or labels, each with its files and the name of its layer.

    Tables, for contours also drawings. All files are complete before the first one is renamed.
    """
    with writing(), ExitStack() as stack:
        for found, output, layer in layers:
            rows: Any = None
            for path in output:
                with watch.stage(f"write {path.name}"):
                    target = stack.enter_context(replacing(path))
                    if path.suffix.lower() == ".dxf":
                        write_drawing(target, found)
                    elif isinstance(found, Contours) and _takes_arrays(path):
                        write_contours(target, [found], layer)
                    else:
                        rows = found.to_geopandas() if rows is None else rows
                        write_table(rows, target, layer=layer)
