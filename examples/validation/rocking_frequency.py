"""Section 5: effective rocking frequency against amplitude, Fig 7."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from . import figures
from .free_vibration import release
from .half_cycles import HalfCycles, half_cycles
from .project import Project
from .report import Row, Section

AMPLITUDE = 0.9  # of tan alpha_cg, to start from
DURATION = 20.0  # s
INTERVAL = 2e-4  # s
LARGE = 5.0  # amplitudes over u_cr from here on count as large


@dataclass(frozen=True)
class Frequencies:
    """The half cycles of a decay from near overturning to full contact, and Eq 14 at their amplitudes."""

    cycles: HalfCycles
    estimated: np.ndarray  # Eq 14 at theta = delta_t/H, Hz
    f_fc: float  # Hz
    damped: float  # frequency in full contact with its damping, Hz
    H: float  # m
    u_cr: float  # m
    time_to_impact: float  # of the release of section 3, s
    estimated_time_to_impact: float  # by Eq 14, s
    curve: tuple[np.ndarray, np.ndarray]  # Eq 14: amplitude over tan alpha_cg, frequency in Hz
    tangent: float  # tan alpha_cg


def effective_frequency(project: Project, *structure, amplitudes: np.ndarray) -> np.ndarray:
    """Eq 14 at amplitudes theta/tan(alpha_cg), Hz, of the structure that the arguments name."""
    listed = ",".join(map(repr, amplitudes.tolist()))
    values = project.values("estimate", *structure, "--amplitudes", listed)
    return np.array([value for name, value in values.items() if name.startswith("f_r(")])


def compute(project: Project) -> Frequencies:
    """One decay, from near overturning to full contact."""
    parameters, derived = project.parameters("evison"), project.calculated("evison")
    H, tangent = parameters["H"], np.tan(derived["alpha_cg"])
    response = project.free_vibration("evison", DURATION, INTERVAL, theta_0=AMPLITUDE * tangent, u_0=derived["u_cr"])
    cycles = half_cycles(response["time"], response["delta_t"])
    of = release(project)
    turned = np.argmax(of.response["theta"] < 0)
    after = of.response[turned]
    curve = np.geomspace(1e-4, 0.95, 200)
    return Frequencies(
        cycles, _eq_14(project, cycles.amplitude / H / tangent), parameters["f_fc"],
        parameters["f_fc"] * np.sqrt(1 - parameters["zeta_fc"]**2), H, derived["u_cr"],
        after["time"] - after["theta"] / after["theta_dot"],
        1 / (4 * _eq_14(project, of.response["theta"][:1] / tangent)[0]), (curve, _eq_14(project, curve)), tangent)


def _eq_14(project: Project, amplitudes: np.ndarray) -> np.ndarray:
    return effective_frequency(project, "--preset", "evison", amplitudes=amplitudes)


def rows(of: Frequencies) -> list[Row]:
    """Eq 14 and the limit of small amplitudes against the simulated half cycles."""
    cycles = of.cycles
    large = cycles.amplitude > LARGE * of.u_cr
    error = np.abs(of.estimated / cycles.frequency - 1)
    between = (cycles.amplitude > of.u_cr) & ~large
    quiet = cycles.amplitude < 0.5 * of.u_cr
    crossing = np.interp(-of.f_fc, -of.curve[1], of.curve[0]) * of.tangent * of.H
    return [
        Row("frequency of the smallest half cycles (full contact)", f"{of.f_fc:.0f}",
            np.mean(cycles.frequency[quiet]), ".3f", "Hz", f"the paper's limit; with its damping {of.damped:.3f} Hz"),
        Row(f"largest error of Eq 14 for amplitudes above {LARGE:g} u_cr ({np.sum(large)} half cycles)", None,
            100 * np.max(error[large]), ".1f", "%", "“adequately describes … for large displacements”"),
        Row(f"largest error of Eq 14 from u_cr to {LARGE:g} u_cr ({np.sum(between)} half cycles)", None,
            100 * np.max(error[between]), ".0f", "%", "“less accurate for small displacements”"),
        Row("amplitude at which Eq 14 gives f_fc, over u_cr", None, crossing / of.u_cr, ".2f", "",
            "below it Eq 14 grows beyond all bounds, the structure stays at f_fc"),
        Row("time from the release of section 3 to the first impact (Eq 14)", f"{of.estimated_time_to_impact:.4f}",
            of.time_to_impact, ".4f", "s", "formula; Eq 14 starts from θ alone, not from q_r = θ + (p_l²/g) u",
            is_printed=False),
    ]


def draw(of: Frequencies, path: Path) -> None:
    """Frequency over amplitude, in the layout of Fig 7."""
    figure, axis = figures.subplots(1, 1, 3.4)
    part, frequency = of.curve
    axis.plot(1e3 * of.H * of.tangent * part, frequency, color=figures.SMOOTH, label="Eq 14")
    axis.axhline(of.f_fc, color=figures.FIXED, linestyle="--", linewidth=0.9, label=r"$f_{fc}$")
    axis.plot(1e3 * of.cycles.amplitude, of.cycles.frequency, "o", color=figures.ROCKING, markersize=3,
              label="simulated half cycles")
    axis.axvline(1e3 * of.u_cr, color=figures.QUIET, linestyle=":", linewidth=0.9)
    axis.text(1e3 * of.u_cr, 0.33, r" $u_{cr}$", color=figures.QUIET)
    axis.set(xscale="log", yscale="log", xlim=(0.05, 400), ylim=(0.3, 30),
             xlabel=r"largest lateral displacement of the half cycle, max $\delta_t$ (mm)",
             ylabel=r"effective frequency $f_t$ (Hz)")
    axis.set_yticks([0.3, 1, 3, 10, 30], ["0.3", "1", "3", "10", "30"])
    axis.set_xticks([0.1, 1, 10, 100], ["0.1", "1", "10", "100"])
    axis.legend(loc="upper right")
    figures.save(figure, path)


def section(project: Project, folder: Path) -> Section:
    """The section with its figure."""
    of = compute(project)
    draw(of, folder / "rocking_frequency.png")
    return Section(
        title="Effective rocking frequency against amplitude (Fig 7)",
        introduction=f"""One simulated decay of Evison's specimen from θ = {AMPLITUDE:g} tan α_cg, near overturning,
down to vibration in full contact. As in the paper, f_t is the inverse of twice the time between zero crossings of
δ_t, and the amplitude the largest δ_t between them. Eq 14 (`rocking-fmu estimate`) is taken at θ = δ_t/H.""",
        rows=rows(of),
        figure="rocking_frequency.png",
        caption="Effective frequency of each half cycle over its largest displacement, with Eq 14 and f_fc (Fig 7).",
        findings=["""Eq 14 does better than the paper asks of it: from a few u_cr to near overturning it is the
frequency of the full nonlinear model, because δ_t/H is the rotation of the rocking mode to within (1−χ) u/H. It
fails where the paper says, below u_cr, where the frequency is that of full contact, f_fc."""],
    )
