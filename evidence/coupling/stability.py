"""Stability limit of weak coupling of the bridge, over the mass of the deck.

The masters themselves, run for one step on piers with the linear equations of full contact from every unit state, give the matrix
that the errors are multiplied by.
"""

import numpy as np

from ..page import spread
from .bridge import Bridge, deck
from .convergence import STRUCTURES
from .masters import extrapolate, gauss_seidel, jacobi
from .swaying_mass import SwayingMass

FREQUENCY = 8.0  # Hz, of the deck on piers that do not move
RATIOS = np.geomspace(0.95, 30, 4)  # mass of the deck over the top masses of both piers
STEPS = np.geomspace(0.05e-3, 64e-3, 100)  # s


def mass(ratio: float) -> float:
    return ratio * sum(p.m for p in STRUCTURES)


class LinearPier(SwayingMass):
    """A pier whose base stays down (Eq 1), on ground at rest."""

    def __init__(self, p):
        super().__init__(p.m, p.k, p.c_fc)

    def step(self, t, h, line):
        super().step(h, [F_t for _, F_t in line])
        return [self.x, self.v]


def growth(master, guess, ratio: float, h: float) -> float:
    """Rate (1/s) at which the fastest of the motions grows."""
    bridge = Bridge([LinearPier(p) for p in STRUCTURES], deck(mass(ratio), FREQUENCY), lambda t, h: np.zeros(2), moments=False)
    masses, columns = [*bridge.piers, bridge.deck], []
    for unit in np.eye(18):
        motions, w, y = np.split(unit, [6, 10])
        for of, motion in zip(masses, motions.reshape(3, 2)):
            of.x, of.v = motion
        bridge.w, bridge.y = w.reshape(2, 2), y.reshape(2, 4)
        master(bridge, 0.0, h, guess)
        columns.append([*(number for of in masses for number in (of.x, of.v)), *bridge.w.ravel(), *bridge.y.ravel()])
    return np.log(np.max(np.abs(np.linalg.eigvals(np.transpose(columns))))) / h


def first_unstable(master, guess, ratio: float, steps=STEPS) -> float:
    """The least of the steps at which a motion grows."""
    return next(h for h in steps if growth(master, guess, ratio, h) > 1e-6)


def findings() -> dict:
    """Limits of h √(k/m), by their names on the page."""
    k, m = mass(RATIOS) * (2 * np.pi * FREQUENCY) ** 2 / len(STRUCTURES), min(p.m for p in STRUCTURES)
    limits = {"jacobi_limit": jacobi, "gauss_seidel_limit": gauss_seidel}
    return {name: spread([first_unstable(master, extrapolate, ratio) for ratio in RATIOS] * np.sqrt(k / m), ".1f") for name, master in limits.items()}
