"""Checks the built pages: no request leaves them, pictures have texts, and the search finds words.

Run it after a build: ``python docs/check_site.py docs/_build/html``. Links to other sites are fine;
what a browser loads by itself (scripts, styles, fonts, pictures, frames) must be a file of the
site. Scripts are searched for calls that load a literal address of another site. The words that
users search for are in `TERMS`: the index of the search must have each.

With ``--live`` each figure that readers can change must have the compiled core next to it: nothing
half-alive is published.
"""

from __future__ import annotations

import json
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple
from urllib.parse import unquote, urlsplit

if TYPE_CHECKING:
    from collections.abc import Iterator

# What a browser fetches by itself, for each element; of `link`, see LOADED.
ADDRESSES = {
    "script": ("src",),
    "img": ("src", "srcset"),
    "source": ("src", "srcset"),
    "video": ("src", "poster"),
    "audio": ("src",),
    "track": ("src",),
    "iframe": ("src",),
    "frame": ("src",),
    "embed": ("src",),
    "object": ("data",),
    "input": ("src",),
    "use": ("href", "xlink:href"),
    "image": ("href", "xlink:href"),
    "body": ("background",),
    "form": ("action",),
}
# Kinds of `link` that are fetched; the others name pages.
LOADED = {
    "stylesheet",
    "icon",
    "shortcut",
    "apple-touch-icon",
    "mask-icon",
    "manifest",
    "preload",
    "modulepreload",
    "prefetch",
    "prerender",
    "preconnect",
    "dns-prefetch",
}
IN_STYLE = re.compile(r"""url\(\s*["']?([^"')]+)|@import\s+["']([^"']+)""")
IN_SCRIPT = re.compile(
    r"""(?:\bfetch|\bimport|importScripts|sendBeacon|new\s+Worker|\.open)\s*\(\s*["'`](?:GET["'`]\s*,\s*["'`])?"""
    r"""((?:https?:)?//[^"'`]+)"""
)
FILE_NAME = re.compile(r"\S+\.(png|jpe?g|svg|gif|webp)", re.IGNORECASE)

# What users search for, and the page that has it.
TERMS = {
    "delaunayn": "coming_from/matlab",
    "natural neighbour": "howto",
    "marching cubes": "howto",
    "blue noise": "howto",
    "hexahedral": "howto",
    "medial axis": "howto",
    "straight skeleton": "howto",
    "watershed": "howto",
    "flow accumulation": "howto",
    "cite": "howto",
    "changelog": "howto",
    "GPU": "howto",
    "conda": "howto",
    "convex decomposition": "howto",
    "simplify": "howto",
    "remesh": "howto",
    "geodesic": "howto",
    "zarr": "howto",
    "JavaScript": "howto",
    "isosurface": "howto",
}
# The compiled core, where figures load it.
CORE = Path("_static/learn/core/delone_web_bg.wasm")
# Of a word the index has the stem: "geodes" for "geodesic", "accumul" for "accumulation".
ENDING = 5
SHORTEST = 3


class Fault(NamedTuple):
    """What is wrong in a file."""

    file: Path
    line: int
    text: str


class Page(HTMLParser):
    """The addresses that a page loads, and the texts of its pictures."""

    def __init__(self) -> None:
        super().__init__()
        self.loads: list[tuple[int, str]] = []
        self.without_text: list[tuple[int, str]] = []
        self.cores: list[tuple[int, str]] = []
        self._style = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note what an element loads."""
        line = self.getpos()[0]
        values = {name: value or "" for name, value in attrs}
        self._style = tag == "style"
        if "data-core" in values:
            self.cores.append((line, values["data-core"]))
        names = ADDRESSES.get(tag, ())
        if tag == "link" and LOADED & set(values.get("rel", "").lower().split()):
            names = ("href",)
        for name in names:
            if name in values:
                self.loads += [(line, address) for address in _addresses(name, values[name])]
        self.loads += [(line, address) for address in _in_style(values.get("style", ""))]
        if tag == "img":
            text = values.get("alt", "").strip()
            if not text or FILE_NAME.fullmatch(text):
                self.without_text.append((line, values.get("src", "")))

    def handle_endtag(self, tag: str) -> None:
        """Leave a style element."""
        if tag == "style":
            self._style = False

    def handle_data(self, data: str) -> None:
        """Note what a style element loads."""
        if self._style:
            line = self.getpos()[0]
            self.loads += [(line, address) for address in _in_style(data)]


def _addresses(name: str, value: str) -> list[str]:
    """Return the addresses of an attribute; a set has several, each with its width."""
    if name != "srcset":
        return [value.strip()]
    return [part.split()[0] for part in value.split(",") if part.strip()]


def _in_style(text: str) -> list[str]:
    """Return the addresses in a style sheet."""
    return [first or second for first, second in IN_STYLE.findall(text)]


def fault_of(address: str, folder: Path, root: Path) -> str | None:
    """Return what is wrong with an address that a file in this folder loads, or None."""
    parts = urlsplit(address)
    if parts.scheme in ("data", "blob", "about", "javascript") or not (parts.path or parts.netloc):
        return None
    if parts.scheme or parts.netloc:
        return f"loads {address} from another site"
    path = unquote(parts.path)
    target = root / path.lstrip("/") if path.startswith("/") else folder / path
    return None if target.exists() else f"loads {address}, which is not there"


def check_page(file: Path, root: Path) -> Iterator[Fault]:
    """Yield the faults of a page."""
    page = Page()
    page.feed(file.read_text(encoding="utf-8"))
    for line, address in page.loads:
        fault = fault_of(address, file.parent, root)
        if fault:
            yield Fault(file, line, fault)
    for line, source in page.without_text:
        yield Fault(file, line, f"shows {source} without a text (alt) that describes it")


def check_style(file: Path, root: Path) -> Iterator[Fault]:
    """Yield the faults of a style sheet."""
    text = file.read_text(encoding="utf-8", errors="replace")
    for match in IN_STYLE.finditer(text):
        fault = fault_of(match[1] or match[2], file.parent, root)
        if fault and "another site" in fault:
            yield Fault(file, text.count("\n", 0, match.start()) + 1, fault)


def check_script(file: Path) -> Iterator[Fault]:
    """Yield the addresses of other sites that a script loads."""
    text = file.read_text(encoding="utf-8", errors="replace")
    for match in IN_SCRIPT.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        yield Fault(file, line, f"loads {match[1]} from another site")


def pages(root: Path) -> list[Path]:
    """Return the pages of a site; the theme also brings a template for Sphinx."""
    return [file for file in sorted(root.rglob("*.html")) if file.name != "webpack-macros.html"]


def _is_stem(stem: str, word: str) -> bool:
    """Whether a term of the index is, or may be, what is left of a word without its ending."""
    # "simplify" and "simplified" have the stem "simplifi".
    other = re.sub(r"y$", "i", word)
    return (word.startswith(stem) or stem == other) and len(stem) >= max(
        SHORTEST, len(word) - ENDING
    )


def found(index: dict[str, Any], term: str) -> set[str]:
    """Return the pages that a search finds: those with all words, or with an entry of the index."""
    names, pages = index["docnames"], set(range(len(index["docnames"])))
    for word in term.lower().split():
        hits: set[int] = set()
        for kind in ("terms", "titleterms"):
            for stem, places in index[kind].items():
                if _is_stem(stem, word):
                    hits |= {places} if isinstance(places, int) else set(places)
        pages &= hits
    for entry, places in index["indexentries"].items():
        if term.lower() in entry:
            pages |= {place[0] for place in places}
    return {names[page] for page in pages}


def check_search(root: Path) -> Iterator[Fault]:
    """Yield the words that the search does not find on their page."""
    file = root / "searchindex.js"
    text = file.read_text(encoding="utf-8")
    index = json.loads(text[text.index("(") + 1 : text.rindex(")")])
    for term, page in TERMS.items():
        if page not in found(index, term):
            yield Fault(file, 1, f"does not lead from {term!r} to {page}")


def check_live(root: Path) -> Iterator[Fault]:
    """Yield the figures without the compiled core; a site without such figures is also a fault."""
    number = 0
    for file in pages(root):
        page = Page()
        page.feed(file.read_text(encoding="utf-8"))
        number += len(page.cores)
        for line, there in page.cores:
            if there != "yes":
                yield Fault(file, line, "has a figure without the core: `make web` brings it")
    core = root / CORE
    if not number:
        yield Fault(root / "index.html", 1, "no page has a figure that readers can change")
    elif not core.is_file() or not core.stat().st_size:
        yield Fault(core, 1, "is missing: `make web` brings it")


def check(root: Path) -> Iterator[Fault]:
    """Yield all faults of a site."""
    for file in pages(root):
        yield from check_page(file, root)
    for file in sorted(root.rglob("*.css")):
        yield from check_style(file, root)
    for file in sorted(root.rglob("*.js")):
        yield from check_script(file)


def main() -> int:
    """Print the faults of a site; the exit code is 1 if there are any."""
    named = [argument for argument in sys.argv[1:] if argument != "--live"]
    root = Path(named[0] if named else "docs/_build/html")
    number = len(pages(root))
    if not number:
        print(f"{root} has no pages: build the site first", file=sys.stderr)
        return 2
    faults = [*check(root), *check_search(root)]
    half = list(check_live(root))
    if "--live" in sys.argv:
        faults += half
    elif half:
        print(
            f"left out: the core for {len(half)} figures, which show stored steps; make site has it"
        )
    for fault in faults:
        print(f"{fault.file.relative_to(root)}:{fault.line}: {fault.text}", file=sys.stderr)
    print(f"{root}: {number} pages, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
