"""Section 3: Evison's free vibration test of Fig 5."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import flexible_rocking as fr
import numpy as np

from .. import figures
from ..page import spread
from ..scenes import G
from .rows import Row
from .specimens import EVISON, HalfCycles, free_vibration, half_cycles

THETA_0 = 0.04  # rad
OTHER_THETA_0 = [0.03, 0.035, 0.045, 0.05]  # rad
DURATION = 4.0  # s
INTERVAL = 5e-5  # s
SHOWN = 10  # half cycles whose decay is told
TANGENT = np.tan(EVISON.alpha_cg)
STEP = EVISON.chi * TANGENT  # the rocking mode's acceleration at small rotation, χ tan α_cg, g (Eq 13)
FIRST = 5  # half cycles: the first three rocking cycles, less what precedes the first impact


@dataclass(frozen=True)
class Release:
    """The response to the release, and its half cycles between the zero crossings of δ_t."""

    response: fr.Response
    cycles: HalfCycles

    def peak(self, name: str, cycle: int) -> float:
        """Largest magnitude of an output within a half cycle after the first crossing (0, 1, ...)."""
        return np.max(np.abs(self.response[name][self.cycles.first[cycle]:self.cycles.end[cycle]]))

    @property
    def first_peak(self) -> float:
        """Largest |a_t| of the first cycles, g."""
        return max(self.peak("a_t", cycle) for cycle in range(FIRST)) / G


@cache
def release(theta: float = THETA_0, duration: float = DURATION) -> Release:
    """Released at rest with u = u_cr, as the paper assumes."""
    response = free_vibration(EVISON, duration, INTERVAL, theta_0=theta, u_0=EVISON.u_cr)
    return Release(response, half_cycles(response["time"], response["delta_t"]))


def rigid_rotation(theta: float) -> float:
    """Peak rotation of a rigid structure one impact after `theta` (Housner): r² of the energy is kept."""
    return TANGENT * (1 - np.sqrt(1 - EVISON.r**2 * (1 - (1 - theta / TANGENT) ** 2)))


def rows(of: Release) -> list[Row]:
    return [
        Row("peak a_t of the first three rocking cycles", "0.85", of.first_peak, ".3f", "g",
            "measured; conservative, as the paper says of its simulation: the transition is instant (section 4)"),
        Row("peak a_t of the whole decay", None, np.max(np.abs(of.response["a_t"])) / G, ".3f", "g",
            "later impacts meet vibrations that have not died out"),
        Row("peak a_t before the first impact", None, np.max(np.abs(of.response["a_t"][:of.cycles.first[0]])) / G, ".3f", "g",
            f"χ tan α_cg is {STEP:.3f} g: no vibrations before the first impact, as the paper observes"),
    ]


def draw(of: Release, path: Path) -> None:
    """Uplift, acceleration and displacement over time, in the layout of Fig 5."""
    response = of.response
    time = response["time"]
    figure, (uplift, acceleration, displacement) = figures.subplots(3, 1, 5.6, sharex=True)
    uplift.plot(time, 1e3 * response["uplift"], color=figures.ROCKING)
    uplift.set(ylabel="uplift $\\delta_u$ (mm)", ylim=(0, None))
    acceleration.plot(time, response["a_t"] / G, color=figures.ROCKING, linewidth=0.7)
    for level in (0.85, -0.85):
        acceleration.axhline(level, color=figures.FIXED, linewidth=0.8, linestyle="--")
    acceleration.text(DURATION, 0.87, "largest measured, 0.85 g", color=figures.FIXED, ha="right", va="bottom",
                      fontsize=8)
    acceleration.set(ylabel="acceleration $a_t$ (g)", ylim=(-1.1, 1.1))
    displacement.plot(time, 1e3 * response["delta_t"], color=figures.ROCKING)
    displacement.set(ylabel="displacement $\\delta_t$ (mm)", xlabel="time (s)", xlim=(0, DURATION))
    figure.suptitle("Every impact excites a vibration, and the rocking dies out")
    figure.align_ylabels()
    figures.save(figure, path)


def section(folder: Path) -> tuple[list[Row], dict]:
    """The rows, and how much of the rotation each impact keeps."""
    of = release()
    draw(of, folder / "free_vibration.png")
    theta = [THETA_0, *(of.peak("theta", i) for i in range(SHOWN))]
    kept = [100 * after / before for before, after in zip(theta, theta[1:])]
    rigid = [100 * rigid_rotation(before) / before for before in theta[:-1]]
    others = [release(theta, 2.0).first_peak for theta in OTHER_THETA_0]
    return rows(of), dict(
        theta_0=THETA_0, other_theta_0=OTHER_THETA_0, other_peaks=spread(others, ".2f"), kept=spread(kept, ".0f"),
        energy=100 * EVISON.r**2, rigid=np.mean(rigid), step=STEP)
