"""No number of a synthetic campaign's tables lacks its uncertainty, or columns.csv says why."""

import pytest
from csvrows import csv_rows

pytestmark = pytest.mark.slow

_WORDLESS = ("", "label", "is an uncertainty")


def is_number(text):
    try:
        float(text)
    except ValueError:
        return False
    return True


@pytest.fixture(params=["tethers", "ropes"])
def tables(request):
    if request.param == "ropes":
        return request.getfixturevalue("nylon_campaign").processed / "tables"
    return request.getfixturevalue("synthetic").processed / "tables"


def test_every_numeric_column_has_its_uncertainty_or_columns_csv_says_why(tables):
    explained = {(row["table"], row["column"]): row for row in csv_rows(tables / "columns.csv")}
    checked = 0
    for path in sorted(tables.glob("*.csv")):
        rows = csv_rows(path)
        header = list(rows[0])
        for place, column in enumerate(header):
            cells = [row[column] for row in rows if row[column]]
            if not cells or not all(is_number(cell) for cell in cells):
                continue
            checked += 1
            base = column.partition(" [")[0]
            follower = header[place + 1] if place + 1 < len(header) else ""
            if follower.startswith(f"{base}_standard_uncertainty"):
                continue
            reason = explained[path.name, column]["no_uncertainty"]
            assert reason not in _WORDLESS or "standard_uncertainty" in base, (path.name, column)
            # where the campaign states its instruments, theirs is carried to the number
            assert "that of the channel" not in reason, (path.name, column)
    assert checked > 100


# a single reading of a diameter shows no scatter; a mean over cycles that no bin is full of, none
_UNKNOWN = {
    "diameter", "area", "tangent_modulus_untrimmed", "branch_tension", "response_point_value",
}  # fmt: skip


def test_every_number_that_has_a_column_for_its_uncertainty_has_one_in_it(tables):
    for path in sorted(tables.glob("*.csv")):
        for row in csv_rows(path):
            for column, cell in row.items():
                base, found, unit = column.partition("_standard_uncertainty")
                if not found or base.endswith("_random") or base in _UNKNOWN:
                    continue
                value = next(row[name] for name in row if name.partition(" [")[0] == base)
                assert not (value and not cell), (path.name, column, unit)


def test_what_instruments_share_is_more_than_scatter_in_what_is_a_plain_reading(tables):
    rows = csv_rows(tables / "relaxation.csv")
    assert rows
    for row in rows:
        tension = float(row["hold_initial_tension [N]"])
        spread = float(row["hold_initial_tension_standard_uncertainty [N]"])
        # half of 0.5 % of gain at the least, where the scatter of a mean is a tenth of that
        assert spread > 0.0024 * tension
