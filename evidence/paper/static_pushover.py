"""Section 1: the displacement-controlled pushover of Fig 1."""

import warnings
from pathlib import Path

import flexible_rocking as fr
import numpy as np
from scipy.optimize import bisect

from .. import figures
from ..scenes import G
from .rows import Row
from .specimens import EVISON, MCMANUS, TOLERANCE

POINTS = 400  # on each branch


def ramp_to_uplift(structure: fr.Structure) -> float:
    """The ground acceleration (m/s2) at which it lifts off when it grows slowly."""
    end, a_g = 20.0, 1.1 * G * np.tan(structure.alpha_cg)
    with warnings.catch_warnings(action="ignore"):  # such ground is no earthquake's
        ground = fr.Record([0.0, end], [0.0, a_g])
    return a_g * fr.simulate(structure, ground, tolerance=TOLERANCE).transitions[0].time / end


def release_to_overturning(structure: fr.Structure, theta: float, u: float) -> float:
    """The rotation (rad) near `theta` from which it overturns when it is released at rest with the displacement `u`."""
    def excess(theta_0: float) -> float:
        return bool(fr.simulate(structure, duration=20.0, tolerance=TOLERANCE, theta_0=theta_0, u_0=u).overturned) - 0.5

    return bisect(excess, 0.99 * theta, 1.01 * theta, xtol=1e-6 * theta)


def rows(name: str, of: fr.Structure, curve: dict[str, np.ndarray]) -> list[Row]:
    """Formulas of the text against the curve and time histories at its two corners."""
    slope = np.diff(curve["M"])[POINTS] / np.diff(curve["delta_t"])[POINTS]
    theta, u = curve["theta"][-1], curve["u"][-1]
    numbers = [
        ("ground acceleration at uplift, g tan α_cg, under a slow ramp", f"{np.tan(of.alpha_cg):.4f}",
         ramp_to_uplift(of) / G, ".4f", "g"),
        ("stiffness as rocking begins, −m g (gravity terms of Eq 8)", f"{-of.weight / 1e3:.3f}", slope / 1e3, ".3f", "kN·m/m"),
        ("rotation at overturning, α_cg of the rigid body", f"{of.alpha_cg:.4f}", theta, ".4f", "rad",
         "the strut's bend takes the top mass further out"),
        ("the same, released at rest: limit of coming down", f"{theta:.4f}", release_to_overturning(of, theta, u), ".4f",
         "rad", "against the pushover above"),
    ]
    return [Row(f"{name}: {quantity}", *number, is_printed=False) for quantity, *number in numbers]


def draw(pushovers: dict[str, tuple], path: Path) -> None:
    """Moment over displacement: near uplift, and to overturning."""
    figure, (near, whole) = figures.subplots(1, 2, 3.0)
    for (name, (of, curve)), color in zip(pushovers.items(), (figures.ROCKING, figures.SMOOTH)):
        delta_t, moment = curve["delta_t"], curve["M"]
        near.plot(delta_t / of.u_cr, moment / ((of.weight + of.weight0) * of.B), color=color, label=name)
        whole.plot(1e3 * delta_t, moment, color=color, label=name)
        whole.plot(1e3 * delta_t[-1], 0, "o", color=color, markersize=4, clip_on=False)
    near.set(xlim=(0, 4), ylim=(0, 1.15), xlabel=r"lateral displacement $\delta_t/u_{cr}$",
             ylabel=r"overturning moment $M/(m+m_0)gB$", title="full contact and uplift")
    near.text(0.72, 0.5, "full contact")
    near.text(1, 1.05, "uplift", ha="center")
    near.text(2.6, 0.88, "rocking")
    whole.set(xlim=(0, None), ylim=(0, 600), xlabel=r"lateral displacement $\delta_t$ (mm)",
              ylabel=r"overturning moment $M$ (N·m)", title="rocking to overturning")
    whole.text(215, 335, "negative stiffness")
    whole.text(300, 30, "overturning", ha="right")
    near.legend(loc="lower right")
    figure.suptitle("From uplift on the stiffness is negative")
    figures.save(figure, path)


def section(folder: Path) -> tuple[list[Row], dict]:
    """The rows of both specimens, and by how much their curves differ from the paper's."""
    pushovers = {name: (of, of.pushover(POINTS)) for name, of in {"Evison": EVISON, "McManus": MCMANUS}.items()}
    draw(pushovers, folder / "pushover.png")
    drops = [100 * (1 - curve["M"][POINTS] / curve["M"][POINTS - 1]) for _, curve in pushovers.values()]
    early = [1e3 * (of.alpha_cg - curve["theta"][-1]) for of, curve in pushovers.values()]
    found = [row for name, (of, curve) in pushovers.items() for row in rows(name, of, curve)]
    return found, {"drops": drops, "early": early}
