"""Each error message is written once: other places call the function that has it."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from pathlib import Path
from typing import TYPE_CHECKING

import delone

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(delone.__file__).parent
# They check the package, and share no code with it.
INDEPENDENT = ("reference", "testing")
# Python's own messages, which a function of the module must raise.
OF_PYTHON = {"module {} has no attribute {}"}
# Messages with fewer words, such as "{}, got {}", are not compared.
FEWEST = 3
# What stands before "must be" is the name of an argument, and before a colon that of a file.
NAMED = re.compile(r"^(?:rows of )?[\w{}./-]+(?= must )|^[\w{}.-]+(?=: )")


def text_of(node: ast.expr) -> str | None:
    """The text of an expression, with {} for what is inserted; None for other expressions."""
    match node:
        case ast.Constant(value=str(text)):
            return text
        case ast.JoinedStr(values=parts):
            return "".join(text_of(part) or "{}" for part in parts)
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            parts = [text_of(left), text_of(right)]
            return "".join(part or "{}" for part in parts) if any(parts) else None
    return None


def messages(source: str) -> Iterator[tuple[int, str]]:
    """The messages of the exceptions that a module raises or returns, with their lines."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Raise | ast.Return):
            made = node.exc if isinstance(node, ast.Raise) else node.value
            name = made.func if isinstance(made, ast.Call) else None
            if isinstance(name, ast.Name) and name.id.endswith(("Error", "Failure")):
                found = [text for each in made.args[:1] if (text := text_of(each)) is not None]
                yield from ((node.lineno, NAMED.sub("{}", text)) for text in found)


def repeated(modules: dict[str, str]) -> dict[str, list[str]]:
    """The messages that occur more than once, and where."""
    places = defaultdict(list)
    for name, source in modules.items():
        for line, text in messages(source):
            if len(re.findall(r"[a-z]{2,}", text)) >= FEWEST and text not in OF_PYTHON:
                places[text].append(f"{name}:{line}")
    return {text: where for text, where in places.items() if len(where) > 1}


def test_no_error_is_worded_twice() -> None:
    modules = {str(path.relative_to(ROOT)): path.read_text("utf-8") for path in ROOT.rglob("*.py")}
    ours = {name: source for name, source in modules.items() if not name.startswith(INDEPENDENT)}
    assert sum(len(list(messages(source))) for source in ours.values()) > 900
    assert repeated(ours) == {}


def test_repeated_words_are_found() -> None:
    one = 'raise InputError(f"{name} must be above 0, got {value}")'
    two = 'def f():\n    return ShapeError("rows of size must be above 0, " + f"got {size!r:.60}")'
    three = 'raise InputError("tol must be finite")'
    assert repeated({"a": one, "b": two, "c": three}) == {
        "{} must be above 0, got {}": ["a:1", "b:2"]
    }
    assert repeated({"a": one}) == repeated({"a": one, "c": three}) == {}
    file = 'raise FileFormatError(f"{path}: it has no points")'
    assert len(repeated({"a": file, "b": file.replace("{path}", "{self.source}")})) == 1
