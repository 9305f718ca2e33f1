"""What a release rests on: versions that agree, a changelog, a README that an index can show."""

from __future__ import annotations

import importlib
import importlib.metadata
import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import delone

if TYPE_CHECKING:
    from types import ModuleType

ROOT = Path(__file__).parents[2]
FILES = (
    ".github/check_release.py",
    "Cargo.toml",
    "CITATION.cff",
    "recipe/recipe.yaml",
    "docs/citation.rst",
    "Cargo.lock",
    "fuzz/Cargo.lock",
    "benchmarks/peers/Cargo.lock",
    "crates/web/Cargo.lock",
)
WRITTEN = tomllib.loads((ROOT / "Cargo.toml").read_text("utf-8"))["workspace"]["package"]["version"]
VERSION = WRITTEN.replace("-alpha.", "a").replace("-beta.", "b").replace("-rc.", "rc")
RELEASED = f"# Changelog\n\n## [Unreleased]\n\n## [{VERSION}] - 2026-01-02\n\n### Added\n\n- All.\n"


def script(name: str) -> ModuleType:
    """A program of the folder .github as a module."""
    folder = str(ROOT / ".github")
    sys.path.insert(0, folder)
    try:
        return importlib.import_module(name)
    finally:
        sys.path.remove(folder)


def check(
    folder: Path, changelog: str, tag: str, date: str = "2026-01-02"
) -> subprocess.CompletedProcess[str]:
    """The check that the release makes, in a copy with another changelog."""
    for name in FILES:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        if not (folder / name).exists():
            shutil.copy(ROOT / name, folder / name)
    cite = folder / "CITATION.cff"
    text = re.sub(r"date-released:.*\n", "", cite.read_text(encoding="utf-8"))
    cite.write_text(f"{text.rstrip()}\ndate-released: {date}\n", encoding="utf-8")
    (folder / "CHANGELOG.md").write_text(changelog, encoding="utf-8")
    command = [sys.executable, folder / ".github/check_release.py", tag]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_a_described_version_is_released_with_its_notes(tmp_path: Path) -> None:
    done = check(tmp_path, RELEASED, f"v{VERSION}")
    assert (done.returncode, done.stdout, done.stderr) == (0, "### Added\n\n- All.\n", "")


@pytest.mark.parametrize(
    ("changelog", "tag", "said"),
    [
        (RELEASED, "v9.9.9", "the tag is v9.9.9"),
        (RELEASED, VERSION, "the tag is"),
        (RELEASED.replace(VERSION, "9.9.9"), f"v{VERSION}", "no text under"),
        (RELEASED.replace(" - 2026-01-02", ""), f"v{VERSION}", "no text under"),
        (RELEASED.replace("### Added\n\n- All.\n", ""), f"v{VERSION}", "no text under"),
        (RELEASED.replace("sed]\n", "sed]\n\n- Late.\n"), f"v{VERSION}", "## [Unreleased]"),
        (RELEASED, f"v{WRITTEN}-rc.1", "the tag is"),
    ],
    ids=["other tag", "no v", "other version", "no date", "no text", "unreleased", "of Cargo"],
)
def test_what_is_not_described_is_not_released(
    changelog: str, tag: str, said: str, tmp_path: Path
) -> None:
    done = check(tmp_path, changelog, tag)
    assert done.returncode == 1 and said in done.stderr


def test_the_citation_has_the_date_of_the_release(tmp_path: Path) -> None:
    done = check(tmp_path, RELEASED, f"v{VERSION}", date="2026-01-03")
    assert done.returncode == 1 and "date-released" in done.stderr


def test_empty_headings_may_stay(tmp_path: Path) -> None:
    changelog = RELEASED.replace("sed]\n", "sed]\n\n### Added\n\n### Fixed\n", 1)
    assert check(tmp_path, changelog, f"v{VERSION}").returncode == 0


@pytest.mark.parametrize("name", FILES[1:])
def test_files_with_other_versions_are_named(name: str, tmp_path: Path) -> None:
    check(tmp_path, RELEASED, f"v{VERSION}")
    text = (tmp_path / name).read_text(encoding="utf-8")
    stated = WRITTEN if "Cargo" in name else VERSION
    assert stated in text
    (tmp_path / name).write_text(text.replace(stated, "9.9.9", 1), encoding="utf-8")
    done = check(tmp_path, RELEASED, f"v{VERSION}")
    assert done.returncode == 1 and name in done.stderr


@pytest.mark.parametrize(
    ("page", "text"),
    [
        ("README.md", "There is no release yet, so you build."),
        ("docs/getting_started.rst", "Before the first\nrelease, build."),
        ("docs/guide/io.rst", "From the first release on, install."),
        ("SECURITY.md", "It is not yet released."),
    ],
)
def test_pages_that_deny_the_release_are_named(page: str, text: str, tmp_path: Path) -> None:
    """With a tag only, and not on the page about releasing."""
    for name in (page, "docs/releasing.rst"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(f"Title\n\n{text}\n", encoding="utf-8")
    done = check(tmp_path, RELEASED, f"v{VERSION}")
    assert done.returncode == 1 and f"{page}:3 says" in done.stderr
    assert "releasing" not in done.stderr
    command = [sys.executable, tmp_path / ".github/check_release.py"]
    assert subprocess.run(command, check=False).returncode == 0


def test_python_states_the_same_version() -> None:
    assert delone.__version__ == importlib.metadata.version("delone") == VERSION


GOOD = f"""\
Metadata-Version: 2.4
Name: delone
Version: {VERSION}
Requires-Dist: numpy>=1.26
Requires-Dist: typer>=0.15 ; extra == 'cli'
Summary: Triangulation
Keywords: delaunay
Author: The delone developers
License-Expression: MIT OR Apache-2.0
Requires-Python: >=3.11
Description-Content-Type: text/markdown; charset=UTF-8; variant=GFM
Project-URL: Homepage, https://example.org
Project-URL: Documentation, https://example.org
Project-URL: Changelog, https://example.org
Project-URL: Repository, https://example.org
Project-URL: Issues, https://example.org

{"# delone " * 200}
"""


def test_good_metadata_have_no_fault() -> None:
    assert script("check_wheels").metadata_faults(GOOD) == []


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        ("Author: The delone developers\n", "", "no Author"),
        ("Project-URL: Changelog, https://example.org\n", "", "no link Changelog"),
        ("Project-URL: Homepage,", "Project-URL: Home,", "no link Homepage"),
        (f"Version: {VERSION}\n", "Version: 9.9.9\n", "not delone"),
        ("numpy>=1.26", "numpy>=2", "requires"),
        ("# delone " * 2, "", "README"),
        ("text/markdown", "text/plain", "Markdown"),
    ],
)
def test_a_fault_of_metadata_is_named(before: str, after: str, said: str) -> None:
    assert before in GOOD
    [fault] = script("check_wheels").metadata_faults(GOOD.replace(before, after))
    assert said in fault


@pytest.mark.parametrize(
    ("tag", "inside", "fit"),
    [
        ("cp311-abi3-manylinux_2_28_x86_64", "cp311-abi3-manylinux_2_28_x86_64", True),
        ("cp314-cp314t-win_arm64", "cp314-cp314t-win_arm64", True),
        ("cp311-abi3-macosx_11_0_arm64", "cp311-abi3-macosx_11_0_arm64", True),
        ("cp311-abi3-linux_x86_64", "cp311-abi3-linux_x86_64", False),
        ("cp311-abi3-manylinux_2_28_x86_64", "cp311-abi3-linux_x86_64", False),
        ("py3-none-any", "py3-none-any", False),
    ],
)
def test_tags_are_those_that_an_index_takes(tag: str, inside: str, fit: bool) -> None:
    wheel = Path(f"delone-{VERSION}-{tag}.whl")
    found = script("check_wheels").tag_faults(wheel, f"Wheel-Version: 1.0\nTag: {inside}\n")
    assert (found == []) is fit


def test_what_is_missing_in_an_sdist_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rehearse = script("rehearse")
    tracked = ["tests/conftest.py", "python/delone/__init__.py", "Cargo.lock", "CHANGELOG.md"]
    tracked += ["LICENSE-MIT", "LICENSE-APACHE", "LICENSE-THIRD-PARTY", "docs/index.rst"]
    monkeypatch.setattr(rehearse, "said_by", lambda *_: "\n".join(tracked))
    folder = tmp_path / f"delone-{VERSION}"
    for name in [name for name in tracked if "docs" not in name]:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).touch()
    (folder / "PKG-INFO").write_text(GOOD, encoding="utf-8")
    assert rehearse.sdist_faults(folder) == []
    (folder / "tests/conftest.py").unlink()
    (folder / "tests/notes.txt").touch()
    assert rehearse.sdist_faults(folder) == [
        "tests/notes.txt is in no commit",
        "tests/conftest.py is missing",
    ]


def test_versions_of_this_tree_agree() -> None:
    command = [sys.executable, ROOT / ".github/check_release.py"]
    subprocess.run(command, check=True)


def test_links_of_the_readme_work_elsewhere() -> None:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    defined = dict(re.findall(r"^\[([^\]]+)\]: (\S+)$", text, re.MULTILINE))
    direct = re.findall(r"\]\(([^)\s]+)\)", text)
    used = re.findall(r"\]\[([^\]]+)\]", text)
    assert set(used) == set(defined) and direct
    for target in [*direct, *defined.values()]:
        assert target.startswith("https://"), target
        here = re.match(r"https://[\w.]+/delone/delone/(?:(?:blob|tree)/)?main/(.*)", target)
        assert here is None or (ROOT / here[1]).exists(), target


def test_actions_are_pinned_by_commit() -> None:
    files = sorted((ROOT / ".github/workflows").glob("*.yml"))
    used = [use for f in files for use in re.findall(r"uses: (\S+)", f.read_text(encoding="utf-8"))]
    pinned = [use for use in used if re.fullmatch(r"[\w./-]+@[0-9a-f]{40}", use)]
    assert set(used) - set(pinned) == {"./.github/workflows/wheels.yml"} and len(pinned) > 10


def test_forms_of_issues_are_valid() -> None:
    """Each has what GitHub requires: a name, a description, and fields with labels."""
    yaml = pytest.importorskip("yaml")
    folder = ROOT / ".github" / "ISSUE_TEMPLATE"
    forms = {path.stem: yaml.safe_load(path.read_text("utf-8")) for path in folder.glob("*.yml")}
    links = forms.pop("config")["contact_links"]
    assert all(set(link) == {"name", "url", "about"} for link in links)
    assert set(forms) == {"bug", "feature"}
    for form in forms.values():
        assert form["name"] and form["description"]
        fields = [field for field in form["body"] if field["type"] != "markdown"]
        assert len({field["id"] for field in fields}) == len(fields)
        assert all(field["attributes"]["label"] for field in fields)


def test_the_oldest_glibc_is_the_same_everywhere() -> None:
    compatibility = script("rehearse").COMPATIBILITY
    oldest = compatibility.removeprefix("manylinux_").replace("_", ".")
    assert f"glibc {oldest} or later" in (ROOT / "README.md").read_text(encoding="utf-8")
    built = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["cibuildwheel"]
    assert {v for k, v in built.items() if k.startswith("manylinux-")} == {compatibility}


def test_a_rehearsal_says_what_it_leaves_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without zig, other targets and tools, one sentence each, and the wheel for this machine."""
    rehearse = script("rehearse")
    monkeypatch.setattr(rehearse, "said_by", lambda *_: "")
    monkeypatch.setattr(rehearse, "has", lambda _: False)
    monkeypatch.setattr(rehearse.platform, "machine", lambda: "x86_64")
    made = rehearse.Rehearsal(Path(), Path())
    assert rehearse.plans(made) == [("x86_64", sys.executable)]
    said = "\n".join(made.left_out)
    assert len(made.left_out) == 3
    assert all(word in said for word in ("aarch64", "zig", "free-threaded", "abi3audit"))
    monkeypatch.setattr(rehearse, "has", lambda _: True)
    made = rehearse.Rehearsal(Path(), Path())
    assert rehearse.plans(made) == [("x86_64", sys.executable), ("x86_64", "3.14t")]
    assert "rustup target add aarch64-unknown-linux-gnu" in made.left_out[0]
    assert made.left_out[1].startswith("tests of the wheel for free-threaded Python: ")
    assert "uv python install 3.14t" in made.left_out[1]


def test_zig_is_found_beside_the_interpreter(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also where its environment is not activated, as in `make release-check`."""
    rehearse = script("rehearse")
    ran = []
    monkeypatch.setenv("PATH", "/nowhere")
    monkeypatch.setattr(rehearse, "has", lambda _: True)
    monkeypatch.setattr(rehearse, "run", lambda *command, **rest: ran.append((command, rest)))
    assert rehearse.build(tmp_path, tmp_path, "aarch64", "3.14t") == []
    [(command, rest)] = ran
    assert "--zig" in command and "aarch64-unknown-linux-gnu" in command
    assert rest["PATH"].split(os.pathsep) == [str(Path(sys.executable).parent), "/nowhere"]


def test_a_wheel_without_its_interpreter_is_built_and_not_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rehearse = script("rehearse")

    def build(source: Path, to: Path, machine: str, python: str) -> list[str]:
        to.mkdir()
        (to / f"delone-{machine}.whl").touch()
        return []

    here = [("x86_64", sys.executable), ("x86_64", "3.14t"), ("aarch64", sys.executable)]
    monkeypatch.setattr(rehearse, "plans", lambda _: here)
    monkeypatch.setattr(rehearse, "build", build)
    monkeypatch.setattr(rehearse, "wheel_faults", lambda _: [])
    monkeypatch.setattr(rehearse.platform, "machine", lambda: "x86_64")
    made = rehearse.Rehearsal(tmp_path, tmp_path)
    assert [python for _, python in rehearse.wheels(made, tmp_path)] == [sys.executable]
    assert made.left_out == ["tests of delone-aarch64.whl: this machine is x86_64"]


def test_a_rehearsal_builds_all_wheels_for_linux_that_it_can(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """For both processors, and free-threaded: an interpreter in the path, and one that uv has."""
    rehearse = script("rehearse")
    (tmp_path / "libstd-0123.rlib").touch()

    def said_by(*command: str) -> str:
        if command[0] == "rustc":
            assert command[-1] == "aarch64-unknown-linux-gnu"
            return f"{tmp_path}\n"
        if command[:3] == (sys.executable, "-m", "uv"):
            return "/uv/python3.15t\n" if command[-1] == "3.15t" else ""
        return "1\n" if command[0] == "python3.14t" else ""

    monkeypatch.setattr(rehearse, "said_by", said_by)
    monkeypatch.setattr(rehearse, "has", lambda _: True)
    monkeypatch.setattr(rehearse.platform, "machine", lambda: "x86_64")
    made = rehearse.Rehearsal(Path(), Path())
    assert rehearse.plans(made) == [
        ("x86_64", sys.executable),
        ("x86_64", "/uv/python3.15t"),
        ("x86_64", "python3.14t"),
        ("aarch64", sys.executable),
    ]
    assert made.left_out == []
    (tmp_path / "libstd-0123.rlib").unlink()
    assert ("aarch64", sys.executable) not in rehearse.plans(made)
