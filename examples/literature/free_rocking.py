"""Section 2: a rigid block released at rest: the instants of its impacts and how fast it then is."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import quad
from validation.project import Project
from validation.report import table

from .block import Block, homogeneous
from .limit import TANGENTS, Limit
from .overturning import R, STOCKY

RELEASES = [0.3, 0.6, 0.9]  # theta_0/tan alpha
IMPACTS = 6
TOLERANCE = 1e-12


@dataclass(frozen=True)
class Decay:
    """Impacts of a block: p times their instants, and the speeds just before them over p tan alpha."""

    instants: np.ndarray
    speeds: np.ndarray


def housner(release: float) -> Decay:
    """Of the slender block released from y = theta_0/alpha.

    From y to the ground takes acosh(1/(1 - y))/p, Housner's T/4. The block arrives with v = sqrt(y (2 - y)), over
    p alpha, and rises again with r v: in v the quarter is atanh(v).
    """
    speeds = np.sqrt(release * (2 - release)) * R ** np.arange(IMPACTS)
    return Decay(_instants(np.arctanh(speeds)), speeds)


def _instants(quarters: np.ndarray) -> np.ndarray:
    """Of impacts that end these quarters of a period; each rise takes as long as the fall after it."""
    return 2 * np.cumsum(quarters) - quarters[0]


def stocky(tangent: float, release: float) -> Decay:
    """Of a block that is not slender: theta'^2/2 - p^2 cos(alpha - theta) is kept between impacts; by quadrature."""
    alpha, theta = np.arctan(tangent), release * tangent
    quarters, speeds = [], []
    for _ in range(IMPACTS):
        energy = 2 * np.sin(alpha - 0.5 * theta) * np.sin(0.5 * theta)  # cos(alpha - theta) - cos(alpha)
        quarters.append(_quarter(alpha, theta))
        speeds.append(np.sqrt(2 * energy) / tangent)
        theta = alpha - np.arccos(np.cos(alpha) + R**2 * energy)
    return Decay(_instants(np.array(quarters)), np.array(speeds))


def _quarter(alpha: float, top: float) -> float:
    """Time from rest at `top` to the ground, over 1/p: the integral of 1/theta', smooth in x, theta = top (1 - x^2)."""
    def integrand(x):
        dropped = top * x**2
        # theta'^2/2 = cos(alpha - top) - cos(alpha - top + dropped)
        return 2 * top * x / np.sqrt(4 * np.sin(alpha - top + 0.5 * dropped) * np.sin(0.5 * dropped))

    return quad(integrand, 0, 1, epsabs=0, epsrel=1e-13)[0]


def of_model(project: Project, block: Block, release: float) -> Decay:
    """Of the rigid limit, as `rocking-fmu simulate` lists its transitions."""
    duration = 1.5 * housner(release).instants[-1] / block.p
    events = project.events("--preset", "mcmanus", *block.options, "--detail", "rigid", "--tolerance", TOLERANCE,
                            "--free", duration, "--theta-0", repr(float(release * block.tangent)))[:IMPACTS]
    return Decay(np.array([block.p * float(event["time[s]"]) for event in events]),
                 np.array([abs(float(event["theta_dot_before[rad/s]"])) / block.p / block.tangent for event in events]))


@dataclass(frozen=True)
class Case:
    """One impact after one release, in the slender limit and of a stocky block."""

    release: float
    impact: int  # from 1 on
    instant: Limit
    speed: Limit
    stocky: list[float]  # relative errors of instant and speed against the quadrature


def compute(project: Project, advance: Callable[[], None]) -> list[Case]:
    """All impacts after all releases."""
    cases = []
    for release in RELEASES:
        exact = housner(release)
        slender = [of_model(project, homogeneous(tangent, R), release) for tangent in TANGENTS]
        found, expected = of_model(project, homogeneous(STOCKY, R), release), stocky(STOCKY, release)
        for i in range(IMPACTS):
            errors = [abs(found.instants[i] / expected.instants[i] - 1), abs(found.speeds[i] / expected.speeds[i] - 1)]
            cases.append(Case(release, i + 1, Limit(exact.instants[i], [decay.instants[i] for decay in slender]),
                              Limit(exact.speeds[i], [decay.speeds[i] for decay in slender]), errors))
        advance()
    return cases


def rows(cases: list[Case]) -> str:
    """The table of the first and the last impact after each release."""
    lines = []
    for case in cases:
        if case.impact in (1, 2, IMPACTS):
            for name, limit, error in zip(("instant", "speed"), (case.instant, case.speed), case.stocky):
                lines.append([f"{case.release:g}", str(case.impact), name, f"{limit.closed_form:.9f}",
                              f"{limit.differences[0]:.1e}", f"{limit.differences[-1]:.1e}", f"{limit.rate:.3f}",
                              f"{limit.error:.0e}", f"{error:.0e}"])
    return table(["θ_0/α", "impact", "quantity", "Housner", f"tan α = {TANGENTS[0]:g}: difference",
                  f"tan α = {TANGENTS[-1]:g}: difference", "rate", "extrapolated: difference",
                  f"tan α = {STOCKY:g}, against quadrature"],
                 [[cell.replace("-", "−") for cell in line] for line in lines], texts=(2,))
