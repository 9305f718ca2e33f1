"""Seed one bug after the other in a copy of the tree, and see the tests that are named for it fail.

``mutants.toml`` lists them: a line, what replaces it, and the tests that must notice. First those
tests must pass without any bug; then each bug must make one of them fail. What survives is
reported, and the exit status is 1. ``make mutants`` runs all, ``make mutants MUTANTS="proof-*"``
some of them.
"""

from __future__ import annotations

import argparse
import fcntl
import os
import shutil
import subprocess
import sys
import tomllib
from contextlib import contextmanager
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

HERE = Path(__file__).parent
TOP = HERE.parent.parent
COPY = TOP / "target" / "mutants" / "tree"
BUILT = TOP / "target" / "mutants" / "build"
# A build that is made often and used once.
QUICK = {
    "CARGO_TARGET_DIR": str(BUILT),
    "CARGO_PROFILE_RELEASE_LTO": "off",
    "CARGO_PROFILE_RELEASE_CODEGEN_UNITS": "16",
    "CARGO_PROFILE_RELEASE_INCREMENTAL": "true",
    "CARGO_PROFILE_RELEASE_DEBUG": "false",
    "PYO3_PYTHON": sys.executable,
}


@dataclass(frozen=True)
class Mutant:
    """A bug: `old`, which `file` has once, becomes `new`; arguments of pytest or of cargo test."""

    name: str
    file: str
    old: str
    new: str
    pytest: tuple[str, ...] = ()
    cargo: tuple[str, ...] = ()

    @property
    def in_rust(self) -> bool:
        return self.file.endswith(".rs")


class ListError(Exception):
    """The list of mutants and the tree do not fit together."""


def read() -> list[Mutant]:
    """Read the list; every line to be replaced must be in its file once."""
    listed = tomllib.loads((HERE / "mutants.toml").read_text(encoding="utf-8"))["mutant"]
    found = [Mutant(**{k: tuple(v) if isinstance(v, list) else v for k, v in row.items()})
             for row in listed]  # fmt: skip
    for mutant in found:
        count = (TOP / mutant.file).read_text(encoding="utf-8").count(mutant.old)
        if count != 1:
            raise ListError(f"{mutant.name}: {mutant.file} has the line {count} times, not once")
        if not (mutant.pytest or mutant.cargo):
            raise ListError(f"{mutant.name} names no tests")
    return found


def copy_tree() -> None:
    """Copy what Git knows or would add, and the built module; equal files stay as they are."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=TOP, check=True, capture_output=True,
    ).stdout.decode().split("\0")  # fmt: skip
    built = [str(path.relative_to(TOP)) for path in built_modules(TOP)]
    if not built:
        raise ListError("the package is not built: run `make test` once")
    for name in {*filter(None, listed), *built}:
        source, target = TOP / name, COPY / name
        if not source.is_file():
            continue
        if not target.is_file() or target.read_bytes() != source.read_bytes():
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target)


def built_modules(tree: Path) -> list[Path]:
    package = tree / "python" / "delone"
    return [path for path in package.glob("_core*") if path.suffix in (".so", ".pyd")]


@contextmanager
def seeded(mutant: Mutant) -> Iterator[None]:
    """Put the bug into the copy, and take it out again."""
    path = COPY / mutant.file
    plain = path.read_text(encoding="utf-8")
    path.write_text(plain.replace(mutant.old, mutant.new), encoding="utf-8")
    rebuilt = mutant.in_rust and mutant.pytest
    modules = {module: module.read_bytes() for module in built_modules(COPY) if rebuilt}
    try:
        yield
    finally:
        path.write_text(plain, encoding="utf-8")
        for module, content in modules.items():
            module.unlink()
            module.write_bytes(content)


def build(mutant: Mutant) -> None:
    """Build what the tests of a bug in Rust run."""
    if not mutant.in_rust:
        return
    if mutant.pytest:
        call("cargo", "build", "-q", "-p", "delone-bindings", "--features", "pyo3/abi3-py311")
        made = [
            p for p in (BUILT / "debug").glob("*_core.*") if p.suffix in (".so", ".dylib", ".dll")
        ]
        (module,) = built_modules(COPY)
        # A new file: the old one may be mapped.
        module.unlink()
        shutil.copyfile(max(made, key=lambda path: path.stat().st_mtime), module)
    if mutant.cargo:
        call("cargo", "test", "-q", "--no-run", *mutant.cargo)


def passes(pytest: tuple[str, ...], cargo: tuple[str, ...]) -> bool:
    """Whether all tests pass; a run that ends in any other way than pass or fail is an error."""
    if cargo and status("cargo", "test", "-q", *cargo) != 0:
        return False
    if not pytest:
        return True
    found = status(sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *pytest)
    if found not in (0, 1):
        raise ListError(f"pytest {' '.join(pytest)} ends with status {found}")
    return found == 0


def call(*command: str) -> None:
    if status(*command) != 0:
        raise ListError(f"{' '.join(command)} fails")


def status(*command: str) -> int:
    environment = os.environ | QUICK | {
        "PYTHONPATH": os.pathsep.join((str(COPY / "python"), os.environ.get("PYTHONPATH", ""))),
        # The time stamps of a bug and of the plain file may be equal.
        "PYTHONDONTWRITEBYTECODE": "1",
        "DELONE_ANY_SKIP": "1",
    }  # fmt: skip
    done = subprocess.run(
        command, cwd=COPY, env=environment, capture_output=True, text=True, check=False
    )
    if "-v" in sys.argv:
        print(*command, done.stdout, done.stderr, sep="\n")
    return done.returncode


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help="patterns of names; all by default")
    parser.add_argument("-v", action="store_true", help="show what the tests print")
    given = parser.parse_args()
    chosen = [
        mutant for mutant in read()
        if not given.names or any(fnmatch(mutant.name, name) for name in given.names)
    ]  # fmt: skip
    if not chosen:
        raise ListError(f"no mutant is named {' or '.join(given.names)}")
    COPY.mkdir(parents=True, exist_ok=True)
    # Held until the end: a second run would take bugs out, or leave some in, that are not its own.
    lock = (COPY.parent / "lock").open("w")
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise ListError("another run is at work in this tree") from None
    copy_tree()
    for pytest, cargo in dict.fromkeys((m.pytest, m.cargo) for m in chosen):
        if not passes(pytest, cargo):
            raise ListError(f"without any bug, {' '.join((*pytest, *cargo))} fails")
    survivors = []
    for mutant in chosen:
        with seeded(mutant):
            build(mutant)
            survives = passes(mutant.pytest, mutant.cargo)
        print(f"{'SURVIVES' if survives else 'found   '}  {mutant.name}", flush=True)
        survivors += [mutant.name] if survives else []
    print(f"{len(chosen) - len(survivors)} of {len(chosen)} found")
    return 1 if survivors else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except ListError as error:
        sys.exit(f"mutants: {error}")
