"""Writes docs/coupling.md and its pictures but for those of the three examples: see `make coupling`.

    PYTHONPATH=examples:tests python -m coupling
"""

import argparse
from pathlib import Path

import numpy as np
from tqdm import tqdm

from . import convergence, early_return, no_slopes, one_system, stability
from .bridge import PIERS, deck
from .tables import markdown


def convergence_table(steps, errors) -> str:
    """Errors of every variant at every step."""
    rows = [[name, *(f"{value:.1e}" for value in values)] for name, values in errors.items()]
    return markdown(["Pacoima Dam, step", *(f"{1e3 * h:g} ms" for h in steps)], rows)


def limits_table() -> str:
    """h sqrt(k/m) at the limits of the extrapolating masters and of the fixed point, over mass ratio and frequency."""
    ratios, frequencies = (0.3, 1.0, 3.0, 10.0, 30.0), (2.5, 8.0, 25.0)
    lightest = min(p.m for p in convergence.STRUCTURES)
    rows = []
    for frequency in frequencies:
        for name in ("Jacobi, extrapolated", "Gauss-Seidel, extrapolated", "fixed point"):
            limits = [stability.first_unstable(lambda h: unstable(name, ratio, h, frequency)) for ratio in ratios]
            bearings = [deck(stability.mass(ratio), frequency).k / len(convergence.STRUCTURES) for ratio in ratios]
            numbers = [f"{h * np.sqrt(k / lightest):.2f}".replace("nan", "–") for h, k in zip(limits, bearings)]
            rows.append([f"{frequency:g} Hz", name, *numbers])
    return markdown(["deck / top masses", "", *(f"{ratio:g}" for ratio in ratios)], rows)


def unstable(name: str, ratio: float, h: float, frequency: float) -> bool:
    """Whether a step is too long while both piers rock."""
    if name in stability.WEAK:
        return stability.growth(*stability.WEAK[name], ratio, h, True, frequency) > stability.GROWTH
    return stability.contraction(ratio, h, True, frequency) > 1


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--output", type=Path, default=Path("docs/coupling.md"), help="page to write")
    arguments = parser.parse_args()
    figures, fmus = arguments.output.with_suffix(""), tuple(PIERS.values())

    runs = len(convergence.SCENES) * len(convergence.VARIANTS)
    cells = (len(stability.WEAK) + len(stability.ITERATED)) * stability.RATIOS.size * stability.STEPS.size
    ended_early = len(early_return.MASTERS) * len(early_return.STEPS)
    with tqdm(total=runs + ended_early + cells, unit="") as progress:
        progress.set_description("convergence")
        errors = convergence.study(fmus, progress.update)
        progress.set_description("early return")
        to_transitions = early_return.study(progress.update)
        progress.set_description("stability")
        measured = stability.study(fmus, progress.update)
    convergence.plot(figures / "convergence.png", errors)
    stability.plot_weak(figures / "stability_weak.png", measured)
    stability.plot_iterated(figures / "stability_sweeps.png", measured)
    steps, of_variants, transitions, _ = errors["Pacoima Dam"]
    page = (Path(__file__).parent / "page.md").read_text(encoding="utf-8").format(
        convergence=convergence_table(steps, of_variants),
        early_return=early_return.table(*to_transitions),
        frequency=stability.FREQUENCY,
        limits=limits_table(),
        one_system=one_system.table(*to_transitions),
        one_system_stability=one_system.stability_table(),
        transitions=transitions,
        **no_slopes.tables(fmus),
    )
    arguments.output.write_text(page, encoding="utf-8")
    print(f"{arguments.output}, figures in {figures}")


if __name__ == "__main__":
    main()
