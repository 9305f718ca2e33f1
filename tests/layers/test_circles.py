"""No file of Rust waits for itself: the modules of a crate know each other one way.

Paths are read from the sources, in `use` and in expressions, and followed through what a module
exports again to the file that defines it; a folder that merely exports what its files define knows
none of them. Tests inside a file do not count.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

import pytest

CRATES = Path(__file__).parents[2] / "crates"

# A module by its words: ("voronoi", "dual"); the root of a crate has none.
Module = tuple[str, ...]

USE = re.compile(r"(\bpub(?:\([\w\s]*\))?\s+)?\buse\s+([^;]+);")
PATH = re.compile(r"(?<![\w:])[a-z_0-9]+(?:::\w+)+")


def code_of(path: Path) -> str:
    """Source without comments, strings and the tests at its end."""
    text = re.sub(r"//[^\n]*", "", path.read_text(encoding="utf-8"))
    text = re.sub(r'"(\\.|[^"\\])*"', '""', text, flags=re.DOTALL)
    return re.split(r"#\[cfg\(test\)\]\s*mod\b", text)[0]


def branches(tree: str) -> list[list[str]]:
    """The paths of a use tree: `a::{b, c::d}` has a::b and a::c::d."""
    tree = tree.strip()
    split = re.fullmatch(r"((?:\w+::)*)\{(.*)\}", tree, flags=re.DOTALL)
    if not split:
        return [re.split("::", re.split(r"\s", tree)[0])] if tree else []
    stem = [word for word in split[1].split("::") if word]
    parts, depth = [""], 0
    for letter in split[2]:
        depth += {"{": 1, "}": -1}.get(letter, 0)
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return [stem + path for part in parts for path in branches(part)]


class Crate(NamedTuple):
    """The modules of a crate with their code, and what each exports again."""

    code: dict[Module, str]
    exports: dict[tuple[Module, str], tuple[Module, list[str]]]

    @classmethod
    def of(cls, source: Path) -> Crate:
        code = {}
        for path in sorted(source.rglob("*.rs")):
            words = path.relative_to(source).with_suffix("").parts
            code[words[:-1] if words[-1] in ("mod", "lib") else words] = code_of(path)
        crate = cls(code, {})
        for module, text in code.items():
            for public, tree in USE.findall(text):
                for path in branches(tree) if public else ():
                    if start := crate.start(module, path):
                        crate.exports[module, path[-1]] = start
        return crate

    def start(self, module: Module, path: list[str]) -> tuple[Module, list[str]] | None:
        """Where a path in a module begins; nothing where that is in no module of the crate."""
        first, *rest = path
        if first == "crate":
            return (), rest
        if first == "self":
            return module, rest
        if first == "super":
            up = next((i for i, word in enumerate(path) if word != "super"), len(path))
            return module[: len(module) - up], path[up:]
        return (module, path) if (*module, first) in self.code else None

    def home(self, module: Module, rest: list[str]) -> Module:
        """The module that defines what a path leads to."""
        while rest:
            if (*module, rest[0]) in self.code:
                module, rest = (*module, rest[0]), rest[1:]
            elif (module, rest[0]) in self.exports:
                start, names = self.exports[module, rest[0]]
                module, rest = start, names + rest[1:]
            else:
                break
        return module

    def uses(self, module: Module) -> set[Module]:
        text = self.code[module]
        trees = [tree for public, tree in USE.findall(text) if not public]
        paths = [path for tree in trees for path in branches(tree)]
        paths += [path.split("::") for path in PATH.findall(USE.sub("", text))]
        starts = [self.start(module, path) for path in paths]
        return {self.home(*start) for start in starts if start and start[1]} - {module}


def circle(source: Path) -> list[str]:
    """The modules left when all have gone that wait for none of the others."""
    crate = Crate.of(source)
    left = {module: crate.uses(module) for module in crate.code}
    while True:
        free = {module for module, to in left.items() if not to & left.keys()}
        wanted = {to for module in left for to in left[module]}
        # Neither what waits for nothing nor what nothing waits for is on a circle.
        free |= left.keys() - wanted
        if not free:
            return sorted("/".join(module) for module in left)
        left = {module: to for module, to in left.items() if module not in free}


@pytest.mark.parametrize("name", ["predicates", "core", "bindings"])
def test_no_file_waits_for_itself(name: str) -> None:
    assert circle(CRATES / name / "src") == []


def test_uses_are_followed_to_where_things_are_defined() -> None:
    crate = Crate.of(CRATES / "core" / "src")
    assert crate.uses(("voronoi", "space", "dual")) >= {
        ("voronoi", "given"),
        ("voronoi", "space", "ridges"),
        ("base", "error"),
    }
    assert ("voronoi",) not in crate.uses(("voronoi", "space", "dual"))


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("use super::b::B;\npub struct A;", "use super::a::A;\npub struct B;"),
        ("use super::{b::{B, C}, d};\npub struct A;", "pub struct B(crate::A);"),
        ("pub struct A(super::b::B);", "fn f() { crate::a::g::<3>() }"),
    ],
)
def test_a_circle_is_found(first: str, second: str, tmp_path: Path) -> None:
    (tmp_path / "lib.rs").write_text("mod a;\nmod b;\nmod d;\npub use a::A;\npub use b::B;\n")
    (tmp_path / "a.rs").write_text(first)
    (tmp_path / "b.rs").write_text(second)
    (tmp_path / "d.rs").write_text("use crate::{A, B};\n// use crate::d;\n")
    expected = ["a", "b"] if "d}" not in first else ["a", "b", "d"]
    assert circle(tmp_path) == expected
    (tmp_path / "b.rs").write_text("pub struct B;\n#[cfg(test)]\nmod tests { use crate::A; }\n")
    if "d}" not in first:
        assert circle(tmp_path) == []
