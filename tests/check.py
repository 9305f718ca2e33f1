"""Check the change at hand: format, lint, types, layers, and the rooms of tests that it touches.

    python tests/check.py [--since REVISION] [--budget SECONDS]

``make check`` builds first and then runs this. A changed file touches the tests of its own part and
of the parts that import it, by the map of imports in architecture/map.md. They are run nearest
first until the time that `times.json` has for them exceeds the budget; the last line says what is
left to ``make test``.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
sys.path.insert(0, str(HERE / "oracles"))

from structure import core_graph, parts_of, python_graph  # noqa: E402

TIMES = HERE / "times.json"
# Seconds of tests, on one processor: with the rest, a check takes a minute and a half.
BUDGET = 40.0

# Tests of a part of the package or of the core that do not have its name.
ROOMS: dict[str, tuple[str, ...]] = {
    "__init__": ("classes", "delaunay"),
    "__main__": ("cli",),
    "_base": ("arrays", "errors", "io", "georeference", "interpolate"),
    "_core": ("predicates", "platforms"),
    "_tiling": ("delaunay", "measure", "locate", "space", "classes", "higher"),
    "dynamic": ("live",),
    "estimation": ("higher",),
    "explorer": ("explore",),
    "flips": ("lawson",),
    "memory": ("delaunay",),
    "regular_validation": ("validation", "regular"),
    "xarray": ("interpolate", "sphere"),
    # Rooms of the core.
    "base": ("errors", "delaunay", "validation"),
    "graphs": ("graphs", "cluster"),
    "mesh": ("delaunay", "constrained", "space"),
    "ndim": ("higher", "space"),
    "order": ("delaunay", "platforms"),
    "overlap": ("sphere",),
    "solids": ("tetrahedra", "surface", "improve"),
}


@dataclass
class Change:
    """What a change touches: files by kind, and rooms of tests, the nearest first."""

    python: list[str] = field(default_factory=list)
    rust: list[str] = field(default_factory=list)
    rooms: list[str] = field(default_factory=list)
    core: list[str] = field(default_factory=list)

    def add(self, rooms: list[str]) -> None:
        """Append rooms that are not there yet."""
        self.rooms += [room for room in rooms if room not in self.rooms]


def rooms_of(part: str) -> list[str]:
    """The folders of tests of a part of the package or a module of the core."""
    names = ROOMS.get(part, (part,))
    return [f"tests/{name}" for name in names if (HERE / name).is_dir()]


def touched(files: list[str]) -> Change:
    """What changed files touch: their own rooms, then those of the parts that import theirs."""
    change = Change(python=[f for f in files if f.endswith((".py", ".pyi"))])
    change.rust = [f for f in files if f.endswith(".rs")]
    package = parts_of(python_graph())
    core = core_graph()
    own_package: list[str] = []
    own_core: list[str] = []
    for file in files:
        words = file.split("/")
        name = words[-1].partition(".")[0]
        if file.startswith("tests/") and len(words) > 2:
            if words[1] == "oracles":
                # What tests compare with: those of all rooms may use it.
                change.add([r for r in all_rooms() if uses(r, name)])
            else:
                change.add(["/".join(words[:2])])
        elif file.startswith("python/delone/"):
            part = words[2].partition(".")[0]
            change.add(rooms_of(part))
            own_package.append(part)
        elif file.startswith("crates/core/src/"):
            part = words[3].partition(".")[0]
            change.core.append(part)
            change.add(rooms_of(part))
            own_core.append(part)
        elif file.startswith("crates/bindings/"):
            change.add(rooms_of(name))
        elif file.startswith("docs/") and file.endswith(".rst"):
            change.add(["tests/pages", file])
        elif file.startswith("examples/"):
            change.add(["tests/pages"])
    for own, graph in ((own_package, package), (own_core, core)):
        for part, used in sorted(graph.items()):
            if used & set(own):
                change.add(rooms_of(part))
    return change


def all_rooms() -> list[str]:
    """All folders with tests."""
    return [f"tests/{path.parent.name}" for path in sorted(HERE.glob("*/test_*.py"))]


def uses(room: str, module: str) -> bool:
    """Whether a test of a room imports a module of the oracles."""
    return any(
        f"from {module} import" in path.read_text(encoding="utf-8")
        for path in (ROOT / room).glob("*.py")
    )


def within(rooms: list[str], budget: float) -> tuple[list[str], list[str]]:
    """Split rooms into those to run, up to a time, and the rest; the first is always run."""
    times = json.loads(TIMES.read_text(encoding="utf-8")) if TIMES.exists() else {}
    now: list[str] = []
    later: list[str] = []
    spent = 0.0
    for room in rooms:
        seconds = times.get(room, (1.0, 0))[0]
        if now and spent + seconds > budget:
            later.append(room)
        else:
            now.append(room)
            spent += seconds
    return now, later


def changed_since(revision: str | None) -> list[str]:
    """Files that are new or changed beside a revision; by default beside the last commit.

    Where nothing is changed beside it, those of the last commit.
    """
    new = _git("ls-files", "--others", "--exclude-standard")
    found = [*_git("diff", "--name-only", "--diff-filter=d", revision or "HEAD"), *new]
    if not found and revision is None:
        found = _git("diff", "--name-only", "--diff-filter=d", "HEAD~1")
    return sorted(set(found))


def _git(*words: str) -> list[str]:
    done = subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=True)
    return done.stdout.splitlines()


def commands(change: Change, rooms: list[str]) -> list[list[str]]:
    """What to run, the quickest first."""
    python = sys.executable
    found: list[list[str]] = []
    sources = [f for f in change.python if (ROOT / f).exists()]
    if sources:
        found += [[python, "-m", "ruff", "check", "-q", *sources]]
        found += [[python, "-m", "ruff", "format", "-q", "--check", *sources]]
    if change.rust:
        found += [["cargo", "fmt", "--all", "--check"]]
        found += [["cargo", "clippy", "-q", "--workspace", "--all-targets", "--", "-D", "warnings"]]
        found += [["cargo", "rustdoc", "-q", "-p", "delone-core", "--", "-D", "warnings"]]
        # The fuzz targets are a workspace of their own, which clippy does not see.
        fuzz = ["--manifest-path", "fuzz/Cargo.toml", "--target-dir", "target"]
        found += [["cargo", "check", "-q", *fuzz]]
        for part in sorted(set(change.core)):
            found += [["cargo", "test", "-q", "-p", "delone-core", "--lib", f"{part}::"]]
    if any(f.startswith("python/") for f in sources):
        found += [[python, "-m", "mypy"]]
    tests = ["tests/layers", *(room for room in rooms if room != "tests/layers")]
    options = ["-n", "auto", "--dist", "worksteal", "--times"]
    pages = ["--doctest-glob=*.rst"] if any(r.endswith(".rst") for r in rooms) else []
    found += [[python, "-m", "pytest", *options, *pages, *tests]]
    return found


def main() -> int:
    """Run all, stop at the first failure, and say what is left."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--since", help="compare with this revision, not with the last commit")
    parser.add_argument("--budget", type=float, default=BUDGET, help="seconds of tests")
    given = parser.parse_args()
    start = time.monotonic()
    change = touched(changed_since(given.since))
    now, later = within(change.rooms, given.budget)
    for command in commands(change, now):
        print("==", " ".join(command[:8]), "..." if len(command) > 8 else "", flush=True)
        if code := subprocess.run(command, cwd=ROOT, check=False).returncode:
            return code
    print(f"== checked in {time.monotonic() - start:.0f} s: {', '.join(now) or 'layers alone'}")
    if later:
        print(f"== left to make test, beyond {given.budget:.0f} s: {', '.join(later)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
