"""The command ``terrain``: several products from one surface in a folder, with a page."""

from __future__ import annotations

import warnings
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from delone import __version__
from delone._base.extras import require
from delone._base.georeference import CRSWarning
from delone._base.numbers import as_positive
from delone.cli.constraints import geometries_of
from delone.cli.exits import Exit, Failure, protect_inputs, reading, writing
from delone.cli.notes import noting
from delone.cli.outputs import staged, write_all
from delone.cli.page import Section, page
from delone.cli.profiles import (
    SectionOptions,
    profile_figures,
    ready_profile,
    write_profile,
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
    other_surface,
    print_figures,
    surface,
    with_surface,
)
from delone.cli.tables import ready_table
from delone.cli.terrain import write_lines
from delone.errors import InputError
from delone.io.raster import raster_writer
from delone.plot.lines import plot_lines
from delone.terrain import difference
from delone.terrain.contouring import Finish, levels_of
from delone.terrain.lines import line_of
from delone.terrain.slopes import extremes, require_room

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from delone.interpolate import Grid
    from delone.terrain import TIN, Contours

__all__ = ["terrain"]

_SHADES = ("hillshade", "slope", "aspect")
# The names of all files that the command writes, except the page.
_PRODUCTS = ("contours.gpkg", "bands.gpkg", *(f"{name}.tif" for name in ("dem", *_SHADES)))
_PROFILES = "profile-*.csv"
# Cells along the longer side of the map of a page.
_CELLS = 900
# Points of one artist; the rasterizer of matplotlib refuses far longer ones.
_RUN = 20_000
_NO_SECTIONS = SectionOptions(
    interval=None, left=None, right=None, start=0.0, exaggeration=None, text_height=None
)


@dataclass
class _Product:
    """A product: what is written, what is reported, and how it is drawn."""

    name: str
    files: list[str]  # names in the folder
    figures: dict[str, Any] = field(default_factory=dict)
    found: Any = None
    goal: float | TIN | None = None  # of a volume


@with_surface
def terrain(
    source: Survey,
    *,
    folder: Annotated[
        Path,
        typer.Option(
            "--output", "-o", metavar="FOLDER", help="Folder for the files and index.html."
        ),
    ],
    contours: Annotated[
        float | None, typer.Option(help="Contour lines at this interval: contours.gpkg")
    ] = None,
    bands: Annotated[
        float | None, typer.Option(help="Polygons between levels at this interval: bands.gpkg")
    ] = None,
    dem: Annotated[
        float | None, typer.Option(help="A raster of heights with cells of this size: dem.tif")
    ] = None,
    hillshade: Annotated[
        bool, typer.Option("--hillshade", help="Brightness, with the cells of --dem: hillshade.tif")
    ] = False,
    slope: Annotated[
        bool, typer.Option("--slope", help="Slope in degrees, with the cells of --dem: slope.tif")
    ] = False,
    aspect: Annotated[
        bool, typer.Option("--aspect", help="Aspect, with the cells of --dem: aspect.tif")
    ] = False,
    profile: Annotated[
        list[Path] | None,
        typer.Option(
            help="File with one line; a polygon is the line around it: profile-NAME.csv, with a "
            "picture; can be repeated."
        ),
    ] = None,
    volume: Annotated[
        list[str] | None,
        typer.Option(
            metavar="HEIGHT|FILE",
            help="Volumes above and below this height or surface, on the page; can be repeated.",
        ),
    ] = None,
    smooth: Annotated[int, typer.Option(help="As for contours.")] = 0,
    min_length: Annotated[float, typer.Option(help="As for contours.")] = 0.0,
    min_area: Annotated[
        float, typer.Option(help="As for the command contours, for lines and polygons.")
    ] = 0.0,
    simplify: Annotated[float, typer.Option(help="As for contours.")] = 0.0,
    options: SurfaceOptions,
) -> None:
    """Make several products from one surface, and a page with pictures and numbers.

    The input is read and triangulated once. The files are the same as those of the commands
    contours, dem and profile with the same options.
    """
    given = locals()
    require_known(options.crs)
    quiet = options.quiet
    shades = [name for name in _SHADES if given[name]]
    if shades and dem is None:
        raise Failure(f"--{shades[0]} needs --dem, the size of its cells", Exit.USAGE)
    if contours is None and (smooth or min_length):
        raise Failure("--smooth and --min-length are for --contours", Exit.USAGE)
    if contours is None and bands is None and (min_area or simplify):
        raise Failure("--min-area and --simplify are for --contours and --bands", Exit.USAGE)
    Finish.of(smooth, min_length, min_area, simplify)
    heights = {text: height_of(text) for text in volume or []}
    products = _wanted(given | {"heights": heights}, shades)
    watch = Stopwatch()
    beside = [*(profile or []), *(Path(text) for text in heights if heights[text] is None)]
    inputs = [source, *beside, *options.inputs()]
    with spinner(options.silent) as say, _folder(folder, products, inputs):
        with reading(quiet=quiet, layer=None):
            lines = [
                geometries_of(path, **curves_of(path, options.chord, aligned=True))
                for path in profile or []
            ]
        _require_lines(profile or [], lines)
        tin = surface(source, options, watch, say, others=beside, aligned=bool(profile))
        _require_room(tin, contours, bands, dem, 1 + len(shades))
        goals = [_goal(text, heights[text], options, watch, say) for text in volume or []]
        given["volume"] = goals
        for product, goal in zip(products[len(products) - len(goals) :], goals, strict=True):
            product.goal = goal
        computed = _computed(tin, given, shades, lines)
        with staged(folder) as place:
            for product, compute in zip(products, computed, strict=True):
                say(f"computing {product.name}")
                with watch.stage(product.name), noting(quiet=quiet):
                    product.found = compute()
                _write(product, place, tin, watch, say)
            say("drawing the page")
            with watch.stage("page"), noting(quiet=quiet):
                _write_page(place / "index.html", source, tin, products)
    files = [folder / name for each in products for name in each.files]
    figures = figures_of(source, tin, [*files, folder / "index.html"])
    earlier = _earlier(folder, files, inputs)
    figures["files_of_earlier_runs"] = earlier or None
    figures["products"] = [{"product": each.name} | each.figures for each in products]
    figures["stages"] = watch.rows(tin.npoints)
    more = [row for each in products for row in _rows(each.figures, f"{each.name}: ")]
    if earlier:
        more.append(("files of earlier runs", ", ".join(earlier)))
    print_figures(source, figures, as_json=options.as_json, quiet=quiet, more=more)


def _write_page(target: Path, source: Path, tin: TIN, products: Sequence[_Product]) -> None:
    # The cells of maps, which several sections show.
    cells = tin.raster(resolution=float((tin.max_bound - tin.min_bound).max()) / _CELLS)
    sections = [
        _overview(source, tin, cells),
        *(_section(tin, each, cells) for each in products),
    ]
    text = page(source.name, sections, f"Made by delone {__version__}")
    with writing():
        target.write_text(text, encoding="utf-8", newline="\n")


def _require_lines(paths: Sequence[Path], lines: Sequence[Any]) -> None:
    """Reject files that do not have one line before the surface is read."""
    with warnings.catch_warnings():
        # The reference system of the surface is unknown before it is read.
        warnings.simplefilter("ignore", CRSWarning)
        for path, line in zip(paths, lines, strict=True):
            line_of(line, name=f"{path}: --profile", crs=None)


def _require_room(
    tin: TIN, contours: float | None, bands: float | None, dem: float | None, rasters: int
) -> None:
    """Reject too many levels and too many cells before the first product is computed."""
    for interval in (contours, bands):
        if interval is not None:
            levels_of(partial(extremes, tin), None, interval, 0.0, 1)
    if dem is not None:
        require_room(tin, dem, rasters)


def _earlier(folder: Path, files: Sequence[Path], inputs: Sequence[Path]) -> list[str]:
    """Return the names of products in the folder that this run has not written."""
    own = {path.resolve() for path in (*files, *inputs)}
    old = [folder / name for name in _PRODUCTS] + sorted(folder.glob(_PROFILES))
    return [path.name for path in old if path.is_file() and path.resolve() not in own]


def _wanted(given: dict[str, Any], shades: list[str]) -> list[_Product]:
    """Return the requested products, in the order in which they are computed."""
    for name in ("contours", "bands", "dem"):
        if given[name] is not None:
            as_positive(given[name], name=f"--{name}", finite=True)
    found = [
        _Product(name, [f"{name}.gpkg"])
        for name in ("contours", "bands")
        if given[name] is not None
    ]
    if given["dem"] is not None:
        found += [_Product(name, [f"{name}.tif"]) for name in ("dem", *shades)]
    for name in _distinct([path.stem for path in given["profile"] or []]):
        found.append(_Product(f"profile {name}", [f"profile-{name}.csv"]))
    found += _volumes(given["volume"] or [], given["heights"])
    if not found:
        raise Failure(
            "give one or more of --contours, --bands, --dem, --profile and --volume", Exit.USAGE
        )
    return found


def _volumes(texts: list[str], heights: dict[str, float | None]) -> list[_Product]:
    """Return the volumes to heights and surfaces; if there are several, each has a name."""
    names = _distinct([Path(text).stem if heights[text] is None else text for text in texts])
    found = []
    for text, name in zip(texts, names, strict=True):
        height = heights[text]
        told = {"surface": Path(text).name} if height is None else {"height": height}
        found.append(_Product("volume" if len(texts) == 1 else f"volume {name}", [], told))
    return found


def _distinct(given: list[str]) -> list[str]:
    """Return the names, with a number appended to repeated ones."""
    names: list[str] = []
    for stem in given:
        name, number = stem, 2
        # Terminates, because there are finitely many names.
        while name in names:
            name, number = f"{stem} {number}", number + 1
        names.append(name)
    return names


def _goal(
    text: str,
    height: float | None,
    options: SurfaceOptions,
    watch: Stopwatch,
    say: Callable[[str], None],
) -> float | TIN:
    """Return the height or the surface of a volume."""
    return other_surface(Path(text), options, watch, say) if height is None else height


@contextmanager
def _folder(folder: Path, products: Sequence[_Product], inputs: list[Path]) -> Iterator[None]:
    """Make the folder, and remove it again if nothing is written."""
    require("matplotlib", extra="plot", what="drawing the page")
    with writing():
        if folder.exists() and not folder.is_dir():
            raise NotADirectoryError(f"{folder} is not a folder")
        new = not folder.exists()
        folder.mkdir(exist_ok=True)
    try:
        _check(folder, products, inputs)
        yield
    finally:
        # A run that fails before its first file leaves nothing behind.
        if new and not any(folder.iterdir()):
            folder.rmdir()


def _check(folder: Path, products: Sequence[_Product], inputs: list[Path]) -> None:
    """Check that all files can be written before any work is done."""
    files = [folder / name for product in products for name in product.files]
    protect_inputs([*files, folder / "index.html"], *inputs)
    with writing():
        for path in files:
            if path.suffix == ".gpkg":
                ready_table(path, "contours")
            elif path.suffix == ".tif":
                raster_writer(path)
    ready_profile([path for path in files if path.suffix == ".csv"], inputs, _NO_SECTIONS)


def _computed(
    tin: TIN, given: dict[str, Any], shades: list[str], lines: Sequence[Any]
) -> list[Callable[[], Any]]:
    """Return what computes each product, in the order of `_wanted`."""
    found: list[Callable[[], Any]] = []
    if given["contours"] is not None:
        options = {name: given[name] for name in ("smooth", "min_length", "min_area", "simplify")}
        found.append(lambda: tin.contours(interval=given["contours"], **options))
    if given["bands"] is not None:
        areas = {name: given[name] for name in ("min_area", "simplify")}
        found.append(lambda: tin.bands(interval=given["bands"], **areas))
    if given["dem"] is not None:
        cells = given["dem"]
        measures = ["height", *shades]
        found += [partial(tin.raster, what, resolution=cells) for what in measures]
    found += [partial(tin.profile, line) for line in lines]
    found += [partial(tin.volume_to, goal) for goal in given["volume"]]
    return found


def _write(
    product: _Product, place: Path, tin: TIN, watch: Stopwatch, say: Callable[[str], None]
) -> None:
    """Write the file of a product as its separate command does, and keep its figures."""
    found, name = product.found, product.name
    files = [place / each for each in product.files]
    if name in ("contours", "bands"):
        write_lines([(found, files, name)], watch)
        what = "lines" if name == "contours" else "polygons"
        levels = found.level if name == "contours" else found.low
        left_out = {
            "triangles left out": found.left_out,
            "short left out": getattr(found, "short", 0),
            "small left out": found.small,
            "points left out": getattr(found, "straightened", 0),
        }
        product.figures = {
            what: len(found),
            "levels": len(np.unique(levels)),
            "coordinates": len(found.points),
            **{key: count for key, count in left_out.items() if count},
        }
    elif name in ("dem", *_SHADES):
        measure = "height" if name == "dem" else name
        unit = {"dem": tin.units, "slope": "degrees", "aspect": "degrees"}.get(name)
        writers = {path: raster_writer(path) for path in files}
        write_all(writers, found, watch, say, name=measure, crs=tin.crs, units=unit)
        known = found.values[np.isfinite(found.values)]
        product.figures = {
            "columns": len(found.x),
            "rows": len(found.y),
            "without value": int(found.values.size - known.size),
            "least": float(known.min()) if known.size else None,
            "greatest": float(known.max()) if known.size else None,
        }
    elif product.goal is not None:
        product.figures |= {
            each: getattr(found, each)
            for each in ("cut", "fill", "net", "area", "volume_units", "area_units")
        }
    else:
        write_profile(found, files, watch, _NO_SECTIONS)
        product.figures = profile_figures(found)


def _rows(figures: dict[str, Any], before: str = "") -> list[tuple[str, str]]:
    """Return figures as texts."""
    units = {"cut": "volume_units", "fill": "volume_units", "net": "volume_units"}
    units["area"] = "area_units"
    rows = []
    for name, value in figures.items():
        if value is None or name in units.values() or isinstance(value, list | dict):
            continue
        form = {float: ".10g", int: ","}.get(type(value), "")
        unit = figures.get(units.get(name, ""))
        text = f"{value:{form}}" + (f" {unit}" if unit else "")
        rows.append((before + name.replace("_", " "), text))
    return rows


def _overview(source: Path, tin: TIN, cells: Grid) -> Section:
    """Return the section on the surface itself: a shaded map, colored by height."""
    low, high = float(tin.z.min()), float(tin.z.max())
    figures = figures_of(source, tin, [])
    told = {key: value for key, value in figures.items() if key not in _NOT_TOLD}
    bounds = np.stack((tin.min_bound, tin.max_bound)).T.tolist()
    told |= {
        "heights": f"{low:.6g} to {high:.6g}" + (f" {tin.units}" if tin.units else ""),
        **{axis: f"{a:.10g} to {b:.10g}" for axis, (a, b) in zip("xy", bounds, strict=True)},
        "input": source.name,
    }
    label = "height" + (f" ({tin.units})" if tin.units else "")
    picture = _drawn(lambda ax: cells.plot(ax, shade=True, label=label), wide=6.0)
    alt = f"Map of the heights of {source.name}, shaded"
    return Section("Surface", _rows(told), picture, alt)


_NOT_TOLD = ("input", "delone", "outputs", "output_bytes", "peak_memory_bytes")


def _section(tin: TIN, product: _Product, cells: Grid) -> Section:
    """Return the section on a product; `cells` are the heights on maps."""
    found, name = product.found, product.name
    files, rows = product.files, _rows(product.figures)
    title = {"dem": "DEM"}.get(name, name[:1].upper() + name[1:])
    draw: Callable[[Any], Any] = found.plot if hasattr(found, "plot") else found
    wide, high, alt = 6.0, None, f"Map of the {title}"
    if product.goal is not None:
        gaps = difference(cells, product.goal, crs=tin.crs, units=tin.units)
        if not np.isfinite(gaps.values).any():
            return Section(title, rows)
        draw = gaps.plot
        level = "level" if "height" in product.figures else "other surface"
        alt = f"Map of what is above the {level} in red, which is to be cut, and below it in blue"
    elif name in ("dem", *_SHADES):
        if not np.isfinite(found.values).any():
            return Section(title, rows, files=files)
        options = {"hillshade": {"cmap": "gray"}, "aspect": {"cmap": "twilight"}}.get(name, {})
        height = "height" + (f" ({tin.units})" if tin.units else "")
        label = {"dem": height, "hillshade": "brightness"}.get(name, f"{name} in degrees")
        draw = partial(found.plot, label=label, **options)
    elif name == "contours":
        size = float((tin.max_bound - tin.min_bound).max()) / (2 * _CELLS)
        draw = partial(_draw_contours, found, size)
    elif name != "bands":
        wide, high, alt = 9.0, 3.0, "Height over distance along the line"
    return Section(title, rows, _drawn(draw, wide=wide, high=high), alt, files)


def _draw_contours(found: Contours, size: float, ax: Any) -> None:
    """Draw contours, index contours wider, without the points that a picture cannot show.

    Of consecutive points in a square of this size only the first is drawn, and the ends of lines.
    Many lines are one artist, because matplotlib takes longer for artists than for points.
    """
    square = np.floor(found.points / size)
    drawn = np.ones(len(square), dtype=bool)
    drawn[1:] = (square[1:] != square[:-1]).any(axis=1)
    drawn[found.starts[:-1]] = drawn[found.starts[1:] - 1] = True
    line = np.repeat(np.arange(len(found)), np.diff(found.starts))
    for wide in (False, True):
        rows = np.flatnonzero(drawn & (found.index[line] == wide))
        breaks = np.flatnonzero(np.diff(line[rows])) + 1
        # NaN lifts the pen between two lines.
        points = np.insert(found.points[rows], breaks, np.nan, axis=0)
        runs = [points[start : start + _RUN] for start in range(0, len(points), _RUN - 1)]
        plot_lines(runs, np.full(len(runs), 1.2 if wide else 0.5), ax)


def _drawn(draw: Callable[[Any], Any], *, wide: float, high: float | None = None) -> bytes | None:
    """Return a picture as the bytes of a PNG file; None, with a warning, if it cannot be drawn."""
    figures = require("matplotlib.figure", extra="plot", what="drawing the page")
    size = wide, wide * 0.8 if high is None else high
    figure = figures.Figure(figsize=size, dpi=130, layout="constrained")
    ax = figure.add_subplot()
    try:
        draw(ax)
    except InputError as error:
        # The products are written, and the page has their numbers.
        warnings.warn(f"the page omits a plot: {error}", stacklevel=2)
        return None
    ax.ticklabel_format(useOffset=False, style="plain")
    # Coordinates of maps are long, and maps may be narrow.
    ax.locator_params(axis="x", nbins=4 if high is None else 9)
    target = BytesIO()
    figure.savefig(target, format="png", facecolor="white")
    return target.getvalue()
