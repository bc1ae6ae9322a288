"""The figures of a report page, read without a browser, and what a reader takes away from one."""

import csv
import io
import json
import re
import zlib
from base64 import b64decode

_FIGURE = re.compile(
    r'<script type="text/deflate" id="([^"]+)-data" data-size="\d+">(.*?)</script>'
)


def figures_of(page):
    """Each figure of a page by its anchor: what plotly is given."""
    found = _FIGURE.findall(page.read_text(encoding="utf-8"))
    return {
        key: json.loads(zlib.decompress(b64decode(text), -zlib.MAX_WBITS)) for key, text in found
    }


def take(shown, figure, kind):
    """Name and content of the file that a button of a figure gives."""
    button = shown.page.locator(f"#{figure}").get_by_role("button", name=f"{kind}: ")
    with shown.page.expect_download() as waiting:
        button.press("Enter")
    return waiting.value.suggested_filename, waiting.value.path().read_bytes()


def table_of(content):
    """First line, headings and rows of the data of a figure."""
    assert content.startswith(b"\xef\xbb\xbf")
    first, *rows = csv.reader(io.StringIO(content.decode("utf-8-sig"), newline=""))
    return first, rows[0], rows[1:]
