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


@dataclass(frozen=True)
class Piece:
    """The motion on side `s` from the instant t0 on, while the pulse lasts."""

    pulse: Pulse
    omega: float
    amplitude: float
    s: int
    t0: float
    z: float
    w: float

    @classmethod
    def start(cls, pulse: Pulse, omega: float, amplitude: float, s: int, t0: float, y: float, v: float) -> "Piece":
        """With the rotation y and the velocity v at t0."""
        f, slope = pulse.shape(omega, t0)
        part = amplitude / (1 + omega**2)
        return cls(pulse, omega, amplitude, s, t0, y - s + part * f, v + part * slope)

    def state(self, t):
        """y and y' at `t`."""
        f, slope = self.pulse.shape(self.omega, t)
        part = self.amplitude / (1 + self.omega**2)
        cosh, sinh = np.cosh(t - self.t0), np.sinh(t - self.t0)
        return self.s - part * f + self.z * cosh + self.w * sinh, -part * slope + self.z * sinh + self.w * cosh

    def impact(self, end: float) -> float | None:
        """The first return to y = 0 until `end`, if there is one."""
        t = np.linspace(self.t0, end, GRID + 1)
        below = np.flatnonzero(self.s * self.state(t)[0][1:] <= 0)
        if not len(below):
            return None
        first = below[0]
        if first == 0:
            raise Bounces(f"an impact within {t[1] - self.t0:g}/p of the last one at A = {self.amplitude}")
        return brentq(lambda t: self.state(t)[0], t[first], t[first + 1], xtol=1e-15, rtol=1e-15)


@dataclass(frozen=True)
class Outcome:
    """Margin of the fate of the block: positive if it overturns after `impacts`."""

    impacts: int
    margin: float

    @property
    def overturns(self) -> bool:
        """Whether the margin is positive."""
        return bool(self.margin > 0)


def follow(pulse: Pulse, omega: float, r: float, amplitude: float, impacts: int | None = None) -> Outcome:
    """The fate of a block at rest, or with `impacts` given whether it overturns after so many and not more."""
    end = pulse.duration(omega)
    piece = Piece.start(pulse, omega, amplitude, 1, pulse.lift_off(omega, amplitude), 0.0, 0.0)
    count = 0
    while count != impacts and (t := piece.impact(end)) is not None:
        count += 1
        piece = Piece.start(pulse, omega, amplitude, -piece.s, t, 0.0, r * piece.state(t)[1])
    y, v = piece.state(end)
    growing = piece.s * (y + v) - 1  # of y - s, over exp(t)
    if growing > 0 or count == impacts:
        return Outcome(count, growing)
    landing = np.sqrt(v**2 - (y - piece.s) ** 2 + 1)  # the energy is kept until the next impact
    return Outcome(count + 1, r * landing - 1)


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
            outcome = follow(pulse, omega, r, amplitude)
        except Bounces:
            continue
        if last is not None and outcome.overturns != last[1].overturns:
            toppling = outcome if outcome.overturns else last[1]

            def margin(x, impacts=toppling.impacts):
                return follow(pulse, omega, r, x, impacts).margin

            root = brentq(margin, last[0], amplitude, xtol=1e-15, rtol=1e-15)
            yield Boundary(root, toppling.impacts, last[1].overturns)
        last = (amplitude, outcome)


def half_sine_boundary(omega: float) -> float:
    """The one boundary of the half sine in closed form: the root of A exp(t_0 - pi/omega) + sqrt(A^2 - 1) = omega.

    It says that the part of y that grows, integrated from lift-off at t_0 on, is zero at the end.
    """
    def growing(amplitude):
        left = HALF_SINE.lift_off(omega, amplitude) - np.pi / omega
        return amplitude * np.exp(left) + np.sqrt(amplitude**2 - 1) - omega

    return brentq(growing, 1, 1 + omega, xtol=1e-15, rtol=1e-15)
