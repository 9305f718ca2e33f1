"""How results become tables: medians, ratios, and the machine in words."""

import datetime
import platform
import statistics
from collections.abc import Iterable, Sequence
from pathlib import Path


def median(seconds: Iterable[float]) -> float:
    """Return the median of some seconds."""
    return statistics.median(seconds)


def seconds(value: float) -> str:
    """Write seconds with three figures that count."""
    return f"{value:.3g}" if value < 100 else f"{value:.0f}"


def ratio(value: float) -> str:
    """Write a ratio with what counts of it."""
    return f"{value:.2f}" if value < 10 else f"{value:.1f}" if value < 100 else f"{value:.0f}"


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table whose columns are aligned in plain text as well."""
    body = [list(row) for row in rows]
    width = [max(len(row[k]) for row in [list(head), *body]) for k in range(len(head))]
    line = "| " + " | ".join(cell.ljust(w) for cell, w in zip(head, width, strict=True)) + " |"
    rule = "|" + "|".join("-" * (w + 2) for w in width) + "|"
    rest = [
        "| " + " | ".join(cell.ljust(w) for cell, w in zip(row, width, strict=True)) + " |"
        for row in body
    ]
    return "\n".join([line, rule, *rest])


def processor() -> str:
    """Return the processor's name as the system has it."""
    try:
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


def machine() -> str:
    """Say in one line when and on what the figures were taken."""
    import os

    today = datetime.datetime.now(tz=datetime.UTC).date()
    return (
        f"{today}, {processor()}, {os.cpu_count()} cores, {platform.system()} {platform.machine()}"
    )
