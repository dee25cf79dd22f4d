"""The model's structure as Housner's block, driven through the FMU: what becomes of it under a pulse.

With u = 0, Eq 6 divided by J_P reads, alpha the slenderness of the centre of gravity and s the side,

    theta'' = -p^2 [sin(s alpha - theta) + (a_g/g) cos(s alpha - theta)],      p^2 = p_l^2/cos alpha = (m + m0) g R/J_P

R the distance of the centre of gravity, at the height H m/(m + m0), from the pivot. That is Housner's block of any
shape, with m0 = 0 and J0 = m R^2/3 the homogeneous one, p^2 = 3 g/(4 R).
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from first_run import G
from validation.records import write_csv
from validation.stepper import RIGID, Outcome, Stepper

from .slender_block import Pulse

SAMPLES = 4000  # intervals of a pulse
REST = 60.0  # time after the pulse, over 1/p: an amplitude 1e-12 away from the boundary takes 28
TOLERANCE = 1e-12
CLOSEST, FARTHEST = 1e-4, 0.1  # first and last relative distance from a guess at which the fate is asked for
CLOSE = 1e-12  # relative width to which a boundary is bisected


class NoBoundary(Exception):
    """The fate is the same on both sides, however far from what was guessed."""


@dataclass(frozen=True)
class Block:
    """A structure of the model and what follows from its parameters."""

    parameters: dict[str, float]

    @property
    def tangent(self) -> float:
        """tan alpha."""
        of = self.parameters
        return (of["m"] + of["m0"]) / of["m"] * of["B"] / of["H"]

    @property
    def J_P(self) -> float:
        """Inertia about a pivot, kg m2."""
        of = self.parameters
        return of["J0"] + of["m"] * (of["H"] ** 2 + of["B"] ** 2) + of["m0"] * of["B"] ** 2

    @property
    def p_l(self) -> float:
        """The paper's frequency parameter, rad/s."""
        return np.sqrt(self.parameters["m"] * G * self.parameters["H"] / self.J_P)

    @property
    def p(self) -> float:
        """Housner's frequency parameter, rad/s."""
        return self.p_l / np.sqrt(np.cos(np.arctan(self.tangent)))

    @property
    def one_minus_chi(self) -> float:
        """1 - chi."""
        return 1 - self.parameters["m"] * self.parameters["H"] ** 2 / self.J_P

    @property
    def omega_fc(self) -> float:
        """Frequency in full contact, rad/s."""
        return 2 * np.pi * self.parameters["f_fc"]

    @property
    def u_cr(self) -> float:
        """Critical displacement, m."""
        return G * self.tangent / self.omega_fc**2

    @property
    def options(self) -> list[str]:
        """As the command line takes it."""
        return [word for name, value in self.parameters.items()
                for word in (f"--{name.replace('_', '-')}", repr(float(value)))]


def homogeneous(tangent: float, r: float) -> Block:
    """A homogeneous rectangular block of R = 1 m."""
    alpha = np.arctan(tangent)
    return Block({"m": 1000.0, "m0": 0.0, "H": np.cos(alpha), "B": np.sin(alpha), "J0": 1000 / 3, "r": r})


class PulseRuns:
    """Blocks under pulses: each run is one step of the FMU in `folder`, with the pulse inside."""

    def __init__(self, folder: Path, records: Path, detail: int = RIGID):
        self.folder = folder
        self.stepper = Stepper(folder, TOLERANCE, detail)
        self.records = records

    def record(self, pulse: Pulse) -> Path:
        """The pulse with unit amplitude and duration: straight lines that have its area.

        Lines between samples of a sine, h apart, have (omega h/2)/tan(omega h/2) of it: 2e-7 less for SAMPLES a period.
        """
        path = self.records / f"{pulse.name.replace(' ', '_')}.csv"
        if not path.exists():
            time = np.linspace(0, 1, SAMPLES + 1)
            half = 0.5 * pulse.duration(1.0) / SAMPLES
            write_csv(path, time, pulse.shape(1.0, time * pulse.duration(1.0))[0] * np.tan(half) / half)
        return path

    def run(self, block: Block, pulse: Pulse, omega: float, amplitude: float) -> Outcome:
        """The block at rest under the pulse with omega over p and its amplitude over g tan alpha."""
        duration = pulse.duration(omega) / block.p
        scales = {"record_scale": amplitude * G * block.tangent, "record_time_scale": duration}
        return self.stepper.run(block.parameters | scales, duration + REST / block.p, self.record(pulse))

    def boundary(self, block: Block, pulse: Pulse, omega: float, near: float) -> float:
        """The amplitude at which the fate changes, bisected between those on both sides of `near` that differ."""
        width, fates = CLOSEST, (True, True)
        while fates[0] == fates[1]:
            if width > FARTHEST:
                raise NoBoundary(f"no boundary near {near} under a {pulse.name} at omega/p = {omega}")
            fates = [self.run(block, pulse, omega, near * (1 + side * width)).overturned for side in (-1, 1)]
            width *= 2
        return self.bisected(block, pulse, omega, near * (1 - width / 2), near * (1 + width / 2))

    def lowest(self, block: Block, pulse: Pulse, omega: float, amplitudes: np.ndarray) -> float:
        """The lowest amplitude that overturns, bisected from the first of the increasing `amplitudes` that does."""
        for low, high in zip(amplitudes, amplitudes[1:]):
            if self.run(block, pulse, omega, high).overturned:
                return self.bisected(block, pulse, omega, low, high)
        raise NoBoundary(f"no amplitude up to {amplitudes[-1]} overturns under a {pulse.name} at omega/p = {omega}")

    def bisected(self, block: Block, pulse: Pulse, omega: float, low: float, high: float) -> float:
        """The amplitude between `low` and `high`, of different fates, at which the fate changes."""
        fate = self.run(block, pulse, omega, low).overturned
        while high - low > CLOSE * high:
            middle = 0.5 * (low + high)
            if self.run(block, pulse, omega, middle).overturned == fate:
                low = middle
            else:
                high = middle
        return 0.5 * (low + high)
