"""The documentation is built as it is published, and no warning comes of it."""

import os
import re
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

for needed in ("sphinx", "furo", "myst_parser", "numpydoc"):
    pytest.importorskip(needed)

ROOT = Path(__file__).parents[2]
MADE = shutil.ignore_patterns("_build", "reference", "__pycache__")


class Page(HTMLParser):
    """What a page points at, and what in it can be pointed at."""

    def __init__(self, text):
        super().__init__()
        self.links, self.fetched, self.anchors = [], [], set()
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        found = dict(attrs)
        if found.get("id"):
            self.anchors.add(found["id"])
        if tag == "a" and found.get("href"):
            self.links.append(found["href"])
        for name in ("src", "srcset", "data", "poster"):
            if found.get(name):
                self.fetched.append(found[name])
        if tag == "link" and found.get("href"):
            self.fetched.append(found["href"])


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """The folder of a build from a copy, so that nothing is written beside the sources."""
    folder = tmp_path_factory.mktemp("docs")
    shutil.copytree(ROOT / "docs", folder / "docs", ignore=MADE)
    for path in ROOT.iterdir():
        if path.name not in ("docs", "processed", "reports") and not path.name.startswith("."):
            (folder / path.name).symlink_to(path)
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-n", "-q", "-j", "2", "-b", "html", "docs", "out"],
        cwd=folder, capture_output=True, text=True, check=False,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return folder / "out"


@pytest.fixture(scope="module")
def pages(built):
    return {
        path.relative_to(built).as_posix(): Page(path.read_text(encoding="utf-8"))
        for path in built.rglob("*.html")
    }


def test_every_document_has_a_page(built, pages):
    sources = {
        path.relative_to(ROOT / "docs").with_suffix(".html").as_posix()
        for path in (ROOT / "docs").rglob("*.md")
        if path.relative_to(ROOT / "docs").parts[0] not in ("_build", "reference")
    }
    assert sources <= pages.keys()


def test_every_inner_link_leads_to_a_page_and_an_anchor(built, pages):
    lost = []
    for name, page in pages.items():
        for link in page.links:
            target = urlsplit(link)
            if target.scheme or target.netloc:
                continue
            path = unquote(target.path)
            there = os.path.normpath(Path(name).parent / path) if path else name
            there = Path(there).as_posix()
            if there in pages:
                if target.fragment and unquote(target.fragment) not in pages[there].anchors:
                    lost.append((name, link))
            elif not (built / there).exists():
                lost.append((name, link))
    assert not lost


def test_nothing_is_fetched_from_the_network(built, pages):
    fetched = {one for page in pages.values() for one in page.fetched}
    assert not [
        one for one in fetched if urlsplit(one).scheme in ("http", "https") or one.startswith("//")
    ]
    styles = "".join(path.read_text(encoding="utf-8") for path in built.rglob("*.css"))
    assert not re.findall(r"(?:url\(|@import)\s*[\"']?(?:https?:)?//[^)\s]*", styles)


def test_formulas_are_set(built):
    text = (built / "reference" / "api" / "predict.html").read_text(encoding="utf-8")
    assert text.count("<math ") > 100
    assert ".. math::" not in text
