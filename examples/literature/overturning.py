"""Section 1: the amplitudes of pulses that overturn a rigid block, with and without impact."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import flexible_rocking as fr
import numpy as np
import pandas as pd
from validation import figures
from validation.report import table

from . import block
from .block import NoBoundary, homogeneous
from .limit import TANGENTS, Limit
from .slender_block import HALF_SINE, ONE_COSINE, ONE_SINE, PULSES, Boundary, Pulse, boundaries, half_sine_boundary

R = 0.9  # coefficient of restitution
MOST = 10.0  # amplitude, g tan alpha
CASES = [*((HALF_SINE, omega) for omega in (2, 4, 6, 8)), *((ONE_SINE, omega) for omega in (2, 3, 4, 5, 6)),
         *((ONE_COSINE, omega) for omega in (2, 3, 4))]  # omega in p
BESIDE = 1e-9  # relative distance from a boundary at which impacts are counted
STOCKY = 0.366  # tan alpha of Evison's specimen
WAY = [0.15, 0.22, 0.29, STOCKY]  # tan alpha on the way to it
CURVES = np.linspace(1.5, 8, 66)  # omega/p of the curves in the figure


@dataclass(frozen=True)
class Case:
    """One boundary: its closed form, the model's in the slender limit, and that of a stocky block."""

    pulse: Pulse
    omega: float
    boundary: Boundary
    limit: Limit
    impacts: int  # counted where the most slender block overturns
    stocky: float  # nan where the boundary does not last

    @property
    def words(self) -> str:
        """Events at the boundary."""
        how = ["without impact", "after one impact", "after two impacts"][self.boundary.impacts]
        return f"{how}, {'below' if self.boundary.upper else 'above'}"


def limit(pulse: Pulse, omega: float, of: Boundary) -> Limit:
    """The boundary of the model's blocks that become slender."""
    return Limit(of.amplitude, [block.boundary(homogeneous(tangent, R), pulse, omega, of.amplitude)
                                for tangent in TANGENTS])


def counted(pulse: Pulse, omega: float, amplitude: float) -> int:
    """Impacts of the most slender block, which overturns: its transitions but for uplift and overturning."""
    run = block.run(homogeneous(TANGENTS[-1], R), pulse, omega, amplitude)
    assert run.overturned
    return len(run.transitions) - 2


def followed(pulse: Pulse, omega: float, slender: Limit) -> float:
    """The boundary followed from slender blocks to the stocky one, guessed by its last two in tan^2 alpha."""
    last = [(0.0, slender.closed_form), (TANGENTS[0], slender.values[0])]
    for tangent in WAY:
        (first, a), (second, b) = last
        guess = b + (b - a) * (tangent**2 - second**2) / (second**2 - first**2)
        try:
            last = [last[1], (tangent, block.boundary(homogeneous(tangent, R), pulse, omega, guess))]
        except NoBoundary:
            return np.nan
    return last[1][1]


def compute(advance: Callable[[], None]) -> list[Case]:
    """All boundaries of CASES."""
    cases = []
    for pulse, omega in CASES:
        for of in boundaries(pulse, omega, R, MOST):
            slender = limit(pulse, omega, of)
            impacts = counted(pulse, omega, slender.values[-1] * (1 - BESIDE if of.upper else 1 + BESIDE))
            cases.append(Case(pulse, omega, of, slender, impacts, followed(pulse, omega, slender)))
        advance()
    return cases


def any_shape(cases: list[Case]) -> float:
    """Largest relative difference between the stocky block's boundaries and those of another structure of its alpha."""
    H = 3.0
    top_heavy = fr.Structure(m=1000.0, m0=700.0, H=H, B=STOCKY * H / 1.7, J0=250.0, f_fc=5.0, zeta_fc=0.02, r=R)
    chosen = [case for case in cases if (case.pulse, case.omega) == (ONE_SINE, 4)]
    return max(abs(block.boundary(top_heavy, case.pulse, case.omega, case.stocky) / case.stocky - 1) for case in chosen)


def save(cases: list[Case], path: Path) -> None:
    """Writes the table of all boundaries."""
    pd.DataFrame([{
        "pulse": case.pulse.name, "omega/p": case.omega, "overturns": case.words,
        "closed form": f"{case.boundary.amplitude:.10f}",
        f"difference at tan alpha = {TANGENTS[0]:g}": f"{case.limit.differences[0]:.1e}",
        f"difference at tan alpha = {TANGENTS[-1]:g}": f"{case.limit.differences[-1]:.1e}",
        "rate": f"{case.limit.rate:.3f}", "extrapolated": f"{case.limit.extrapolated:.10f}",
        "difference": f"{case.limit.error:.0e}", f"amplitude at tan alpha = {STOCKY:g}": f"{case.stocky:.4f}",
    } for case in cases]).to_csv(path, index=False)


def changes(cases: list[Case], upper: bool) -> str:
    """By how much the stocky block's boundaries after an impact differ from the slender block's."""
    of = [100 * (case.stocky / case.boundary.amplitude - 1) for case in cases
          if case.boundary.impacts and case.boundary.upper == upper and np.isfinite(case.stocky)]
    return f"{min(of):+.0f} to {max(of):+.0f} %".replace("-", "−")


def half_sines() -> str:
    """The table of the half sine's closed form beside the formula that lets the sine go on."""
    lines = []
    for pulse, omega in CASES:
        if pulse is HALF_SINE:
            amplitude, endless = half_sine_boundary(omega), np.hypot(1, omega)
            lines.append([f"{omega:g}", f"{amplitude:.6f}", f"{endless:.6f}", f"{endless / amplitude:.2f}"])
    return table(["ω/p", "closed form", "√(1 + (ω/p)²)", "ratio"], lines)


def draw(cases: list[Case], path: Path) -> None:
    """The boundaries over the frequency: lines by the closed form, dots by the model."""
    figure, axes = figures.subplots(1, 3, 3.4, sharey=True)
    for axis, pulse in zip(axes, PULSES):
        found = {}
        for omega in CURVES:
            for of in boundaries(pulse, omega, R, MOST, step=0.02):
                found.setdefault((of.impacts, of.upper), {})[omega] = of.amplitude
        for (impacts, _), of in sorted(found.items()):
            if impacts <= 1:
                color = [figures.FIXED, figures.ROCKING][impacts]
                axis.plot(CURVES, [of.get(omega, np.nan) for omega in CURVES], color=color)
        own = [case for case in cases if case.pulse is pulse]
        omega = [case.omega for case in own]
        axis.plot(omega, [case.limit.extrapolated for case in own], "o", color="black", markersize=3)
        axis.plot(omega, [case.stocky for case in own], "o", color="black", markersize=4, fillstyle="none")
        axis.set(title=pulse.name, xlabel="$\\omega/p$", xlim=(CURVES[0], CURVES[-1] + 0.2), ylim=(1, MOST + 0.5))
    axes[0].set_ylabel("amplitude over $g\\,\\tan\\alpha$")
    axes[0].plot([], [], color=figures.FIXED, label="no impact")
    axes[0].plot([], [], color=figures.ROCKING, label="one impact")
    axes[0].plot([], [], "o", color="black", markersize=3, label="model, slender limit")
    axes[0].plot([], [], "o", color="black", markersize=4, fillstyle="none", label=f"model, $\\tan\\alpha$ = {STOCKY:g}")
    axes[0].legend(loc="upper left")
    title = "The model of a slender block overturns where the closed form does"
    figure.suptitle(title)
    figures.save(figure, path, title,
                 "Closed form for the slender block as lines, the model as dots, over the frequency of the pulse.")
