"""Cyclic tests made from a law, for the tests of the stages that reduce them."""

import gc
import os
from pathlib import Path

import hypothesis
import numpy as np
import pytest
from visits import browser, visit

from reduction.stages.cycles.cycle_product import Cycles

# modules, items and reports stay to the end: they are looked through for circles as seldom as the
# command does it
gc.set_threshold(100_000, 20, 50)

# a run puts fifty files on the disk and waits 7 ms for each, as long as it works; no power fails
# while it is tested, and tests/faults holds the order of these calls in processes of their own
os.fsync = os.fstat

# an example takes as long as the machine lets it: others may work beside
hypothesis.settings.register_profile("some", deadline=None, max_examples=20)
hypothesis.settings.register_profile("nightly", deadline=None, max_examples=100)
hypothesis.settings.load_profile("some")


# each takes a minute or more; the first makes the campaigns that others read, and would wait for
LONGEST = (
    "browser/test_campaign_pages.py", "docs/test_docs_build.py", "cli/test_run_workers.py",
    "browser/test_design_values.py", "oracle/test_strangers_end_to_end.py",
)  # fmt: skip
# each takes ten seconds or more and would be among the last by its name: a process would be left alone
LATE = ("unit/test_verify.py", "unit/test_workers.py", "unit/test_strain_fit.py")
# files in which all is nightly but a few tests, which are slow
NIGHTLY_BUT = {
    "cli/test_run_workers.py": ("test_products_have_the_same_bytes_on_any_number_of_workers[2]",),
    "browser/test_design_values.py": (
        "test_questions_put_into_the_form_are_answered_in_the_same_words[2]",
        "test_lines_with_everything_at_once_have_the_answers_of_the_command",
        "test_the_page_is_sound_for_everybody[dark-390]",
        "test_levels_of_an_own_rope_are_the_table_of_the_command",
    ),
    "browser/test_explorer.py": ("test_a_setting_is_moved_seen_saved_and_run",),
    "cli/test_hostile_binary.py": (
        "test_a_hostile_log_is_refused_with_a_message_in_little_memory[log.xlsx-encrypted]",
        "test_a_hostile_log_is_refused_with_a_message_in_little_memory[log.h5-external_link_on_the_way]",
        "test_a_hostile_log_is_refused_with_a_message_in_little_memory[log.json-json_of_many_brackets]",
        "test_a_hostile_archive_is_refused_or_looked_up[cut_in_half]",
        "test_a_hostile_archive_is_refused_or_looked_up[strain_is_passwd]",
    ),
    "cli/test_run_history.py": (
        "test_a_product_made_while_one_test_failed_does_not_stand_for_another",
        "test_what_a_failed_test_did_is_not_known_and_is_said",
        "test_weights_are_in_the_history_and_have_one",
        "test_each_product_has_the_key_of_its_settings",
        "test_a_warning_goes_with_the_other_test_that_caused_it",
    ),
    "cli/test_run_remote.py": (
        "test_without_the_option_nothing_is_fetched[words4-the source]",
        "test_a_log_that_is_not_there_is_the_error_of_its_test",
        "test_check_fetches_logs_and_writes_nothing",
        "test_an_export_of_a_remote_archive_is_that_of_a_local_one",
    ),
    "cli/test_run_rests_on.py": (
        "test_a_test_that_is_parted_into_steps_is_put_aside_and_nothing_answers_from_it",
    ),
    "faults/test_faults.py": (
        "test_a_call_that_fails_is_told_and_leaves_old_or_new_products[write-processed/short/.B.nc.-28-True-6]",
        "test_the_order_in_which_products_become_new_is_known",
    ),
    "oracle/test_load_train.py": (
        "test_what_is_not_stated_is_told_with_the_size_that_matters[train-both-unstated]",
        "test_what_is_stated_of_the_load_train_is_taken_off_with_its_uncertainty[train-both]",
    ),
}
# files that run campaigns or start servers over and over
SLOW_FILES = (
    "cli/test_catalogue.py", "cli/test_explore.py", "cli/test_hostile_binary.py",
    "cli/test_run_remote.py", "cli/test_verify.py", "unit/test_catalogue.py",
    "unit/test_explore_server.py", "unit/test_explore_session.py", "unit/test_remote_transfer.py",
    "unit/test_report_client.py", "unit/test_verify.py",
)  # fmt: skip
SLOW_FOLDERS = ("browser", "docs", "faults", "fuzz")
# what a whole campaign of the project or a browser is needed for
SLOW_FIXTURES = {"synthetic", "static", "nylon_campaign", "hose_campaign", "campaigns", "browser"}


@pytest.hookimpl(wrapper=True)
def pytest_collect_file():
    """Examples are those of the package: in tests and their helpers there is nothing to look for."""
    found = yield
    return [one for one in found if type(one).__name__ != "DoctestModule"]


def pytest_collection_finish(session):
    """What was collected stays to the end: it is not looked through for circles again."""
    gc.collect()
    gc.freeze()


def is_nightly(config):
    return config.option.markexpr == "nightly"


def pytest_configure(config):
    """Before the tests are imported: each of them asks how many examples it has."""
    if is_nightly(config):
        hypothesis.settings.load_profile("nightly")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config, items):
    """Mark by folder and fixture, and put the longest files first.

    A property is tried with some examples by default and with all of them nightly. No process is
    left alone with a long file at the end.
    """
    tests = Path(__file__).parent
    slow_places = {tests / name for name in (*SLOW_FOLDERS, *SLOW_FILES)}
    nightly_but = {tests / name: kept for name, kept in NIGHTLY_BUT.items()}
    for item in items:
        if item.get_closest_marker("posix") and os.name != "posix":
            item.add_marker(pytest.mark.skip(reason="needs a POSIX system"))
        is_property = getattr(getattr(item, "obj", None), "is_hypothesis_test", False)
        if is_nightly(config) and is_property:
            item.add_marker(pytest.mark.nightly)
        if item.path in nightly_but:
            is_kept = item.name in nightly_but[item.path]
            item.add_marker(pytest.mark.slow if is_kept else pytest.mark.nightly)
        if (
            item.get_closest_marker("nightly")
            or SLOW_FIXTURES & set(getattr(item, "fixturenames", ()))
            or not slow_places.isdisjoint((item.path, *item.path.parents))
        ):
            item.add_marker(pytest.mark.slow)
    places = {tests / name: place for place, name in enumerate((*LONGEST, *LATE))}
    items.sort(key=lambda item: places.get(item.path, len(places)))


# a process of the tests has one browser, whichever folder asks for it first
__all__ = ["browser", "visit"]


def make_triangle(
    n_cycles=10, per_cycle=100, low=1.0, high=1.5, *, trimmed=0, begins="valley", phase=0.0
):
    """Strain of a triangular test and its cycles; ``trimmed`` samples go from each branch end."""
    half = per_cycle // 2
    n_samples = 2 * half * n_cycles + 1
    turn = np.arange(2 * n_cycles + 1) * half
    strain = (
        low
        + (high - low) * np.abs((np.arange(n_samples) + phase + half) % (2 * half) - half) / half
    )
    if begins == "peak":
        strain = low + high - strain
    edges = np.stack([turn[:-1], turn[1:]], axis=-1).reshape(n_cycles, 2, 2)
    ascending, descending = (0, 1) if begins == "valley" else (1, 0)
    half_number = np.minimum(np.arange(n_samples) // half, 2 * n_cycles - 1)
    within = np.arange(n_samples) - half * half_number
    first_is_up = begins == "valley"
    cycles = Cycles(
        first=turn[:-1:2],
        last=turn[2::2],
        branch_first=edges[:, [ascending, descending], 0],
        branch_last=edges[:, [ascending, descending], 1],
        plateau_rate=np.ones((n_cycles, 2)),
        cycle_number=(half_number // 2 + 1).astype(np.int32),
        branch=np.where((half_number % 2 == 0) == first_is_up, 1, 2).astype(np.int8),
        is_in_trimmed_branch=(within >= trimmed) & (within <= half - trimmed),
        band=0.01,
    )
    return strain, cycles


@pytest.fixture(scope="session")
def triangle():
    return make_triangle
