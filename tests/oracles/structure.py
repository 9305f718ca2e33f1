"""The structure of the sources, read from their imports: files of Python and of the core.

Python is read with `ast`: every import counts, those inside functions and those for types included.
A name that a package exports again is followed to the file that defines it.
"""

from __future__ import annotations

import ast
from pathlib import Path
from typing import TypeAlias

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "python" / "delone"

# A file of Python by its dotted name, and the files that it imports.
Graph: TypeAlias = dict[str, set[str]]


def python_files(package: Path = PACKAGE) -> dict[str, Path]:
    """The files of a package by their dotted names; a folder is named like its `__init__`."""
    found = {}
    for path in sorted((*package.rglob("*.py"), *package.rglob("*.pyi"))):
        words = (package.name, *path.relative_to(package).with_suffix("").parts)
        found[".".join(words[:-1] if words[-1] == "__init__" else words)] = path
    return found


def python_graph(package: Path = PACKAGE) -> Graph:
    """What each file imports, wherever in the file, and for types alone, too."""
    files = python_files(package)
    trees = {name: ast.parse(path.read_text(encoding="utf-8")) for name, path in files.items()}
    exports = {
        (name, alias.asname or alias.name): (node.module, alias.name)
        for name, tree in trees.items()
        if files[name].stem == "__init__"
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.module
        for alias in node.names
    }

    def home(module: str, name: str) -> str:
        while f"{module}.{name}" not in files and (module, name) in exports:
            module, name = exports[module, name]
        return f"{module}.{name}" if f"{module}.{name}" in files else module

    graph: Graph = {}
    for file, tree in trees.items():
        found = set()
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and node.module:
                found |= {home(node.module, alias.name) for alias in node.names}
            elif isinstance(node, ast.Import):
                found |= {alias.name for alias in node.names}
        graph[file] = (found & set(files)) - {file}
    return graph


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
