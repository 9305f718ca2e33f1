"""The examples of the gallery: their folders in order, what each needs, and which are left out.

The docstring of an example says what to install, for example ``pip install "delone[plot,fem]"``. An
example is left out of the gallery where one of these packages is missing; the build says so.
"""

from __future__ import annotations

import ast
import importlib.util
import re
import subprocess
import sys
import tomllib
from functools import cache
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from typing import TYPE_CHECKING, Any

from packaging.requirements import Requirement
from sphinx.errors import ExtensionError
from sphinx.util import logging

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "examples"
FOLDERS = (
    "points",
    "terrain",
    "constraints",
    "meshes",
    "voronoi",
    "interpolation",
    "climate",
    "solids",
    "neighbors",
    "plotting",
    "large",
)
PROBE = """
import pyvista
plotter = pyvista.Plotter(off_screen=True)
plotter.add_mesh(pyvista.Cube())
plotter.screenshot()
"""
INSTALL = re.compile(r"``pip install ([^`]+)``")


def examples() -> list[Path]:
    """Return all examples."""
    return sorted(EXAMPLES.glob("*/*.py"))


def requirements(path: Path) -> Iterator[Requirement]:
    """Return what the docstring of an example asks to install, with the extras resolved."""
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    docstring = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    for command in INSTALL.findall(docstring):
        for word in command.split():
            wanted = Requirement(word.strip("\"'"))
            if wanted.name != "delone":
                yield wanted
            for extra in sorted(wanted.extras):
                yield from map(Requirement, extras["project"]["optional-dependencies"][extra])


@cache
def renders() -> bool:
    """Return whether PyVista can draw here; in a process of its own, which may crash."""
    if importlib.util.find_spec("pyvista") is None:
        return False
    run = subprocess.run([sys.executable, "-c", PROBE], capture_output=True, check=False)
    return run.returncode == 0


def missing(path: Path) -> list[str]:
    """Return what an example needs and what is not here: packages, or a renderer for PyVista."""
    names = []
    for wanted in requirements(path):
        try:
            distribution(wanted.name)
        except PackageNotFoundError:
            names.append(wanted.name)
        else:
            if wanted.name == "pyvista" and not renders():
                names.append("a renderer for PyVista (OpenGL, or VTK with OSMesa)")
    return names


@cache
def left_out() -> dict[str, list[str]]:
    """Return the examples that cannot run here, each with what is missing."""
    lacking = {f"{path.parent.name}/{path.name}": missing(path) for path in examples()}
    return {name: what for name, what in lacking.items() if what}


def left_out_pattern() -> str:
    """Return the regular expression of the examples that cannot run here.

    sphinx-gallery compares it with names without folders; no two examples have one name.
    """
    files = [re.escape(name.rpartition("/")[2]) for name in left_out()]
    return rf"^({'|'.join(files)})$" if files else r"__init__\.py"


def suppressed() -> list[str]:
    """Return the warnings to ignore: links to examples, where some are left out."""
    return ["ref.doc"] if left_out() else []


def scrape_pyvista(block: Any, block_vars: dict[str, Any], gallery_conf: dict[str, Any]) -> str:
    """Save the open plotters of a block as pictures, described by the title of the example."""
    del block
    if "pyvista" not in sys.modules:
        return ""
    import pyvista
    from pyvista.plotting.utilities.sphinx_gallery import generate_images
    from sphinx_gallery.scrapers import figure_rst

    source = Path(block_vars["src_file"]).read_text(encoding="utf-8")
    title = (ast.get_docstring(ast.parse(source)) or "").partition("\n")[0]
    names = generate_images(block_vars["image_path_iterator"], dynamic=False)
    pyvista.close_all()
    return str(figure_rst(names, gallery_conf["src_dir"], f"Figure of the example: {title}"))


def scrapers() -> tuple[Any, ...]:
    """Return what collects the figures of examples."""
    if not any(wanted.name == "pyvista" for path in examples() for wanted in requirements(path)):
        return ("matplotlib",)
    if not renders():
        return ("matplotlib",)
    import pyvista

    pyvista.BUILDING_GALLERY = True
    pyvista.OFF_SCREEN = True
    return ("matplotlib", "example_files.scrape_pyvista")


def reset(gallery_conf: dict[str, Any], path: str) -> None:
    """Give all figures of the gallery the same size."""
    del gallery_conf, path
    import matplotlib.pyplot as plt

    plt.rcParams.update({"figure.figsize": (7, 4.6), "figure.dpi": 110})


def report(app: Any) -> None:
    """Say which examples are left out, and fail if none is left."""
    del app
    number = len(examples()) - len(left_out())
    if not number:
        raise ExtensionError("no example can run here: install the extras of delone")
    for name, what in left_out().items():
        # A plain print: the line appears also where the build is quiet.
        print(f"gallery: without {name}, which needs {', '.join(what)}")
    logging.getLogger(__name__).info("gallery: %d examples", number)
