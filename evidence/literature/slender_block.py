"""The slender rigid block under one pulse, solved piece by piece to rounding: Housner's linearised equation.

    y'' = y - s + A f(t),      y = -theta/alpha,  s = the sign of y,  time in 1/p,  acceleration in g alpha

At rest until A f exceeds 1; at an impact, y = 0, the velocity is multiplied by r. f is sin or cos of omega t (omega in
p) over a number of half periods, so that between impacts, with f'' = -omega^2 f,

    y = s - A f/(1 + omega^2) + z cosh(t - t0) + w sinh(t - t0)

and when the pulse is over the same without f. The block then overturns where the part that grows like exp(t) points
away from the ground. An amplitude at which that part vanishes is a boundary: the block comes to a stand on its edge.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

GRID = 400  # instants of a pulse at which an impact is looked for, before it is located


@dataclass(frozen=True)
class Pulse:
    """Pulse: cos(omega t + phase) over `half_periods` of pi/omega."""

    name: str
    phase: float
    half_periods: int

    def duration(self, omega: float) -> float:
        """In 1/p."""
        return self.half_periods * np.pi / omega

    def shape(self, omega: float, t):
        """f and f'."""
        argument = omega * t + self.phase
        return np.cos(argument), -omega * np.sin(argument)

    def lift_off(self, omega: float, amplitude: float) -> float:
        """The first instant at which A f reaches 1: at once where the pulse starts at its height."""
        return (-self.phase - np.arccos(1 / amplitude)) / omega if self.phase < 0 else 0.0


HALF_SINE = Pulse("half sine", -np.pi / 2, 1)
ONE_SINE = Pulse("one sine", -np.pi / 2, 2)
ONE_COSINE = Pulse("one cosine", 0.0, 2)
PULSES = [HALF_SINE, ONE_SINE, ONE_COSINE]


class Bounces(Exception):
    """Impacts follow each other faster than they are looked for: the block bounces to rest while the pulse lasts."""


def motion(pulse: Pulse, omega: float, amplitude: float, s: int, t0: float, v0: float):
    """A function of time that gives y and y' on side `s` while the pulse lasts, from y = 0 and y' = v0 at t0 on."""
    part, (f0, slope0) = amplitude / (1 + omega**2), pulse.shape(omega, t0)
    z, w = part * f0 - s, v0 + part * slope0

    def state(t):
        (f, slope), cosh, sinh = pulse.shape(omega, t), np.cosh(t - t0), np.sinh(t - t0)
        return s - part * f + z * cosh + w * sinh, -part * slope + z * sinh + w * cosh

    return state


def follow(pulse: Pulse, omega: float, r: float, amplitude: float, impacts: int | None = None) -> tuple[int, float]:
    """Impacts of a block at rest, and a margin that is positive if it overturns after them; with `impacts` given after so many."""
    s, t, v, count, end = 1, pulse.lift_off(omega, amplitude), 0.0, 0, pulse.duration(omega)
    while True:
        state, grid = motion(pulse, omega, amplitude, s, t, v), np.linspace(t, end, GRID + 1)
        below = np.flatnonzero(s * state(grid)[0][1:] <= 0)
        if count == impacts or not len(below):
            break
        if below[0] == 0:
            raise Bounces(f"an impact within {grid[1] - t:g}/p of the last one at A = {amplitude}")
        t = brentq(lambda t: state(t)[0], grid[below[0]], grid[below[0] + 1], xtol=1e-15, rtol=1e-15)
        s, v, count = -s, r * state(t)[1], count + 1
    y, v = state(end)
    growing = s * (y + v) - 1  # of y - s, over exp(t)
    if growing > 0 or count == impacts:
        return count, growing
    return count + 1, r * np.sqrt(v**2 - (y - s) ** 2 + 1) - 1  # the energy is kept until the next impact


@dataclass(frozen=True)
class Boundary:
    """An amplitude (in g alpha) at which the outcome changes."""

    amplitude: float
    impacts: int  # of the block that overturns
    upper: bool  # whether it overturns below and not above


def boundaries(pulse: Pulse, omega: float, r: float, most: float, step: float = 0.002) -> Iterator[Boundary]:
    """The boundaries between 1 and the amplitude `most`, increasing; two closer together than `step` may be missed.

    Amplitudes just above 1, at which the block bounces to rest while the pulse lasts, are passed over.
    """
    last = None
    for amplitude in np.linspace(1, most, int(np.ceil((most - 1) / step)) + 1)[1:]:
        try:
            impacts, margin = follow(pulse, omega, r, amplitude)
        except Bounces:
            continue
        if last and (margin > 0) != last[2]:
            toppling = impacts if margin > 0 else last[1]
            root = brentq(lambda x: follow(pulse, omega, r, x, toppling)[1], last[0], amplitude, xtol=1e-15, rtol=1e-15)
            yield Boundary(root, toppling, last[2])
        last = amplitude, impacts, margin > 0
