"""Section 1: the displacement-controlled pushover of Fig 1."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from first_run import G

from . import figures
from .project import Project
from .report import Row, Section

PRESETS = {"evison": "Evison", "mcmanus": "McManus"}
POINTS = 400  # on each branch
FULL_CONTACT = 1


@dataclass(frozen=True)
class Pushover:
    """The curve of one specimen, and what the FMU does at its two corners."""

    delta_t: np.ndarray  # m
    theta: np.ndarray  # rad
    moment: np.ndarray  # N.m
    derived: dict[str, float]
    weight_moment: float  # (m + m0) g B, N.m
    weight: float  # of the top mass, m g, N
    a_g_at_uplift: float  # of a slow ramp of ground acceleration on the FMU, m/s2
    theta_at_overturning: float  # beyond which the FMU, released at rest, overturns, rad

    @property
    def drop(self) -> float:
        """Part of the moment by which it falls as the base lifts off."""
        return 1 - self.moment[POINTS] / self.moment[POINTS - 1]


def compute(project: Project) -> dict[str, Pushover]:
    """The pushovers of both specimens."""
    return {preset: _pushover(project, preset) for preset in PRESETS}


def _pushover(project: Project, preset: str) -> Pushover:
    curve = project.columns("pushover", "--preset", preset, "--points", POINTS, "-o", "-")
    parameters = project.parameters(preset)
    derived = project.values("describe", "--preset", preset)
    return Pushover(curve["delta_t"], curve["theta"], curve["M"], derived,
                    weight_moment=(parameters["m"] + parameters["m0"]) * G * parameters["B"],
                    weight=parameters["m"] * G,
                    a_g_at_uplift=_ramp_to_uplift(project, preset, 1.1 * G * np.tan(derived["alpha_cg"])),
                    theta_at_overturning=_release_to_overturning(project, preset, curve["theta"][-1], curve["u"][-1]))


def _ramp_to_uplift(project: Project, preset: str, a_g: float) -> float:
    """The ground acceleration (m/s2) at which the FMU lifts off when it grows slowly to `a_g`."""
    time = np.array([0.0, 20.0])
    response = project.earthquake(preset, time, np.array([0.0, a_g]), per_sample=20000)
    return a_g * response["time"][np.argmax(response["phase"] != FULL_CONTACT)] / time[1]


def _release_to_overturning(project: Project, preset: str, theta: float, u: float) -> float:
    """The rotation (rad) near `theta` from which the FMU, released at rest with the displacement `u`, overturns."""
    comes_down, overturns = 0.99 * theta, 1.01 * theta
    while overturns - comes_down > 1e-6 * theta:
        middle = (comes_down + overturns) / 2
        response = project.free_vibration(preset, 6.0, 0.02, theta_0=middle, u_0=u)
        if response["theta"][-1] > middle:
            overturns = middle
        else:
            comes_down = middle
    return (comes_down + overturns) / 2


def rows(pushovers: dict[str, Pushover]) -> list[Row]:
    """Formulas of the text against the curve and the FMU."""
    result = []
    for preset, name in PRESETS.items():
        p = pushovers[preset]
        tangent = np.tan(p.derived["alpha_cg"])
        slope = (p.moment[POINTS + 1] - p.moment[POINTS]) / (p.delta_t[POINTS + 1] - p.delta_t[POINTS])
        result += [
            Row(f"{name}: displacement at uplift, u_cr = g tan α_cg/ω_fc² (after Eq 4)",
                f"{1e3 * G * tangent / p.derived['omega_fc']**2:.4f}", 1e3 * p.delta_t[POINTS - 1], ".4f", "mm"),
            Row(f"{name}: moment at uplift, (m + m0) g B", f"{p.weight_moment:.1f}", p.moment[POINTS - 1], ".1f",
                "N·m"),
            Row(f"{name}: ground acceleration at uplift, g tan α_cg, of the FMU under a slow ramp", f"{tangent:.4f}",
                p.a_g_at_uplift / G, ".4f", "g"),
            Row(f"{name}: stiffness as rocking begins, −m g (gravity terms of Eq 8)", f"{-p.weight / 1e3:.3f}",
                slope / 1e3, ".3f", "kN·m/m"),
            Row(f"{name}: rotation at overturning, α_cg of the rigid body", f"{p.derived['alpha_cg']:.4f}", p.theta[-1],
                ".4f", "rad", "the strut's bend takes the top mass further out"),
            Row(f"{name}: the same, of the FMU released at rest: limit of coming down", f"{p.theta[-1]:.4f}",
                p.theta_at_overturning, ".4f", "rad", "against the pushover above"),
        ]
    return result


def draw(pushovers: dict[str, Pushover], path: Path) -> None:
    """Moment over displacement: near uplift, and to overturning."""
    figure, (near, whole) = figures.subplots(1, 2, 3.0)
    for (preset, name), color in zip(PRESETS.items(), (figures.ROCKING, figures.SMOOTH)):
        p = pushovers[preset]
        critical = p.derived["u_cr"]
        near.plot(p.delta_t / critical, p.moment / p.weight_moment, color=color, label=name)
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
    figures.save(figure, path)


def section(project: Project, folder: Path) -> Section:
    """The section with its figure."""
    pushovers = compute(project)
    draw(pushovers, folder / "pushover.png")
    evison, mcmanus = (pushovers[preset] for preset in PRESETS)
    return Section(
        title="Pushover of the static system (Fig 1)",
        introduction="""Claims: elastic in full contact; uplift at u_cr; from there negative stiffness, because the
weight, not the strut, restores; no restoring moment at overturning. `rocking-fmu pushover` solves the equilibrium
of Eqs 5 and 6 without inertia exactly; the FMU is asked for the two corners, by a ramp of ground acceleration slow
enough to be static and by releases at rest near overturning.""",
        rows=rows(pushovers),
        figure="pushover.png",
        caption="Moment of the lateral force about the base over the displacement of the top mass, as in Fig 1.",
        findings=[f"""All of the picture is there. Two things are finer than in it. The moment drops at uplift, by
{100 * evison.drop:.1f} % (Evison) and {100 * mcmanus.drop:.1f} % (McManus): u_cr leaves out the moment m g u of the
top mass's own lean, which Eq 6 counts from the instant of uplift. And overturning comes
{1e3 * (evison.derived['alpha_cg'] - evison.theta[-1]):.2f} mrad (Evison) and
{1e3 * (mcmanus.derived['alpha_cg'] - mcmanus.theta[-1]):.2f} mrad (McManus) before α_cg, for the same reason."""],
        source="formula",
    )
