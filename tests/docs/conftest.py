"""The browser of the tests of pages."""

from browser.conftest import browser, visit

__all__ = ["browser", "visit"]
