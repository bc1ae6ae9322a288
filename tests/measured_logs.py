"""Measured logs of third parties: read where they lie beside the project, never a part of it."""

from pathlib import Path

import pytest

LOGS = Path(__file__).parents[2] / "shared" / "data"
needs_measured_logs = pytest.mark.skipif(
    not LOGS.exists(), reason="measured logs of third parties are not part of the project"
)
