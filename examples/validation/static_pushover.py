"""Section 1: the displacement-controlled pushover of Fig 1."""

import warnings
from dataclasses import dataclass
from pathlib import Path

import flexible_rocking as fr
import numpy as np
from first_run import G

from . import figures
from .report import Row, Section
from .specimens import EVISON, MCMANUS, TOLERANCE

SPECIMENS = {"Evison": EVISON, "McManus": MCMANUS}
POINTS = 400  # on each branch


@dataclass(frozen=True)
class Pushover:
    """The curve of one specimen, and what runs do at its two corners."""

    delta_t: np.ndarray  # m
    theta: np.ndarray  # rad
    moment: np.ndarray  # N.m
    structure: fr.Structure
    a_g_at_uplift: float  # of a slow ramp of ground acceleration, m/s2
    theta_at_overturning: float  # beyond which it overturns when it is released at rest, rad

    @property
    def weight_moment(self) -> float:
        """(m + m0) g B, N.m."""
        return (self.structure.weight + self.structure.weight0) * self.structure.B

    @property
    def drop(self) -> float:
        """Part of the moment by which it falls as the base lifts off."""
        return 1 - self.moment[POINTS] / self.moment[POINTS - 1]


def compute() -> dict[str, Pushover]:
    """The pushovers of both specimens."""
    return {name: _pushover(structure) for name, structure in SPECIMENS.items()}


def _pushover(structure: fr.Structure) -> Pushover:
    curve = structure.pushover(POINTS)
    return Pushover(curve["delta_t"], curve["theta"], curve["M"], structure, _ramp_to_uplift(structure),
                    _release_to_overturning(structure, curve["theta"][-1], curve["u"][-1]))


def _ramp_to_uplift(structure: fr.Structure) -> float:
    """The ground acceleration (m/s2) at which it lifts off when it grows slowly."""
    end, a_g = 20.0, 1.1 * G * np.tan(structure.alpha_cg)
    with warnings.catch_warnings(action="ignore"):  # such ground is no earthquake's
        ground = fr.Record([0.0, end], [0.0, a_g])
    run = fr.simulate(structure, ground, tolerance=TOLERANCE)
    return a_g * run.transitions[0].time / end


def _release_to_overturning(structure: fr.Structure, theta: float, u: float) -> float:
    """The rotation (rad) near `theta` from which it overturns when it is released at rest with the displacement `u`."""
    comes_down, overturns = 0.99 * theta, 1.01 * theta
    while overturns - comes_down > 1e-6 * theta:
        middle = (comes_down + overturns) / 2
        if fr.simulate(structure, duration=20.0, tolerance=TOLERANCE, theta_0=middle, u_0=u).overturned:
            overturns = middle
        else:
            comes_down = middle
    return (comes_down + overturns) / 2


def rows(pushovers: dict[str, Pushover]) -> list[Row]:
    """Formulas of the text against the curve and the FMU."""
    result = []
    for name, p in pushovers.items():
        of, tangent = p.structure, np.tan(p.structure.alpha_cg)
        slope = (p.moment[POINTS + 1] - p.moment[POINTS]) / (p.delta_t[POINTS + 1] - p.delta_t[POINTS])
        result += [
            Row(f"{name}: ground acceleration at uplift, g tan α_cg, under a slow ramp", f"{tangent:.4f}",
                p.a_g_at_uplift / G, ".4f", "g"),
            Row(f"{name}: stiffness as rocking begins, −m g (gravity terms of Eq 8)", f"{-of.weight / 1e3:.3f}",
                slope / 1e3, ".3f", "kN·m/m"),
            Row(f"{name}: rotation at overturning, α_cg of the rigid body", f"{of.alpha_cg:.4f}", p.theta[-1],
                ".4f", "rad", "the strut's bend takes the top mass further out"),
            Row(f"{name}: the same, released at rest: limit of coming down", f"{p.theta[-1]:.4f}",
                p.theta_at_overturning, ".4f", "rad", "against the pushover above"),
        ]
    return result


def draw(pushovers: dict[str, Pushover], path: Path) -> None:
    """Moment over displacement: near uplift, and to overturning."""
    figure, (near, whole) = figures.subplots(1, 2, 3.0)
    for (name, p), color in zip(pushovers.items(), (figures.ROCKING, figures.SMOOTH)):
        near.plot(p.delta_t / p.structure.u_cr, p.moment / p.weight_moment, color=color, label=name)
        whole.plot(1e3 * p.delta_t, p.moment, color=color, label=name)
        whole.plot(1e3 * p.delta_t[-1], 0, "o", color=color, markersize=4, clip_on=False)
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


def section(folder: Path) -> Section:
    """The section with its figure."""
    pushovers = compute()
    draw(pushovers, folder / "pushover.png")
    evison, mcmanus = pushovers.values()
    return Section(
        title="Pushover of the static system (Fig 1)",
        introduction="""The paper claims that the system is elastic in full contact and lifts off at u_cr. Beyond u_cr the stiffness is
negative, because the weight restores and not the strut. The restoring moment is zero at overturning. We solve the
equilibrium of Eqs 5 and 6 without inertia exactly. Time histories check its two corners: a ramp of ground acceleration slow
enough to be static, and releases at rest near overturning.""",
        rows=rows(pushovers),
        figure="pushover.png",
        caption="Moment of the lateral force about the base over the displacement of the top mass, as in Fig 1.",
        findings=[f"""Our curve agrees with the picture and differs in two details. The moment drops at uplift, by
{100 * evison.drop:.1f} % (Evison) and {100 * mcmanus.drop:.1f} % (McManus). The reason is the moment m g u of the
leaning top mass: u_cr does not include it, and Eq 6 includes it from the instant of uplift. Overturning comes
{1e3 * (EVISON.alpha_cg - evison.theta[-1]):.2f} mrad (Evison) and
{1e3 * (MCMANUS.alpha_cg - mcmanus.theta[-1]):.2f} mrad (McManus) before α_cg, for the same reason."""],
        source="formula",
    )
