"""A reduced test as one flat dataset that follows CF, and every part of it by name."""

from __future__ import annotations

import xarray as xr

from reduction.archive.attributes import global_attributes
from reduction.archive.build import build_dataset
from reduction.archive.curves import (
    curve_values,
    elastomer_values,
    first_loading_values,
    ratio_values,
    segment_values,
    stress_at_strain_values,
)
from reduction.archive.holds import hold_values, standstill_values
from reduction.archive.kept import KeptSamples
from reduction.archive.lag import lag_values
from reduction.archive.line import (
    line_values,
    pull_values,
    random_of_line,
    spread_of_line_values,
)
from reduction.archive.notes import note_values
from reduction.archive.per_cycle import (
    amplitude_values,
    cycle_values,
    end_modulus_values,
    identity_values,
    loop_values,
    slip_values,
    trend_values,
)
from reduction.archive.programme import rope_values
from reduction.archive.samples import row_account, sample_values
from reduction.archive.schema import schema_of
from reduction.archive.shared import with_shared
from reduction.archive.specimens import (
    history_values,
    random_of_section,
    specimen_values,
    strain_model_values,
)
from reduction.archive.stepwise import stepwise_values
from reduction.archive.values import Values
from reduction.product import ReducedTest


def to_dataset(
    test: ReducedTest, *, version: str, command: str, kept: KeptSamples | None = None
) -> xr.Dataset:
    """Bring a reduced test into the form of the archive; no file is touched.

    Parameters
    ----------
    test : ReducedTest
        All that one log gave.
    version : str
        Version of this software.
    command : str
        What the user asked for, without paths, jobs and scheduler.
    kept : KeptSamples, optional
        Which samples are stored; every one where it is left out.

    Returns
    -------
    dataset : xarray.Dataset
        Names, dimensions and attributes of `reduction.archive.schema`, encoding
        included. Equal inputs give equal datasets.

    Raises
    ------
    ArchiveError
        If an array does not have the dimensions of its name, or a name is unknown.
    """
    return build_dataset(
        _all_values(test, kept),
        schema_of(is_stepwise=test.stepwise is not None),
        attributes=global_attributes(
            test, version=version, command=command, samples="all" if kept is None else kept.words
        ),
    )


def _all_values(test: ReducedTest, kept: KeptSamples | None) -> Values:
    names = tuple(one.name for one in test.specimens)
    values = specimen_values(test.specimens) | note_values(test)
    if test.stepwise is not None:
        values |= stepwise_values(test.stepwise)
    elif test.record is not None:
        values |= row_account(test.record, kept) | sample_values(test, test.record, kept)
    if test.history is not None:
        values |= history_values(test.history)
    if test.strain_models:
        values |= strain_model_values(test.strain_models)
    if test.standstills is not None:
        values |= standstill_values(test.standstills)
    if test.cycles is not None:
        values |= cycle_values(test.cycles, control=test.description.control)
    if test.loops is not None:
        values |= loop_values(test.loops)
    if test.end_moduli is not None:
        values |= end_modulus_values(test.end_moduli)
    if test.identity is not None:
        values |= identity_values(test.identity)
    if test.amplitude is not None:
        values |= amplitude_values(test.amplitude)
    if test.line is not None and test.line_of_test is not None:
        values |= line_values(test.line, test.line_of_test, test.quasi_static_standard_uncertainty)
    if any(test.pulls):
        values |= pull_values(test.pulls, test.specimens)
    if test.rope_step is not None:
        values |= rope_values(test.rope_step, test.specimens)
    if test.trend is not None:
        values |= trend_values(test.trend)
    if test.slips is not None:
        values |= slip_values(test.slips, specimens=names)
    if test.curves is not None:
        values |= curve_values(test.curves)
    if test.first_loading is not None:
        values |= first_loading_values(test.first_loading)
    if test.segments is not None:
        values |= segment_values(test.segments)
    if test.ratios:
        values |= ratio_values(test.ratios)
    if test.elastomers:
        values |= elastomer_values(test.elastomers)
    if test.holds:
        values |= hold_values(test.holds)
    stress, spread = test.stress_at_strain, test.stress_at_strain_standard_uncertainty
    if stress is not None and spread is not None:
        values |= stress_at_strain_values(stress, spread, test.stress_at_strain_levels)
    if test.slack_strain is not None:
        left = test.slack_strain
        values["slack_strain_at_unloading"] = left.strain
        values["slack_strain_at_unloading_standard_uncertainty"] = left.standard_uncertainty
    values = with_shared(
        values,
        test.contributions,
        test.shared_uncertainty_of_cycles,
        (
            {}
            if test.line is None or test.line_of_test is None
            else random_of_line(test.line, test.line_of_test)
        )
        | (
            {}
            if test.contributions is None
            else random_of_section(test.specimens, test.contributions)
        ),
    )
    if test.channel_lag is not None:
        values |= lag_values(test.channel_lag)
    if test.line_of_test is not None and test.line_spread is not None:
        values |= spread_of_line_values(test.line_spread, values)
    return values
