"""How fast each master's error falls with the communication step, against the bridge integrated as one system."""

import monolithic
import numpy as np
import reference
from tqdm import tqdm

from ..page import table
from ..scenes import pacoima_dam
from .bridge import Bridge, deck, linear, pier, simulate
from .masters import MASTERS, extrapolate, hold

STRUCTURES = (reference.MCMANUS, reference.EVISON)


# name: master, guess, whether lines have the moments of the true course, order without transitions
VARIANTS = {
    "Jacobi, held": (MASTERS["jacobi"], hold, False, 1),
    "Gauss-Seidel, held": (MASTERS["gauss-seidel"], hold, False, 1),
    "Jacobi, extrapolated": (MASTERS["jacobi"], extrapolate, False, 2),
    "Gauss-Seidel, extrapolated": (MASTERS["gauss-seidel"], extrapolate, False, 2),
    "iterated, lines between end values": (MASTERS["iqn-ils"], extrapolate, False, 2),
    "iterated, lines of same moments": (MASTERS["iqn-ils"], extrapolate, True, 4),
    "the same, steps with transitions halved": (MASTERS["halving"], extrapolate, True, 4),
}
PARTS = (1, 2, 4, 8, 16)  # steps per sample


def monolithic_bridge(of_deck, structures=STRUCTURES) -> monolithic.Bridge:
    return monolithic.Bridge(structures, of_deck.M, of_deck.k / len(structures), of_deck.c / len(structures))


def columns(response) -> np.ndarray:
    """The deck's x, then theta and u of every pier, of a monolithic response."""
    return response.y[:, [0, 4, 2, 8, 6]]


def cosimulated(time, a_g, fmus, of_deck, variant: str, per_sample: int) -> np.ndarray:
    """The same of a co-simulation."""
    master, guess, moments, _ = VARIANTS[variant]
    return course(Bridge([pier(fmu) for fmu in fmus], of_deck, linear(time, a_g), moments), master(), guess, time, per_sample)


def course(bridge: Bridge, master, guess, time, per_sample: int) -> np.ndarray:
    """The same of a bridge under a master."""
    def row():
        return [bridge.deck.x, *(value for pier in bridge.piers for value in pier.read("theta", "u"))]

    return simulate(bridge, master, guess, time, per_sample, row)


def error(found: np.ndarray, expected: np.ndarray) -> float:
    """The largest error of the columns that move, each over its peak."""
    peaks = np.max(np.abs(expected), axis=0)
    moving = peaks > 0
    return np.max(np.abs(found - expected)[:, moving] / peaks[moving])


def smooth() -> tuple[np.ndarray, np.ndarray]:
    """A pulse of 3 Hz that leaves both bases down, linear between samples of 4 ms."""
    time = np.linspace(0, 1, 251)
    phase = (np.pi * 3 * (time - 0.5)) ** 2
    return time, 0.2 * (1 - 2 * phase) * np.exp(-phase)


def study(fmus):
    """Steps (s) under Pacoima Dam, errors of every variant at each, and transitions."""
    time, a_g = pacoima_dam()
    response = monolithic.integrate(monolithic_bridge(deck()), time, a_g)
    errors = {variant: [error(cosimulated(time, a_g, fmus, deck(), variant, n), columns(response)) for n in PARTS] for variant in tqdm(VARIANTS)}
    return time[1] / np.array(PARTS), errors, sum(map(len, response.transitions))


def errors_by_step(steps, errors) -> str:
    rows = [[name, *(f"{value:.1e}" for value in values)] for name, values in errors.items()]
    return table(["Pacoima Dam, step", *(f"{1e3 * h:g} ms" for h in steps)], rows)
