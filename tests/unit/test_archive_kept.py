"""Of a long record an archive holds selected cycles and what is in no cycle, and says so."""

import subprocess
import sys
import tracemalloc
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from long_records import AFTER, BEFORE, PER_CYCLE, cycles_of, long_test
from rulesofcf import hold_against_cf

from reduction.archive.open import open_archive
from reduction.archive.test_dataset import kept_samples, stored_cycles, to_dataset
from reduction.archive.test_variables import rope_values
from reduction.archive.write import write_archive
from reduction.record.settings import ModulusSettings, ReductionSettings, _ArchiveSettings
from reduction.stages.moduli.local_regression import select_cycles
from reduction.stages.three_parameter_line.rope_programme import RopeStep


def wanted(samples=None, longest=4000, selected=8):
    return ReductionSettings(
        archive=_ArchiveSettings(samples, longest),
        modulus=ModulusSettings(selected_cycles=selected),
    )


def places_of(cycles, numbers):
    """Of the cycles, from end to end, and of what is in none."""
    is_there = cycles.cycle_number == 0
    for number in numbers:
        is_there[cycles.first[number - 1] : cycles.last[number - 1] + 1] = True
    return np.flatnonzero(is_there)


def built(test, kept):
    return to_dataset(test, version="1.2.3", command="reduction run", kept=kept)


def test_a_short_record_a_whole_one_and_a_test_without_a_log_are_stored_as_they_are(stepwise_test):
    test = long_test()
    assert kept_samples(test, wanted(longest=test.record.n_samples)) is None
    assert kept_samples(test, wanted("all", longest=1000)) is None
    assert kept_samples(stepwise_test, wanted("selected", longest=1000)) is None
    assert kept_samples(test, wanted(longest=test.record.n_samples - 1)) is not None


def test_a_record_of_which_everything_is_selected_is_stored_whole():
    assert kept_samples(long_test(n_cycles=8), wanted("selected", longest=10**6)) is None


def test_selected_cycles_and_all_that_is_in_no_cycle_stay():
    test = long_test()
    found = kept_samples(test, wanted("selected", longest=10**6)).index
    # first three, last three, and by equal ratio between them: the rule of the modulus curves
    np.testing.assert_array_equal(found, places_of(test.cycles, [1, 2, 3, 10, 32, 98, 99, 100]))


def test_cycles_whose_curves_are_pooled_are_there_by_their_first():
    test = long_test()
    curves = type("Curves", (), {"selected_cycle": np.array([1, 41])})()
    found = kept_samples(replace(test, curves=curves), wanted("selected", longest=10**6))
    expected = places_of(test.cycles, [1, 2, 3, 10, 32, 41, 98, 99, 100])
    np.testing.assert_array_equal(found.index, expected)


def test_of_what_is_too_long_evenly_spaced_samples_and_the_ends_stay():
    test = long_test(n_samples=100_000)
    kept = kept_samples(test, wanted(longest=4000))
    # 500 samples, an eighth of 4000, and the last one
    np.testing.assert_array_equal(kept.index, [*range(0, 100_000, 200), 99_999])
    assert kept.words == (
        "501 of 100000; what is in no cycle, one sample in 200 of it and its ends"
    )


def test_slow_cycles_are_thinned_evenly_and_short_rests_are_whole():
    cycles = cycles_of(4, before=10, per_cycle=1000, after=10)
    test = long_test(cycles=cycles)
    index = kept_samples(test, wanted("selected", longest=3200)).index
    # 4004 samples of four cycles for 400
    expected = [
        *range(10), *(one for start in range(10, 4010, 1000) for one in range(start, start + 1000, 11)),
        *range(4010, 4021),
    ]  # fmt: skip
    np.testing.assert_array_equal(index, expected)


def test_every_rest_between_cycles_is_there():
    cycles = cycles_of(3000, per_cycle=10, rest=2, before=5, after=5)
    found = kept_samples(long_test(cycles=cycles), wanted("selected", longest=10**7)).index
    expected = places_of(cycles, select_cycles(3000, longest=8))
    np.testing.assert_array_equal(found, expected)


@settings(deadline=None)
@given(
    n_cycles=st.integers(1, 60),
    per_cycle=st.integers(2, 40).map(lambda half: 2 * half),
    rest=st.integers(0, 30),
    before=st.integers(0, 200),
    after=st.integers(0, 200),
    longest=st.integers(2, 20),
    most=st.integers(600, 4000),
)
def test_places_rise_stay_in_the_record_and_hold_the_ends_of_every_kept_cycle(
    n_cycles, per_cycle, rest, before, after, longest, most
):
    cycles = cycles_of(n_cycles, before=before, per_cycle=per_cycle, after=after, rest=rest)
    test = long_test(cycles=cycles)
    numbers = select_cycles(n_cycles, longest=longest)
    expected = places_of(cycles, numbers)
    kept = kept_samples(test, wanted("selected", longest=most, selected=longest))
    if kept is None:
        assert expected.size == test.record.n_samples
        return
    index = kept.index
    assert (np.diff(index) > 0).all()
    assert index[0] == 0 and index[-1] == test.record.n_samples - 1
    # every stretch and cycle adds its last sample, and one where its spacing begins anew
    assert index.size <= most // 4 + 2 * (n_cycles + 1 + numbers.size)
    assert set(cycles.first[numbers - 1]) | set(cycles.last[numbers - 1]) <= set(index)
    assert set(index) <= set(expected)
    if "one sample in" not in kept.words:
        np.testing.assert_array_equal(index, expected)


def test_the_archive_says_what_it_holds_and_counts_over_the_whole_record(tmp_path):
    test = long_test()
    kept = kept_samples(test, wanted("selected"))
    write_archive(built(test, kept), tmp_path / "L-1.nc")
    with open_archive(tmp_path / "L-1.nc") as archive:
        index = archive["sample_index"].values
        np.testing.assert_array_equal(index, kept.index)
        np.testing.assert_array_equal(archive["time"], test.record.time[index])
        for name, whole in (
            ("crosshead_position", test.record.crosshead_position),
            ("tension", test.record.tension),
            ("quality_flag", test.record.quality_flag),
            ("machine_cycle_number", test.record.cycle_counter),
            ("strain", test.strain),
            ("phase", test.phase),
            ("cycle_number", test.cycles.cycle_number),
            ("branch", test.cycles.branch),
        ):
            np.testing.assert_array_equal(archive[name], whole[..., index])
        area = np.pi / 4 * np.array([[0.02], [0.01]]) ** 2
        np.testing.assert_allclose(
            archive["nominal_stress"], test.record.tension[:, index] / area, rtol=1e-14
        )
        n_samples = BEFORE + 100 * PER_CYCLE + 1 + AFTER
        assert [int(archive[f"n_rows_{name}"]) for name in ("read", "kept", "stored")] == [
            n_samples + 2, n_samples, index.size,
        ]  # fmt: skip
        resampled = archive["quality_mask"].values.tolist().index("resampled")
        assert archive["n_flagged"].values[:, resampled].tolist() == [
            0,
            0,
            len(range(0, n_samples, 7)),
        ]
        # places in the record, whatever is stored of it
        np.testing.assert_array_equal(archive["cycle_first_sample"], test.cycles.first)
        assert archive.attrs["stored_samples"] == kept.words
        assert stored_cycles(archive).tolist() == [1, 2, 3, 10, 32, 98, 99, 100]
    assert kept.words.startswith(
        f"{index.size} of {n_samples}; 8 of 100 cycles (1, 2, 3, 10, 32, 98, 99, 100)"
    )


def test_an_archive_of_the_whole_record_has_no_index_of_samples(rich_test):
    dataset = built(rich_test, None)
    assert "sample_index" not in dataset
    assert stored_cycles(dataset).tolist() == dataset["cycle"].values.tolist()
    assert stored_cycles(dataset.drop_dims("cycle")).size == 0
    assert dataset.attrs["stored_samples"] == "all"
    assert int(dataset["n_rows_stored"]) == int(dataset["n_rows_kept"])


def test_an_archive_of_a_part_keeps_every_rule_of_cf(tmp_path):
    path = tmp_path / "L-1.nc"
    write_archive(built(long_test(), kept_samples(long_test(), wanted("selected"))), path)
    hold_against_cf(path)


def test_nothing_as_long_as_the_record_is_made_for_an_archive_of_a_part():
    test = long_test(cycles=cycles_of(2000, per_cycle=1000))
    built(test, kept_samples(test, wanted()))  # what is imported at the first time
    tracemalloc.start()
    built(test, kept_samples(test, wanted()))
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < test.record.time.nbytes / 4


TAKE = """
import sys
from pathlib import Path
import numpy as np
from reduction.archive.test_dataset import _KeptSamples
from reduction.record.samples import ColumnWriter

def memory(key):
    with open("/proc/self/status") as lines:
        return next(int(line.split()[1]) / 1024 for line in lines if line.startswith(key))

writer = ColumnWriter(Path(sys.argv[1]))
for _ in range(16):
    writer.append(np.zeros(1 << 20))
series = writer.finish()
kept = _KeptSamples(np.arange(0, series.size, 500), "")
before = memory("VmHWM")
assert kept.of(series).size == kept.index.size
print(memory("VmHWM") - before)
"""


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="no /proc to read the peak from")
def test_a_long_thinned_stretch_is_taken_off_the_disk_piece_by_piece(tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", TAKE, tmp_path], capture_output=True, text=True, check=True
    )
    assert float(done.stdout) < 40  # MB, of 128 that its samples lie in


# steps of a rope programme arrive at their places


def test_a_refused_pair_keeps_its_levels_and_its_reason(rich_test):
    dataset = to_dataset(rich_test, version="1", command="run")
    assert dataset["held_pair_specimen"].values.tolist() == ["new", "used"]
    assert dataset["static_refusal"].values.tolist() == ["", "the upper hold is too short"]
    assert np.isnan(dataset["static_stiffness"].values).tolist() == [False, True]
    assert dataset["held_pair_high_tension"].values.tolist() == [300.0, 300.0]
    of_time = dataset["static_stiffness_at_time"].values
    assert np.isfinite(of_time[0]).all() and np.isnan(of_time[1]).all()


def test_only_what_broke_has_a_strength(rich_test):
    dataset = to_dataset(rich_test, version="1", command="run")
    peak = dataset["pull_peak_tension"].values
    assert dataset["tensile_strength"].values[0] == peak[0]
    assert np.isnan(dataset["tensile_strength"].values[1]) and np.isfinite(peak[1])
    assert np.isnan(dataset["strain_at_failure_standard_uncertainty"].values[1])
    assert dataset["cycles_are_run_out"].values.tolist() == [0, 1]


def test_without_any_strength_nothing_over_it_is_there(rich_test):
    bare = tuple(replace(one, rated_break_strength=None) for one in rich_test.specimens)
    values = rope_values(rich_test.rope_step, bare)
    assert not [name for name in values if "over_strength" in name or "compliance" in name]
    assert "dynamic_stiffness" in values


def test_a_step_that_gives_one_thing_has_its_name_and_that():
    assert set(rope_values(RopeStep("creep"), ())) == {"programme_step"}
