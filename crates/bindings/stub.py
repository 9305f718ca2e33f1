"""Writes `python/delone/_core.pyi`, the types of the compiled module, from the bindings.

`python crates/bindings/stub.py` writes the file; a test compares it. What the source says is taken:
names, arguments with their defaults, types, and the comments that document them. Types of Rust
become types of Python by `WORDS` and by the rules of `Reader.python`. An alias of an untyped object
says in the first line of its comment what it is, between backticks: `Callable[[int], object]`.
"""

from __future__ import annotations

import re
import subprocess
import sys
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).parents[2]
SOURCES = ROOT / "crates" / "bindings" / "src"
STUB = ROOT / "python" / "delone" / "_core.pyi"
WIDTH = 100

HEAD = '''"""The compiled core. All arrays are C-contiguous; inputs must have the dtypes given here.

Written by crates/bindings/stub.py from the source of the bindings; changes here are lost.
"""

from collections.abc import Callable, Sequence
from typing import Final, Protocol, final

import numpy as np
from numpy.typing import NDArray
'''
WORDS = {
    **dict.fromkeys(("usize", "u64", "u32", "u8", "i64", "i32", "i8"), "int"),
    **dict.fromkeys(("str", "String", "&'static str"), "str"),
    **{"f64": "float", "bool": "bool", "()": "None", "PyAny": "object"},
}
DTYPES = {
    **{"bool": "bool_", "f64": "float64"},
    **{f"i{bits}": f"int{bits}" for bits in (8, 32, 64)},
    **{f"u{bits}": f"uint{bits}" for bits in (8, 32, 64)},
}
CODE = {"(": ")", "[": "]", "{": "}"}
# In types; in code it is also an operator.
TYPES = CODE | {"<": ">"}


def closing(text: str, start: int, brackets: dict[str, str] = CODE) -> int:
    """The index of the bracket that closes the one at `start`."""
    opened: list[str] = []
    for i in range(start, len(text)):
        if text[i] in brackets:
            opened.append(brackets[text[i]])
        elif opened and text[i] == opened[-1] and text[i - 1 : i + 1] not in ("->", "=>"):
            opened.pop()
            if not opened:
                return i
    raise ValueError(text[start : start + 80])


def split(text: str) -> list[str]:
    """The parts of a list between commas that are in no brackets."""
    parts, start, i = [], 0, 0
    while i < len(text):
        if text[i] in TYPES:
            i = closing(text, i, TYPES)
        elif text[i] == ",":
            parts.append(text[start:i])
            start = i + 1
        i += 1
    return [part.strip() for part in (*parts, text[start:]) if part.strip()]


def expanded(text: str, macros: dict[str, tuple[list[str], str]]) -> str:
    """`text` with what calls of macros that take one list of words stand for."""
    for found in re.finditer(r"^(\w+)!\(([^;{}]*)\);", text, re.MULTILINE):
        if found[1] not in macros:
            continue
        names, body = macros[found[1]]
        for name, value in zip(names, split(found[2]), strict=True):
            body = re.sub(rf"\${name}\b", value, body)
        text += textwrap.dedent(body)
    return text


# The comments, and the attributes, of an item.
COMMENTS = r"((?:^ *///[^\n]*\n)*)"
MARKS = r"((?:^ *#\[(?:[^\[\]]|\[[^\]]*\])*\]\n)*)"
MACRO = re.compile(r"macro_rules! (\w+) \{\s*\(((?:\s*\$\w+:\w+,?)+)\)\s*=> (?=\{)")
ALIAS = re.compile(
    COMMENTS + r"^(?:pub(?:\(crate\))? )?type (\w+)(?:<[^>]*>)? =\s*([^;]+);", re.MULTILINE
)
GIVEN = re.compile(
    COMMENTS + r"^#\[derive\(FromPyObject\)\]\n^pub struct (\w+)(?:<[^>]*>)?\s*(?=[({])",
    re.MULTILINE,
)
CLASS = re.compile(COMMENTS + MARKS + r"^pub struct (\w+)\s*(?=[({])", re.MULTILINE)
FIELD = re.compile(COMMENTS + r"^ *pub (\w+): (.+?),\n", re.MULTILINE)
FUNCTION = re.compile(COMMENTS + MARKS + r"^ *(?:pub )?fn (\w+)(?:<[^>(]*>)?(?=\()", re.MULTILINE)
EXPORTED = re.compile(r"#\[pymodule_export\]\s*use super::\w+::([^;]+);")


def macros_of(text: str) -> dict[str, tuple[list[str], str]]:
    """The macros of a file that take one list of words: their words and bodies."""
    made = {}
    for found in MACRO.finditer(text):
        body = text[found.end() + 1 : closing(text, found.end())]
        made[found[1]] = (re.findall(r"\$(\w+):", found[2]), body)
    return made


@dataclass
class Function:
    """A function or method: its lines without the indent."""

    name: str
    arguments: str
    returns: str
    doc: str
    marks: str = ""

    def lines(self) -> Iterator[str]:
        """Its declaration."""
        yield from (mark for mark in self.marks.split() if mark)
        body = docstring(self.doc, 4) if self.doc else " ..."
        yield f"def {self.name}({self.arguments}) -> {self.returns}:{body}"


@dataclass
class Class:
    """A class: its properties and its methods."""

    name: str
    doc: str
    parts: list[Function] = field(default_factory=list)


def docstring(text: str, indent: int) -> str:
    """Text between triple quotes, on a line of its own."""
    quoted = f'"""{text}"""'
    space = " " * indent
    if len(quoted) + indent + 4 > WIDTH:
        lines = textwrap.wrap(text, WIDTH - indent - 12)
        quoted = (
            f'"""{lines[0]}\n' + "".join(f"{space}{line}\n" for line in lines[1:]) + f'{space}"""'
        )
    return f"\n{space}{quoted}"


def comment(lines: str) -> str:
    """What `///` lines say, as one paragraph."""
    found = re.findall(r"^\s*/// ?(.*)$", lines, re.MULTILINE)
    text = " ".join(found).strip().replace("[`", "`").replace("`]", "`")
    return text.replace("\\", "\\\\")


class Reader:
    """The source of the bindings."""

    def __init__(self, folder: Path) -> None:
        texts = {path.stem: path.read_text("utf-8") for path in sorted(folder.glob("*.rs"))}
        arrays = re.search(r"macro_rules! made_of_arrays.*?\n\}\n", texts["results"], re.DOTALL)
        assert arrays
        self.macro = arrays[0]
        self.texts = {name: expanded(text, macros_of(text)) for name, text in texts.items()}
        self.texts["results"] = texts["results"].replace(arrays[0], "")
        whole = "\n".join(self.texts.values())
        # Functions and classes that the module contains.
        exported = EXPORTED.findall(texts["lib"])
        self.kept = {name for names in exported for name in split(names.strip("{}\n "))}
        self.aliases = self.read_aliases(whole)
        self.protocols: list[Class] = []
        self.read_given(whole)

    def read_aliases(self, text: str) -> dict[str, str]:
        """What `type` names, and what untyped ones are."""
        found: dict[str, str] = {}
        for lines, name, means in ALIAS.findall(text):
            said = re.match(r"`([^`]+)`", comment(lines))
            untyped = re.search(r"\bPy(Any|Tuple)\b", means)
            found.setdefault(name, f"={said[1]}" if said and untyped else means.strip())
        return found

    def read_given(self, text: str) -> None:
        """Arguments that are structures of arrays: tuples, or objects with attributes."""
        for found in GIVEN.finditer(text):
            inside = text[found.end() + 1 : closing(text, found.end())]
            if text[found.end()] == "(":
                self.aliases[found[2]] = f"({inside})"
                continue
            fields = re.findall(r"(\w+): ([^\n]+),\n", inside)
            parts = [Function(n, "self", self.python(t), "", "@property") for n, t in fields]
            self.protocols.append(Class(f"_{found[2]}", comment(found[1]), parts))
            self.aliases[found[2]] = f"=_{found[2]}"

    def python(self, rust: str, *, given: bool = False) -> str:  # noqa: PLR0911
        """The type of Python that a type of Rust is; `given` for an argument."""
        text = re.sub(r"'(?!static)\w+(?:,\s*)?", "", rust)
        text = re.sub(r"\s+", " ", text).strip().removeprefix("mut ")
        text = re.sub(r"<\s*>", "", re.sub(r"\w+::(?=\w)", "", text))
        text = text if text.startswith("&'static") else text.lstrip("& ")
        if text in WORDS:
            return WORDS[text]
        inner = text[text.index("<") + 1 : -1] if text.endswith(">") else ""
        parts = split(inner)
        head = text.partition("<")[0]
        if re.fullmatch(r"PyReadonlyArray\w*|PyArray\w*|Column|Table", head):
            return f"NDArray[np.{DTYPES[parts[0]]}]"
        if head == "Option":
            return f"{self.python(inner, given=given)} | None"
        if head in ("Outcome", "PyResult", "Py", "Bound", "PyRef"):
            return self.python(inner, given=given)
        if head == "Vec":
            return f"list[{self.python(inner)}]"
        if text.startswith("["):
            of = self.python(text[1:-1].split(";")[0], given=given)
            return f"Sequence[{of}]" if given else f"list[{of}]"
        if text.startswith("("):
            return f"tuple[{', '.join(self.python(t, given=given) for t in split(text[1:-1]))}]"
        if head in self.aliases:
            means = self.aliases[head]
            return means[1:] if means.startswith("=") else self.python(means, given=given)
        return head

    def arguments(self, text: str, marks: str) -> str:
        """The arguments of Python, with the defaults that a signature gives."""
        defaults: dict[str, str] = {}
        if found := re.search(r"signature = (?=\()", marks):
            inside = marks[found.end() + 1 : closing(marks, found.end())]
            for part in split(inside):
                name, equal, value = part.partition("=")
                if equal:
                    defaults[name] = {"false": "False", "true": "True"}.get(value, value)
        made = []
        for part in split(text):
            if re.fullmatch(r"&(mut )?self", part):
                made.append("self")
                continue
            name, _, kind = part.partition(":")
            name = name.strip().removeprefix("mut ").removeprefix("_")
            if re.match(r"Python\b", kind.strip()):
                continue
            default = f" = {defaults[name]}" if name in defaults else ""
            made.append(f"{name}: {self.python(kind, given=True)}{default}")
        return ", ".join(made)

    def functions(self, text: str, mark: str = "") -> Iterator[tuple[Function, str]]:
        """The functions of a text that have an attribute, with all of their attributes."""
        for found in FUNCTION.finditer(text):
            if mark not in found[2]:
                continue
            end = closing(text, found.end())
            after = re.match(r"\s*(?:-> (.*?))?\s*(?:\{|where\b)", text[end + 1 :], re.DOTALL)
            assert after, found[3]
            made = Function(
                found[3],
                self.arguments(text[found.end() + 1 : end], found[2]),
                self.python(after[1] or "()"),
                comment(found[1]),
            )
            yield made, found[2]

    def methods(self, text: str, name: str) -> Iterator[Function]:
        """The methods of a class."""
        for block in re.finditer(rf"#\[pymethods\]\nimpl {name} (?=\{{)", text):
            inside = text[block.end() : closing(text, block.end())]
            for made, marks in self.functions(inside):
                yield method(made, marks, name)
        if found := re.search(rf"made_of_arrays!\({name} (?=\{{)", text):
            inside = text[found.end() + 1 : closing(text, found.end())]
            fields = ", ".join(part for part in split(inside))
            body = self.macro.replace("$($field: $kind),+", fields)
            body = re.sub(r"\$\(.*?\),\+", "", body)
            for made, marks in self.functions(body[body.index("#[pymethods]") :]):
                yield method(made, marks, name)

    def classes(self) -> Iterator[Class]:
        """The classes of the module."""
        for text in self.texts.values():
            for found in CLASS.finditer(text):
                if "pyclass" not in found[2] or found[3] not in self.kept:
                    continue
                made = Class(found[3], comment(found[1]))
                if "get_all" in found[2]:
                    inside = text[found.end() + 1 : closing(text, found.end())]
                    for lines, name, kind in FIELD.findall(inside):
                        made.parts.append(
                            Function(name, "self", self.python(kind), comment(lines), "@property")
                        )
                made.parts += self.methods(text, made.name)
                yield made

    def module(self) -> Iterator[Function]:
        """The functions of the module."""
        for text in self.texts.values():
            for made, _ in self.functions(text, "#[pyfunction"):
                if made.name in self.kept:
                    yield made


def method(made: Function, marks: str, name: str) -> Function:
    """A method as Python declares it."""
    made.returns = re.sub(r"\bSelf\b", name, made.returns)
    made.arguments = re.sub(r"\bSelf\b", name, made.arguments)
    if "#[new]" in marks:
        made.name, made.marks = "__new__", ""
        made.arguments = f"cls, {made.arguments}" if made.arguments else "cls"
    elif "#[staticmethod]" in marks:
        made.marks = "@staticmethod"
    elif "#[getter]" in marks:
        made.marks = "@property"
    return made


def stub(folder: Path = SOURCES) -> str:
    """The whole file."""
    reader = Reader(folder)
    classes = sorted(reader.classes(), key=lambda made: made.name)
    functions = sorted(reader.module(), key=lambda made: made.name)
    found = {made.name for made in classes} | {made.name for made in functions}
    if (missing := reader.kept - found) or not found:
        raise SystemExit(f"stub.py does not find {', '.join(sorted(missing))} in {folder}")
    names = sorted(["__version__", *reader.kept], key=lambda name: (not name[0].isupper(), name))
    text = HEAD + "\n__all__ = [\n" + "".join(f'    "{name}",\n' for name in names) + "]\n\n"
    text += "__version__: Final[str]\n"
    for made in (*reader.protocols, *classes):
        private = made.name.startswith("_")
        head = f"class {made.name}(Protocol):" if private else f"@final\nclass {made.name}:"
        text += f"\n{head}{docstring(made.doc, 4)}\n\n"
        for part in made.parts:
            text += textwrap.indent("\n".join(part.lines()), "    ") + "\n"
    for function in functions:
        text += "\n" + "\n".join(function.lines()) + "\n"
    command = [sys.executable, "-m", "ruff", "format", "--stdin-filename", str(STUB), "-"]
    done = subprocess.run(command, input=text, capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(done.stderr)
    return done.stdout


if __name__ == "__main__":
    STUB.write_text(stub(), encoding="utf-8")
