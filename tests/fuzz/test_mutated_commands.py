"""A share of the mutations through the command itself; docs/fuzzing.md has the rule."""

import hypothesis
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from mutations import strategies
from typer.testing import CliRunner

from reduction.cli.main import app

STATUSES = (0, 2, 3, 4, 5, 6)


@pytest.mark.parametrize(
    "name",
    [
        "delimited",
        *(pytest.param(name, marks=pytest.mark.nightly) for name in ("tdms", "campaign", "tables")),
    ],
)
def test_the_command_ends_with_a_status_and_a_message_or_with_products(name, tmp_path):
    @hypothesis.seed(20261122)
    @settings(
        max_examples=6, database=None, deadline=None, phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )  # fmt: skip
    @given(strategies()[name])
    def run(mutation):
        folder = tmp_path / f"run-{len(list(tmp_path.iterdir()))}"
        (folder / "raw").mkdir(parents=True)
        toml = mutation.case.write(folder / "raw", mutation.files)
        places = ["--processed", str(folder / "processed"), "--reports", str(folder / "reports")]
        done = CliRunner().invoke(app, ["run", str(toml), *places])
        assert done.exit_code in STATUSES, (mutation, done.output, done.exception)
        assert "Traceback" not in done.output and "internal error" not in done.output
        # the campaign of tables has products of its outcomes beside a test that failed
        if done.exit_code:
            assert not list((folder / "processed").rglob("A.nc"))
            assert done.output.strip()
        else:
            assert list((folder / "processed").rglob("*.nc"))

    run()
