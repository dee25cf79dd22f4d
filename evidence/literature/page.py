"""The model against closed forms of the literature: amplitudes of pulses that overturn a rigid block, with and without impact."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from tqdm import tqdm

from ..figures import FIXED, ROCKING, save, subplots
from ..page import spread
from . import block
from .block import homogeneous
from .slender_block import HALF_SINE, ONE_COSINE, ONE_SINE, PULSES, Boundary, Pulse, boundaries

R = 0.9  # coefficient of restitution
MOST = 10.0  # amplitude, g tan alpha
CASES = [*((HALF_SINE, omega) for omega in (2, 4, 6, 8)), *((ONE_SINE, omega) for omega in (2, 3, 4, 5, 6)),
         *((ONE_COSINE, omega) for omega in (2, 3, 4))]  # omega in p
BESIDE = 1e-9  # relative distance from a boundary at which impacts are counted
TANGENTS = [0.08, 0.04, 0.02, 0.01]  # tan alpha of blocks that become slender
CURVES = np.linspace(1.5, 8, 66)  # omega/p of the curves in the figure


@dataclass(frozen=True)
class Case:
    """One boundary: its closed form in the slender limit, and the amplitudes of the model's blocks with TANGENTS."""

    pulse: Pulse
    omega: float
    boundary: Boundary

    @cached_property
    def amplitudes(self) -> list[float]:
        return [block.boundary(homogeneous(tangent, R), self.pulse, self.omega, self.boundary.amplitude) for tangent in TANGENTS]

    @property
    def differences(self) -> np.ndarray:
        """From the closed form, over it."""
        return np.array(self.amplitudes) / self.boundary.amplitude - 1

    @property
    def rate(self) -> float:
        """The power of tan alpha by which the difference vanishes: a straight line through the logarithms."""
        return np.polyfit(np.log(TANGENTS), np.log(np.abs(self.differences)), 1)[0]

    @property
    def extrapolated(self) -> float:
        """At tan alpha = 0 by Richardson, for a series in powers of tan^2 alpha."""
        column = list(self.amplitudes)
        for order in range(1, len(TANGENTS)):
            column = [(4**order * finer - coarser) / (4**order - 1) for coarser, finer in zip(column, column[1:])]
        return column[0]

    @property
    def error(self) -> float:
        """Of the extrapolated amplitude, over the closed form."""
        return abs(self.extrapolated / self.boundary.amplitude - 1)

    @cached_property
    def impacts(self) -> int:
        """Impacts of the most slender block where it overturns: its transitions but for uplift and overturning."""
        beside = self.amplitudes[-1] * (1 - BESIDE if self.boundary.upper else 1 + BESIDE)
        run = block.run(homogeneous(TANGENTS[-1], R), self.pulse, self.omega, beside)
        assert run.overturned
        return len(run.transitions) - 2


def draw(cases: list[Case], path: Path) -> None:
    """The boundaries over the frequency: lines by the closed form, dots by the model."""
    figure, axes = subplots(1, 3, 3.4, sharey=True)
    for axis, pulse in zip(axes, PULSES):
        found = {}
        for omega in CURVES:
            for of in boundaries(pulse, omega, R, MOST, step=0.02):
                found.setdefault((of.impacts, of.upper), {})[omega] = of.amplitude
        for (impacts, _), of in sorted(found.items()):
            if impacts <= 1:
                color = [FIXED, ROCKING][impacts]
                axis.plot(CURVES, [of.get(omega, np.nan) for omega in CURVES], color=color)
        own = [case for case in cases if case.pulse is pulse]
        omega = [case.omega for case in own]
        axis.plot(omega, [case.extrapolated for case in own], "o", color="black", markersize=3)
        axis.set(title=pulse.name, xlabel="$\\omega/p$", xlim=(CURVES[0], CURVES[-1] + 0.2), ylim=(1, MOST + 0.5))
    axes[0].set_ylabel("amplitude over $g\\,\\tan\\alpha$")
    axes[0].plot([], [], color=FIXED, label="no impact")
    axes[0].plot([], [], color=ROCKING, label="one impact")
    axes[0].plot([], [], "o", color="black", markersize=3, label="model")
    axes[0].legend(loc="upper left")
    title = "The model of a slender block overturns where the closed form does"
    figure.suptitle(title)
    save(figure, path, title,
                 "Closed form for the slender block as lines, the model as dots, over the frequency of the pulse.")


def values(figures: Path) -> dict:
    cases = [Case(pulse, omega, of) for pulse, omega in tqdm(CASES) for of in boundaries(pulse, omega, R, MOST)]
    draw(cases, figures / "overturning.svg")
    return dict(
        restitution=R, impacts_agree=sum(case.impacts == case.boundary.impacts for case in cases),
        most=MOST, boundary_count=len(cases), boundary_error=max(case.error for case in cases),
        boundary_rates=spread([case.rate for case in cases], ".3f"), samples=block.SAMPLES,
        tangents=", ".join(f"{tangent:g}" for tangent in TANGENTS))
