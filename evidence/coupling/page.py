"""Coupling: the masters on a bridge and on soil, beside the same systems integrated as one."""

from pathlib import Path

from tqdm import tqdm

from ..scenes import exported
from . import bridge, bridge_model_exchange, bridge_ssp, building_on_soil, convergence, early_return, no_slopes, stability


def values(figures: Path) -> dict:
    """Errors and limits of stability."""
    fmus = tuple(exported(name.lower()) for name in bridge.PIERS)
    bridge.draw(fmus, figures / "bridge.png")
    building_on_soil.draw(fmus[0], figures / "building_on_soil.png")
    runs = len(convergence.SCENES) * len(convergence.VARIANTS)
    cells = (len(stability.WEAK) + len(stability.ITERATED)) * stability.RATIOS.size * stability.STEPS.size
    with tqdm(total=runs + len(early_return.MASTERS) * len(early_return.STEPS) + cells, unit="") as progress:
        errors = convergence.study(fmus, progress.update)
        to_transitions = early_return.study(progress.update)
        measured = stability.study(fmus, progress.update)
    convergence.plot(figures / "convergence.png", errors)
    stability.plot_weak(figures / "stability_weak.png", measured)
    stability.plot_iterated(figures / "stability_sweeps.png", measured)
    steps, of_variants, transitions, _ = errors["Pacoima Dam"]
    return dict(
        convergence=convergence.errors_by_step(steps, of_variants), early_return=early_return.errors(*to_transitions),
        frequency=stability.FREQUENCY, one_system=bridge_model_exchange.errors(fmus, *to_transitions),
        one_system_stability=bridge_model_exchange.stability_errors(fmus), ssp=bridge_ssp.errors(fmus), transitions=transitions,
        ms=1e3 * steps, halved=of_variants["the same, steps with transitions halved"],
        slow=of_variants["Gauss-Seidel, extrapolated"], held_jacobi=of_variants["Jacobi, held"][-1],
        held_gauss_seidel=of_variants["Gauss-Seidel, held"][-1], **stability.findings(measured), **no_slopes.tables(fmus))
