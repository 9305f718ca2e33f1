"""The stub of the compiled module says what is in it; `make lint` runs mypy's stubtest on both."""

from __future__ import annotations

import importlib.util
import inspect
import re
import shutil
import sys
from pathlib import Path

import pytest

from delone import _core

ROOT = Path(__file__).parents[2]
BINDINGS = ROOT / "crates" / "bindings"


def test_the_stub_is_what_the_source_of_the_bindings_says(tmp_path: Path) -> None:
    """`make stub` writes it. A changed argument, field or comment makes another stub."""
    pytest.importorskip("ruff")
    spec = importlib.util.spec_from_file_location("stub", BINDINGS / "stub.py")
    assert spec and spec.loader
    made = importlib.util.module_from_spec(spec)
    sys.modules["stub"] = made
    spec.loader.exec_module(made)
    written = (ROOT / "python" / "delone" / "_core.pyi").read_text(encoding="utf-8")
    assert made.stub() == written, "run make stub"
    for name, old, new in (
        ("hull.rs", "pub facet_of: Column<i32>", "pub facet_of: Column<i64>"),
        ("alpha.rs", "edges: PyReadonlyArray2<'_, i32>", "pairs: PyReadonlyArray2<'_, i32>"),
        ("results.rs", "fn arrays<'py>", "fn every<'py>"),
        ("terrain.rs", "heights: PyReadonlyArray1<'py, f64>,\n}", "}"),
    ):
        folder = tmp_path / name.removesuffix(".rs")
        shutil.copytree(BINDINGS / "src", folder)
        text = (folder / name).read_text(encoding="utf-8")
        assert old in text
        (folder / name).write_text(text.replace(old, new), encoding="utf-8")
        assert made.stub(folder) != written, name


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
