import numpy as np
from export_lines import line

from reduction.lines.deck_text import header_lines, number, one_line, real_number
from reduction.lines.export_line import thin_curve


def test_numbers_are_short_and_lose_nothing_that_was_measured():
    assert number(0.1) == "0.1"
    assert number(100.0) == "100"
    assert real_number(100.0) == "100.0"
    assert real_number(1e-20) == "1.0e-20"
    assert float(number(np.pi)) == 3.14159265358979


def test_remarks_have_no_sign_that_a_grammar_knows():
    told = one_line('30 % of "RBS" # \u00e9 --- a|b {c}\n * /* x */')
    assert not set(told) & set('%"#|{}*\n')
    assert "---" not in told
    assert told.isascii()
    # with one hyphen it is no option of the command
    assert one_line("state --wet-linear-density") == "state --wet-linear-density"


def test_a_header_tells_range_error_source_and_that_it_is_synthetic():
    one = line(is_synthetic=True, notes=("a gap from strain 0.4 to 0.6",))
    text = " ".join(header_lines(one, thin_curve(one.strain, one.tension, most=30), "kN"))
    for part in (
        "SYNTHETIC", "mean of both branches", "tested from strain 0.1 to 1.4", "30 points of 400",
        "greatest error", "WHOI-2005-10, Table 5", "a gap from strain", "Remark: kN",
    ):  # fmt: skip
        assert part in text


def test_a_prediction_was_not_tested():
    one = line(tested=(np.nan, np.nan))
    assert "nothing was tested" in " ".join(
        header_lines(one, thin_curve(one.strain, one.tension, most=30))
    )


def test_a_line_of_a_header_never_breaks_inside_an_option():
    said = "9" * 84  # "Note: " and this leave nine signs: room for "--wet-", not for the option
    lines = header_lines(line(notes=(f"{said} --wet-linear-density",)), None)
    assert any(text.split() == ["--wet-linear-density"] for text in lines)
