"""A wheel holds the package and its campaigns, has the same bytes wherever built, and works by itself."""

import hashlib
import json
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
CAMPAIGNS = ("tmt-synthetic", "nylon-synthetic", "hose-synthetic")
pytest.importorskip("hatchling", reason="the backend is not installed")


def package_files():
    return {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / "reduction").rglob("*")
        if path.is_file() and "cache__" not in str(path) and ".mypy_cache" not in path.parts
    }


def campaign_files():
    """Of the campaigns of `reduction demo`, below ``raw``."""
    return {
        path.relative_to(ROOT / "raw").as_posix()
        for name in CAMPAIGNS
        for path in (ROOT / "raw" / name).rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }


def build(folder, *, mode, time, zone):
    """Build in a copy of the checkout whose files have other permissions and times."""
    shutil.copytree(
        ROOT / "reduction", folder / "reduction",
        ignore=shutil.ignore_patterns("__pycache__", ".mypy_cache"),
    )  # fmt: skip
    for name in ("pyproject.toml", "README.md", "LICENSE", ".gitignore"):
        shutil.copy(ROOT / name, folder / name)
    for name in CAMPAIGNS:
        shutil.copytree(
            ROOT / "raw" / name, folder / "raw" / name, ignore=shutil.ignore_patterns("__pycache__")
        )
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


@pytest.mark.nightly
def test_two_builds_have_the_same_bytes(built):
    first, second = (
        {name: hashlib.sha256(path.read_bytes()).hexdigest() for name, path in one.items()}
        for one in built
    )
    assert len(first) == 2
    assert first == second


def test_a_wheel_holds_the_package_and_its_campaigns_alone(built):
    (wheel,) = (path for name, path in built[0].items() if name.endswith(".whl"))
    with zipfile.ZipFile(wheel) as archive:
        names = {name for name in archive.namelist() if not name.endswith("/")}
    about = {name for name in names if name.partition("/")[0].endswith(".dist-info")}
    campaigns = {f"reduction/demo/{name}" for name in campaign_files()}
    assert names - about == package_files() | campaigns
    assert wheel.stat().st_size < 5_000_000
    assert {name.rpartition("/")[2] for name in about} == {
        "METADATA", "WHEEL", "RECORD", "entry_points.txt", "LICENSE",
    }  # fmt: skip


def test_the_archive_of_the_source_holds_what_a_wheel_is_built_from(built):
    (source,) = (path for name, path in built[0].items() if name.endswith(".gz"))
    with tarfile.open(source) as archive:
        names = {member.name.partition("/")[2] for member in archive if member.isfile()}
    assert names - package_files() - {f"raw/{name}" for name in campaign_files()} == {
        "pyproject.toml", "README.md", "LICENSE", ".gitignore", "PKG-INFO",
    }  # fmt: skip


@pytest.fixture
def installed(built, tmp_path):
    """An environment with the wheel and the libraries of this one; it runs a command elsewhere."""
    (wheel,) = (path for name, path in built[0].items() if name.endswith(".whl"))
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", tmp_path / "venv"], check=True)
    python = tmp_path / "venv" / "bin" / "python"
    (site,) = (tmp_path / "venv" / "lib").glob("python3*/site-packages")
    subprocess.run(
        [sys.executable, "-m", "pip", "--python", python, "install", "-q", "--no-deps",
         "--no-index", wheel],
        check=True, capture_output=True,
    )  # fmt: skip
    # its own copy of the package comes behind the wheel's
    (site / "libraries.pth").write_text(sysconfig.get_path("purelib") + "\n", encoding="utf-8")
    elsewhere = tmp_path / "Prüf stand ü"
    elsewhere.mkdir()
    plain = {name: text for name, text in os.environ.items() if not name.startswith("PYTHON")}

    def say(program, *words):
        done = subprocess.run(
            [tmp_path / "venv" / "bin" / program, *words],
            cwd=elsewhere, env=plain, capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        return done.stdout

    assert say("python", "-c", "import reduction; print(reduction.__file__)").startswith(str(site))
    return elsewhere, say


@pytest.mark.posix
def test_the_wheel_works_in_an_environment_outside_of_the_checkout(installed):
    elsewhere, say = installed
    assert "Reduces cyclic tension tests" in say("reduction", "--help")
    assert "erratum" in say("reduction", "reproduce", "Wang-2022")
    assert "WHOI-2005-10" in say("reduction", "lookup", "published", "--list")
    assert not list(elsewhere.iterdir())


@pytest.mark.posix
@pytest.mark.nightly
def test_the_demonstration_of_a_wheel_gives_the_first_answer(installed):
    elsewhere, say = installed
    answer = json.loads(say("reduction", "demo", "mit Leerzeichen", "--json"))
    assert [one["campaign"] for one in answer["campaigns"]] == list(CAMPAIGNS)
    assert all(not test["exit_status"] for one in answer["campaigns"] for test in one["tests"])
    folder = elsewhere / "mit Leerzeichen"
    for name in CAMPAIGNS:
        assert (folder / "reports" / name / "index.html").is_file()
    made = {path.relative_to(folder / "raw").as_posix() for path in (folder / "raw").rglob("*.csv")}
    assert made == {name for name in campaign_files() if name.endswith(".csv")}


@pytest.mark.posix
@pytest.mark.nightly
def test_the_pages_are_built_from_the_extra_of_their_own(built, tmp_path):
    """Whole, in an empty environment; test_docs_build.py does so in this one, the rest hidden."""
    (wheel,) = (path for name, path in built[0].items() if name.endswith(".whl"))
    subprocess.run([sys.executable, "-m", "venv", tmp_path / "venv"], check=True)
    python = tmp_path / "venv" / "bin" / "python"
    subprocess.run([python, "-m", "pip", "install", "-q", f"{wheel}[docs]"], check=True)
    folder = tmp_path / "checkout"
    folder.mkdir()
    made = shutil.ignore_patterns("_build", "gallery", "reference", "tutorial", "__pycache__")
    shutil.copytree(ROOT / "docs", folder / "docs", ignore=made)
    for path in ROOT.iterdir():
        if path.name not in ("docs", "processed", "reports") and not path.name.startswith("."):
            (folder / path.name).symlink_to(path)
    done = subprocess.run(
        [python, "-m", "sphinx", "-W", "--keep-going", "-n", "-q", "-b", "html", "docs", "out"],
        cwd=folder, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
