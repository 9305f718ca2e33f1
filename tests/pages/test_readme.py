"""README.md: its code is run as pasted, its pictures are small, and its links lead somewhere.

All blocks of Python run in one session, in order. Each block of commands runs in a shell, in order,
in an empty folder that contains only the examples of a clone.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from delone import datasets

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\((https://[^)\s]+)\)")
STATIC = "https://raw.githubusercontent.com/delone/delone/main/docs/_static/"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
SITE = PROJECT["urls"]["Documentation"] + "/en/latest/"

# Commands that no test can run: the start of the block, and why.
NOT_RUN = {"git clone": "needs a network, and builds the core"}


def blocks(language: str) -> list[str]:
    return [text for kind, text in BLOCK.findall(TEXT) if kind == language]


def commands() -> list[str]:
    return [text for text in blocks("sh") if not text.startswith(tuple(NOT_RUN))]


def run(command: list[str], folder: Path) -> None:
    """Run a program in a folder, with the `delone` of this environment before all others."""
    path = os.pathsep.join((str(Path(sys.executable).parent), os.environ["PATH"]))
    done = subprocess.run(
        command,
        cwd=folder,
        env={**os.environ, "PATH": path},
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_code_is_found() -> None:
    assert {kind for kind, _ in BLOCK.findall(TEXT)} == {"python", "sh"}
    assert len(blocks("python")) >= 5 and len(blocks("sh")) == len(commands()) + len(NOT_RUN)
    used = {
        word for text in commands() for word in re.findall(r"^delone (\w+)", text, re.MULTILINE)
    }
    assert used >= {"triangulate", "check", "mesh", "tile", "dem"}


@pytest.mark.slow("starts a process and runs every block, as a reader does")
def test_python_runs_as_pasted(tmp_path: Path) -> None:
    """In one session, with warnings as errors: a reader sees no warning either."""
    script = tmp_path / "pasted.py"
    script.write_text("\n".join(blocks("python")), encoding="utf-8")
    run([sys.executable, "-W", "error", str(script)], tmp_path)


@pytest.mark.slow("starts a process for each command, as a reader does")
@pytest.mark.skipif(os.name == "nt", reason="the commands are for a POSIX shell")
def test_commands_run_as_pasted(tmp_path: Path) -> None:
    for extra in ("typer", "laspy", "meshio", "matplotlib", "rasterio", "dask", "shapely"):
        pytest.importorskip(extra)
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    for text in commands():
        run(["sh", "-e", "-c", text], tmp_path)
        for name in re.findall(r" -o (\S+)", text):
            assert (tmp_path / name).exists(), name


def test_install_commands_name_what_exists() -> None:
    (text,) = (text for text in blocks("sh") if text.startswith("git clone"))
    assert PROJECT["urls"]["Repository"] in text
    for extra in re.findall(r"\.\[(\w+)\]", text):
        assert extra in PROJECT["optional-dependencies"]
    minor = re.search(r"Python 3\.(\d+) or", TEXT)
    assert minor and PROJECT["requires-python"] == f">=3.{minor[1]}"


def test_links_to_the_site_lead_to_pages() -> None:
    pages = [link for link in LINK.findall(TEXT) if "readthedocs" in link]
    assert {SITE, SITE + "learn/index.html", SITE + "coming_from/index.html"} <= set(pages)
    for link in pages:
        assert link.startswith(SITE), link
        page = link.removeprefix(SITE) or "index.html"
        assert (ROOT / "docs" / page).with_suffix(".rst").exists(), link


def test_pictures_are_committed_and_small() -> None:
    names = {
        link.removeprefix(STATIC).removesuffix(".png")
        for link in LINK.findall(TEXT)
        if link.startswith(STATIC)
    }
    assert names == {"terrain", "mesh", "globe", "solid"}
    drawn = (ROOT / "docs" / "figures.py").read_text(encoding="utf-8")
    for name in names:
        assert (ROOT / "docs" / "_static" / f"{name}.png").stat().st_size < 60_000, name
        assert f"\ndef {name}() -> None:" in drawn


def test_it_is_short() -> None:
    assert len(TEXT.splitlines()) <= 150


def test_numbers_of_points_are_those_of_the_data() -> None:
    for sample in (datasets.ahn3(), datasets.baja()):
        assert f"{len(sample.points):,}" in TEXT
