"""Configuration of the documentation; `make docs` builds it with warnings as errors."""

from importlib.metadata import version as installed_version

project = "delone"
author = "The delone developers"
copyright = "2026, The delone developers"
release = installed_version("delone")
version = release

# MathJax comes with the pages, so that they can be read without a network.
extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx-mathjax-offline",
    "numpydoc",
    "matplotlib.sphinxext.plot_directive",
]
templates_path = ["_templates"]
exclude_patterns = ["_build"]
default_role = "py:obj"
nitpicky = False

html_theme = "pydata_sphinx_theme"
html_title = "delone"
html_static_path = ["_static"]
html_show_sourcelink = False
html_theme_options = {
    "icon_links": [],
    "navigation_with_keys": False,
    "show_toc_level": 2,
    "footer_start": ["copyright"],
    "footer_end": [],
}

autosummary_generate = True
autodoc_typehints = "none"
numpydoc_show_class_members = False
numpydoc_class_members_toctree = False

# Pictures are drawn by the code that stands above them, at build time.
plot_formats = [("png", 120)]
plot_html_show_formats = False
plot_html_show_source_link = False
plot_include_source = True
plot_rcparams = {"figure.figsize": (6.4, 4.2), "savefig.bbox": "tight"}
plot_apply_rcparams = True
