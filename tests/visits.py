"""A browser, for the pages that people look at; without one these tests are skipped."""

import os
import shutil
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path

import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
QUIET = (
    "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-sync",
    "--disable-component-update", "--no-first-run",
)  # fmt: skip


@dataclass
class Visit:
    """A page in a tab of its own, and what it said and asked for since it was opened."""

    page: object
    errors: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)

    def open_section(self, title):
        """Open a section by its link in the contents, and wait until its first figure is drawn."""
        self.page.get_by_role("link", name=title, exact=True).first.click()
        section = self.page.locator(f'section[data-title="{title}"]')
        section.locator(".plot.js-plotly-plot").first.wait_for()
        return section

    def drawn(self, key):
        """Go to a figure, wait until it is drawn, and return its plot."""
        plot = self.page.locator(f"#{key} .plot")
        plot.scroll_into_view_if_needed()
        self.page.locator(f"#{key} .plot.js-plotly-plot .main-svg").first.wait_for()
        return plot

    @property
    def beyond(self):
        """What was asked of anything but the disk and the page itself."""
        own = ("file:", "data:", "blob:", "about:")
        return [address for address in self.requests if not address.startswith(own)]

    def faults(self, *, impact=("serious", "critical")):
        """What axe-core finds wrong with the page for people who cannot see it or use a mouse."""
        folder = Path(find_spec("axe_playwright_python").origin).parent
        self.page.evaluate((folder / "axe.min.js").read_text(encoding="utf-8"))
        found = self.page.evaluate("axe.run(document, {resultTypes: ['violations']})")
        return [
            f"{one['id']}: {one['help']}: {node['target']}"
            for one in found["violations"]
            if one["impact"] in impact
            for node in one["nodes"]
        ]


@pytest.fixture(scope="session")
def browser():
    path = os.environ.get("BROWSER_PROGRAM") or next(filter(None, map(shutil.which, NAMES)), None)
    if path is None:
        pytest.skip(f"no browser on the path: none of {', '.join(NAMES)}")
    # not where no page is looked at: it takes a third of a second
    from playwright.sync_api import sync_playwright

    with sync_playwright() as opened:
        found = opened.chromium.launch(executable_path=path, args=list(QUIET))
        yield found
        found.close()


@pytest.fixture
def visit(browser):
    """Open an address or a file, as wide and as dark as asked for."""
    contexts = []

    def opened(address, *, width=1280, height=900, dark=False, **settings):
        context = browser.new_context(
            viewport={"width": width, "height": height},
            color_scheme="dark" if dark else "light",
            **settings,
        )
        contexts.append(context)
        found = Visit(context.new_page())
        found.page.on("pageerror", lambda error: found.errors.append(str(error)))
        found.page.on(
            "console",
            lambda said: found.errors.append(said.text) if said.type == "error" else None,
        )
        found.page.on("request", lambda asked: found.requests.append(asked.url))
        found.page.goto(address.as_uri() if isinstance(address, Path) else address)
        return found

    yield opened
    for context in contexts:
        context.close()
