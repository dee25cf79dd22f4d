"""Coupling: the masters on a bridge and on soil, beside the same systems integrated as one."""

from pathlib import Path

from ..scenes import exported
from . import bridge, bridge_model_exchange, building_on_soil, convergence, no_slopes, stability


def values(figures: Path) -> dict:
    fmus = tuple(exported(name.lower()) for name in bridge.PIERS)
    bridge.draw(fmus, figures / "bridge.png")
    building_on_soil.draw(fmus[0], figures / "building_on_soil.png")
    steps, of_variants, transitions = convergence.study(fmus)
    return dict(
        convergence=convergence.errors_by_step(steps, of_variants),
        frequency=stability.FREQUENCY, one_system=bridge_model_exchange.errors(fmus), transitions=transitions,
        ms=1e3 * steps, halved=of_variants["the same, steps with transitions halved"],
        slow=of_variants["Gauss-Seidel, extrapolated"], held_jacobi=of_variants["Jacobi, held"][-1],
        held_gauss_seidel=of_variants["Gauss-Seidel, held"][-1], **stability.findings(), **no_slopes.tables(fmus[0]))
