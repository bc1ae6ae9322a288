"""10,000 response surfaces of fifteen runs in one call against other programs, in one run.

    python benchmarks/surfaces.py [number of surfaces]

The call gives coefficients in both units with standard uncertainties, p of the coded ones, r2
(three), lack of fit, stationary point, eigenvalues and leverage.  The other side is statsmodels'
OLS on arrays, one fit a surface, with its coefficients, standard errors and p alone; and R's
summary(rsm()) where R and rsm are installed, timed on a tenth of the surfaces.  Analysis of
variance and residuals looked at are those of one regression at a time, and not in the call.
"""

from __future__ import annotations

import shutil
import statistics
import subprocess
import sys
from time import perf_counter

import numpy as np
import statsmodels.api as sm
from figures import Figure, hand_on

from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents
from reduction.experiments.least_squares_fit import two_sided_p
from reduction.experiments.response_surfaces import fit_surfaces

PASSES = 5
R_SCRIPT = """
suppressMessages(library(rsm))
d <- bbd(3, n0 = 3, randomize = FALSE)
set.seed(1)
y <- matrix(rnorm({count} * 15, 10), ncol = 15)
start <- proc.time()[["elapsed"]]
for (i in 1:{count}) {{ d$y <- y[i, ]; s <- summary(rsm(y ~ SO(x1, x2, x3), data = d)) }}
cat(proc.time()[["elapsed"]] - start)
"""


def time_of_r(count: int) -> float | None:
    """Seconds of `count` summaries, or None where R or rsm is missing."""
    program = shutil.which("Rscript")
    if program is None:
        return None
    done = subprocess.run(
        [program, "-e", R_SCRIPT.format(count=count)], capture_output=True, text=True, check=False
    )
    return float(done.stdout) if done.returncode == 0 else None


def main(count: int) -> list[Figure]:
    """Print the times and their ratios."""
    runs = box_behnken(3).coded
    responses = np.random.default_rng(1).normal(10.0, 1.0, (count, len(runs)))
    names = [f"y{number}" for number in range(count)]
    seconds = []
    for _ in range(PASSES):
        start = perf_counter()
        found = fit_surfaces(
            runs,
            responses,
            factor_names=["frequency", "mean_tension", "tension_amplitude"],
            response_names=names,
            low=[-1, -1, -1],
            high=[1, 1, 1],
            units="coded",
            with_tests=False,
        )
        uncertainty = found.coefficient_standard_uncertainty
        p_values = two_sided_p(found.coefficient / uncertainty, found.term_degrees_of_freedom)
        seconds.append(perf_counter() - start)
    ours = statistics.median(seconds)
    matrix = model_matrix(runs, quadratic_exponents(3))
    largest = 0.0
    start = perf_counter()
    theirs = [sm.OLS(response, matrix).fit() for response in responses]
    kept = [(fit.params, fit.bse, fit.pvalues) for fit in theirs]
    other = perf_counter() - start
    for row, (coefficient, deviation, p_value) in enumerate(kept):
        for mine, their in (
            (found.coefficient, coefficient),
            (uncertainty, deviation),
            (p_values, p_value),
        ):
            largest = max(largest, float(np.max(np.abs(mine[row] / their - 1))))
    spread = f"{min(seconds):.3f} to {max(seconds):.3f} s"
    print(f"reduction, {count} surfaces in one call: {ours:.3f} s (median of {PASSES}, {spread})")
    print(f"statsmodels OLS arrays, {count} fits: {other:.2f} s; ratio {other / ours:.0f}")
    print(f"largest relative difference of coefficients, standard errors and p: {largest:.1e}")
    figures = [
        Figure(what=f"{count:,} surfaces in one call", values=tuple(seconds)),
        Figure(
            what=f"statsmodels OLS arrays, {count:,} fits",
            values=(other,),
            against="times the one call",
            ratios=tuple(other / one for one in seconds),
        ),
    ]
    share = max(count // 10, 1)
    of_r = time_of_r(share)
    if of_r is None:
        print("R with rsm: not installed")
        figures.append(Figure(what="R summary(rsm())", remark="R with rsm is not installed"))
    else:
        whole = of_r * count / share
        print(f"R summary(rsm()), {share} fits timed: {whole:.0f} s; ratio {whole / ours:.0f}")
        figures.append(
            Figure(
                what=f"R summary(rsm()), {count:,} of {share:,} timed",
                values=(whole,),
                against="times the one call",
                ratios=tuple(whole / one for one in seconds),
            )
        )
    return figures


if __name__ == "__main__":
    hand_on(main(int(sys.argv[1]) if len(sys.argv) > 1 else 10_000))
