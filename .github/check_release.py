"""Whether a tag is a release: all versions agree, and the changelog describes it.

``python .github/check_release.py v1.2.3`` prints the notes of that version, or says what is wrong
and fails. Without a tag it compares the versions only.
"""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]


def read(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


def versions() -> dict[str, str]:
    """The version that each file states."""
    patterns = {
        "CITATION.cff": r"^version: *\"?([^\"\n]+)\"?$",
        "recipe/recipe.yaml": r"^  version: *\"?([^\"\n]+)\"?$",
    }
    found = {"Cargo.toml": tomllib.loads(read("Cargo.toml"))["workspace"]["package"]["version"]}
    for name, pattern in patterns.items():
        match = re.search(pattern, read(name), re.MULTILINE)
        found[name] = match[1] if match else "none"
    return found


def notes(changelog: str, version: str) -> str:
    """The section of one version: its heading has a date, and its text is not empty."""
    heading = rf"^## \[{re.escape(version)}\] - \d{{4}}-\d\d-\d\d$"
    match = re.search(heading + r"\n(.*?)(?=^## |\Z)", changelog, re.MULTILINE | re.DOTALL)
    return match[1].strip() if match else ""


def faults(tag: str | None) -> list[str]:
    """What speaks against the release, one sentence each."""
    stated = versions()
    found = []
    if len(set(stated.values())) > 1:
        found.append(f"the versions differ: {stated}")
    if tag is None:
        return found
    version = stated["Cargo.toml"]
    if tag != f"v{version}":
        found.append(f"the tag is {tag}, the version is {version}")
    changelog = read("CHANGELOG.md")
    if not notes(changelog, version):
        found.append(f"CHANGELOG.md has no text under '## [{version}] - YYYY-MM-DD'")
    released = re.search(r"^date-released: *(\S+)$", read("CITATION.cff"), re.MULTILINE)
    if released is None or f"## [{version}] - {released[1]}\n" not in changelog:
        found.append("date-released of CITATION.cff is not the date of the version in CHANGELOG.md")
    left = re.search(r"^## \[Unreleased\]\n(.*?)(?=^## |\Z)", changelog, re.MULTILINE | re.DOTALL)
    if left and left[1].strip():
        found.append("CHANGELOG.md has text under '## [Unreleased]'")
    return found


def main() -> int:
    tag = sys.argv[1] if len(sys.argv) > 1 else None
    wrong = faults(tag)
    for sentence in wrong:
        print(sentence, file=sys.stderr)
    if tag and not wrong:
        print(notes(read("CHANGELOG.md"), tag.removeprefix("v")))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
