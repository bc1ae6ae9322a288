"""Inputs that once broke the invariant, each with what was wrong; docs/fuzzing.md has the rule."""

from pathlib import Path

import pytest
from fuzzcases import CASES
from invariant import judge

FOUND = Path(__file__).parents[1] / "data" / "fuzz"
# file, case that it is a file of, which file, kind of change, what becomes of it
INPUTS = [
    # OverflowError: a whole number that no float holds
    ("json-huge-integer.json", "json", "A.json", "another log", "refused"),
    # the first of two lists of rows was lost without a word
    ("json-key-twice.json", "json", "A.json", "another log", "refused"),
    # LinAlgError: a clock that shows 1e300 s leaves a cycle without a fundamental
    ("matlab-time-of-1e300.mat", "matlab", "A.mat", "another log", "refused"),
    # a negative spring constant: the drift of the jump was taken off the last cycle
    ("delimited-load-falls-to-a-tenth.csv", "delimited", "A.csv", "another log", "flagged"),
    # LinAlgError: beside a gap all samples of a ramp are one instant
    ("delimited-gap-beside-a-turn.csv", "delimited", "A.csv", "fault", "flagged"),
    # a cell that was skipped with its broken tag
    ("spreadsheet-tag-lost-a-letter.xlsx", "spreadsheet", "A.xlsx", "another log", "refused"),
    # a part that no parser can read, beside sheets that were read all the same
    ("spreadsheet-unknown-encoding.xlsx", "spreadsheet", "A.xlsx", "another log", "refused"),
    # infinity went through as a number
    ("spreadsheet-infinite.xlsx", "spreadsheet", "A.xlsx", "fault", "refused"),
    # scipy goes on with numbers in the byte order of a Cray, which it cannot read
    ("matlab-4-cray.mat", "matlab-4", "A.mat", "another log", "refused"),
    # a warning of numpy for each NaN that signals
    (
        "parquet-plain-signalling-nan.parquet",
        "parquet-plain",
        "A.parquet",
        "another log",
        "flagged",
    ),
    # SIGSEGV: the type of numbers is taken for a place in a table, by scipy
    ("matlab-numbers-of-no-type.mat", "matlab", "A.mat", "another log", "refused"),
    # 750 MB for a name of that length, which is not in the file
    ("hdf5-matrix-name-of-750-MB.h5", "hdf5-matrix", "A.h5", "another log", "refused"),
    # what is free of a heap of texts has no size: the library never came to its end
    ("hdf5-heap-without-end.h5", "hdf5", "A.h5", "another log", "refused"),
    # 3.4 GB for lists in place of names, which the library takes before it looks for them
    ("hdf5-matrix-names-that-are-lists.h5", "hdf5-matrix", "A.h5", "another log", "refused"),
    # ValueError: a float with more bits than numpy has
    ("hdf5-float-of-no-type.h5", "hdf5", "A.h5", "another log", "refused"),
    # SIGSEGV: a unit of any length that is neither text nor row, by HDF5
    ("hdf5-unit-of-no-type.h5", "hdf5", "A.h5", "another log", "refused"),
    # a warning of numpy: a float of sixteen bytes that is infinite in eight
    ("hdf5-matrix-wide-float.h5", "hdf5-matrix", "A.h5", "another log", "refused"),
    # TypeError: a unit in letters of no encoding
    ("hdf5-unit-of-no-encoding.h5", "hdf5", "A.h5", "another log", "refused"),
    # loads of 2.96 and 3.22 lb were 2 and 3: stored as doubles, of a class of whole numbers
    ("matlab-doubles-of-a-whole-class.mat", "matlab", "A.mat", "another log", "refused"),
    # a warning of scipy: numbers that are no letters, in a text
    ("matlab-4-text-of-no-letters.mat", "matlab-4", "A.mat", "another log", "refused"),
    # pint takes kN and a NUL, or a comment, for kN
    ("marked-unit-with-nul.csv", "marked", "results.csv", "another log", "refused"),
    # the sign of a time channel was ignored
    ("delimited-time-with-a-sign.toml", "delimited", "campaign.toml", "fault", "refused"),
    # 2 m were added to a tension
    ("delimited-load-with-a-length.toml", "delimited", "campaign.toml", "fault", "refused"),
    # ValueError of JSON: numbers in the settings of a product are finite
    ("delimited-diameter-beyond-a-float.toml", "delimited", "campaign.toml", "fault", "refused"),
    ("delimited-tolerance-infinite.toml", "delimited", "campaign.toml", "fault", "refused"),
    ("delimited-stress-at-nan.toml", "delimited", "campaign.toml", "fault", "refused"),
    ("delimited-factor-infinite.toml", "delimited", "campaign.toml", "fault", "refused"),
    # ValueError: a superscript is a digit to str.isdigit and none to int
    ("marked-order-is-a-superscript.csv", "marked", "tests.csv", "fault", "refused"),
]


# the library is stopped after ten seconds, and not before
LONG = "hdf5-heap-without-end.h5"


@pytest.mark.parametrize(
    ("found", "name", "file", "expected", "verdict"),
    [
        pytest.param(*one, id=one[0], marks=pytest.mark.nightly if one[0] == LONG else ())
        for one in INPUTS
    ],
)
def test_what_was_found_is_told(found, name, file, expected, verdict):
    case = CASES[name]
    data = (FOUND / found).read_bytes()
    assert judge(case, case.files | {file: data}, expected) == verdict


def test_every_input_that_was_found_is_tried():
    assert sorted(one[0] for one in INPUTS) == sorted(path.name for path in FOUND.iterdir())
