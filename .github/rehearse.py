"""Rehearses a release: builds what would be published for Linux, installs it and tests it there.

``python .github/rehearse.py`` makes the sdist, unpacks it, and builds all wheels from what it
contains, so that a file that is missing there is noticed. Each wheel that runs on this machine is
installed into an environment with NumPy alone, and into one with all extras; no compiler is in
their path. In the first the quick tests run from the sdist, in the second the code of README.md, as
a reader pastes it. Names, tags and metadata are checked. If the last commit has the tag of this
version, or with ``--tag vX.Y.Z``, changelog and pages must be those of a release.

What this machine cannot do is left out, and said once at the end.
"""

from __future__ import annotations

import argparse
import importlib.util
import os
import platform
import shutil
import subprocess
import sys
import tarfile
import tempfile
import time
import tomllib
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import check_release
import check_wheels

ROOT = Path(__file__).parents[1]
# Wheels are linked with zig against the glibc that README.md promises.
COMPATIBILITY = "manylinux_2_28"
MACHINES = {"x86_64": "x86_64-unknown-linux-gnu", "aarch64": "aarch64-unknown-linux-gnu"}
FREE_THREADED = ("3.15t", "3.14t")
# What the commands on pages need of a shell. Nothing else is in the path of an environment.
SHELL = ("sh", "mkdir", "env", "uname")
# What is in the sdist and in no repository.
MADE = {"PKG-INFO"}


@dataclass
class Rehearsal:
    """What was found so far."""

    out: Path
    work: Path
    faults: list[str] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)

    def leave_out(self, what: str, why: str) -> None:
        """Note what is not done, and why; without a reason it is done."""
        if why:
            self.left_out.append(f"{what}: {why}")

    def step(self, name: str, done: Callable[[], list[str]]) -> None:
        """Do one step; what is wrong is kept for the end, so that all of it is seen at once."""
        start = time.monotonic()
        try:
            found = done()
        except subprocess.CalledProcessError as error:
            found = [f"exit code {error.returncode} of {' '.join(map(str, error.cmd))}"]
        self.faults += [f"{name}: {fault}" for fault in found]
        state = "FAILED" if found else "passed"
        print(f"== {state} in {time.monotonic() - start:.0f} s: {name}", flush=True)
        for fault in found:
            print(f"   {fault}", flush=True)


def run(*command: str | Path, cwd: Path = ROOT, **variables: str) -> None:
    subprocess.run(command, check=True, cwd=cwd, env={**os.environ, **variables})


def said_by(*command: str | Path) -> str:
    """What a program writes, nothing if it fails or is not there."""
    try:
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return ""
    return done.stdout


def tag_here() -> str | None:
    """The tag of this version, if the last commit has it."""
    version = check_release.versions()["Cargo.toml"]
    return f"v{version}" if f"v{version}" in said_by("git", "tag", "--points-at").split() else None


def sdist(to: Path) -> Path:
    """Build the sdist, and unpack it; the folder that it contains."""
    run(sys.executable, "-m", "maturin", "sdist", "--out", to)
    [packed] = to.glob("*.tar.gz")
    folder = to / "unpacked"
    with tarfile.open(packed) as opened:
        opened.extractall(folder, filter="data")
    return folder / packed.name.removesuffix(".tar.gz")


def sdist_faults(folder: Path) -> list[str]:
    """What is missing in the sdist, what should not be in it, and wrong metadata."""
    version = check_release.versions()["Cargo.toml"]
    found = check_wheels.metadata_faults((folder / "PKG-INFO").read_text(encoding="utf-8"))
    if folder.name != f"delone-{version}":
        found.append(f"is named {folder.name}")
    inside = {p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file()}
    tracked = set(said_by("git", "ls-files").split("\n"))
    if len(tracked) > 1:
        found += [f"{name} is in no commit" for name in sorted(inside - tracked - MADE)]
        needed = {name for name in tracked if name.startswith(("tests/", "python/"))}
        found += [f"{name} is missing" for name in sorted(needed - inside)]
    wanted = {"Cargo.lock", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE", "LICENSE-THIRD-PARTY"}
    return found + [f"{name} is missing" for name in sorted(wanted - inside)]


def has(module: str) -> bool:
    return importlib.util.find_spec(module) is not None


def build(source: Path, to: Path, machine: str, python: str) -> list[str]:
    """Build one wheel from the unpacked sdist."""
    if has("ziglang"):
        options = ["--zig", "--compatibility", COMPATIBILITY, "--target", MACHINES[machine]]
    else:
        options = ["--compatibility", "linux"]
    # Maturin looks for zig in the path: as a command, or as a package of the first Python there.
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
    run(
        *(sys.executable, "-m", "maturin", "build", "--release", "--locked", "--out", to),
        *("--interpreter", python, *options),
        cwd=source,
        CARGO_TARGET_DIR=str(ROOT / "target" / "release-check"),
        PATH=path,
    )
    return []


def free_threaded() -> list[str]:
    """Free-threaded interpreters, in the path or installed by uv; one for each version."""
    found = []
    for version in FREE_THREADED:
        name = f"python{version}"
        if not said_by(name, "-c", "print(1)"):
            # It finds what is there, and downloads nothing.
            name = said_by(sys.executable, "-m", "uv", "python", "find", version).strip()
        found += [name] if name else []
    return found


def has_target(target: str) -> bool:
    """Whether the compiler has the standard library for a target, from rustup or a distribution."""
    folder = said_by("rustc", "--print", "target-libdir", "--target", target).strip()
    return bool(folder) and any(Path(folder).glob("libstd-*"))


def plans(rehearsal: Rehearsal) -> list[tuple[str, str]]:
    """The machine and the interpreter of each wheel that can be built; notes those that cannot."""
    here = platform.machine()
    free = free_threaded()
    # With zig, maturin needs no interpreter: it has the configuration of each.
    missing = [] if free or not has("ziglang") else [FREE_THREADED[-1]]
    found = [(here, python) for python in (sys.executable, *free, *missing)]
    for machine in sorted(set(MACHINES) - {here}):
        target = MACHINES[machine]
        if not has("ziglang"):
            why = (
                "zig is missing: `pip install ziglang`; the wheel for this machine is not portable"
            )
        elif not has_target(target):
            why = f"its compiler is missing: `rustup target add {target}`"
        else:
            found.append((machine, sys.executable))
            why = ""
        rehearsal.leave_out(f"the wheel for {machine}", why)
    why = "no Python 3.15t or 3.14t was found: `uv python install 3.14t`" if not free else ""
    left = "tests of the wheel" if missing else "the wheel"
    rehearsal.leave_out(f"{left} for free-threaded Python", why)
    why = "" if has("abi3audit") else "abi3audit is missing: `pip install abi3audit`"
    rehearsal.leave_out("the check of the stable ABI", why)
    return found


def wheels(rehearsal: Rehearsal, source: Path) -> list[tuple[Path, str]]:
    """Build all wheels that can be built here; those that run here, with their interpreters."""
    here = platform.machine()
    runnable = []
    for machine, python in plans(rehearsal):
        to = rehearsal.out / f"{machine}-{Path(python).name}"
        name = f"build the wheel for {machine} with {Path(python).name}"
        rehearsal.step(name, partial(build, source, to, machine, python))
        for wheel in to.glob("*.whl"):
            rehearsal.step(f"check {wheel.name}", partial(wheel_faults, wheel))
            # For an interpreter that is not here, `plans` said so.
            runs = machine == here and shutil.which(python) is not None
            runnable += [(wheel, python)] if runs else []
            why = "" if machine == here else f"this machine is {here}"
            rehearsal.leave_out(f"tests of {wheel.name}", why)
    return runnable


def wheel_faults(wheel: Path) -> list[str]:
    found = check_wheels.faults(wheel, audit=has("abi3audit"))
    # Without zig the wheel is for this machine, which was said.
    return [fault for fault in found if has("ziglang") or "no index" not in fault]


def environment(folder: Path, python: str, wanted: str) -> tuple[Path, str]:
    """Make an environment with a wheel and pytest; its Python, and a path without compilers."""
    run(python, "-m", "venv", folder)
    inside = folder / "bin" / "python"
    with (ROOT / "pyproject.toml").open("rb") as file:
        quick = tomllib.load(file)["dependency-groups"]["quick"]
    install = [inside, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    run(*install, "--only-binary", ":all:", wanted, *quick)
    shell = folder / "shell"
    shell.mkdir()
    for command in SHELL:
        found = shutil.which(command)
        if found:
            (shell / command).symlink_to(found)
    return inside, f"{folder / 'bin'}{os.pathsep}{shell}"


def try_wheel(wheel: Path, python: str, source: Path, folder: Path) -> list[str]:
    """Run the quick tests with NumPy alone."""
    inside, path = environment(folder, python, str(wheel))
    variables = {"PATH": path, "DELONE_ANY_SKIP": "1", "PYTHONPATH": "", "VIRTUAL_ENV": ""}
    for compiler in ("cc", "gcc", "cargo", "rustc"):
        if shutil.which(compiler, path=path):
            return [f"{compiler} is in the path"]
    run(inside, "-I", "-c", WHERE, wheel.name.split("-")[1], **variables)
    pytest = [inside, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    run(*pytest, "--quick", cwd=source, **variables)
    return []


def try_extras(wheel: Path, python: str, folder: Path) -> list[str]:
    """Run all of README.md with all extras, from the wheel."""
    inside, path = environment(folder, python, f"{wheel}[all]")
    variables = {"PATH": path, "PYTHONPATH": "", "VIRTUAL_ENV": ""}
    run(
        *(inside, "-m", "pytest", "-q", "-p", "no:cacheprovider", "tests/pages/test_readme.py"),
        **variables,
    )
    return []


# The module that is imported is that of the environment, and has the version of the wheel.
WHERE = (
    "import sys, delone; assert delone.__file__.startswith(sys.prefix), delone.__file__; "
    "assert delone.__version__ == sys.argv[1], delone.__version__"
)


def has_index() -> bool:
    """Whether pip reaches an index of packages."""
    ask = ("-m", "pip", "download", "--quiet", "--no-deps", "--only-binary", ":all:", "numpy", "-d")
    with tempfile.TemporaryDirectory() as folder:
        return subprocess.run([sys.executable, *ask, folder], check=False).returncode == 0


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--tag", default=tag_here(), help="judge as a release with this tag")
    parser.add_argument("--out", type=Path, default=ROOT / "dist" / "check")
    chosen = parser.parse_args(arguments)
    if platform.system() != "Linux" or platform.machine() not in MACHINES:
        print("make release-check builds wheels for Linux, on Linux", file=sys.stderr)
        return 1
    shutil.rmtree(chosen.out, ignore_errors=True)
    chosen.out.mkdir(parents=True)
    with tempfile.TemporaryDirectory() as work:
        rehearsal = Rehearsal(chosen.out, Path(work))
        rehearse(rehearsal, chosen.tag)
    for sentence in rehearsal.left_out:
        print(f"left out: {sentence}")
    for fault in rehearsal.faults:
        print(f"FAILED: {fault}")
    if not rehearsal.faults:
        print(f"{check_release.versions()['Cargo.toml']} can be released; it is in {chosen.out}")
    return 1 if rehearsal.faults else 0


def rehearse(rehearsal: Rehearsal, tag: str | None) -> None:
    judged = f"changelog and pages of {tag}" if tag else "versions"
    rehearsal.step(judged, partial(check_release.faults, tag))
    why = "" if tag else "no tag of this version; make release-check TAG=vX.Y.Z"
    rehearsal.leave_out("notes and pages of a release", why)
    source = sdist(rehearsal.out)
    rehearsal.step("check the sdist", partial(sdist_faults, source))
    runnable = wheels(rehearsal, source)
    why = "" if has_index() else "no index of packages can be reached"
    rehearsal.leave_out("environments", why)
    for number, (wheel, python) in enumerate(() if why else runnable):
        folder = rehearsal.work / str(number)
        name = f"quick tests with NumPy alone, {wheel.name}"
        rehearsal.step(name, partial(try_wheel, wheel, python, source, folder / "bare"))
        # Not every extra has wheels for the newest interpreters.
        if python == sys.executable:
            name = f"all of README with all extras, {wheel.name}"
            rehearsal.step(name, partial(try_extras, wheel, python, folder / "all"))
    shutil.rmtree(source.parent)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
