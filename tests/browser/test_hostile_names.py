"""Names with markup, quotes, line ends or 500 letters are text on the page, in figures and in files."""

import shutil

import netCDF4
import pytest
from commandruns import reduction
from pagefigures import table_of, take

from reduction.archive.open import open_archive

MARKUP = (
    '=1+1</script><script>window.hurt = 1</script><!-- <img src=x onerror="window.hurt = 2">'
    "<b>bold</b> <a href=\"https://example.org/\">link</a> 'quoted' & {{ 7 * 7 }} \n%{x} é"
)
LONG = "N" * 500
NAMES = {"markup": MARKUP, "long": LONG}


@pytest.fixture(scope="module", params=["markup", pytest.param("long", marks=pytest.mark.nightly)])
def hostile(request, small, tmp_path_factory):
    """The small campaign with such a name for all that has a name; of archives made elsewhere."""
    name = NAMES[request.param]
    folder = tmp_path_factory.mktemp("hostile")
    processed = folder / "processed" / "many"
    shutil.copytree(small.processed, processed)
    for path in processed.glob("*.nc"):
        with open_archive(path) as opened:
            data = opened.load()
        for variable in [*data.variables]:
            values = data[variable]
            if values.dtype.kind in "OU" and values.size and (values == "one").any():
                data[variable] = values.where(values != "one", name).astype(object)
        for attribute in ("title", "summary", "raw_file", "campaign", "institution", "operator"):
            data.attrs[attribute] = name
        encoding = {one: {"_FillValue": None} for one in data.variables}
        data.to_netcdf(path, encoding=encoding)
        with netCDF4.Dataset(path) as written:
            assert name in list(written["specimen"][:])
    done = reduction("report", processed, "--reports", folder / "reports")
    assert done.returncode == 0, done.stderr
    return name, folder / "reports" / "many" / "index.html"


@pytest.mark.nightly
@pytest.mark.parametrize("width", [390, 1280])
def test_a_name_is_text_and_breaks_no_layout(hostile, visit, width):
    name, page = hostile
    shown = visit(page, width=width)
    tab = shown.page
    plain = " ".join(name.split())
    assert " ".join(tab.locator("h1").inner_text().split()) == plain
    assert " ".join(tab.title().split()) == plain
    shown.open_section("T01")
    plot = shown.drawn("test-0-modulus-0")
    shown.drawn("test-0-record")
    assert tab.evaluate("window.hurt") is None
    assert tab.locator("img, iframe, script[src], main b:text-is('bold'), svg a").count() == 0
    assert tab.locator("a[href^='http']").count() == 0
    assert tab.locator("svg tspan[style*='bold']").count() == 0
    title = plot.locator(".gtitle").text_content()
    assert plain[:20] in title.replace("\N{NO-BREAK SPACE}", " ")
    assert tab.evaluate("document.documentElement.scrollWidth") <= width
    outside = tab.evaluate(
        "[...document.querySelectorAll('.gtitle, .legendtext')].filter(one => {"
        " const own = one.getBoundingClientRect(), all = one.closest('.plot').getBoundingClientRect();"
        " return all.width && (own.right > all.right + 1 || own.left < all.left - 1); })"
        ".map(one => one.textContent)"
    )
    assert outside == []
    assert shown.errors == []
    assert shown.beyond == []


@pytest.mark.nightly
def test_a_name_is_text_where_a_reader_points(hostile, visit):
    _, page = hostile
    shown = visit(page)
    shown.open_section("T01")
    plot = shown.drawn("test-0-spring-constant")
    place = plot.evaluate(
        """plot => { const {xaxis, yaxis} = plot._fullLayout;
             const trace = plot.data.find(one => one.mode === "lines+markers");
             return {x: xaxis._offset + xaxis.c2p(trace.x[4]), y: yaxis._offset + yaxis.c2p(trace.y[4])}; }"""
    )
    plot.hover(position=place)
    hover = plot.locator(".hoverlayer .hovertext")
    hover.first.wait_for()
    assert hover.locator("a, tspan[style*='bold']").count() == 0
    assert shown.page.evaluate("window.hurt") is None


@pytest.mark.nightly
def test_a_name_is_text_in_a_file_and_no_formula(hostile, visit):
    name, page = hostile
    shown = visit(page)
    shown.open_section("T01")
    file, content = take(shown, "test-0-spring-constant", "CSV")
    assert len(file) < 150
    assert not set(file) & set("<>:\"/\\|?*'= \n")
    first, columns, rows = table_of(content)
    assert len(first) == 1 and first[0].startswith("# SYNTHETIC DATA. ")
    assert len(columns) == 3
    lines = {row[0] for row in rows}
    if name == MARKUP:
        assert all(line.startswith("'=1+1</script>") for line in lines)
    assert not [cell for row in rows for cell in row if cell.startswith(("=", "@", "+"))]
    _, drawing = take(shown, "test-0-spring-constant", "SVG")
    assert b"<script" not in drawing and b"<a " not in drawing
