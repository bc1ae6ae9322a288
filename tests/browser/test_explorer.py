"""The explorer as a person uses it: a setting moved, what follows seen, saved, and run."""

import json
import os
import shutil
import signal
import subprocess
import sys
from contextlib import contextmanager

import pytest
from commandruns import ROOT, reduction
from manytests import hear_interrupts
from playwright.sync_api import expect

from reduction.archive.open import open_archive

LONG = 180_000  # a loaded machine, in ms
TRIM = "#setting-cycles-trim_threshold"


@contextmanager
def explored(place, *options):
    """The command in a process of its own, until it is interrupted: the address of its page."""
    process = subprocess.Popen(
        [sys.executable, "-m", "reduction", "explore", str(place / "processed" / "tmt-synthetic"),
         "--no-browser", "--json", *options],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=place,
        env=os.environ | {"PYTHONPATH": str(ROOT)}, preexec_fn=hear_interrupts,
    )  # fmt: skip
    try:
        lines = ""
        while not lines.endswith("}\n"):
            line = process.stdout.readline()
            assert line, process.stderr.read()
            lines += line
        yield json.loads(lines)["address"]
    finally:
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=60)
    assert process.returncode == 130 and "Traceback" not in said, said


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A copy of the synthetic campaign where it lies by habit, with the archive of one test."""
    folder = tmp_path_factory.mktemp("explorer")
    raw = folder / "raw" / "tmt-synthetic"
    shutil.copytree(ROOT / "raw" / "tmt-synthetic", raw, ignore=shutil.ignore_patterns("truth"))
    run(folder)
    return folder


@pytest.fixture(scope="module")
def address(place):
    with explored(place) as found:
        yield found


def run(folder):
    done = reduction(
        "run", folder / "raw" / "tmt-synthetic" / "campaign.toml", "--test", "T-1", cwd=folder
    )
    assert done.returncode == 0, done.stderr


def opened(visit, address, **how):
    """The page after its first test was reduced."""
    shown = visit(address, **how)
    expect(shown.page.locator("#status")).to_contain_text("Reduced in", timeout=LONG)
    return shown


def moved(page, key, text):
    """Write a value into a field, and wait for what follows."""
    field = page.locator(key)
    field.evaluate("field => { field.closest('details').open = true; }")
    field.fill(text)
    field.press("Enter")
    expect(page.locator("#status")).to_contain_text("changed, not saved. Reduced", timeout=LONG)


def modulus(page, side=""):
    """First segment modulus that is shown, as it is or changed. [MPa]"""
    table = page.locator(f"{side} table", has=page.get_by_text("segment modulus")).first
    heads = table.locator("thead th").all_inner_texts()
    place = next(place for place, one in enumerate(heads) if "segment" in one and "MPa" in one)
    return float(
        table.locator("tbody tr").first.locator("th, td").nth(place).inner_text().split()[0]
    )


def test_a_setting_is_moved_seen_saved_and_run(place, address, visit):
    shown = opened(visit, address)
    page = shown.page
    campaign = place / "raw" / "tmt-synthetic" / "campaign.toml"
    before = campaign.read_text("utf-8")
    expect(page.locator("#review")).to_be_disabled()
    page.locator(".plot .main-svg").first.wait_for()
    assert page.locator(".pair").count() == 0
    alone = modulus(page)

    moved(page, TRIM, "0.9")
    was, now = modulus(page, ".old"), modulus(page, ".new")
    assert was == alone != now
    page.locator(".new .plot .main-svg").first.wait_for()
    assert page.locator("td.moved").count() > 0
    assert page.locator(".old td.moved").count() == 0
    page.get_by_text("Holds: nothing moved").wait_for()
    with open_archive(place / "processed" / "tmt-synthetic" / "T-1.nc") as archive:
        assert float(archive["segment_modulus"][0, 0, 0]) / 1e6 == pytest.approx(was, rel=1e-3)
    assert campaign.read_text("utf-8") == before, "nothing is written before it is asked for"

    page.locator("#review").click()
    diff = page.locator("#diff").inner_text()
    assert "+reduction.cycles.trim_threshold = 0.9" in diff.splitlines()
    page.locator("#write").click()
    expect(page.locator("#status")).to_contain_text("Written", timeout=LONG)
    after = campaign.read_text("utf-8")
    assert after == before.replace(
        "target_strain = [0.75, 1.25]\nn_cycles = 10\n",
        "target_strain = [0.75, 1.25]\nn_cycles = 10\nreduction.cycles.trim_threshold = 0.9\n",
    )
    expect(page.locator("#standing")).to_contain_text("reduction run updates it")

    run(place)
    with open_archive(place / "processed" / "tmt-synthetic" / "T-1.nc") as archive:
        assert float(archive["segment_modulus"][0, 0, 0]) / 1e6 == pytest.approx(now, rel=1e-3)
    assert shown.errors == []
    assert all(
        one.startswith((address.partition("?")[0], "data:", "blob:")) for one in shown.requests
    )


def test_a_value_that_cannot_be_is_said_and_undone(address, visit):
    page = opened(visit, address).page
    page.locator(TRIM).fill("7")
    page.locator(TRIM).press("Enter")
    expect(page.locator("#error")).to_contain_text("trim_threshold is out of range", timeout=LONG)
    assert page.locator(TRIM).get_attribute("aria-invalid") == "true"
    expect(page.locator("#review")).to_be_disabled()
    page.locator("#undo").click()
    expect(page.locator("#status")).to_contain_text("As campaign.toml is", timeout=LONG)
    expect(page.locator("#error")).to_be_hidden()


def test_a_file_that_somebody_else_changed_is_not_written_over(place, address, visit):
    page = opened(visit, address).page
    moved(page, "#setting-cycles-break_in_cycles", "2")
    page.locator("#review").click()
    campaign = place / "raw" / "tmt-synthetic" / "campaign.toml"
    theirs = campaign.read_text("utf-8") + "# of somebody else\n"
    campaign.write_text(theirs, encoding="utf-8")
    page.locator("#write").click()
    expect(page.locator("#error")).to_contain_text("changed on the disk", timeout=LONG)
    assert campaign.read_text("utf-8") == theirs
    page.locator("#reload").click()
    expect(page.locator("#status")).to_contain_text("As campaign.toml is", timeout=LONG)
    expect(page.locator("#disk")).to_be_hidden()


@pytest.mark.parametrize(("width", "dark"), [(1280, False), (390, True)])
def test_everybody_can_use_it_on_any_screen(address, visit, width, dark):
    shown = opened(visit, address, width=width, dark=dark)
    page = shown.page
    moved(page, TRIM, "0.95")
    assert shown.faults() == []
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    page.locator("#review").click()
    assert shown.faults() == []
    page.keyboard.press("Escape")
    expect(page.locator("#save")).to_be_hidden()
    assert shown.errors == []


def test_a_keyboard_is_enough(address, visit):
    page = opened(visit, address).page
    page.keyboard.press("Tab")
    seen = []
    for _ in range(12):
        page.keyboard.press("Tab")
        seen.append(page.evaluate("document.activeElement.id || document.activeElement.type"))
        if seen[-1] == "range":
            break
    assert seen[0] == "test" and seen[-1] == "range"
    page.keyboard.press("ArrowLeft")
    expect(page.locator(TRIM)).not_to_have_value("")
    expect(page.locator("#status")).to_contain_text("1 setting changed", timeout=LONG)
    page.locator("#review").focus()
    page.keyboard.press("Enter")
    expect(page.locator("#save")).to_be_visible()
    page.locator("#cancel").focus()
    page.keyboard.press("Enter")
    expect(page.locator("#save")).to_be_hidden()


def test_names_that_are_markup_are_text(place, visit):
    title = '<img src=x onerror=alert(1)>\\n</script>\\"' + "long " * 100
    text = (place / "raw" / "tmt-synthetic" / "campaign.toml").read_text("utf-8")
    was = 'title = "Cycle tests of a new and a used rubber mooring tether (synthetic)"'
    assert was in text
    stated = place / "raw" / "tmt-synthetic" / "hostile.toml"
    stated.write_text(text.replace(was, f'title = "{title}"'), encoding="utf-8")
    with explored(place, "--campaign", str(stated)) as address:
        shown = opened(visit, address)
        assert shown.page.locator("h1").inner_text().startswith("<img src=x onerror=alert(1)>")
        assert shown.page.locator("main img").count() == 0
        assert shown.errors == []
