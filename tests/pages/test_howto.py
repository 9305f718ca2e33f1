"""Calls on the page "How do I ...?" name what exists: attributes, options, modules, commands."""

from __future__ import annotations

import ast
import importlib
import importlib.util
import inspect
import re
import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import delone
import delone.interpolate
import delone.terrain

if TYPE_CHECKING:
    from collections.abc import Callable

PAGE = Path(__file__).parents[2] / "docs" / "howto.rst"
LITERALS = list(dict.fromkeys(re.findall(r"``([^`]+)``", PAGE.read_text(encoding="utf-8"))))
COMMANDS = [text for text in LITERALS if text.startswith("delone ")]
# What the head of the page says that these names are, and what its calls bind.
KINDS: dict[str, Any] = {
    "delone": delone,
    "mesh": delone.Delaunay,
    "constrained": delone.ConstrainedDelaunay,
    "elements": delone.Mesh,
    "raster": delone.interpolate.Grid,
    "tin": delone.terrain.TIN,
}
UNKNOWN = object()


def attribute(owner: Any, name: str) -> Any:
    """An attribute of a module or class; a submodule is imported, as `import delone.io` does."""
    if inspect.ismodule(owner) and not hasattr(owner, name):
        return importlib.import_module(f"{owner.__name__}.{name}")
    if not hasattr(owner, name):
        annotated = {key for base in owner.__mro__ for key in getattr(base, "__annotations__", {})}
        assert name in annotated, f"{owner.__name__} has no {name}"
        return UNKNOWN
    return getattr(owner, name)


def kind(node: ast.expr) -> Any:
    """The module, class or function that an expression names; a class also for its instances."""
    if isinstance(node, ast.Name):
        return KINDS.get(node.id, UNKNOWN)
    if isinstance(node, ast.Attribute):
        owner = kind(node.value)
        known = inspect.ismodule(owner) or inspect.isclass(owner)
        return attribute(owner, node.attr) if known else UNKNOWN
    if isinstance(node, ast.Call):
        called = kind(node.func)
        return called if inspect.isclass(called) else UNKNOWN
    return UNKNOWN


def check_keywords(call: ast.Call, called: Callable[..., Any]) -> None:
    parameters = inspect.signature(called).parameters
    passed_on = [each.name for each in parameters.values() if each.kind is each.VAR_KEYWORD]
    # `Delaunay` takes unknown options to name them in its error; others pass options on.
    if passed_on and passed_on != ["unknown"]:
        return
    unknown = {word.arg for word in call.keywords} - set(parameters)
    assert not unknown, f"{called.__name__} has no {unknown}"


def check(text: str) -> int:
    """Check each name of delone in the text of a call; return how many there are."""
    checked = 0
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("delone"):
            module = importlib.import_module(node.module or "")
            for each in node.names:
                attribute(module, each.name)
                checked += 1
        elif isinstance(node, ast.Import):
            for each in node.names:
                # Not imported: it may need an extra.
                assert importlib.util.find_spec(each.name), each.name
                checked += 1
        elif isinstance(node, ast.Attribute | ast.Call):
            found = kind(node.func if isinstance(node, ast.Call) else node)
            checked += found is not UNKNOWN
            if isinstance(node, ast.Call) and callable(found):
                check_keywords(node, found)
    return checked


def calls() -> list[str]:
    """The literals that are Python."""
    found = []
    for text in LITERALS:
        try:
            ast.parse(text)
        except SyntaxError:
            continue
        found.append(text)
    return found


@pytest.mark.parametrize("text", calls())
def test_names_and_keywords_exist(text: str) -> None:
    check(text)


def test_most_calls_are_checked() -> None:
    """Calls on names that the page does not define would pass without a look."""
    assert sum(check(text) > 0 for text in calls()) > 100
    others = set(LITERALS) - set(calls()) - set(COMMANDS)
    assert [text for text in others if not text.startswith((".", "pip install "))] == []


@pytest.mark.parametrize(
    "text",
    [
        "mesh.neighbours",
        "delone.Delaunay(points).nearby",
        "delone.nothing(points)",
        "delone.Delaunay(points, helpers=2)",
        "delone.mesh(polygon, minimum_angle=30)",
        "from delone.compat.scipy import Delauny",
        "delone.terrain.TIN.from_nothing(points)",
    ],
)
def test_a_wrong_name_is_found(text: str) -> None:
    with pytest.raises((AssertionError, ImportError)):
        check(text)


@pytest.mark.parametrize("command", COMMANDS)
def test_commands_exist(command: str) -> None:
    typer = pytest.importorskip("typer")
    from delone.cli.app import app

    words = shlex.split(command)[1:]
    sub = typer.main.get_command(app).commands[words[0]]
    known = {name for option in sub.params for name in (*option.opts, *option.secondary_opts)}
    used = {word.partition("=")[0] for word in words[1:] if re.match(r"--?[a-z]", word)}
    assert used <= known
