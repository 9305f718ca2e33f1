"""Whether a tag is a release: all versions agree, the changelog describes it, pages offer it.

``python .github/check_release.py v1.2.3`` prints the notes of that version, or says what is wrong
and fails. Without a tag it compares the versions only. Python writes a version as 0.1.0a1 and
Cargo as 0.1.0-alpha.1; a tag is v and the version of Python.
"""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]
LOCKS = ("Cargo.lock", "fuzz/Cargo.lock", "benchmarks/peers/Cargo.lock", "crates/web/Cargo.lock")
# The packages of the workspace; others in the lock files have versions of their own.
PACKAGES = ("delone-bindings", "delone-core", "delone-predicates")
# What pages say before the first release, and no longer when a version has a tag.
UNRELEASED = re.compile(
    r"\bno release yet\b|\bnot (?:yet )?released\b|\bfrom the first release on\b"
    r"|\b(?:before|until) the first release\b",
    re.IGNORECASE,
)
# What users read. The page about releasing speaks of the first one for its own reasons.
PAGES = ("README.md", "SECURITY.md", "CITATION.cff", "docs/**/*.rst")
NOT_PAGES = ("docs/releasing.rst", "docs/generated/", "docs/gallery/", "docs/_build/")


def read(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


def of_python(version: str) -> str:
    """A version of Cargo as Python writes it."""
    for long, short in (("-alpha.", "a"), ("-beta.", "b"), ("-rc.", "rc")):
        version = version.replace(long, short)
    return version


def versions() -> dict[str, str]:
    """The version that each file states, as Python writes it."""
    patterns = {
        "CITATION.cff": r"^version: *\"?([^\"\n]+)\"?$",
        "recipe/recipe.yaml": r"^  version: *\"?([^\"\n]+)\"?$",
        "docs/citation.rst": r"^ +version = \{([^}]+)\},$",
    }
    workspace = tomllib.loads(read("Cargo.toml"))["workspace"]
    found = {"Cargo.toml": of_python(workspace["package"]["version"])}
    for name in PACKAGES[2:]:
        required = workspace["dependencies"][name]["version"]
        found[f"Cargo.toml, {name}"] = of_python(required.removeprefix("="))
    for name, pattern in patterns.items():
        match = re.search(pattern, read(name), re.MULTILINE)
        found[name] = match[1] if match else "none"
    for name in LOCKS:
        for package in tomllib.loads(read(name))["package"]:
            if package["name"] in PACKAGES:
                found[f"{name}, {package['name']}"] = of_python(package["version"])
    return found


def notes(changelog: str, version: str) -> str:
    """The section of one version: its heading has a date, and its text is not empty."""
    heading = rf"^## \[{re.escape(version)}\] - \d{{4}}-\d\d-\d\d$"
    match = re.search(heading + r"\n(.*?)(?=^## |\Z)", changelog, re.MULTILINE | re.DOTALL)
    return match[1].strip() if match else ""


def unreleased() -> list[str]:
    """Each sentence of a page that says that there is no release, with its file and line."""
    found = []
    for path in sorted({path for pattern in PAGES for path in ROOT.glob(pattern)}):
        name = path.relative_to(ROOT).as_posix()
        if name.startswith(NOT_PAGES):
            continue
        # A sentence may be broken where a line ends.
        text = path.read_text(encoding="utf-8")
        for match in UNRELEASED.finditer(re.sub(r"\s", " ", text)):
            line = text.count("\n", 0, match.start()) + 1
            found.append(f"{name}:{line} says {match[0]!r}")
    return found


def faults(tag: str | None) -> list[str]:
    """What speaks against the release, one sentence each."""
    stated = versions()
    version = stated["Cargo.toml"]
    found = []
    if len(set(stated.values())) > 1:
        others = {name: said for name, said in stated.items() if said != version}
        found.append(f"the versions differ: Cargo.toml has {version}, but {others}")
    if tag is None:
        return found
    if tag != f"v{version}":
        found.append(f"the tag is {tag}, the version is {version}")
    changelog = read("CHANGELOG.md")
    if not notes(changelog, version):
        found.append(f"CHANGELOG.md has no text under '## [{version}] - YYYY-MM-DD'")
    released = re.search(r"^date-released: *(\S+)$", read("CITATION.cff"), re.MULTILINE)
    if released is None or f"## [{version}] - {released[1]}\n" not in changelog:
        found.append("date-released of CITATION.cff is not the date of the version in CHANGELOG.md")
    left = re.search(r"^## \[Unreleased\]\n(.*?)(?=^## |\Z)", changelog, re.MULTILINE | re.DOTALL)
    # Empty headings may stay for what comes next.
    if left and re.sub(r"^### .*$", "", left[1], flags=re.MULTILINE).strip():
        found.append("CHANGELOG.md has text under '## [Unreleased]'")
    return found + unreleased()


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
