"""Writes docs/evidence/coupling.md and its pictures but for those of two examples: see `make coupling`.

    PYTHONPATH=examples:tests python -m coupling
"""

import argparse
from pathlib import Path

from tqdm import tqdm
from validation import report

from . import bridge_ssp, convergence, early_return, no_slopes, one_system, stability
from .bridge import PIERS


def convergence_table(steps, errors) -> str:
    """Errors of every variant at every step."""
    rows = [[name, *(f"{value:.1e}" for value in values)] for name, values in errors.items()]
    return report.table(["Pacoima Dam, step", *(f"{1e3 * h:g} ms" for h in steps)], rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--output", type=Path, default=Path("docs/evidence/coupling.md"), help="page to write")
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
    halved, slow = of_variants["the same, steps with transitions halved"], of_variants["Gauss-Seidel, extrapolated"]
    page = (Path(__file__).parent / "page.md").read_text(encoding="utf-8").format(
        convergence=convergence_table(steps, of_variants),
        early_return=early_return.table(*to_transitions),
        frequency=stability.FREQUENCY,
        one_system=one_system.table(*to_transitions),
        one_system_stability=one_system.stability_table(),
        ssp=bridge_ssp.table(fmus),
        transitions=transitions,
        longest=f"{1e3 * steps[0]:g} ms", shortest=f"{1e3 * steps[-1]:g} ms", middle=f"{1e3 * steps[2]:g} ms",
        halved_longest=f"{halved[0]:.0e}", halved_shortest=f"{halved[-1]:.0e}",
        slow_middle=f"{slow[2]:.0e}", slow_shortest=f"{slow[-1]:.0e}",
        held_jacobi=f"{of_variants['Jacobi, held'][-1]:.0%}",
        held_gauss_seidel=f"{of_variants['Gauss-Seidel, held'][-1]:.0%}",
        **stability.findings(measured),
        **no_slopes.tables(fmus),
    )
    report.write_page(arguments.output, page, "make coupling")
    print(f"{arguments.output}, figures in {figures}")


if __name__ == "__main__":
    main()
