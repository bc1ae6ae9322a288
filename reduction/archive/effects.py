"""Effects of a screening by name: what they are mixed of, and where noise alone would be."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from reduction.archive.values import Values, texts
from reduction.record import Floats
from reduction.surface.confounding import alias_matrix, half_normal_coordinates
from reduction.surface.screening import ScreeningEffects


def effect_values(effects: ScreeningEffects, response_names: Sequence[str]) -> Values:
    """Return the effects of the factors and then of the dummies, which are not tested.

    Parameters
    ----------
    effects : ScreeningEffects
        Of the responses.
    response_names : sequence of str
        In the order of the effects.

    Returns
    -------
    values : dict of str to ndarray
        Names of `reduction.archive.surface_schema`.
    """
    values: Values = {
        "effect_error_from": np.array(effects.error_from),
        "effect_degrees_of_freedom": np.array(effects.degrees_of_freedom),
        "effect_significance": np.array(effects.significance),
    }
    untested = np.full(effects.dummy_effect.shape[-1], np.nan)
    every = np.concatenate([effects.effect, effects.dummy_effect], axis=-1)
    quantile = _half_normal_quantile(every)
    for index, name in enumerate(response_names):
        values |= {
            f"{name}_effect": every[index],
            f"{name}_effect_standard_uncertainty": effects.effect_standard_error[index],
            f"{name}_effect_t": np.append(effects.t_value[index], untested),
            f"{name}_effect_p_value": np.append(effects.p_value[index], untested),
            f"{name}_effect_is_significant": np.append(
                effects.is_significant[index], np.zeros(untested.size, dtype=bool)
            ),
            f"{name}_effect_refusal": np.array(str(effects.reason[index])),
            f"{name}_effect_size": np.abs(every[index]),
            f"{name}_effect_half_normal_quantile": quantile[index],
            f"{name}_mean": effects.mean[index],
            f"{name}_minimum_significant_effect": effects.minimum_significant_effect[index],
            f"{name}_simultaneous_minimum_effect": effects.simultaneous_minimum_effect[index],
        }
    return values


def _half_normal_quantile(effects: Floats) -> Floats:
    """Quantile of each effect in its own place; NaN where a response has none."""
    points = half_normal_coordinates(effects)
    quantile = np.empty(effects.shape)
    along = np.broadcast_to(points.quantile, effects.shape)
    np.put_along_axis(quantile, points.order, along, axis=-1)
    return np.where(np.isfinite(effects), quantile, np.nan)


def alias_values(plan: Floats, factor_names: Sequence[str]) -> Values:
    """Return the share of each two-factor interaction in the effect of each column.

    Parameters
    ----------
    plan : ndarray, shape (n_runs, n_columns)
        Coded levels of the factors and then of the dummies; balanced and orthogonal.
    factor_names : sequence of str
        Of the first columns.

    Returns
    -------
    values : dict of str to ndarray
        Names of `reduction.archive.surface_schema`; empty for a single factor.

    Notes
    -----
    The dummies are columns as the factors are: what stands in them is in the error that the
    effects are judged by.  In the mean of an orthogonal plan no interaction stands.
    """
    n_factors = len(factor_names)
    pairs, alias = alias_matrix(plan)
    of_factors = [place for place, pair in enumerate(pairs) if max(pair) < n_factors]
    if not of_factors:
        return {}
    named = list(combinations(factor_names, 2))
    # the runs in which an interaction moves with a column are whole: without the solver's rounding
    n_runs = plan.shape[0]
    share = np.rint(alias[1:, of_factors].T * n_runs) / n_runs + 0.0
    return {
        "interaction": np.arange(1, len(named) + 1),
        "interaction_factor": texts([one for one, _ in named]),
        "interaction_other_factor": texts([other for _, other in named]),
        "effect_alias": share,
    }
