"""The documentation is built as it is published, and no warning comes of it.

First every command of docs/get-started.md is run, in its order; then its products are those that the
scripts of the gallery read. Nightly each of these is run by the build, by default a few.
"""

import contextlib
import doctest
import itertools
import os
import re
import shlex
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from commandruns import ROOT, reduction
from hiddenpackages import environment_with

NEEDED = ("sphinx", "furo", "matplotlib", "myst_parser", "numpydoc", "sphinx_gallery")
MADE = shutil.ignore_patterns("_build", "gallery", "reference", "tutorial", "__pycache__")
PAGE = (ROOT / "docs" / "get-started.md").read_text(encoding="utf-8")
README = (ROOT / "README.md").read_text(encoding="utf-8")
STEPS = re.findall(r"^```(sh|text|python)\n(.*?)^```$", PAGE, re.M | re.S)
SCRIPTS = sorted(
    path.relative_to(ROOT / "docs") for path in (ROOT / "docs").glob("[et]*/plot_*.py")
    if path.parent.name in ("examples", "tutorials")
)  # fmt: skip
# a reader's first, one of each kind of source, and what is copied to be changed
RUN_OFTEN = (
    "plot_01_tether_test",
    "plot_02_rope_design_values",
    "plot_03_hose_against_its_test",
    "plot_07_own_reader",
    "plot_1_whoi_2005_10",
)
# references to scripts that were not run lead nowhere
IN_PART = (
    "-D", "nitpicky=0",
    "-D", f"sphinx_gallery_conf.filename_pattern={'|'.join(f'/{name}.py' for name in RUN_OFTEN)}",
)  # fmt: skip
RUN_ALONE = [word for name in ("T-1", "T-2", "T-4-extended") for word in ("--test", name)]
OPENED = (
    "index", "method", "errata", "gallery/index", "tutorial/plot_1_whoi_2005_10",
    "reference/commands",
)  # fmt: skip
PAGES_OF = {"examples": "gallery", "tutorials": "tutorial"}


def commands(body):
    return [line for line in body.replace("\\\n", " ").splitlines() if line]


def without_blank_ends(text):
    return [line.rstrip() for line in text.strip().splitlines()]


@pytest.fixture(scope="module")
def walked(tmp_path_factory):
    """What each command printed, in a folder that has the raw files and nothing else."""
    folder = tmp_path_factory.mktemp("five-minutes")
    (folder / "raw").symlink_to(ROOT / "raw")
    (folder / "my-logs").mkdir()
    shutil.copy(ROOT / "raw" / "tmt-synthetic" / "T-1.csv", folder / "my-logs")
    done = {}
    for kind, body in STEPS:
        for line in commands(body) if kind == "sh" else ():
            program, *arguments = shlex.split(line)
            if program == "reduction":
                # the whole campaign is run by tests of its own; here those that are asked for
                arguments += RUN_ALONE if arguments[0] == "run" else []
                done[line] = reduction(*arguments, cwd=folder, COLUMNS="96")
    return folder, done


def test_it_installs_as_the_readme_does():
    (install, _) = commands(STEPS[0][1])
    main_job = re.search(r"^(python3 -m venv .*? && .*?) && .*reduction run (\S+)$", README, re.M)
    assert install == main_job[1]
    assert f"reduction run {main_job[2]}" in PAGE


def test_every_command_runs(walked):
    _, done = walked
    assert len(done) == 6
    for line, one in done.items():
        assert one.returncode == 0, f"{line}\n{one.stderr}"


def test_the_answers_on_the_page_are_those_of_the_commands(walked):
    _, done = walked
    shown = {
        commands(before)[-1]: body
        for (_, before), (kind, body) in itertools.pairwise(STEPS)
        if kind == "text"
    }
    assert len(shown) == 3
    for line, body in shown.items():
        assert without_blank_ends(done[line].stdout) == without_blank_ends(body), line


def test_the_lines_of_python_give_what_they_show(walked):
    folder, _ = walked
    lines = "".join(body for kind, body in STEPS if kind == "python")
    example = doctest.DocTestParser().get_doctest(lines, {}, "get-started", None, 0)
    with contextlib.chdir(folder):
        assert not doctest.DocTestRunner().run(example).failed


def test_what_the_page_names_is_there(walked):
    folder, _ = walked
    for name in (
        "processed/tmt-synthetic", "reports/tmt-synthetic/index.html", "tether.dat", "tether_table.txt",
        "my-logs/campaign.toml", "my-logs/tests.csv",
    ):  # fmt: skip
        assert Path(folder, name).exists(), name
    assert "tether_table.txt" in (folder / "tether.dat").read_text(encoding="utf-8")


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
def built(request, walked, tmp_path_factory):
    """The folder of a build from a copy, so that nothing is written beside the sources.

    It has what the extra `docs` brings and nothing else. It is whole where a nightly test asks for
    it; otherwise a few scripts of the gallery are run.
    """
    for name in NEEDED:
        pytest.importorskip(name)
    work, _ = walked
    folder = tmp_path_factory.mktemp("docs")
    shutil.copytree(ROOT / "docs", folder / "docs", ignore=MADE)
    for path in ROOT.iterdir():
        if path.name not in ("docs", "processed", "reports") and not path.name.startswith("."):
            (folder / path.name).symlink_to(path)
    is_whole = any(
        item.get_closest_marker("nightly")
        for item in request.session.items
        if item.path == request.path
    )
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-j", "2", "-b", "html",
         *(["-n"] if is_whole else IN_PART), "docs", "out"],
        cwd=folder, capture_output=True, text=True, check=False,
        env=environment_with(folder / "site", "docs") | {"REDUCTION_DOCS_WORK": str(work)},
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


@pytest.mark.parametrize(
    ("name", "least"),
    [
        ("method", 50),
        pytest.param("reference/api/prediction", 50, marks=pytest.mark.nightly),
    ],
)
def test_formulas_are_set(name, least, built):
    text = (built / f"{name}.html").read_text(encoding="utf-8")
    assert text.count("<math ") > least
    assert ".. math::" not in text


@pytest.mark.parametrize(
    "script",
    [
        pytest.param(
            path,
            id=path.stem,
            marks=() if path.stem in RUN_OFTEN else pytest.mark.nightly,
        )
        for path in SCRIPTS
    ],
)
def test_a_script_ran_and_is_shown_with_what_it_printed_and_drew(script, built):
    page = (built / PAGES_OF[script.parent.name] / f"{script.stem}.html").read_text(
        encoding="utf-8"
    )
    assert "sphx-glr-script-out" in page
    assert f"sphx_glr_{script.stem}_001.png" in page
    assert "Traceback" not in page


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_every_figure_says_what_its_numbers_are(script):
    text = (ROOT / "docs" / script).read_text(encoding="utf-8")
    figures = text.split("plt.subplots(")[1:]
    assert figures
    for one in figures:
        assert re.search(r"synthetic|published|computed|made-up", one), one[:200]


@pytest.mark.parametrize(
    ("name", "width"),
    [
        ("index", 1280),
        ("method", 390),
        *(
            pytest.param(name, width, marks=pytest.mark.nightly)
            for name, width in itertools.product(OPENED, (1280, 390))
            if (name, width) not in (("index", 1280), ("method", 390))
        ),
    ],
)
def test_a_page_opens_from_the_disk_and_is_as_wide_as_the_screen(name, width, built, visit):
    opened = visit(built / f"{name}.html", width=width)
    assert not opened.errors
    assert not opened.beyond
    assert opened.page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")
    if width == 1280:
        assert not opened.faults()
