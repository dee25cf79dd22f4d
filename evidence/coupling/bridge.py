"""A bridge: the specimens of McManus and Evison as piers under one deck, on the shake table, Pacoima Dam 1971.

The piers are two instances of the FMU. The deck is a mass in Python on an elastic bearing (spring and dashpot) on top
of each pier; its weight is carried by something else. A bearing's force goes to the pier as F_t; displacement and
velocity of the pier's top come back as delta_t and v_t.
"""

import contextlib
import math
from pathlib import Path

import numpy as np

from ..figures import FIXED, QUIET, ROCKING, save, subplots
from ..scenes import G, pacoima_dam
from .masters import MASTERS, extrapolate
from .structure import Structure
from .swaying_mass import SwayingMass

MASS, FREQUENCY, DAMPING = 300.0, 2.5, 0.05  # of the deck on piers that do not move: kg, Hz, ratio of critical
PIERS = ("McManus", "Evison")


def deck(M: float = MASS, frequency: float = FREQUENCY, damping: float = DAMPING) -> SwayingMass:
    """A deck, with the stiffness and damping of all its bearings."""
    omega = 2 * math.pi * frequency
    return SwayingMass(M, M * omega**2, 2 * damping * M * omega)


def pier(fmu: str) -> Structure:
    return Structure(fmu, ["a_g", "F_t"], ["delta_t", "v_t"])


class Coupled:
    """Structures and a mass that move each other."""

    def __init__(self, structures: list, mass: SwayingMass, w, y):
        self.structures, self.swaying, self.w, self.y = structures, mass, w, y

    def transitions(self):
        return sum(structure.transitions() for structure in self.structures)

    @contextlib.contextmanager
    def checkpoint(self):
        with contextlib.ExitStack() as stack:
            of_structures = [stack.enter_context(structure.checkpoint()) for structure in self.structures]
            yield of_structures, (self.swaying.x, self.swaying.v), self.w, self.y

    def restore(self, state):
        of_structures, (self.swaying.x, self.swaying.v), self.w, self.y = state
        for structure, of_structure in zip(self.structures, of_structures):
            structure.restore(of_structure)


class Bridge(Coupled):
    """The first side is the piers: bearing forces in, delta_t and v_t of every pier out. The second is the deck."""

    def __init__(self, piers: list, deck: SwayingMass, ground, moments: bool = True):
        """`ground` gives a_g at the start and the end of a step. Lines have the moments of the true course, or else its
        values at both ends."""
        super().__init__(piers, deck, np.zeros((2, len(piers))), np.zeros((2, 2 * len(piers))))
        self.piers, self.deck, self.ground, self.moments = piers, deck, ground, moments

    def first(self, t, h, w):
        a_g = self.ground(t, h)
        tops = [pier.step(t, h, list(zip(a_g, forces))) for pier, forces in zip(self.piers, w.T.tolist())]
        return np.array([self.y[1], np.ravel(tops)])

    def second(self, t, h, y):
        deck, before = self.deck, (self.deck.x, self.deck.v)
        delta, v = y[:, ::2], y[:, 1::2]
        deck.step(h, np.sum(self.bearing_forces(h, delta, v), axis=1) - deck.M * self.ground(t, h))
        x, x_dot = np.transpose([before, (deck.x, deck.v)])[:, :, np.newaxis]
        forces = self.bearing_forces(h, x - delta, x_dot - v)
        return forces if self.moments else np.array([self.w[1], forces[1]])

    def bearing_forces(self, h, d, v):
        """Of every bearing, as lines over the step, from its deformation and the rate of it at both ends."""
        if self.moments:
            d, v = lines_of_same_moments(h, d, v)
        return (self.deck.k * d + self.deck.c * v) / len(self.piers)


def lines_of_same_moments(h, d, v):
    """A displacement and its rate over a step as lines of the same mean and first moment, from both at its two ends.

    The structure's response to such a line is that to the true course but for O(h^4), since what the line leaves out is
    orthogonal to all lines. The displacement is taken to be a cubic; the moments of its rate follow from it.
    """
    mean, half = (d[0] + d[1]) / 2 + h * (v[0] - v[1]) / 12, 0.6 * (d[1] - d[0]) - h * (v[0] + v[1]) / 20
    mean_rate, half_rate = (d[1] - d[0]) / h, (v[1] - v[0]) / 2
    return np.array([mean - half, mean + half]), np.array([mean_rate - half_rate, mean_rate + half_rate])


def linear(time, a_g):
    """Returns a function for the ground acceleration at the start and the end of a step, linear between samples."""
    return lambda t, h: np.interp((t, t + h), time, a_g)


def simulate(system, step, guess, time, per_sample, row) -> np.ndarray:
    """Steps to every sample of `time` with a master's `step`; what `row` gives at each of them."""
    h = time[1] / per_sample
    rows = [row()]
    for n in range((len(time) - 1) * per_sample):
        step(system, n * h, h, guess)
        if (n + 1) % per_sample == 0:
            rows.append(row())
    return np.array(rows)


def histories(path: Path, title: str, time, labels: list[str], *curves: list[tuple]) -> None:
    """Panels over time, one under the other, each with its curves: values, colour and name."""
    figure, axes = subplots(len(labels), 1, 7.0, sharex=True)
    for axis, label, of in zip(axes, labels, curves):
        for values, color, name in of:
            axis.plot(time, values, color=color, label=name)
        axis.set_ylabel(label)
        if of[0][2]:
            axis.legend(loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0, ncols=3)
    axes[-1].set(xlabel="time (s)", xlim=(0, time[-1]))
    figure.suptitle(title)
    figure.align_ylabels()
    save(figure, path)


def draw(fmus, path: Path) -> None:
    time, a_g = pacoima_dam()
    bridge = Bridge([pier(fmu) for fmu in fmus], deck(), linear(time, a_g))

    def row():
        uplifts, (tops, rates) = [pier.read("uplift")[0] for pier in bridge.piers], (bridge.y[1, ::2], bridge.y[1, 1::2])
        forces = (bridge.deck.k * (bridge.deck.x - tops) + bridge.deck.c * (bridge.deck.v - rates)) / len(bridge.piers)
        return [bridge.deck.x, *tops, *uplifts, *forces]

    x, top_1, top_2, *others = simulate(bridge, MASTERS["halving"](), extrapolate, time, 1, row).T
    colors = (ROCKING, FIXED)
    uplifts, forces = ([*zip(of, colors, PIERS)] for of in (1e3 * np.array(others[:2]), others[2:]))
    histories(path, "Two piers under one deck rock out of step", time,
              ["ground\nacceleration (g)", "displacement (mm)", "uplift (mm)", "force on the pier\nin the bearing (N)"],
              [(a_g / G, QUIET, "")],
              [(1e3 * x, "black", "deck"), *((1e3 * top, color, f"top of {name}") for top, color, name in zip((top_1, top_2), colors, PIERS))],
              uplifts, forces)
