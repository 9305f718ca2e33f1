"""The code base as a whole: sizes, openings, names, what must not be in it."""

from __future__ import annotations

import ast
import importlib
import inspect
import pkgutil
import re
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import delone

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "python" / "delone"
CRATES = ROOT / "crates"

# Files that may hold `unsafe`, each with what it is for.
UNSAFE = {
    "crates/core/src/base/memory.rs": "zeroed pages, large pages, signed rows",
    "crates/core/src/delaunay/space/dispatch.rs": "code for features found at run time",
    "crates/core/src/ndim/dispatch.rs": "code for features found at run time",
}

LONGEST = 800
FORBIDDEN_NAMES = re.compile(r"^(utils?|helpers?|misc|common|new_.*|.*_v\d)$")
# Written in pieces, so that this file does not find itself.
UNFINISHED = re.compile(
    "|".join(
        (r"\bTO" + "DO", r"\bFIX" + "ME", r"\bXX" + "X\b", "unimplemented" + "!", "todo" + "!")
    )
)
OF_SOMEBODYS_MACHINE = re.compile(r"(?<![\w.])/(home|Users|root|work)/\w")


def sources() -> Iterator[Path]:
    for folder, pattern in (
        ("python", "*.py"),
        ("tests", "*.py"),
        ("benchmarks", "*.py"),
        ("examples", "*.py"),
        ("crates", "*.rs"),
        ("fuzz", "*.rs"),
        ("benchmarks", "*.rs"),
    ):
        for path in sorted((ROOT / folder).rglob(pattern)):
            if "target" not in path.parts:
                yield path


SOURCES = list(sources())


def name_of(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def test_sources_are_found() -> None:
    names = {name_of(path) for path in SOURCES}
    assert {"python/delone/delaunay.py", "crates/core/src/lib.rs"} <= names


@pytest.mark.parametrize("path", SOURCES, ids=name_of)
def test_each_file_is_short_finished_and_aptly_named(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert text.count("\n") <= LONGEST
    assert not FORBIDDEN_NAMES.match(path.stem)
    assert not UNFINISHED.search(text)
    assert not OF_SOMEBODYS_MACHINE.search(text)


@pytest.mark.parametrize(
    "path",
    [p for p in SOURCES if PACKAGE in p.parents or (CRATES in p.parents and "src" in p.parts)],
    ids=name_of,
)
def test_each_file_says_what_lives_in_it(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".rs":
        assert text.startswith("//! ")
    else:
        assert ast.get_docstring(ast.parse(text))


ALIAS = re.compile(
    r"^\s+\w+(?:: TypeAlias)? = NDArray\[np\.(?:float64|int32|int64|bool_)\]$", re.MULTILINE
)
# Names that say what 64-bit numbers are, and oracles that import nothing of the package.
OWN_ALIASES = {"dynamic", "reference", "testing", "datasets"}


def test_types_of_arrays_have_one_module() -> None:
    """`delone._base.types` has them: one name, one type, in all modules."""
    own = [
        name_of(path)
        for path in SOURCES
        if PACKAGE in path.parents
        and path.relative_to(PACKAGE) != Path("_base/types.py")
        and path.relative_to(PACKAGE).parts[0] not in OWN_ALIASES
        and ALIAS.search(path.read_text(encoding="utf-8"))
    ]
    assert own == []
    assert ALIAS.search("    Floats = NDArray[np.float64]")


def holds_unsafe(text: str) -> bool:
    code = re.sub(r"//[^\n]*", "", text)
    return bool(re.search(r"\bunsafe\b", code))


def test_unsafe_is_only_where_it_is_listed() -> None:
    found = {
        name_of(path)
        for path in SOURCES
        if path.suffix == ".rs"
        and "crates" in path.parts
        and holds_unsafe(path.read_text(encoding="utf-8"))
    }
    assert found == set(UNSAFE)


def test_each_unsafe_block_says_why_it_is_sound() -> None:
    for name in UNSAFE:
        lines = (ROOT / name).read_text(encoding="utf-8").splitlines()
        for number, line in enumerate(lines):
            if re.search(r"\bunsafe (\{|impl)", line) and not line.lstrip().startswith("//"):
                above = "\n".join(lines[max(0, number - 8) : number])
                assert "SAFETY:" in above, f"{name}:{number + 1}"


def test_what_is_forbidden_is_found() -> None:
    assert FORBIDDEN_NAMES.match("utils")
    assert UNFINISHED.search("# TO" + "DO: later")
    assert OF_SOMEBODYS_MACHINE.search("see /home" + "/me/data")
    assert holds_unsafe("let x = unsafe { 1 };")
    assert not holds_unsafe("// unsafe")


# The modules that users import from.
PUBLIC_MODULES = (
    "delone.compat.scipy",
    "delone.constrained.delaunay",
    "delone.constrained.validation",
    "delone.datasets",
    "delone.delaunay",
    "delone.distributed",
    "delone.constrained.editing",
    "delone.explorer.widget",
    "delone.interpolate",
    "delone.io",
    "delone._tiling.location",
    "delone.periodic",
    "delone.plot",
    "delone.constrained.polygons",
    "delone.predicates",
    "delone.reference",
    "delone.regular",
    "delone.regular_validation",
    "delone.constrained.segments",
    "delone.testing",
    "delone.validation",
    "delone.voronoi",
)


def public_items() -> list[Any]:
    found = []
    for module_name in PUBLIC_MODULES:
        module = importlib.import_module(module_name)
        for name in module.__all__:
            item = getattr(module, name)
            ours = getattr(item, "__module__", "").startswith("delone")
            if ours and (inspect.isfunction(item) or inspect.isclass(item)):
                found.append(pytest.param(item, id=f"{module_name}.{name}"))
    return found


@pytest.mark.parametrize("item", public_items())
def test_public_names_are_documented(item: Any) -> None:
    text = inspect.getdoc(item)
    assert text
    summary = text.split("\n\n")[0]
    assert "\n" not in summary, "the summary is one line"
    assert summary.endswith(".")
    if inspect.isfunction(item):
        signature = inspect.signature(item)
        assert signature.return_annotation is not inspect.Signature.empty
        for parameter in signature.parameters:
            assert re.search(rf"\b{parameter}\b", text), f"{parameter} is not described"
        if signature.return_annotation not in (None, "None"):
            assert re.search(r"^(Returns|Yields)$", text, flags=re.MULTILINE)


def test_every_name_of_the_package_is_there() -> None:
    for name in delone.__all__:
        assert getattr(delone, name) is not None
        assert name in dir(delone)
    with pytest.raises(AttributeError, match="nothing"):
        delone.nothing  # noqa: B018


def test_a_star_import_hides_no_module_of_the_standard_library() -> None:
    assert not set(delone.__all__) & set(sys.stdlib_module_names)
    assert "io" in dir(delone)


def test_importing_the_package_imports_numpy_alone() -> None:
    code = """
import sys, numpy
before = set(sys.modules)
import delone
loaded = {name.split(".")[0] for name in set(sys.modules) - before}
allowed = set(sys.stdlib_module_names) | {"delone", "numpy"}
print(sorted(loaded - allowed))
late = ["delone.testing", "delone.datasets", "delone.io", "delone.plot", "delone.compat",
        "delone.reference", "delone.interpolate", "delone.distributed", "delone._tiling.archive",
        "zipfile"]
print([name for name in late if name in set(sys.modules) - before])
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split("\n")[:2] == ["[]", "[]"]


def test_a_first_call_does_not_import_masked_arrays() -> None:
    code = """
import sys, numpy
if "numpy.ma" in sys.modules:  # as in NumPy 1
    print([])
    sys.exit()
import delone
from delone.interpolate import Linear
found = delone.Delaunay([(0, 0), (4, 0), (0, 3)], workers=1)
Linear(found, [1, 2, 3])([(1, 1)])
found.nearest([(1, 1)])
print([name for name in sys.modules if name == "numpy.ma"])
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


def test_no_function_hides_a_module() -> None:
    """``delone.x.y`` is the module wherever there is a file of that name."""
    hidden = []
    for each in pkgutil.walk_packages(delone.__path__, "delone."):
        folder, _, name = each.name.rpartition(".")
        if name != "__main__":
            module = importlib.import_module(each.name)
            found = getattr(importlib.import_module(folder), name, module)
            hidden += [each.name] if found is not module else []
    assert hidden == []
