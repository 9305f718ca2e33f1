"""Output of the command: tables, JSON, and a spinner."""

from __future__ import annotations

import json
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from delone.cli.constraints import constraint_rows
from delone.cli.exits import Exit, Failure

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

__all__ = [
    "memory_text",
    "print_json",
    "print_report",
    "print_rows",
    "print_text",
    "show_figures",
    "space_rows",
    "spinner",
    "triangulation_rows",
]

Row = tuple[str, str]

# Longer than any line of a report: file names on Linux have up to 4096 bytes.
_UNBOUNDED = 1 << 16


def print_json(figures: dict[str, Any]) -> None:
    """Print figures without NaN and infinity as one JSON object on standard output."""
    print_text(json.dumps(figures, indent=2, allow_nan=False))


def print_rows(title: str, rows: list[Row]) -> None:
    """Print a table of two columns on standard output."""
    table = Table(show_header=False, box=None, pad_edge=False)
    table.add_column(style="dim", no_wrap=True)
    table.add_column()
    for name, value in rows:
        table.add_row(name, value)
    print_text(f"{_heading(title)}\n{_rendered(table)}")


def print_report(title: str, rows: list[Row], figures: dict[str, Any]) -> None:
    """Print rows, and what the figures of a command say about memory, outputs and stages."""
    peak = ("peak memory", memory_text(figures["peak_memory_bytes"]))
    print_rows(title, [*rows, peak, *(("written", path) for path in figures["outputs"])])
    _print_stages(figures["stages"])


def show_figures(
    title: str,
    figures: dict[str, Any],
    rows: Callable[[dict[str, Any]], list[Row]],
    *,
    as_json: bool,
    quiet: bool,
) -> None:
    """Print the figures of a command as JSON, or as rows with a title unless it is quiet."""
    if as_json:
        print_json(figures)
    elif not quiet:
        print_report(title, rows(figures), figures)


def _print_stages(stages: list[dict[str, Any]]) -> None:
    table = Table(box=None, pad_edge=False, header_style="dim")
    table.add_column("stage", no_wrap=True)
    table.add_column("seconds", justify="right")
    table.add_column("points per second", justify="right")
    for stage in stages:
        speed = stage["points_per_second"]
        table.add_row(
            stage["name"], f"{stage['seconds']:.3f}", "" if speed is None else f"{speed:,}"
        )
    print_text("\n" + _rendered(table))


def triangulation_rows(figures: dict[str, Any]) -> list[Row]:
    """Return the rows of the report of a triangulation from `report.summary`."""
    angle, area = figures["smallest_angle_degrees"], figures["area"]
    return [
        *_input_rows(figures),
        ("hull vertices", f"{figures['hull_vertices']:,}"),
        ("triangles", _against(figures["triangles"], "2n - h - 2")),
        ("edges", _against(figures["edges"], "3n - h - 3")),
        ("mean degree", f"{figures['mean_degree']:.4f}"),
        ("smallest angle", "beyond range" if angle is None else f"{angle:.6g} degrees"),
        (
            "area",
            "beyond range" if area is None else f"{area:,.6g}" if area < 1e6 else f"{area:,.0f}",
        ),
    ]


def space_rows(figures: dict[str, Any]) -> list[Row]:
    """Return the rows of the report from `solid.space_summary`."""
    volume = figures["volume"]
    return [
        *_input_rows(figures),
        ("hull vertices", f"{figures['hull_vertices']:,}"),
        ("hull faces", f"{figures['hull_faces']:,}"),
        ("tetrahedra", _against(figures["tetrahedra"], "n - edges + faces - 1")),
        ("edges", f"{figures['edges']['count']:,}"),
        ("faces", f"{figures['faces']['count']:,}"),
        ("mean degree", f"{figures['mean_degree']:.4f}"),
        ("volume", "beyond range" if volume is None else f"{volume:,.6g}"),
    ]


def memory_text(size: int | None) -> str:
    """Format a number of bytes in MiB."""
    return "unknown" if size is None else f"{size / 2**20:,.0f} MiB"


def _input_rows(figures: dict[str, Any]) -> list[Row]:
    if "constraints" in figures:
        given = figures["points"] - figures["constraints"]["added"]
        return [("points", f"{given:,}"), *constraint_rows(figures["constraints"])]
    return [
        ("points read", f"{figures['points']:,}"),
        ("distinct", f"{figures['distinct']:,}"),
        ("duplicates", _duplicates(figures["duplicates"])),
    ]


def _against(counted: dict[str, int | None], formula: str) -> str:
    count, expected = counted["count"], counted["expected"]
    if expected is None:
        return f"{count:,}"
    verdict = "=" if count == expected else f"IS NOT {expected:,} ="
    return f"{count:,} {verdict} {formula}"


def _duplicates(duplicates: dict[str, Any]) -> str:
    count, first = duplicates["count"], duplicates["first"]
    lines = [f"{count:,}"]
    for each in first:
        place = ", ".join(repr(each[axis]) for axis in "xyz" if axis in each)
        lines.append(f"row {each['row']} is row {each['same_as']} at ({place})")
    if count > len(first):
        lines.append("...")
    return "\n".join(lines)


def print_text(text: str) -> None:
    """Print text on standard output.

    If that is closed, the failure has an empty message, because nothing can be reported there.
    """
    try:
        print(text, flush=True)
    except BrokenPipeError:
        raise Failure("", Exit.PIPE) from None


def _heading(title: str) -> str:
    # Never truncated, so that the name of a file can be copied and searched for.
    console = _console()
    with console.capture() as captured:
        console.print(Text(title, style="italic"), soft_wrap=True, end="")
    heading: str = captured.get()
    return heading


def _rendered(table: Table) -> str:
    console = _console()
    with console.capture() as captured:
        console.print(table)
    return "\n".join(line.rstrip() for line in captured.get().splitlines())


def _console() -> Console:
    # Reports are also read from files and pipes, where lines may have any length.
    width = None if sys.stdout.isatty() else _UNBOUNDED
    return Console(highlight=False, markup=False, width=width)


@contextmanager
def spinner(quiet: bool) -> Iterator[Callable[[str], None]]:
    """Yield a function that shows the current step on standard error, if that is a terminal."""
    console = Console(stderr=True)
    if quiet or not console.is_terminal:
        yield lambda _: None
        return
    with console.status("") as status:
        yield lambda text: status.update(f"{text} ...")
