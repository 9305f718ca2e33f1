"""Each example runs as a plain script, in a fresh process and another folder, and leaves no file.

The packages that an example needs stand in its docstring; the gallery leaves it out without them.
"""

from __future__ import annotations

import ast
import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "examples"
SCRIPTS = sorted(EXAMPLES.glob("*/*.py"))
INSTALL = re.compile(r"``pip install ([^`]+)``")
# For each extra and package that docstrings name, a module that comes with it.
MODULES = {
    "cli": "typer",
    "dask": "dask",
    "dxf": "ezdxf",
    "fem": "skfem",
    "geo": "shapely",
    "las": "laspy",
    "learn": "sklearn",
    "mesh": "meshio",
    "plot": "matplotlib",
    "pyvista": "pyvista",
    "raster": "rasterio",
    "scipy": "scipy",
    "xarray": "xarray",
}


def name_of(path: Path) -> str:
    return path.relative_to(EXAMPLES).as_posix()


def docstring(path: Path) -> str:
    return ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""


def needed(path: Path) -> set[str]:
    """The modules of what an example asks to install."""
    commands = " ".join(INSTALL.findall(docstring(path)))
    extras = re.findall(r"delone\[([a-z,]+)\]", commands)
    packages = re.findall(r"(?<=\s)[a-z-]+", re.sub(r'"[^"]*"', "", commands))
    return {MODULES[name] for text in (*extras, *packages) for name in text.split(",")}


def test_each_folder_has_a_header_and_an_example() -> None:
    folders = {path.parent for path in SCRIPTS}
    assert folders == {path.parent for path in EXAMPLES.glob("*/GALLERY_HEADER.rst")}


def test_no_two_examples_have_one_name() -> None:
    """A page can be named in a link without its folder, and files of pictures do not mix."""
    names = [path.stem for path in SCRIPTS]
    assert len(names) == len(set(names))


@pytest.mark.parametrize("path", SCRIPTS, ids=name_of)
def test_an_example_opens_with_title_and_requirements(path: Path) -> None:
    title, line, *_ = docstring(path).splitlines()
    assert line == "=" * len(title)
    assert INSTALL.search(docstring(path)), 'name what to install: ``pip install "delone[plot]"``'
    imports = {
        name.partition(".")[0]
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        for name in (
            [alias.name for alias in node.names]
            if isinstance(node, ast.Import)
            else [node.module or ""]
            if isinstance(node, ast.ImportFrom)
            else []
        )
    }
    given = needed(path) | {"delone", "numpy"} | set(sys.stdlib_module_names)
    # Pandas, PyArrow and others come with what the extras hold.
    assert imports & set(MODULES.values()) <= given


@pytest.mark.parametrize("path", SCRIPTS, ids=name_of)
@pytest.mark.deep
def test_an_example_runs_as_a_script(path: Path, tmp_path: Path) -> None:
    missing = [name for name in needed(path) if importlib.util.find_spec(name) is None]
    if missing:
        pytest.skip(f"needs {', '.join(missing)}")
    run = subprocess.run(
        [sys.executable, str(path)],
        cwd=tmp_path,
        env={**os.environ, "MPLBACKEND": "agg", "PYVISTA_OFF_SCREEN": "true"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    assert not list(tmp_path.iterdir()), "write files into a temporary directory"
