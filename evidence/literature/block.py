"""The rigid limit of the model as Housner's block, run by the Python module under a pulse.

With u = 0, Eq 6 divided by J_P reads, alpha the slenderness of the centre of gravity and s the side,

    theta'' = -p^2 [sin(s alpha - theta) + (a_g/g) cos(s alpha - theta)],      p^2 = p_l^2/cos alpha = (m + m0) g R/J_P

R the distance of the centre of gravity, at the height H m/(m + m0), from the pivot. That is Housner's block of any
shape, with m0 = 0 and J0 = m R^2/3 the homogeneous one, p^2 = 3 g/(4 R).
"""

from functools import cache

import flexible_rocking as fr
import numpy as np
from scipy.optimize import bisect

from ..scenes import G
from .slender_block import Pulse

SAMPLES = 4000  # intervals of a pulse
REST = 60.0  # time after the pulse, over 1/p: an amplitude 1e-12 away from the boundary takes 28
TOLERANCE = 1e-12
WIDTHS, SIDES = 1e-4 * 2.0 ** np.arange(10), np.array([-1, 1])  # relative distances from a guess at which the fate is asked for
CLOSE = 1e-12  # relative width to which a boundary is bisected


def homogeneous(tangent: float, r: float) -> fr.Structure:
    """A homogeneous rectangular block of R = 1 m; its strut does not bend at the level rigid."""
    alpha = np.arctan(tangent)
    return fr.Structure(m=1000.0, m0=0.0, H=np.cos(alpha), B=np.sin(alpha), J0=1000 / 3, f_fc=5.0, zeta_fc=0.02, r=r)


def p(block: fr.Structure) -> float:
    """Housner's frequency parameter, rad/s."""
    return block.p_l / np.sqrt(np.cos(block.alpha_cg))


@cache
def of_unit(pulse: Pulse) -> fr.Record:
    """The pulse with unit amplitude and duration: straight lines that have its area.

    Lines between samples of a sine, h apart, have (omega h/2)/tan(omega h/2) of it: 2e-7 less for SAMPLES a period.
    """
    time = np.linspace(0, 1, SAMPLES + 1)
    half = 0.5 * pulse.duration(1.0) / SAMPLES
    return fr.Record(time, pulse.shape(1.0, time * pulse.duration(1.0))[0] * np.tan(half) / half)


def run(block: fr.Structure, pulse: Pulse, omega: float, amplitude: float) -> fr.Run:
    """The block at rest under the pulse with omega over p and its amplitude over g tan alpha."""
    duration = pulse.duration(omega) / p(block)
    ground = of_unit(pulse).scaled(amplitude * G * np.tan(block.alpha_cg), time_scale=duration)
    return fr.simulate(block, ground, duration=duration + REST / p(block), detail="rigid", tolerance=TOLERANCE)


def boundary(block: fr.Structure, pulse: Pulse, omega: float, near: float) -> float:
    """The amplitude at which the fate changes, bisected between the nearest on both sides of `near` that differ."""
    def falls(amplitude: float) -> bool:
        return run(block, pulse, omega, amplitude).overturned

    low, high = next(pair for pair in (near * (1 + width * SIDES) for width in WIDTHS) if falls(pair[0]) != falls(pair[1]))
    return bisect(lambda amplitude: bool(falls(amplitude)) - 0.5, low, high, xtol=CLOSE * low)
