"""Arrows between the parts point one way.

Imports are read from the sources: with `ast` from Python, with a few regular expressions (comments
and strings taken out first) from Rust, and the dependencies of crates from Cargo.toml. A part that
is in no layer or table fails: a new part needs a place. architecture/map.md shows every arrow.
"""

from __future__ import annotations

import re
import shutil
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from structure import imports, knots, python_graph, rust_text, used_modules

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "python" / "delone"
CRATES = ROOT / "crates"

# The parts of the Python package, modules and folders below delone, from the ground up. A part may
# import those of the layers below its own. Files must not import each other in a circle, wherever
# the import is and whatever it is for.
PYTHON: tuple[set[str], ...] = (
    {"_core", "errors"},
    {"_base"},
    {"memory", "predicates"},
    # Rooms that take plain arrays and protocols, and no class.
    {"exchange", "plot"},
    {"_tiling"},
    {"flips", "validation"},
    {"regular_validation"},
    {"delaunay", "constrained", "regular"},
    {"dynamic", "estimation", "hull", "periodic", "refine"},
    {"alpha", "graphs", "io"},
    {"voronoi", "interpolate", "cluster", "solids", "areal"},
    {"compat", "explorer", "sphere", "terrain"},
    {"distributed"},
    {"xarray"},
    # Data and oracles: nothing that they test may use them, and they use the ground alone.
    {"datasets", "reference", "testing"},
    # The package itself re-exports.
    {"delone"},
    {"cli"},
    {"__main__"},
)
# These use the public interface, as any other program would, and not what lies behind it.
OUTSIDE = {"cli", "datasets", "exchange", "io", "plot", "reference", "testing"}
INSIDE = {"_core", "_tiling"}
ALONE = {"datasets", "reference", "testing"}
GROUND_FLOOR = set[str]().union(*PYTHON[:3])

# What each room of the core, and each file of its `base`, may use, of the core and of other crates.
GROUND = {"arrays", "error", "memory", "random", "sets", "vector", "watch"}
BASE: dict[str, set[str]] = {
    "arrays": set(),
    "error": {"delone_predicates"},
    "memory": {"error", "libc"},
    "watch": {"error"},
    "sets": {"error", "memory"},
    "random": set(),
    "vector": set(),
    "target": set(),
    "parallel": GROUND,
    "points": {"error", "memory", "delone_predicates"},
    "boxes": {"points"} | GROUND,
    "proof": GROUND,
    "wide": {"delone_predicates"},
    "joins": {"error", "memory", "watch"},
    "consistency": {"parallel", "delone_predicates"} | GROUND,
}
CORE: dict[str, set[str]] = {
    **BASE,
    "order": {"points", "parallel", "delone_predicates"} | GROUND,
    # Topology alone: neither coordinates nor predicates.
    "mesh": {"parallel"} | GROUND,
    "delaunay": {"mesh", "order", "points", "parallel", "proof", "delone_predicates"} | GROUND,
    "measure": {"parallel", "wide", "num_bigint", "delone_predicates"} | GROUND,
    "constrained": {"boxes", "delaunay", "joins", "mesh", "order", "points", "delone_predicates"}
    | GROUND,
    "refine": {"constrained", "delaunay", "measure", "mesh", "target", "wide", "delone_predicates"}
    | GROUND,
    "locate": {"boxes", "order", "points", "parallel", "wide", "delone_predicates"} | GROUND,
    "alpha": {"measure", "order", "parallel", "wide", "num_bigint", "delone_predicates"} | GROUND,
    "graphs": {"boxes", "order", "points", "parallel", "wide", "num_bigint", "delone_predicates"}
    | GROUND,
    "hull": {"order", "wide", "num_bigint", "delone_predicates"} | GROUND,
    "ndim": {
        "consistency",
        "locate",
        "measure",
        "order",
        "parallel",
        "points",
        "proof",
        "regular",
        "wide",
        "num_bigint",
        "delone_predicates",
    }
    | GROUND,
    "live": {"constrained", "delaunay", "locate", "mesh", "order", "points", "delone_predicates"}
    | GROUND,
    "distributed": {"locate", "points", "parallel", "delone_predicates"} | GROUND,
    "regular": {"parallel", "delaunay", "order", "points", "proof", "wide", "delone_predicates"}
    | GROUND,
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
    "sphere": {
        "constrained",
        "mesh",
        "order",
        "parallel",
        "points",
        "wide",
        "num_bigint",
        "delone_predicates",
    }
    | GROUND,
    "solids": {
        "constrained",
        "delaunay",
        "locate",
        "order",
        "parallel",
        "points",
        "target",
        "wide",
        "num_bigint",
        "delone_predicates",
    }
    | GROUND,
    "terrain": {
        "constrained",
        "delaunay",
        "locate",
        "mesh",
        "order",
        "parallel",
        "points",
        "delone_predicates",
    }
    | GROUND,
    "interpolate": {"delaunay", "locate", "sphere", "parallel", "wide", "delone_predicates"}
    | GROUND,
    "overlap": {
        "locate",
        "order",
        "parallel",
        "points",
        "sphere",
        "num_bigint",
        "delone_predicates",
    }
    | GROUND,
}
# The crates that each crate may need.
NEEDS = {
    "predicates": set[str](),
    "core": {"delone-predicates", "num-bigint", "thiserror", "libc"},
    "bindings": {"delone-core", "delone-predicates", "pyo3", "numpy"},
    "web": {"delone-core", "delone-predicates", "wasm-bindgen"},
}
NAMES_OF_CRATES = ("delone_predicates", "delone_core", "pyo3", "numpy", "libc")


def python_part(path: Path, package: Path) -> str:
    relative = path.relative_to(package)
    if len(relative.parts) > 1:
        return relative.parts[0]
    return "delone" if relative.stem == "__init__" else relative.stem


def python_imports(path: Path, parts: set[str]) -> set[str]:
    """The parts of delone that a module imports, wherever in the file."""
    found = set()
    for each in imports(path.read_text(encoding="utf-8")):
        assert each.level == 0, f"{path}: imports are absolute"
        words = each.module.split(".") + ([each.name] if each.name else [])
        if words[0] == "delone":
            found.add(words[1] if len(words) > 1 and words[1] in parts else "delone")
    return found


def python_faults(package: Path) -> list[str]:
    level = {part: i for i, layer in enumerate(PYTHON) for part in layer}
    parts = {p.stem if p.is_file() else p.name for p in package.iterdir()} - {"__init__"}
    faults = []
    for path in sorted(package.rglob("*.py")):
        part = python_part(path, package)
        if part not in level:
            faults.append(f"{path.relative_to(package)}: {part} is in no layer")
            continue
        others = python_imports(path, parts) - {part}
        wrong = [name for name in others if level.get(name, level[part]) >= level[part]]
        wrong += sorted(others & INSIDE) if part in OUTSIDE else []
        wrong += sorted(others - GROUND_FLOOR) if part in ALONE else []
        faults += [f"{path.relative_to(package)} imports {name}" for name in sorted(set(wrong))]
    return faults


def rust_uses(path: Path) -> set[str]:
    """Modules of the same crate and names of other crates that a file mentions in paths."""
    text = rust_text(path)
    found = used_modules(path) - {"base"} | used_modules(path, within="base")
    found |= {name for name in NAMES_OF_CRATES if re.search(rf"\b{name}\b\s*(::|;|as\b)", text)}
    return found


def core_part(relative: Path) -> str:
    """A room of the core, or a file of `base`."""
    parts = relative.parts
    return (parts[1] if parts[0] == "base" else parts[0]).removesuffix(".rs")


def core_faults(core: Path) -> list[str]:
    faults = []
    source = core / "src"
    for path in sorted(source.rglob("*.rs")):
        relative = path.relative_to(source)
        part = core_part(relative)
        if part in ("lib", "mod"):
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


def test_no_python_files_import_each_other_in_a_circle() -> None:
    assert knots(python_graph(PACKAGE)) == []


def test_core_arrows_point_one_way() -> None:
    assert core_faults(CRATES / "core") == []


def used(paths: Iterable[Path], part_of: Callable[[Path], str], uses: Callable[[Path], set[str]]):
    """What each part is known to use, for all of its files."""
    found: dict[str, set[str]] = {}
    for path in paths:
        found.setdefault(part_of(path), set()).update(uses(path))
    return found


def test_the_tables_hold_nothing_that_is_not_so() -> None:
    source = CRATES / "core" / "src"
    rust = used(
        source.rglob("*.rs"),
        lambda path: core_part(path.relative_to(source)),
        rust_uses,
    )
    stale = {
        (part, to)
        for part, allowed in CORE.items()
        for to in allowed & set(CORE) - GROUND
        if to not in rust.get(part, ())
    }
    assert not stale, sorted(stale)


def test_crates_need_what_they_may() -> None:
    assert crate_faults(CRATES) == []


def test_the_core_has_no_cycle() -> None:
    left = {part: {to for to in CORE[part] if to in CORE} for part in CORE}
    while left:
        free = [part for part, to in left.items() if not to]
        assert free, f"a cycle among {sorted(left)}"
        left = {p: to - set(free) for p, to in left.items() if p not in free}


def test_a_circle_of_files_is_found(tmp_path: Path) -> None:
    package = tmp_path / "delone"
    shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("*.so", "__pycache__"))
    with (package / "_tiling" / "plane" / "topology.py").open("a", encoding="utf-8") as source:
        source.write("\ndef f():\n    from delone._tiling.plane.dimension import PLANE\n")
    assert knots(python_graph(package)) == [
        ["delone._tiling.plane.dimension", "delone._tiling.plane.topology"]
    ]


@pytest.mark.parametrize(
    ("file", "line", "fault"),
    [
        ("io/text.py", "from delone import _core", "io/text.py imports _core"),
        (
            "io/text.py",
            "from delone._tiling.plane.topology import edges",
            "io/text.py imports _tiling",
        ),
        ("plot/axes.py", "def f():\n    import delone._core", "plot/axes.py imports _core"),
        (
            "_tiling/plane/geometry.py",
            "from delone.delaunay import Delaunay",
            "_tiling/plane/geometry.py imports delaunay",
        ),
        ("delaunay.py", "from delone.reference import lawson", "delaunay.py imports reference"),
        ("errors.py", "import delone", "errors.py imports delone"),
        ("helpers.py", "", "helpers.py: helpers is in no layer"),
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
        ("mesh/plane/mod.rs", "use crate::base::points::Extent;", "mesh/plane/mod.rs uses points"),
        (
            "mesh/mod.rs",
            "use delone_predicates::Sign;",
            "mesh/mod.rs uses delone_predicates",
        ),
        ("order/mod.rs", "use crate::{base::error::Result, mesh};", "order/mod.rs uses mesh"),
        ("order/mod.rs", "fn f() { crate::delaunay::plane::g(); }", "order/mod.rs uses delaunay"),
        ("base/points.rs", "use pyo3::prelude::*;", "base/points.rs uses pyo3"),
        ("base/watch.rs", "use crate::base::{error::E, points};", "base/watch.rs uses points"),
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
