"""Configuration of the documentation; `make docs` builds it with warnings as errors."""

import sys
from importlib.metadata import version as installed_version
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "extensions"))

import example_files

ROOT = Path(__file__).parents[1]

project = "delone"
author = "The delone developers"
copyright = "2026, The delone developers"
release = installed_version("delone")
version = release

SITE = "https://delone.readthedocs.io/en/latest/"
REPOSITORY = "https://github.com/delone/delone"
DESCRIPTION = "Exact, canonical and fast Delaunay triangulation: a Python package on a Rust core."

# MathJax comes with the pages, so that they can be read without a network.
extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.intersphinx",
    "sphinx-mathjax-offline",
    "numpydoc",
    "matplotlib.sphinxext.plot_directive",
    "sphinx_gallery.gen_gallery",
    "sphinx_design",
    "sphinx_copybutton",
    "sphinxcontrib.bibtex",
    "sphinxext.opengraph",
    "exercise",
    "live",
    "member_tables",
    "picture_texts",
    "question_index",
    "questions",
    "try_page",
]
templates_path = ["_templates"]
# The folder `gallery` also receives notebooks and scripts, which are not pages.
exclude_patterns = ["_build", "gallery/**/*.ipynb", "gallery/**/*.py"]
# Where `make web` puts the core for figures that readers can change; without it they show stored
# steps. All pages are written again when it comes.
WEB = ROOT / "target" / "web"
live_core = str(WEB) if (WEB / "delone_web_bg.wasm").exists() else None
default_role = "py:obj"
# Roles must lead somewhere. Single backticks alone, which docstrings put around names of arguments,
# are links where a name is public.
nitpicky = True
# Files in Markdown that pages include link to their own headings, which remain text. The parser is
# used without its extension, for which each README.md would be a page.
suppress_warnings = [*example_files.suppressed(), "ref.myst", "myst.header"]
nitpick_ignore_regex = [("py:obj", r".*")]

html_theme = "pydata_sphinx_theme"
html_title = "delone"
html_baseurl = SITE
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_js_files = ["search_titles.js"]
html_show_sourcelink = False
html_favicon = "_static/favicon.svg"
html_theme_options = {
    "icon_links": [{"name": "Repository", "url": REPOSITORY, "icon": "fa-brands fa-github"}],
    "navbar_start": ["navbar-logo", "site-version"],
    "navigation_with_keys": False,
    "show_toc_level": 2,
    "header_links_before_dropdown": 8,
    "navbar_align": "left",
    "footer_start": ["copyright"],
    "footer_end": [],
}
# Pages without a list of related pages.
html_sidebars = {name: [] for name in ("index", "howto", "compared", "benchmarks", "changelog")}

autosummary_generate = True
toc_object_entries_show_parents = "hide"
autodoc_typehints = "none"
numpydoc_show_class_members = False
numpydoc_class_members_toctree = False

# Inventories are in the repository (inventories/README.md): a build needs no network.
intersphinx_mapping = {
    "python": ("https://docs.python.org/3/", "inventories/python.inv"),
    "numpy": ("https://numpy.org/doc/stable/", "inventories/numpy.inv"),
    "scipy": ("https://docs.scipy.org/doc/scipy/", "inventories/scipy.inv"),
    "shapely": ("https://shapely.readthedocs.io/en/stable/", "inventories/shapely.inv"),
    "xarray": ("https://docs.xarray.dev/en/stable/", "inventories/xarray.inv"),
}
# A reference without a package is one of delone: never to a label of another site by chance.
intersphinx_disabled_reftypes = ["std:*"]

bibtex_bibfiles = ["references.bib"]
bibtex_default_style = "plain"
bibtex_reference_style = "author_year"

ogp_site_url = SITE
ogp_site_name = "delone"
ogp_image = "_static/ahn3.png"
ogp_image_alt = "Lidar points of a town, triangulated and hill-shaded"
ogp_social_cards = {"enable": False}

# Prompts and output are left out of what is copied.
copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True

# Pictures are drawn by the code that stands above them, at build time.
plot_formats = [("png", 120)]
plot_html_show_formats = False
plot_html_show_source_link = False
plot_include_source = True
plot_rcparams = {"figure.figsize": (6.4, 4.2), "savefig.bbox": "tight"}
plot_apply_rcparams = True

sphinx_gallery_conf = {
    "examples_dirs": "../examples",
    "gallery_dirs": "gallery",
    "subsection_order": [f"../examples/{folder}" for folder in example_files.FOLDERS],
    "within_subsection_order": "FileNameSortKey",
    "filename_pattern": r"\.py$",
    "ignore_pattern": example_files.left_out_pattern(),
    "backreferences_dir": "gallery/backreferences",
    "doc_module": ("delone",),
    "image_scrapers": example_files.scrapers(),
    "reset_modules": ("matplotlib", "example_files.reset"),
    "capture_repr": (),
    "remove_config_comments": True,
    "show_signature": False,
    # Times are those of the machine that built the pages.
    "write_computation_times": False,
    "min_reported_time": 3600,
    "download_all_examples": False,
    "log_level": {"backreference_missing": "debug"},
}


def setup(app):
    """Say which examples are left out."""
    app.connect("builder-inited", example_files.report)
