"""The stub of the compiled module says what is in it; `make lint` runs mypy's stubtest on both."""

from __future__ import annotations

import inspect
import re
from pathlib import Path

import pytest

from delone import _core

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("untyped", [r"\bAny\b", r"\bdict\["])
def test_nothing_untyped_passes(untyped: str) -> None:
    """Results are classes with typed attributes, not dictionaries."""
    stub = (ROOT / "python" / "delone" / "_core.pyi").read_text(encoding="utf-8")
    found = [line for line in stub.splitlines() if re.search(untyped, line)]
    assert not found, f"_core.pyi: {found}"


@pytest.mark.parametrize(
    "result", [each for each in vars(_core).values() if isinstance(each, type)]
)
def test_each_attribute_says_what_it_is(result: type) -> None:
    attributes = {k: v for k, v in vars(result).items() if inspect.isdatadescriptor(v)}
    silent = [name for name, attribute in attributes.items() if not attribute.__doc__]
    assert not silent, f"{result.__name__} has attributes without a sentence: {silent}"


def test_the_version_is_that_of_the_workspace() -> None:
    import tomllib

    cargo = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))
    written = cargo["workspace"]["package"]["version"]
    for long, short in (("-alpha.", "a"), ("-beta.", "b"), ("-rc.", "rc")):
        written = written.replace(long, short)
    assert _core.__version__ == written
