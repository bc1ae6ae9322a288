"""A wheel holds the package alone, has the same bytes wherever built, and works by itself."""

import hashlib
import os
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
DATE = "1763769600"
pytest.importorskip("hatchling", reason="the backend is not installed")


def package_files():
    return {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / "reduction").rglob("*")
        if path.is_file() and "cache__" not in str(path) and ".mypy_cache" not in path.parts
    }


def build(folder, *, mode, time, zone):
    """Build in a copy of the checkout whose files have other permissions and times."""
    shutil.copytree(
        ROOT / "reduction", folder / "reduction",
        ignore=shutil.ignore_patterns("__pycache__", ".mypy_cache"),
    )  # fmt: skip
    for name in ("pyproject.toml", "README.md", "LICENSE", ".gitignore"):
        shutil.copy(ROOT / name, folder / name)
    (folder / "raw").mkdir()
    (folder / "raw" / "stray.csv").write_text("not of the package")
    for path in folder.rglob("*"):
        if path.is_file():
            path.chmod(mode)
            os.utime(path, (time, time))
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-d", str(folder / "dist")],
        cwd=folder, check=True, capture_output=True,
        env=os.environ | {"SOURCE_DATE_EPOCH": DATE, "TZ": zone},
    )  # fmt: skip
    return {
        path.name: path for path in (folder / "dist").glob("*.*") if path.suffix in (".whl", ".gz")
    }


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    folders = [tmp_path_factory.mktemp(name) / name for name in ("one", "ö another one")]
    return [
        build(folder, mode=mode, time=time, zone=zone)
        for folder, mode, time, zone in zip(
            folders, (0o644, 0o600), (1e9, 1.5e9), ("UTC", "Pacific/Kiritimati"), strict=True
        )
    ]


def test_two_builds_have_the_same_bytes(built):
    first, second = (
        {name: hashlib.sha256(path.read_bytes()).hexdigest() for name, path in one.items()}
        for one in built
    )
    assert len(first) == 2
    assert first == second


def test_a_wheel_holds_the_package_alone(built):
    (wheel,) = (path for name, path in built[0].items() if name.endswith(".whl"))
    with zipfile.ZipFile(wheel) as archive:
        names = {name for name in archive.namelist() if not name.endswith("/")}
    about = {name for name in names if name.partition("/")[0].endswith(".dist-info")}
    assert names - about == package_files()
    assert {name.rpartition("/")[2] for name in about} == {
        "METADATA", "WHEEL", "RECORD", "entry_points.txt", "LICENSE",
    }  # fmt: skip


def test_the_archive_of_the_source_holds_what_a_wheel_is_built_from(built):
    (source,) = (path for name, path in built[0].items() if name.endswith(".gz"))
    with tarfile.open(source) as archive:
        names = {member.name.partition("/")[2] for member in archive if member.isfile()}
    assert names - package_files() == {
        "pyproject.toml", "README.md", "LICENSE", ".gitignore", "PKG-INFO",
    }  # fmt: skip


@pytest.mark.skipif(os.name == "nt", reason="paths of a POSIX environment")
def test_the_wheel_works_in_an_environment_outside_of_the_checkout(built, tmp_path):
    (wheel,) = (path for name, path in built[0].items() if name.endswith(".whl"))
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", tmp_path / "venv"], check=True)
    python = tmp_path / "venv" / "bin" / "python"
    (site,) = (tmp_path / "venv" / "lib").glob("python3*/site-packages")
    subprocess.run(
        [sys.executable, "-m", "pip", "--python", python, "install", "-q", "--no-deps",
         "--no-index", wheel],
        check=True, capture_output=True,
    )  # fmt: skip
    # the libraries of this environment; its own copy of the package comes behind the wheel's
    (site / "libraries.pth").write_text(sysconfig.get_path("purelib") + "\n", encoding="utf-8")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    plain = {name: text for name, text in os.environ.items() if not name.startswith("PYTHON")}

    def say(*command):
        done = subprocess.run(
            command, cwd=elsewhere, env=plain, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    where = say(python, "-c", "import reduction; print(reduction.__file__)")
    assert where.startswith(str(site))
    command = tmp_path / "venv" / "bin" / "reduction"
    assert "Reduces cyclic tension tests" in say(command, "--help")
    assert "erratum" in say(command, "reproduce", "Wang-2022")
    assert "WHOI-2005-10" in say(command, "lookup", "published", "--list")
    assert not list(elsewhere.iterdir())
