"""Files of tests that are named somewhere are there: a name of a moved file marks and runs nothing."""

import importlib.util
import re
import tomllib
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[1]
ROOT = TESTS.parent
LOWEST = re.findall(r"tests/\S+\.py", (ROOT / ".ci" / "lowest").read_text(encoding="utf-8"))


def settings():
    """The module of settings of all tests, by its path: there are others of its name."""
    spec = importlib.util.spec_from_file_location("settings_of_tests", TESTS / "conftest.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("pattern", LOWEST)
def test_what_is_run_with_the_lowest_versions_is_there(pattern):
    assert list(ROOT.glob(pattern))


def test_every_file_and_folder_whose_tests_are_marked_is_there():
    named = settings()
    names = {*named.LONGEST, *named.NIGHTLY_BUT, *named.SLOW_FILES, *named.SLOW_FOLDERS}
    assert not [name for name in sorted(names) if not (TESTS / name).exists()]


def test_every_test_that_is_kept_of_a_nightly_file_is_there():
    for name, kept in settings().NIGHTLY_BUT.items():
        text = (TESTS / name).read_text(encoding="utf-8")
        for one in kept:
            assert f"def {one.partition('[')[0]}(" in text, (name, one)


def test_every_folder_of_tests_is_looked_into():
    options = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    patterns = options["tool"]["pytest"]["ini_options"]["python_files"]
    folders = {path.parent.name for path in TESTS.glob("*/test_*.py")}
    assert set(patterns) == {f"tests/{name}/test_*.py" for name in folders}
