"""A row of the schema takes unit and meaning from the vocabulary."""

import pytest

from reduction.archive.schema import SCHEMA, schema_of
from reduction.archive.test_variables import STEPWISE
from reduction.archive.variables import Variable
from reduction.record.errors import ArchiveError


def test_a_name_that_the_vocabulary_lacks_is_refused():
    with pytest.raises(ArchiveError, match=r"'colour' has no row in the vocabulary"):
        Variable("colour", (), "f8")


def test_companions_take_unit_and_meaning_from_their_base():
    row = SCHEMA["tangent_modulus_standard_uncertainty"]
    assert row.unit == "Pa"
    assert row.long_name == (
        "standard uncertainty (k=1) of tangent modulus, trimmed branches, mean over the cycles"
    )
    assert SCHEMA["tangent_modulus_count"].unit == "1"


def test_a_companion_has_no_standard_name():
    assert SCHEMA["quality_flag"].standard_name == "quality_flag"
    assert SCHEMA["tension_standard_uncertainty"].standard_name is None


def test_a_number_has_an_uncertainty_or_a_reason_for_none():
    for row in [*SCHEMA.values(), *STEPWISE.values()]:
        assert row.has_uncertainty != bool(row.no_uncertainty), row.name
        assert row.is_text == (row.unit == ""), row.name


def test_what_a_row_refers_to_is_in_the_schema():
    for row in SCHEMA.values():
        assert set(row.ancillary) <= set(SCHEMA)
        assert not row.bounds or row.bounds in SCHEMA


def test_a_stepwise_test_has_its_own_time_and_tension():
    assert schema_of(is_stepwise=True)["time"].dims == ("step",)
    assert schema_of(is_stepwise=False)["time"].dims == ("sample",)
