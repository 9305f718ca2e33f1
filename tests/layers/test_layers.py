"""Arrows between the parts point one way.

The tables below are the diagram of ARCHITECTURE.md. Imports are read from the sources: with `ast`
from Python, with a few regular expressions (comments and strings taken out first) from Rust, and
the dependencies of crates from Cargo.toml. A part that is not in a table fails: whoever adds one
says what it may know.
"""

from __future__ import annotations

import ast
import re
import shutil
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from structure import rust_text, used_modules

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "python" / "delone"
CRATES = ROOT / "crates"

# What each Python part may import of delone. A part is a module or a folder below delone.
FOUNDATION = {
    "exchange",
    "errors",
    "_arrays",
    "_masks",
    "blocks",
    "counting",
    "extras",
    "georeference",
}
PUBLIC = {
    "delone",
    "errors",
    "constrained",
    "delaunay",
    "datasets",
    "georeference",
    "hull",
    "lawson",
    "predicates",
    "improve",
    "refine",
    "validation",
}
PYTHON: dict[str, set[str]] = {
    "errors": set(),
    "_arrays": {"_masks", "counting", "errors"},
    "_masks": {"errors"},
    "_values": {"_arrays", "errors"},
    "blocks": set(),
    "counting": set(),
    "extras": {"errors"},
    "exchange": {"_arrays", "errors", "extras"},
    "georeference": {"errors"},
    "_core": set(),
    "immutable": {"_arrays", "blocks"},
    "plane": {"_core", "immutable", "location", "plot"} | FOUNDATION,
    "space": {"immutable", "_core", "location", "plane", "plot", "predicates"} | FOUNDATION,
    "hull": {"immutable", "_core", "delaunay", "plane", "predicates", "space"} | FOUNDATION,
    "validation": {"immutable", "_core", "plane", "space"} | FOUNDATION,
    "predicates": {"_core"} | FOUNDATION,
    "lawson": {"immutable", "_core"} | FOUNDATION,
    "atomic": {"errors"},
    "archive": {"_core", "_arrays", "atomic", "plane", "space", "errors"},
    "location": {"_core"} | FOUNDATION,
    "delaunay": {"immutable", "_core", "archive", "periodic", "space", "validation"} | FOUNDATION,
    "constrained": {"immutable", "_core", "archive", "location", "plane", "validation"}
    | FOUNDATION,
    "refine": {"immutable", "_core", "archive", "constrained", "plane"} | FOUNDATION,
    "improve": {"immutable", "_core", "io", "plot", "space"} | FOUNDATION,
    "regular": {"immutable", "_core", "space"} | FOUNDATION,
    "periodic": {"immutable", "_core", "plane", "regular"} | FOUNDATION,
    "voronoi": {
        "immutable",
        "_core",
        "delaunay",
        "hull",
        "periodic",
        "plane",
        "plot",
        "regular",
        "space",
    }
    | FOUNDATION,
    "interpolate": {
        "immutable",
        "_core",
        "delaunay",
        "location",
        "periodic",
        "plane",
        "plot",
        "space",
    }
    | FOUNDATION,
    "compat": {
        "_core",
        "delaunay",
        "hull",
        "interpolate",
        "plane",
        "predicates",
        "constrained",
        "location",
        "refine",
        "voronoi",
    }
    | FOUNDATION,
    "reference": FOUNDATION,
    "testing": FOUNDATION,
    "distributed": {"_core", "atomic", "interpolate", "io"} | FOUNDATION,
    "datasets": FOUNDATION,
    # These call the public interface, as any other program would; readers coerce where all do.
    "io": PUBLIC | {"extras", "atomic", "plot", "_arrays", "_values", "counting"},
    # Takes objects by their attributes, and imports no class.
    "plot": {"extras", "atomic", "_arrays", "_values", "errors"},
    "cli": PUBLIC
    | {
        "extras",
        "atomic",
        "counting",
        "distributed",
        "interpolate",
        "io",
    },
    "__main__": PUBLIC | {"cli"},
    # The package itself re-exports.
    "delone": {
        "_core",
        "compat",
        "constrained",
        "datasets",
        "delaunay",
        "distributed",
        "errors",
        "georeference",
        "improve",
        "hull",
        "interpolate",
        "io",
        "lawson",
        "periodic",
        "plot",
        "plane",
        "predicates",
        "reference",
        "refine",
        "regular",
        "space",
        "testing",
        "validation",
        "voronoi",
    },
}

# What each module of the core may use, of the core and of other crates.
GROUND = {"arrays", "error", "memory", "watch"}
CORE: dict[str, set[str]] = {
    "arrays": set(),
    "consistency": {"parallel", "delone_predicates"} | GROUND,
    "error": {"delone_predicates"},
    "memory": {"error", "libc"},
    "watch": {"error"},
    "parallel": GROUND,
    "points": {"error", "memory", "delone_predicates"},
    "order": {"points", "parallel", "delone_predicates"} | GROUND,
    # Topology alone: neither coordinates nor predicates.
    "mesh2": {"parallel"} | GROUND,
    "delaunay2": {"mesh2", "order", "points", "parallel", "delone_predicates"} | GROUND,
    "mesh3": GROUND,
    "measure": {"parallel", "wide", "num_bigint", "delone_predicates"} | GROUND,
    "delaunay3": {"mesh3", "order", "points", "parallel", "delone_predicates"} | GROUND,
    "constrained": {"delaunay2", "mesh2", "order", "points", "delone_predicates"} | GROUND,
    "refine": {"constrained", "delaunay2", "mesh2", "wide", "delone_predicates"} | GROUND,
    "improve": {"delone_predicates"} | GROUND,
    "locate": {"order", "points", "parallel", "wide", "delone_predicates"} | GROUND,
    "hull": {"order", "wide", "num_bigint", "delone_predicates"} | GROUND,
    "locate3": {"locate", "points", "wide", "delone_predicates"} | GROUND,
    "wide": {"delone_predicates"},
    "distributed": {"locate", "points", "parallel", "delone_predicates"} | GROUND,
    "regular": {"order", "points", "wide", "delone_predicates"} | GROUND,
    "voronoi": {
        "measure",
        "regular",
        "constrained",
        "points",
        "parallel",
        "wide",
        "delone_predicates",
    }
    | GROUND,
    "regular3": {"regular", "locate3", "order", "points", "wide", "delone_predicates"} | GROUND,
    "voronoi3": {
        "measure",
        "regular3",
        "voronoi",
        "parallel",
        "wide",
        "delone_predicates",
    }
    | GROUND,
    "interpolate": {"locate", "delaunay2", "parallel", "wide", "delone_predicates"} | GROUND,
    "interpolate3": {"interpolate", "locate", "locate3", "parallel", "wide", "delone_predicates"}
    | GROUND,
}
# The crates that each crate may need.
NEEDS = {
    "predicates": set[str](),
    "core": {"delone-predicates", "num-bigint", "thiserror", "libc"},
    "bindings": {"delone-core", "delone-predicates", "pyo3", "numpy"},
}
NAMES_OF_CRATES = ("delone_predicates", "delone_core", "pyo3", "numpy", "libc")


def python_part(path: Path, package: Path) -> str:
    relative = path.relative_to(package)
    if len(relative.parts) > 1:
        return relative.parts[0]
    return "delone" if relative.stem == "__init__" else relative.stem


def python_imports(path: Path, package: Path) -> set[str]:
    """The parts of delone that a module imports, wherever in the file."""
    parts = {p.stem if p.is_file() else p.name for p in package.iterdir()} - {"__init__"}
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: imports are absolute"
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        else:
            continue
        for name in names:
            words = name.split(".")
            if words[0] == "delone":
                found.add(words[1] if len(words) > 1 and words[1] in parts else "delone")
    return found


def python_faults(package: Path) -> list[str]:
    faults = []
    for path in sorted(package.rglob("*.py")):
        part = python_part(path, package)
        if part not in PYTHON:
            faults.append(f"{path.relative_to(package)}: {part} is in no table of layers")
            continue
        wrong = python_imports(path, package) - PYTHON[part] - {part}
        faults += [f"{path.relative_to(package)} imports {name}" for name in sorted(wrong)]
    return faults


def rust_uses(path: Path) -> set[str]:
    """Modules of the same crate and names of other crates that a file mentions in paths."""
    text = rust_text(path)
    found = used_modules(path)
    found |= {name for name in NAMES_OF_CRATES if re.search(rf"\b{name}\b\s*(::|;|as\b)", text)}
    return found


def core_faults(core: Path) -> list[str]:
    faults = []
    source = core / "src"
    for path in sorted(source.rglob("*.rs")):
        relative = path.relative_to(source)
        part = relative.parts[0].removesuffix(".rs")
        if part == "lib":
            continue
        if part not in CORE:
            faults.append(f"{relative}: {part} is in no table of layers")
            continue
        wrong = rust_uses(path) - CORE[part] - {part}
        faults += [f"{relative} uses {name}" for name in sorted(wrong)]
    return faults


def crate_faults(crates: Path) -> list[str]:
    faults = []
    for manifest in sorted(crates.glob("*/Cargo.toml")):
        crate = manifest.parent.name
        content = tomllib.loads(manifest.read_text(encoding="utf-8"))
        tables = [content, *content.get("target", {}).values()]
        needs = {
            name
            for table in tables
            for kind in ("dependencies", "build-dependencies")
            for name in table.get(kind, {})
        }
        if crate not in NEEDS:
            faults.append(f"{crate} is in no table of layers")
            continue
        faults += [f"{crate} needs {name}" for name in sorted(needs - NEEDS[crate])]
    for path in sorted((crates / "predicates" / "src").rglob("*.rs")):
        wrong = rust_uses(path) & set(NAMES_OF_CRATES) - {"delone_predicates"}
        faults += [f"{path.name} uses {name}" for name in sorted(wrong)]
    return faults


def test_python_arrows_point_one_way() -> None:
    assert python_faults(PACKAGE) == []


def test_core_arrows_point_one_way() -> None:
    assert core_faults(CRATES / "core") == []


def used(paths: Iterable[Path], part_of: Callable[[Path], str], uses: Callable[[Path], set[str]]):
    """What each part is known to use, for all of its files."""
    found: dict[str, set[str]] = {}
    for path in paths:
        found.setdefault(part_of(path), set()).update(uses(path))
    return found


def test_the_tables_hold_nothing_that_is_not_so() -> None:
    python = used(
        PACKAGE.rglob("*.py"),
        lambda path: python_part(path, PACKAGE),
        lambda path: python_imports(path, PACKAGE),
    )
    source = CRATES / "core" / "src"
    rust = used(
        source.rglob("*.rs"),
        lambda path: path.relative_to(source).parts[0].removesuffix(".rs"),
        rust_uses,
    )
    stale = {
        (part, to)
        for table, found in ((PYTHON, python), (CORE, rust))
        for part, allowed in table.items()
        for to in allowed & set(table) - FOUNDATION - GROUND - PUBLIC
        if to not in found.get(part, ())
    }
    assert not stale, sorted(stale)


def test_crates_need_what_they_may() -> None:
    assert crate_faults(CRATES) == []


# Arrows up, which only the inside of a function may have: a triangulation, a diagram and io
# ask plot to draw. A constrained triangulation begins edits, which make another one.
# A mesh makes others of itself, measures draw themselves, and a mesh becomes what the libraries of
# io take.
LAZY = {
    ("plane", "plot"),
    ("voronoi", "plot"),
    ("space", "plot"),
    ("io", "plot"),
    ("refine", "io"),
    ("improve", "io"),
    ("improve", "plot"),
}


def test_the_tables_have_no_cycle_but_the_lazy_ones() -> None:
    for table in (PYTHON, CORE):
        known = {part: {to for to in table[part] if to in table} for part in table}
        known.pop("delone", None)
        left = {
            p: {to for to in t if (p, to) not in LAZY and to in known} for p, t in known.items()
        }
        while left:
            free = [part for part, to in left.items() if not to]
            assert free, f"a cycle among {sorted(left)}"
            left = {p: to - set(free) for p, to in left.items() if p not in free}


def test_arrows_up_are_inside_functions() -> None:
    for path in sorted(PACKAGE.rglob("*.py")):
        part = python_part(path, PACKAGE)
        for statement in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(statement, ast.ImportFrom) and statement.module:
                up = {to for below, to in LAZY if below == part}
                assert statement.module.split(".")[1:2] not in [[to] for to in up], path


def imported_at_once(path: Path, modules: set[str]) -> set[str]:
    """The modules that a module needs while it is being imported."""
    found = set()
    for statement in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(statement, ast.ImportFrom) and statement.module:
            names = [f"{statement.module}.{alias.name}" for alias in statement.names]
            found |= {name if name in modules else statement.module for name in names}
    return found & modules


def test_no_module_waits_for_itself() -> None:
    def name(path: Path) -> str:
        return ".".join(("delone", *path.relative_to(PACKAGE).with_suffix("").parts))

    paths = {name(path): path for path in PACKAGE.rglob("*.py") if path.stem != "__init__"}
    left = {module: imported_at_once(path, set(paths)) for module, path in paths.items()}
    while left:
        free = {module for module, to in left.items() if not to}
        assert free, f"a cycle among {sorted(left)}"
        left = {module: to - free for module, to in left.items() if module not in free}


@pytest.mark.parametrize(
    ("file", "line", "fault"),
    [
        ("io/text.py", "from delone import _core", "io/text.py imports _core"),
        ("io/text.py", "from delone.plane.topology import edges", "io/text.py imports plane"),
        ("plot/axes.py", "def f():\n    import delone._core", "plot/axes.py imports _core"),
        (
            "plane/geometry.py",
            "from delone.delaunay import Delaunay",
            "plane/geometry.py imports delaunay",
        ),
        ("delaunay.py", "from delone.reference import lawson", "delaunay.py imports reference"),
        ("errors.py", "import delone", "errors.py imports delone"),
        ("helpers.py", "", "helpers.py: helpers is in no table of layers"),
    ],
)
def test_a_wrong_arrow_in_python_is_found(file: str, line: str, fault: str, tmp_path: Path) -> None:
    package = tmp_path / "delone"
    shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("*.so", "__pycache__"))
    (package / "_core.pyi").touch()
    with (package / file).open("a", encoding="utf-8") as source:
        source.write(f"\n{line}\n")
    assert set(python_faults(package)) - set(python_faults(PACKAGE)) == {fault}


@pytest.mark.parametrize(
    ("file", "line", "fault"),
    [
        ("mesh2/mod.rs", "use crate::points::Extent;", "mesh2/mod.rs uses points"),
        (
            "mesh2/mod.rs",
            "use delone_predicates::Sign;",
            "mesh2/mod.rs uses delone_predicates",
        ),
        ("order/mod.rs", "use crate::{error::Result, mesh2};", "order/mod.rs uses mesh2"),
        ("order/mod.rs", "fn f() { crate::delaunay2::g(); }", "order/mod.rs uses delaunay2"),
        ("points.rs", "use pyo3::prelude::*;", "points.rs uses pyo3"),
        ("watch.rs", "use numpy as np;", "watch.rs uses numpy"),
        ("tools.rs", "", "tools.rs: tools is in no table of layers"),
    ],
)
def test_a_wrong_arrow_in_the_core_is_found(
    file: str, line: str, fault: str, tmp_path: Path
) -> None:
    core = tmp_path / "core"
    shutil.copytree(CRATES / "core" / "src", core / "src")
    with (core / "src" / file).open("a", encoding="utf-8") as source:
        source.write(f"\n{line}\n// use crate::cli; in a comment\n")
    assert set(core_faults(core)) - set(core_faults(CRATES / "core")) == {fault}


def test_a_wrong_dependency_is_found(tmp_path: Path) -> None:
    shutil.copytree(CRATES, tmp_path / "crates")
    manifest = tmp_path / "crates" / "core" / "Cargo.toml"
    text = manifest.read_text(encoding="utf-8")
    manifest.write_text(text.replace("[dependencies]", '[dependencies]\npyo3 = "0"', 1))
    with (tmp_path / "crates/predicates/src/lib.rs").open("a", encoding="utf-8") as source:
        source.write("use delone_core::points;\n")
    found = set(crate_faults(tmp_path / "crates")) - set(crate_faults(CRATES))
    assert found == {"core needs pyo3", "lib.rs uses delone_core"}
