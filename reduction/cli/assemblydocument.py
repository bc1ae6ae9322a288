"""What ``reduction assembly --json`` says, in SI."""

from __future__ import annotations

from typing import Any

import numpy as np

from reduction.cli.composite import contributions
from reduction.cli.numbers import plain
from reduction.pipeline.deployed import DeployedLine, WorkingState


def assembly_document(line: DeployedLine) -> dict[str, Any]:
    """What ``--json`` says, in SI."""
    deployed, assembly = line.deployed, line.deployed.assembly
    return {
        "name": line.name,
        "n_tethers": assembly.n_tethers,
        "free_length": plain(np.array(deployed.free_length)),
        "slack_length": plain(assembly.slack_length),
        "total_length": plain(assembly.total_length),
        "tension": plain(assembly.tension),
        "tension_standard_uncertainty": plain(assembly.standard_uncertainty),
        "tension_random_standard_uncertainty": plain(assembly.random_standard_uncertainty),
        "tension_shared_standard_uncertainty": plain(assembly.shared_standard_uncertainty),
        "tension_uncertainty_contributions": contributions(
            assembly.component, assembly.contribution
        ),
        "strain": plain(deployed.strain),
        "apparent_spring_constant": plain(deployed.apparent_spring_constant),
        "secant_spring_constant": plain(deployed.secant_spring_constant),
        "tether_length": plain(assembly.tether_length),
        "tether_tension": plain(assembly.tether_tension),
        "tether_strain": plain(assembly.tether_strain),
        "is_tested": plain(assembly.is_tested),
        "is_join": plain(assembly.is_join),
        "is_moved": plain(assembly.is_moved),
        "units": {
            **dict.fromkeys(
                ("free_length", "slack_length", "total_length", "tether_length", "peak_length",
                 "minimum_length"), "m",
            ),
            **dict.fromkeys(
                ("tension", "tension_standard_uncertainty", "tension_random_standard_uncertainty",
                 "tension_shared_standard_uncertainty", "tension_uncertainty_contributions",
                 "apparent_spring_constant",
                 "secant_spring_constant",
                 "tether_tension", "mean_tension", "peak_tension", "minimum_tension",
                 "peak_tether_tension", "minimum_tether_tension", "greatest_load", "least_load",
                 "tension_at_slack"), "N",
            ),
            **dict.fromkeys(
                ("strain", "tether_strain", "load_share", "peak_share", "minimum_share"), "1"
            ),
            "stiffness": "N m-1",
        },
        "working": [_state_document(state) for state in deployed.working],
        "sources": [line.splices, *line.source.sources],
        "notes": [*deployed.notes, *line.curve.notes, *line.source.notes],
        "synthetic": line.source.is_synthetic,
    }  # fmt: skip


def _state_document(state: WorkingState) -> dict[str, Any]:
    names = (
        "mean_tension", "peak_tension", "minimum_tension", "total_length", "peak_length",
        "minimum_length", "stiffness", "apparent_spring_constant", "tether_tension",
        "peak_tether_tension", "minimum_tether_tension", "load_share", "peak_share",
        "minimum_share", "is_tested",
    )  # fmt: skip
    sharing = None if state.sharing is None else {
        name: plain(getattr(state.sharing, name))
        for name in ("greatest_load", "least_load", "tension_at_slack")
    }  # fmt: skip
    return {
        "given": state.level.quantity,
        **{name: plain(getattr(state.point, name)) for name in names},
        "tension_standard_uncertainty": state.standard_uncertainty,
        "tension_random_standard_uncertainty": state.random_standard_uncertainty,
        "tension_shared_standard_uncertainty": state.shared_standard_uncertainty,
        "secant_spring_constant": state.secant_spring_constant,
        "is_moved": state.is_moved,
        "tether_strain": plain(state.strain),
        "sharing": sharing,
    }
