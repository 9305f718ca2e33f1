"""The structure of the sources, read from their imports and from the heads of files.

Python is read with `ast`: every import counts, those inside functions and those for types included.
A name that a package exports again is followed to the file that defines it.
"""

from __future__ import annotations

import ast
import itertools
import re
import textwrap
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "python" / "delone"
CORE = ROOT / "crates" / "core" / "src"
PAGE = ROOT / "architecture" / "map.md"

# A file of Python by its dotted name, and the files that it imports.
Graph: TypeAlias = dict[str, set[str]]


def python_files(package: Path = PACKAGE) -> dict[str, Path]:
    """The files of a package by their dotted names; a folder is named like its `__init__`."""
    found = {}
    for path in sorted((*package.rglob("*.py"), *package.rglob("*.pyi"))):
        words = (package.name, *path.relative_to(package).with_suffix("").parts)
        found[".".join(words[:-1] if words[-1] == "__init__" else words)] = path
    return found


class Import(NamedTuple):
    """What one name of an import statement says; `name` is None for ``import module``."""

    module: str
    name: str | None
    known_as: str
    level: int = 0


@cache
def imports(text: str) -> tuple[Import, ...]:
    """All imports of a source, wherever in it. Tests ask for the same sources again and again."""
    found = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom):
            module = node.module or ""
            found += [Import(module, a.name, a.asname or a.name, node.level) for a in node.names]
        elif isinstance(node, ast.Import):
            found += [Import(a.name, None, a.asname or a.name) for a in node.names]
    return tuple(found)


def python_graph(package: Path = PACKAGE) -> Graph:
    """What each file imports, wherever in the file, and for types alone, too."""
    files = python_files(package)
    found = {name: imports(path.read_text(encoding="utf-8")) for name, path in files.items()}
    exports = {
        (name, each.known_as): (each.module, each.name)
        for name, each_import in found.items()
        if files[name].stem == "__init__"
        for each in each_import
        if each.name is not None
    }

    def home(module: str, name: str) -> str:
        while f"{module}.{name}" not in files and (module, name) in exports:
            module, name = exports[module, name]
        return f"{module}.{name}" if f"{module}.{name}" in files else module

    return {
        file: {
            each.module if each.name is None else home(each.module, each.name) for each in listed
        }
        & set(files) - {file}
        for file, listed in found.items()
    }


def knots(graph: Graph) -> list[list[str]]:
    """The sets of files that import each other in circles, the largest first (R. Tarjan, 1972)."""
    index: dict[str, int] = {}
    low: dict[str, int] = {}
    stack: list[str] = []
    found: list[list[str]] = []

    def visit(start: str) -> None:
        path = [(start, iter(sorted(graph[start])))]
        index[start] = low[start] = len(index)
        stack.append(start)
        while path:
            node, rest = path[-1]
            to = next(rest, None)
            if to is None:
                path.pop()
                if path:
                    low[path[-1][0]] = min(low[path[-1][0]], low[node])
                if low[node] == index[node]:
                    cut = stack.index(node)
                    if len(stack) - cut > 1:
                        found.append(sorted(stack[cut:]))
                    del stack[cut:]
            elif to not in index:
                index[to] = low[to] = len(index)
                stack.append(to)
                path.append((to, iter(sorted(graph[to]))))
            elif to in stack:
                low[node] = min(low[node], index[to])

    for node in graph:
        if node not in index:
            visit(node)
    return sorted(found, key=len, reverse=True)


def sentence(text: str) -> str:
    """The first sentence of a text, or all of it, on one line without a full stop."""
    words = " ".join(text.split())
    return re.split(r"(?<=[^.])\.(?: |$)", words)[0]


def python_summary(path: Path) -> str:
    """What a module of Python says first of itself."""
    return sentence(ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or "")


def rust_summary(path: Path) -> str:
    """What a module of Rust says first of itself."""
    lines = itertools.takewhile(
        lambda line: line.startswith("//!") and line != "//!",
        path.read_text(encoding="utf-8").splitlines(),
    )
    return sentence(" ".join(line[3:] for line in lines))


def parts_of(graph: Graph) -> Graph:
    """What the parts of a package import of each other: modules and folders just below it."""
    found: Graph = {}
    for file, targets in graph.items():
        part = _part(file)
        found.setdefault(part, set()).update(_part(to) for to in targets)
    return {part: to - {part} for part, to in found.items()}


def _part(file: str) -> str:
    words = file.split(".")
    return words[1] if len(words) > 1 else words[0]


def levels(graph: Graph) -> list[list[str]]:
    """Parts in layers: each imports only parts of the layers before its own.

    Parts that import each other in a circle share a layer.
    """
    together = {part: tuple(knot) for knot in knots(graph) for part in knot}
    level: dict[str, int] = {}

    def of(part: str) -> int:
        if part not in level:
            group = set(together.get(part, (part,)))
            below = {to for each in group for to in graph[each] if to in graph} - group
            found = 1 + max((of(to) for to in below), default=-1)
            level.update(dict.fromkeys(group, found))
        return level[part]

    for part in graph:
        of(part)
    rows: list[list[str]] = [[] for _ in range(max(level.values()) + 1)]
    for part in sorted(graph):
        rows[level[part]].append(part)
    return rows


class Part(NamedTuple):
    """A part of the core or of the package: where it is and what it says of itself."""

    place: str
    summary: str


def core_parts() -> dict[str, Part]:
    """The modules of the core by name."""
    found = {}
    for path in sorted(CORE.iterdir()):
        head = path / "mod.rs" if path.is_dir() else path
        if path.stem != "lib":
            place = f"crates/core/src/{path.name}{'/' if path.is_dir() else ''}"
            found[path.stem] = Part(place, rust_summary(head))
    return found


def python_parts() -> dict[str, Part]:
    """The modules and folders of the package by name."""
    found = {}
    for path in sorted(PACKAGE.iterdir()):
        head = path / "__init__.py" if path.is_dir() else path
        if head.suffix == ".py" and head.exists() and path.name != "__init__.py":
            place = f"python/delone/{path.name}{'/' if path.is_dir() else ''}"
            found[path.stem] = Part(place, python_summary(head))
    return found


def drawn(core: Graph) -> str:
    """The map of the core and of the package, as a text for the page with the map."""
    package = {part: to for part, to in parts_of(python_graph()).items() if part != "delone"}
    text = [
        _chart("Modules of the core: each uses only modules on lines above its own", core),
        _table(core_parts(), core),
        _chart(
            "Parts of the package: each imports parts on its own line or on lines above it",
            package,
        ),
        _table(python_parts(), package),
        "Files of the crates, by their first sentences.",
        _files((ROOT / "crates").glob("*/src"), "*.rs", rust_summary),
        "Files of the package, by their first sentences.",
        _files([PACKAGE], "*.py", python_summary),
    ]
    return "\n\n".join(text)


def _chart(title: str, graph: Graph) -> str:
    indent = " " * 4
    rows = (
        textwrap.fill("  ".join(row), 100, initial_indent=f"{i:2}  ", subsequent_indent=indent)
        for i, row in enumerate(levels({part: to & set(graph) for part, to in graph.items()}))
    )
    return "\n".join((f"{title}.", "", "```text", *rows, "```"))


def _table(parts: dict[str, Part], graph: Graph) -> str:
    rows = ["| path | contents | uses |", "|---|---|---|"]
    for name, part in parts.items():
        uses = ", ".join(sorted(graph.get(name, set()) & set(parts)))
        summary = part.summary.replace("|", "\\|")
        rows.append(f"| `{part.place}` | {summary} | {uses} |")
    return "\n".join(rows)


def _files(folders: Iterable[Path], pattern: str, summary: Callable[[Path], str]) -> str:
    """A table of all files in folders, with what each says of itself."""
    rows = ["| file | contents |", "|---|---|"]
    for path in sorted(path for folder in folders for path in folder.rglob(pattern)):
        if said := summary(path):
            rows.append(f"| `{path.relative_to(ROOT)}` | {said.replace('|', chr(92) + '|')} |")
    return "\n".join(rows)


BEGIN, END = "<!-- map: made by `make map` -->\n", "<!-- end of the map -->\n"


def with_map(page: str, text: str) -> str:
    """A page with the map between its marks replaced."""
    before, rest = page.split(BEGIN)
    return f"{before}{BEGIN}\n{text}\n\n{END}{rest.split(END)[1]}"


def core_graph() -> Graph:
    """What each module of the core uses of the others, wherever in its files."""
    found: Graph = {name: set() for name in core_parts()}
    for path in CORE.rglob("*.rs"):
        part = path.relative_to(CORE).parts[0].removesuffix(".rs")
        if part != "lib":
            found[part] |= used_modules(path) & set(found) - {part}
    return found


def rust_text(path: Path) -> str:
    """Source without comments and strings."""
    return _code(path.read_text(encoding="utf-8"))


@cache
def _code(text: str) -> str:
    text = re.sub(r"//[^\n]*", "", text)
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    return re.sub(r'"(\\.|[^"\\])*"', '""', text)


def first_words(tree: str) -> list[str]:
    """First words of the paths in a use tree: `{a::b, c}` has a and c."""
    if not tree.startswith("{"):
        return re.findall(r"^\w+", tree)
    words, depth, start = [], 0, 1
    for i, letter in enumerate(tree):
        depth += {"{": 1, "}": -1}.get(letter, 0)
        if (letter == "," and depth == 1) or depth == 0:
            words += re.findall(r"^\w+", tree[start:i].strip())
            start = i + 1
        if depth == 0:
            break
    return words


def used_modules(path: Path, within: str = "") -> set[str]:
    """Modules of the same crate, or of one module of it, that a file of Rust mentions in paths."""
    return set(_mentioned(rust_text(path), f"crate::{within}::" if within else "crate::"))


@cache
def _mentioned(text: str, start: str) -> frozenset[str]:
    return frozenset(
        word
        for match in re.finditer(rf"\b{start}", text)
        for word in first_words(text[match.end() :])
    )


if __name__ == "__main__":
    PAGE.write_text(
        with_map(PAGE.read_text(encoding="utf-8"), drawn(core_graph())), encoding="utf-8"
    )
