"""What a release rests on: versions that agree, a changelog, a README that an index can show."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FILES = (".github/check_release.py", "Cargo.toml", "CITATION.cff", "recipe/recipe.yaml")
VERSION = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]["version"]
RELEASED = f"# Changelog\n\n## [Unreleased]\n\n## [{VERSION}] - 2026-01-02\n\n### Added\n\n- All.\n"


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
    ],
    ids=["other tag", "tag without v", "other version", "no date", "no text", "unreleased"],
)
def test_what_is_not_described_is_not_released(
    changelog: str, tag: str, said: str, tmp_path: Path
) -> None:
    done = check(tmp_path, changelog, tag)
    assert done.returncode == 1 and said in done.stderr


def test_the_citation_has_the_date_of_the_release(tmp_path: Path) -> None:
    done = check(tmp_path, RELEASED, f"v{VERSION}", date="2026-01-03")
    assert done.returncode == 1 and "date-released" in done.stderr


@pytest.mark.parametrize("name", FILES[1:])
def test_files_with_other_versions_are_named(name: str, tmp_path: Path) -> None:
    check(tmp_path, RELEASED, f"v{VERSION}")
    text = (tmp_path / name).read_text(encoding="utf-8")
    (tmp_path / name).write_text(text.replace(VERSION, "9.9.9", 1), encoding="utf-8")
    done = check(tmp_path, RELEASED, f"v{VERSION}")
    assert done.returncode == 1 and name in done.stderr


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
