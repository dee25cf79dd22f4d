"""The bridge integrated by CVODE as one system: error against cost, beside the masters."""

import monolithic
import numpy as np

from ..page import table
from ..scenes import pacoima_dam
from . import convergence, stability
from .bridge import deck
from .bridge_model_exchange import OneSystem, Pier, integrate

TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10)
SETTINGS = [*((tolerance, 0.0) for tolerance in TOLERANCES), (1e-10, 0.2e-3)]  # the latter the longest step, s; 0: any
RATIOS = (0.03, 0.3, 3.0, 30.0)  # mass of the deck over the top masses of both piers


def response(fmus, of_deck, tolerance: float, time, longest_step: float = 0.0) -> tuple[np.ndarray, OneSystem]:
    """The deck's x, then theta and u of every pier; and the system, which has counted."""
    system = OneSystem([Pier(fmu, tolerance) for fmu in fmus], of_deck)
    return integrate(system, tolerance, time, longest_step)[:, [0, 4, 2, 8, 6]], system


def errors(fmus, step: float, masters) -> str:
    """Errors and work of each pier, beside the masters that go from transition to transition."""
    time, a_g = pacoima_dam()
    expected = convergence.columns(monolithic.integrate(convergence.monolithic_bridge(deck()), time, a_g))
    rows = []
    for tolerance, longest_step in SETTINGS:
        found, system = response(fmus, deck(), tolerance, time, longest_step)
        limit = f", steps of at most {1e3 * longest_step:g} ms" if longest_step else ""
        rows.append([f"one system, tolerance {tolerance:g}{limit}", f"{convergence.error(found, expected):.1e}",
                     f"{system.evaluations} evaluations, {system.steps} steps of the solver"])
    for (name, per_sample), (error, _, sweeps, _) in masters.items():
        rows.append([f"{name}, {1e3 * step / per_sample:g} ms", f"{error:.1e}",
                     f"{sweeps * per_sample * (len(time) - 1):.0f} steps"])
    return table(["", "error", "work of each pier"], rows)


def stability_errors(fmus) -> str:
    """The scene of the stability maps: errors by tolerances and masses of the deck."""
    rows = []
    for tolerance in TOLERANCES[:-1]:
        errors = []
        for ratio in RATIOS:
            time, expected = stability.reference_deck(ratio)
            found, _ = response(fmus, deck(stability.mass(ratio), stability.FREQUENCY), tolerance, time)
            errors.append(f"{np.max(np.abs(found[:, 0] - expected)) / np.max(np.abs(expected)):.1e}")
        rows.append([f"one system, tolerance {tolerance:g}", *errors])
    return table(["deck / top masses", *(f"{ratio:g}" for ratio in RATIOS)], rows)
