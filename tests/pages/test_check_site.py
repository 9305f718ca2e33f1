"""The check of the built site finds what pages load from elsewhere, and pictures without text."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import pytest

SCRIPT = Path(__file__).parents[2] / "docs" / "check_site.py"


@pytest.fixture(scope="module")
def check_site() -> ModuleType:
    spec = importlib.util.spec_from_file_location("check_site", SCRIPT)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def site(tmp_path: Path) -> Path:
    (tmp_path / "here.png").touch()
    (tmp_path / "here.css").write_text("body { background: url(here.png) }")
    return tmp_path


GOOD = (
    '<a href="https://example.org">a link</a>',
    '<link rel="canonical" href="https://example.org/page">',
    '<link rel="stylesheet" href="here.css?v=1">',
    '<meta property="og:image" content="https://example.org/picture.png">',
    '<img src="here.png" srcset="here.png 1x, here.png 2x" alt="a triangle">',
    '<img src="data:image/png;base64,AAAA" alt="a dot">',
)
BAD = (
    '<script src="https://example.org/a.js"></script>',
    '<script src="//example.org/a.js"></script>',
    '<link rel="stylesheet" href="https://example.org/a.css">',
    '<link rel="preconnect" href="https://example.org">',
    '<img src="https://example.org/a.png" alt="a triangle">',
    '<img src="here.png" srcset="here.png 1x, https://example.org/a.png 2x" alt="a triangle">',
    '<iframe src="https://example.org"></iframe>',
    "<style>@import 'https://example.org/a.css';</style>",
    '<p style="background: url(https://example.org/a.png)">text</p>',
    '<img src="gone.png" alt="a triangle">',
    '<img src="here.png">',
    '<img src="here.png" alt=" ">',
    '<img src="here.png" alt="_images/here.png">',
)


@pytest.mark.parametrize("text", GOOD)
def test_what_is_of_the_site_is_fine(check_site: ModuleType, site: Path, text: str) -> None:
    (site / "index.html").write_text(text)
    assert list(check_site.check(site)) == []


@pytest.mark.parametrize("text", BAD)
def test_a_fault_is_found(check_site: ModuleType, site: Path, text: str) -> None:
    (site / "index.html").write_text(text)
    assert len(list(check_site.check(site))) == 1


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.css", '@font-face { src: url("https://example.org/a.woff2") }'),
        ("a.js", "fetch('https://example.org/a.json')"),
        ("b.js", 'import("//example.org/b.js")'),
    ],
)
def test_styles_and_scripts_are_read(
    check_site: ModuleType, site: Path, name: str, text: str
) -> None:
    (site / "index.html").write_text("text")
    (site / name).write_text(text)
    assert [fault.file.name for fault in check_site.check(site)] == [name]


FIGURE = '<div class="live-figure" data-core="{}"></div>'


@pytest.mark.parametrize(
    ("there", "wasm", "said"),
    [
        ("yes", b"code", []),
        ("no", b"code", ["has a figure without the core: `make web` brings it"]),
        ("yes", b"", ["is missing: `make web` brings it"]),
        ("yes", None, ["is missing: `make web` brings it"]),
        (None, b"code", ["no page has a figure that readers can change"]),
    ],
)
def test_a_figure_without_its_core_is_not_published(
    check_site: ModuleType, site: Path, there: str | None, wasm: bytes | None, said: list[str]
) -> None:
    (site / "index.html").write_text("text" if there is None else FIGURE.format(there))
    if wasm is not None:
        core = site / check_site.CORE
        core.parent.mkdir(parents=True)
        core.write_bytes(wasm)
    assert [fault.text for fault in check_site.check_live(site)] == said
