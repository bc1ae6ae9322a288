"""What docs/export.md shows works as it is printed, for every format and form."""

import ast
import re
import shlex
from pathlib import Path

import pytest
from commandruns import run_once, shared_by_processes
from typer.testing import CliRunner

from reduction.cli.main import app
from reduction.lines.deck_formats import FORMATS, FORMS
from reduction.pages.design_values import _render_design_page
from reduction.quantities.names import SINGLE_QUANTITIES

DOCS = Path(__file__).parents[2] / "docs"
TEXT = (DOCS / "export.md").read_text(encoding="utf-8")


def commands():
    (body,) = re.findall(r"^```bash\n(.*?)^```$", TEXT, re.MULTILINE | re.DOTALL)
    return [shlex.split(line)[1:] for line in body.replace("\\\n", " ").strip().split("\n")]


def after(words, option):
    return words[words.index(option) + 1] if option in words else None


@pytest.mark.parametrize("arguments", commands(), ids=lambda words: after(words, "--out"))
def test_commands_end_well(arguments, tmp_path, monkeypatch, tmp_path_factory):
    if arguments[1].startswith("processed/"):
        made = run_once("tmt-synthetic", shared_by_processes(tmp_path_factory))
        (tmp_path / "processed").symlink_to(made.processed.parent)
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, arguments)
    assert done.exit_code == 0, done.output
    assert (tmp_path / after(arguments, "--out")).is_file()


def test_every_format_has_a_command_and_every_form_of_what_is_run_here():
    shown = {(after(words, "--to"), after(words, "--form")) for words in commands()}
    assert {name for name, _ in shown} == set(FORMATS)
    for name in ("moordyn", "moorpy"):
        first, *others = FORMS[name]
        assert {(name, None), *((name, form) for form in others)} <= shown, first


def test_every_format_has_a_row_with_its_forms():
    part = TEXT.partition("| format | forms")[2].partition("\n\n")[0]
    rows = [row.split("|")[1:3] for row in part.split("\n")[2:]]
    forms = {
        name: re.findall(r"`([\w-]+)`", told)
        for names, told in rows
        for name in re.findall(r"`([\w-]+)`", names)
    }
    assert set(forms) == set(FORMATS)
    assert all(tuple(told) == FORMS.get(name, ()) for name, told in forms.items())


def test_every_format_is_in_the_help_of_the_command():
    done = CliRunner().invoke(app, ["export", "--help"], terminal_width=400)
    (told,) = re.findall(r"--to\b(.*?)--out\b", done.output, re.DOTALL)
    assert set(FORMATS) <= set(re.findall(r"[\w-]+", told))


def test_every_mooring_code_is_on_the_page_of_design_values():
    (told,) = re.findall(r"after --to: (.*?)\.</p>", _render_design_page())
    assert ["moordyn", *told.split(", ")] == list(FORMS)


def test_no_two_commands_write_the_same_file():
    names = [after(words, "--out") for words in commands()]
    assert len(set(names)) == len(names)


def test_symbols_of_the_look_up_are_those_of_the_vocabulary():
    page = (DOCS / "lookup.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\w+) \| `(\w+)` \|", page, re.MULTILINE)
    assert len(rows) == 6
    for symbol, name in rows:
        assert SINGLE_QUANTITIES[name].source.split(",")[0].split()[-1] in (
            symbol, symbol.replace("_", "")
        )  # fmt: skip


def test_every_source_of_uncertainty_is_explained():
    page = (DOCS / "uncertainty.md").read_text(encoding="utf-8")
    root = DOCS.parent / "reduction"
    found = {
        call.args[0].value
        for path in root.rglob("*.py")
        for call in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(call, ast.Call) and getattr(call.func, "id", "") == "Component"
        if call.args and isinstance(call.args[0], ast.Constant)
    }
    assert {"diameter", "lag", "splice_method", "strain_calibration"} <= found
    part = page.partition("## Names of the sources")[2].partition("\n## ")[0]
    told = set(re.findall(r"`(\w+)`", part))
    assert found <= told, found - told
