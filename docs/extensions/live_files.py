"""The files of figures that the reader can change: their elements, stored answers, and the view."""

from __future__ import annotations

import json
import shutil
from html import escape
from pathlib import Path

import live_picture
import live_steps

FOLDER = "_static/learn"
STATIC = Path(__file__).parents[1] / FOLDER
EXPLORER = Path(__file__).parents[2] / "python" / "delone" / "explorer"

WITHOUT_SCRIPTS = "This page needs scripts."


def figure_html(name: str, alt: str, *, folder: str, live: bool) -> str:
    """Return the element of a figure on a page from which `folder` leads to the modules."""
    text = escape(alt, quote=True)
    return (
        f'<div class="live-figure" data-live="{name}" data-alt="{text}" '
        f'data-stored="{folder}/stored/{name}.json" data-core="{"yes" if live else "no"}">'
        f"{live_picture.svg(live_steps.stored(name), text)}</div>\n"
    )


def points_html(*, live: bool) -> str:
    """Return the element for points of the reader; without `live`, there is no compiled core."""
    return (
        f'<div class="live-figure try" data-try data-core="{"yes" if live else "no"}">'
        f'<p class="try-before">{WITHOUT_SCRIPTS}</p></div>\n'
    )


def write_answers(target: Path) -> None:
    """Write the stored answers of all figures."""
    (target / "stored").mkdir(parents=True, exist_ok=True)
    for name in live_steps.FIGURES:
        text = json.dumps(live_steps.stored(name), separators=(",", ":"))
        (target / "stored" / f"{name}.json").write_text(text, encoding="utf-8")


def copy_view(target: Path) -> None:
    """Copy the canvas view that the package shows its meshes with."""
    if EXPLORER.is_dir():
        (target / "view").mkdir(parents=True, exist_ok=True)
        for file in EXPLORER.glob("*.js"):
            shutil.copy(file, target / "view")
