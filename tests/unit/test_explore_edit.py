"""campaign.toml is changed line by line, and what is not meant to change stays as it is."""

import difflib
import tomllib
from pathlib import Path

import pytest

from reduction.pages.explorer_campaign import _edited, _value_at
from reduction.record.errors import SettingsError

TEXT = '''# about the campaign
[campaign]
id = "x"   # the id

[tests.T-1]
file = "T-1.csv"  # as sent, [not] a = "table"
note = """
[tests.T-9]
order = 5
"""
n_cycles = 10      # ten

# about T-2
[tests.T-2]
file = "T-2.csv"
target_strain = [
  0.5,   # low
  1.5,
]
reduction.cycles.band = "0.2 ft"   # why

[[tests.T-2.steps]]
name = "a"
from = "1 s"   # begins
to = "2 s"
[[tests.T-2.steps]]
name = "b"
from = "2 s"
to = "3 s"

[tests.T-3]
file = 'c.csv'
[tests.T-3.reduction.cycles]
  trim_threshold = 0.9
'''


def lines_changed(before, after):
    lines = difflib.ndiff(before.splitlines(), after.splitlines())
    return sorted(line for line in lines if line[0] in "+-")


@pytest.mark.parametrize(
    ("path", "value", "changed"),
    [
        (("tests", "T-1", "reduction", "cycles", "band"), "1 ft",
         ['+ reduction.cycles.band = "1 ft"']),
        (("tests", "T-2", "reduction", "cycles", "band"), "1 ft",
         ['- reduction.cycles.band = "0.2 ft"   # why', '+ reduction.cycles.band = "1 ft"   # why']),
        (("tests", "T-2", "reduction", "cycles", "band"), None,
         ['- reduction.cycles.band = "0.2 ft"   # why']),
        (("tests", "T-2", "steps", 1, "from"), "2.5 s", ['- from = "2 s"', '+ from = "2.5 s"']),
        (("tests", "T-3", "reduction", "cycles", "band"), "1 ft", ['+   band = "1 ft"']),
        (("tests", "T-3", "reduction", "modulus", "window"), "5 %",
         ['+ reduction.modulus.window = "5 %"']),
        (("tests", "T-2", "target_strain", 0), 0.25,
         ["-   0.5,   # low", "+   0.25,   # low"]),
        (("tests", "T-4", "order"), 4, ["+ ", "+ [tests.T-4]", "+ order = 4"]),
        (("tests", "T-1", "n_cycles"), 10, []),
        (("tests", "T-1", "order"), None, []),
    ],
)  # fmt: skip
def test_one_key_moves_and_every_other_line_stays(path, value, changed):
    made = _edited(TEXT, {path: value})
    assert lines_changed(TEXT, made) == sorted(changed)
    assert _value_at(tomllib.loads(made), path) == value


def test_a_new_line_stands_with_its_test_and_not_below_the_comment_of_the_next():
    made = _edited(TEXT, {("tests", "T-1", "order"): 1})
    assert "n_cycles = 10      # ten\norder = 1\n\n# about T-2\n" in made


def test_an_inline_table_is_changed_within_its_line():
    text = '[tests.T]\nstrain = { marks = "m.csv" }  # tape\n'
    made = _edited(text, {("tests", "T", "strain", "method"): "marks"})
    assert made == '[tests.T]\nstrain = { marks = "m.csv", method = "marks" }  # tape\n'
    both = {("tests", "T", "strain", "method"): None, ("tests", "T", "strain", "marks"): None}
    assert _edited(made, both) == "[tests.T]\n"


def test_all_tests_on_one_line_are_changed_within_it():
    text = 'tests = { T = { file = "a" } }  # all\n[campaign]\nid = "x"\n'
    made = _edited(text, {("tests", "U", "strain"): {"method": "marks"}})
    line = 'tests = { T = { file = "a" }, U = { strain = { method = "marks" } } }  # all'
    assert made == text.replace(text.splitlines()[0], line)


def test_line_ends_of_the_file_are_kept():
    text = '[tests.T]\r\nfile = "a"\r\n'
    made = _edited(text, {("tests", "T", "order"): 1, ("tests", "U", "order"): 2})
    assert made == text + "order = 1\r\n\r\n[tests.U]\r\norder = 2\r\n"


def test_a_file_without_a_last_line_end_gets_one():
    assert _edited('[tests.T]\nfile = "a"', {("tests", "T", "order"): 1}) == (
        '[tests.T]\nfile = "a"\norder = 1\n'
    )


def test_dotted_keys_of_a_test_at_the_top_of_a_table_are_found():
    made = _edited('[tests]\nT.file = "a"\n"U V".file = "b"\n', {("tests", "U V", "order"): 2})
    assert made == '[tests]\nT.file = "a"\n"U V".file = "b"\n"U V".order = 2\n'


@pytest.mark.parametrize(
    ("value", "made"),
    [(None, ""), ({"method": "marks"}, 'strain = { method = "marks" }\n')],
)
def test_a_table_with_a_header_is_taken_out_or_written_on_one_line(value, made):
    text = '[tests.T]\nfile = "a"\n[tests.T.strain]\nmarks = "m.csv"\n'
    assert _edited(text, {("tests", "T", "strain"): value}) == f'[tests.T]\nfile = "a"\n{made}'


@pytest.mark.parametrize(
    ("text", "path", "value", "line"),
    [
        # a table in two places
        ('[tests.T]\nfile = "a"\n[defaults]\n[tests.T.strain]\nmarks = "m.csv"\n',
         ("tests", "T", "order"), 1, "written by hand: tests.T.order = 1"),
        ('[tests.T]\nfile = "a"\n[defaults]\n[tests.T.strain]\nmarks = "m.csv"\n',
         ("tests", "T", "reduction"), {"cycles": {"band": "1 ft"}},
         'written by hand: tests.T.reduction = { cycles = { band = "1 ft" } }'),
        ('[tests]\nT = 3\n', ("tests", "T", "order"), 1, "written by hand: tests.T.order = 1"),
    ],
)  # fmt: skip
def test_what_would_be_read_as_something_else_is_refused_with_the_line_to_write(
    text, path, value, line
):
    with pytest.raises(
        SettingsError, match=r"cannot be edited here; needed the line .* by hand"
    ) as told:
        _edited(text, {path: value})
    assert line in str(told.value)


@pytest.mark.parametrize(
    "value",
    ['a "b" \\ c', "é\x7f\x01\n\ttab", True, 1, -2.5e-9, [1, "x"], {"a b": {"c": []}}, {}],
)
def test_a_value_is_read_as_it_was_meant(value):
    path = ("tests", "T", "key")
    for text in ("[tests.T]\n", "", "[tests.T]\nkey = 0.1  # as it was\n"):
        made = _edited(text, {path: value})
        assert _value_at(tomllib.loads(made), path) == value
        assert ("# as it was" in text) == ("# as it was" in made)


def test_a_key_of_every_test_of_the_project_is_set_and_left_out_again():
    for path in sorted((Path(__file__).parents[2] / "raw").glob("*/campaign.toml")):
        text = path.read_bytes().decode("utf-8")
        document = tomllib.loads(text)
        if isinstance(document.get("tests"), str):
            continue
        for test in document["tests"]:
            key = ("tests", test, "reduction", "holds", "maximum_terms")
            made = _edited(text, {key: 2})
            (line,) = lines_changed(text, made)
            assert line.endswith("maximum_terms = 2"), (path, line)
            assert _edited(made, {key: None}) == text
