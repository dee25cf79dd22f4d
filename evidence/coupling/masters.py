"""Masters of a co-simulation of two sides that move each other.

A system has a `first` side, which takes w and gives y, and a `second`, which takes y and gives w. Over a step each of
them is a line in time: an array of two rows, at the start and at the end of the step.

    system.first(t, h, w) -> y     advances the first side over the step
    system.second(t, h, y) -> w    advances the second side
    system.w, system.y             the lines over the last step
    system.checkpoint()            context: the state to which system.restore(state) goes back
    system.transitions()           how many transitions there were: uplifts, impacts, landings
"""

from collections import deque
from functools import partial

import numpy as np

TOLERANCE = 1e-11  # of an iteration, over the largest value that it has met, or over 1
MOST_SWEEPS = 100
SHORTEST = 1e-9  # s; a step with a transition in it is halved down to this


class Diverged(Exception):
    """The iteration over a step did not converge."""


def hold(line):
    """The last value, for the whole of the next step."""
    return line[[1, 1]]


def extrapolate(line):
    """On, for a step as long as the last one, in the direction of the last one."""
    return np.array([line[1], 2 * line[1] - line[0]])


def jacobi(system, t, h, guess):
    """Both sides at once, on what was known of the other."""
    system.y, system.w = system.first(t, h, guess(system.w)), system.second(t, h, guess(system.y))


def gauss_seidel(system, t, h, guess):
    """One side after the other: one sweep."""
    system.y = system.first(t, h, guess(system.w))
    system.w = system.second(t, h, system.y)


class Iterated:
    """Repeats the sweep over a step, each time from the same state, until its w is the w that it was given.

    The next w is the result of the sweep if `columns` is 0 (fixed point). Otherwise the method is IQN-ILS. It fits a linear residual
    to the last differences of this step and the steps before, by least squares, and returns the w of the least residual.
    """

    def __init__(self, columns: int = 0):
        self.residuals, self.values = deque(maxlen=columns), deque(maxlen=columns)
        self.largest, self.h = 1.0, 0.0

    def __call__(self, system, t, h, guess):
        if h != self.h:
            self.residuals.clear(), self.values.clear()
        self.h = h
        w, before = guess(system.w), None
        with system.checkpoint() as start:
            for _ in range(MOST_SWEEPS):
                system.y = system.first(t, h, w)
                value = system.second(t, h, system.y)
                residual = value - w
                self.largest = max(self.largest, np.max(np.abs(value)))
                if np.max(np.abs(residual)) <= TOLERANCE * self.largest:
                    system.w = value
                    return
                if before and np.any(residual != before[0]):
                    self.residuals.append((residual - before[0]).ravel())
                    self.values.append((value - before[1]).ravel())
                before = residual, value
                w = value + self.correction(residual)
                system.restore(start)
        left = np.max(np.abs(residual))
        raise Diverged(f"{MOST_SWEEPS} sweeps over the step of {h} s from {t} s leave a residual of {left:.1e}")

    def correction(self, residual):
        """The correction of the sweep's value that follows from the differences so far."""
        if not self.residuals:
            return 0.0
        R, V = np.array(self.residuals).T, np.array(self.values).T
        size = np.linalg.norm(R, axis=0)
        weights = np.linalg.lstsq(R / size, -residual.ravel(), rcond=1e-8)[0]
        return (V / size @ weights).reshape(residual.shape)


def between_transitions(step, system, t, h, guess):
    """A step of an iterated master; one with a transition in it is halved until it is too short to matter."""
    before = system.transitions()
    with system.checkpoint() as start:
        step(system, t, h, guess)
        if system.transitions() == before or h <= SHORTEST:
            return
        system.restore(start)
    between_transitions(step, system, t, h / 2, guess)
    between_transitions(step, system, t + h / 2, h / 2, hold)  # what the first half ended with may be a jump


MASTERS = {
    "jacobi": lambda: jacobi,
    "gauss-seidel": lambda: gauss_seidel,
    "iqn-ils": lambda: Iterated(columns=8),
    "halving": lambda: partial(between_transitions, Iterated(columns=8)),
}
