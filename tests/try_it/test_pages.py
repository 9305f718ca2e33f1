"""Each page of the course, with its figures alone, in a headless Chromium: touch, keys, silence."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from contextlib import AbstractContextManager

    from browser import Browser, Page

    Write = Callable[[Path, str], None]
    Serve = Callable[[Path], AbstractContextManager[str]]

DOCS = Path(__file__).parents[2] / "docs"
sys.path.insert(0, str(DOCS / "extensions"))

import live_files  # noqa: E402


def elements(path: Path) -> list[str]:
    """The figures of a page, in its order."""
    text = path.read_text(encoding="utf-8")
    found = [
        live_files.figure_html(name, name, folder=live_files.FOLDER, live=True)
        for name in re.findall(r"^\.\. live:: (\w+)", text, re.MULTILINE)
    ]
    return [*found, *([live_files.points_html(live=True)] if ".. try-points::" in text else [])]


PAGES = {path.stem: path for path in sorted((DOCS / "learn").glob("*.rst")) if elements(path)}


@pytest.fixture(scope="module", params=PAGES)
def address(
    request: pytest.FixtureRequest,
    core: Path,
    write_page: Write,
    serve: Serve,
    tmp_path_factory: pytest.TempPathFactory,
) -> Iterator[str]:
    """One page after the other."""
    del core
    folder = tmp_path_factory.mktemp(request.param)
    write_page(folder, "".join(elements(PAGES[request.param])))
    with serve(folder) as found:
        yield f"{found}/index.html"


@pytest.fixture
def page(address: str, browser: Browser) -> Page:
    return opened(browser, address)


def opened(browser: Browser, address: str, **options: Any) -> Page:
    page = browser.page(address, **options)
    page.run("Promise.all([window.deloneReady, window.deloneTry]).then(() => 1)")
    return page


def names(page: Page) -> list[str]:
    found: list[str] = page.run("Object.keys(window.deloneFigures ?? {})")
    return found


def test_pages_ask_their_own_site_alone_and_are_silent(page: Page, address: str) -> None:
    assert len(names(page)) == page.run("document.querySelectorAll('[data-live]').length")
    page.run("for (const each of document.querySelectorAll('input[type=checkbox]')) each.click()")
    page.run(
        "for (const each of document.querySelectorAll('.live-next, .live-reset')) each.click()"
    )
    site = address.rpartition("/")[0]
    assert [each for each in page.addresses() if not each.startswith((site, "data:"))] == []
    assert page.complaints() == []


@pytest.mark.parametrize("width", [390, 1280])
def test_pages_fit_into_the_window(browser: Browser, address: str, width: int) -> None:
    page = opened(browser, address, size=(width, 800), dark=width == 390)
    assert page.run("document.documentElement.scrollWidth") <= width
    assert page.complaints() == []


def test_all_controls_have_names(page: Page) -> None:
    unnamed = page.run(
        "[...document.querySelectorAll('button, input, select, textarea, canvas')]"
        ".filter((each) => !(each.getAttribute('aria-label') ?? '').trim() && !each.labels?.length "
        "&& !each.textContent.trim()).map((each) => each.outerHTML)"
    )
    assert unnamed == []


def points(page: Page, name: str) -> list[float]:
    found: list[float] = page.run(f"[...window.deloneFigures.{name}.points]")
    return found


def test_keys_move_points_and_steps(page: Page) -> None:
    for name in names(page):
        figure = f"window.deloneFigures.{name}"
        handles = f"{figure}.element.querySelectorAll('.live-handle')"
        if page.run(f"{handles}.length"):
            before = points(page, name)
            page.run(f"{handles}[0].focus()")
            page.key("ArrowRight")
            assert points(page, name) != before, name
        # Steps: the browser moves the slider that has the focus.
        if page.run(f"{figure}.states.length") > 1 and page.run(f"Boolean({figure}.kind.step)"):
            page.run(f"{figure}.show(0)")
            page.run(f"{figure}.element.querySelector('.live-step').focus()")
            page.call(
                "Input.dispatchKeyEvent", type="rawKeyDown", key="ArrowRight",
                code="ArrowRight", windowsVirtualKeyCode=39,
            )  # fmt: skip
            assert page.run(f"{figure}.step") == 1, name
    assert page.complaints() == []


def test_a_finger_drags_a_point_and_scrolls_elsewhere(browser: Browser, address: str) -> None:
    page = opened(browser, address, size=(390, 800))
    page.call("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=1)
    for name in names(page):
        figure = f"window.deloneFigures.{name}"
        if page.run(f"{figure}.kind.fixed || Boolean({figure}.kind.turn || {figure}.kind.mark)"):
            continue
        page.run(f"{figure}.canvas.scrollIntoView({{ block: 'center' }})")
        x, y = page.run(
            f"(() => {{ const box = {figure}.canvas.getBoundingClientRect(); "
            f"const paint = {figure}.paints[0]; const [x, y] = {figure}.points; "
            "return [box.left + paint.x(x), box.top + paint.y(y)]; })()"
        )
        before = points(page, name)
        for kind, at in (("Start", [(x, y)]), ("Move", [(x + 12, y - 9)]), ("End", [])):
            touches = [{"x": u, "y": v} for u, v in at]
            page.call("Input.dispatchTouchEvent", type=f"touch{kind}", touchPoints=touches)
        assert points(page, name) != before, name
    assert page.complaints() == []
