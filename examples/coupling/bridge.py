"""A bridge: the specimens of McManus and Evison as piers under one deck, on the shake table, Pacoima Dam 1971.

The piers are two instances of the FMU. The deck is a mass in Python on an elastic bearing (spring and dashpot) on top
of each pier; its weight is carried by something else. A bearing's force goes to the pier as F_t; displacement and
velocity of the pier's top come back as delta_t and v_t. Runs the iterated master and draws the response.

    PYTHONPATH=examples python -m coupling.bridge
"""

import argparse
import contextlib
import functools
import math
from pathlib import Path

import numpy as np
from first_run import G
from validation.figures import FIXED, QUIET, ROCKING, save, subplots
from validation.records import pacoima_dam

from .masters import MASTERS, Iterated, between_transitions, extrapolate
from .structure import Structure
from .swaying_mass import SwayingMass

MASS, FREQUENCY, DAMPING = 300.0, 2.5, 0.05  # of the deck on piers that do not move: kg, Hz, ratio of critical
PIERS = {"McManus": "out/mcmanus.fmu", "Evison": "out/evison.fmu"}


def deck(M: float = MASS, frequency: float = FREQUENCY, damping: float = DAMPING) -> SwayingMass:
    """A deck, with the stiffness and damping of all its bearings."""
    omega = 2 * math.pi * frequency
    return SwayingMass(M, M * omega**2, 2 * damping * M * omega)


def pier(fmu: str, **start_values: float) -> Structure:
    return Structure(fmu, ["a_g", "F_t"], ["delta_t", "v_t"], **start_values)


class Bridge:
    """The first side is the piers: bearing forces in, delta_t and v_t of every pier out. The second is the deck."""

    def __init__(self, piers: list, deck: SwayingMass, ground, moments: bool = True):
        """`ground` gives a_g at the start and the end of a step. Lines have the moments of the true course, or else its
        values at both ends."""
        self.piers, self.deck, self.ground, self.moments = piers, deck, ground, moments
        self.w, self.y = np.zeros((2, len(piers))), np.zeros((2, 2 * len(piers)))

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

    def transitions(self):
        return sum(pier.transitions() for pier in self.piers)

    @contextlib.contextmanager
    def checkpoint(self):
        with contextlib.ExitStack() as stack:
            of_piers = [stack.enter_context(pier.checkpoint()) for pier in self.piers]
            yield of_piers, (self.deck.x, self.deck.v), self.w, self.y

    def restore(self, state):
        of_piers, (self.deck.x, self.deck.v), self.w, self.y = state
        for pier, of_pier in zip(self.piers, of_piers):
            pier.restore(of_pier)


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


def plot(path: Path, time, a_g, x, tops, uplifts, forces) -> None:
    figure, axes = subplots(4, 1, 7.0, sharex=True)
    axes[0].plot(time, a_g / G, color=QUIET)
    axes[1].plot(time, 1e3 * x, color="black", label="deck")
    for i, (name, color) in enumerate(zip(PIERS, (ROCKING, FIXED))):
        axes[1].plot(time, 1e3 * tops[:, i], color=color, label=f"top of {name}")
        axes[2].plot(time, 1e3 * uplifts[:, i], color=color, label=name)
        axes[3].plot(time, forces[:, i], color=color, label=name)
    labels = ("ground\nacceleration (g)", "displacement (mm)", "uplift (mm)", "force on the pier\nin the bearing (N)")
    for axis, label in zip(axes, labels):
        axis.set_ylabel(label)
    for axis, place in zip(axes[1:], ("lower right", "upper right", "upper right")):
        axis.legend(loc=place, ncols=3)
    axes[-1].set(xlabel="time (s)", xlim=(0, time[-1]))
    figure.suptitle("Two piers under one deck rock out of step")
    figure.align_ylabels()
    save(figure, path)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0],
                                     formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--piers", nargs=2, metavar="FMU", default=list(PIERS.values()), help="of the two piers")
    parser.add_argument("--master", choices=MASTERS, default="iqn-ils", help="how the two sides are stepped")
    parser.add_argument("--steps", type=int, default=1, help="communication steps per sample of the record (2 ms)")
    parser.add_argument("--figure", type=Path, default=Path("docs/evidence/coupling/bridge.png"), help="where to save it")
    arguments = parser.parse_args()

    time, a_g = pacoima_dam()
    master = MASTERS[arguments.master]()
    bridge = Bridge([pier(fmu) for fmu in arguments.piers], deck(), linear(time, a_g),
                    moments=isinstance(master, Iterated))
    step = functools.partial(between_transitions, master) if isinstance(master, Iterated) else master

    def row():
        uplifts = [pier.read("uplift")[0] for pier in bridge.piers]
        tops, rates = bridge.y[1, ::2], bridge.y[1, 1::2]
        forces = (bridge.deck.k * (bridge.deck.x - tops) + bridge.deck.c * (bridge.deck.v - rates)) / len(bridge.piers)
        return [bridge.deck.x, *tops, *uplifts, *forces]

    rows = simulate(bridge, step, extrapolate, time, arguments.steps, row)
    x, tops, uplifts, forces = rows[:, 0], rows[:, 1:3], rows[:, 3:5], rows[:, 5:7]
    print(f"deck: {1e3 * np.max(np.abs(x)):.2f} mm")
    for i, name in enumerate(PIERS):
        print(f"{name}: uplift {1e3 * np.max(uplifts[:, i]):.2f} mm, bearing {np.max(np.abs(forces[:, i])):.1f} N, "
              f"{bridge.piers[i].transitions()} transitions")
    if isinstance(master, Iterated):
        print(f"{master.sweeps / (len(time) - 1) / arguments.steps:.2f} iterations per communication step")
    plot(arguments.figure, time, a_g, x, tops, uplifts, forces)
    print(f"figure: {arguments.figure}")


if __name__ == "__main__":
    main()
