"""The lines of docs/other-programs.md read an archive in R and in Octave."""

import re
import shutil
import subprocess

import numpy as np
import pytest
from commandruns import ROOT

from reduction.archive.open import open_archive

PAGE = (ROOT / "docs" / "other-programs.md").read_text(encoding="utf-8")
# language of a block: what stands before it, what runs a file of it, its first column of numbers
PROGRAMS = {
    "r": ("", ["Rscript"], 1),
    "matlab": ("pkg load netcdf\n", ["octave-cli", "-q"], 0),
}
ARCHIVE = "processed/tmt-synthetic/T-1.nc"


@pytest.mark.nightly
@pytest.mark.parametrize("language", PROGRAMS)
def test_the_lines_read_what_the_archive_holds(language, tmp_path, synthetic):
    before, program, first = PROGRAMS[language]
    if shutil.which(program[0]) is None:
        pytest.skip(f"{program[0]} is not installed")
    (code,) = re.findall(rf"^```{language}\n(.*?)^```$", PAGE, re.M | re.S)
    made = synthetic.processed / "T-1.nc"
    assert code.count(ARCHIVE) == 1
    script = tmp_path / f"lines.{language}"
    script.write_text(before + code.replace(ARCHIVE, made.as_posix()), encoding="utf-8")
    done = subprocess.run([*program, script], capture_output=True, text=True, check=False)
    if re.search(r"no package called|package netcdf", done.stderr):
        pytest.skip(done.stderr.splitlines()[0])
    # Octave of some versions ends with a complaint of its own after the last line
    rows = [
        [float(word.replace("NA", "nan")) for word in line.split()[first:]]
        for line in done.stdout.splitlines()
        if re.match(r"\s*[\d.]", line)
    ]
    with open_archive(made) as archive:
        new = archive.sel(specimen="new")
        curve = new["tangent_modulus"].sel(branch_name="ascending")
        ea = new["apparent_spring_constant"]
        u = new["apparent_spring_constant_standard_uncertainty"]
        expected = [
            *zip(archive["strain_bin"].values, curve.values / 1e6, strict=True),
            *zip(ea.values, u.values, strict=True),
        ]  # fmt: skip
    np.testing.assert_allclose(rows, expected, rtol=1e-6, err_msg=done.stderr)
