"""Section 5: effective rocking frequency against amplitude, Fig 7."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from . import figures
from .free_vibration import TANGENT, release
from .half_cycles import HalfCycles, half_cycles
from .report import Row, Section
from .specimens import EVISON, free_vibration

AMPLITUDE = 0.9  # of tan alpha_cg, to start from
DURATION = 20.0  # s
INTERVAL = 2e-4  # s
LARGE = 5.0  # amplitudes over u_cr from here on count as large


@dataclass(frozen=True)
class Frequencies:
    """The half cycles of a decay from near overturning to full contact, and Eq 14 at their amplitudes."""

    cycles: HalfCycles
    estimated: np.ndarray  # Eq 14 at theta = delta_t/H, Hz
    time_to_impact: float  # of the release of section 3, s
    estimated_time_to_impact: float  # by Eq 14, s
    curve: tuple[np.ndarray, np.ndarray]  # Eq 14: amplitude in rad, frequency in Hz


def compute() -> Frequencies:
    """One decay, from near overturning to full contact."""
    response = free_vibration(EVISON, DURATION, INTERVAL, theta_0=AMPLITUDE * TANGENT, u_0=EVISON.u_cr)
    cycles = half_cycles(response["time"], response["delta_t"])
    of = release().response
    turned = np.argmax(of["theta"] < 0)
    curve = np.geomspace(1e-4, 0.95, 200) * TANGENT
    return Frequencies(
        cycles, _eq_14(cycles.amplitude / EVISON.H),
        of["time"][turned] - of["theta"][turned] / of["theta_dot"][turned],
        1 / (4 * EVISON.effective_frequency(of["theta"][0])), (curve, _eq_14(curve)))


def _eq_14(amplitudes: np.ndarray) -> np.ndarray:
    return np.array([EVISON.effective_frequency(theta) for theta in amplitudes])


def rows(of: Frequencies) -> list[Row]:
    """Eq 14 and the limit of small amplitudes against the simulated half cycles."""
    cycles = of.cycles
    damped = EVISON.f_fc * np.sqrt(1 - EVISON.zeta_fc**2)
    large = cycles.amplitude > LARGE * EVISON.u_cr
    error = np.abs(of.estimated / cycles.frequency - 1)
    between = (cycles.amplitude > EVISON.u_cr) & ~large
    quiet = cycles.amplitude < 0.5 * EVISON.u_cr
    crossing = np.interp(-EVISON.f_fc, -of.curve[1], of.curve[0]) * EVISON.H
    return [
        Row("frequency of the smallest half cycles (full contact)", f"{EVISON.f_fc:.0f}",
            np.mean(cycles.frequency[quiet]), ".3f", "Hz", f"the paper's limit; with its damping {damped:.3f} Hz"),
        Row(f"largest error of Eq 14 for amplitudes above {LARGE:g} u_cr ({np.sum(large)} half cycles)", None,
            100 * np.max(error[large]), ".1f", "%", "“adequately describes … for large displacements”"),
        Row(f"largest error of Eq 14 from u_cr to {LARGE:g} u_cr ({np.sum(between)} half cycles)", None,
            100 * np.max(error[between]), ".0f", "%", "“less accurate for small displacements”"),
        Row("amplitude at which Eq 14 gives f_fc, over u_cr", None, crossing / EVISON.u_cr, ".2f", "",
            "below it Eq 14 grows beyond all bounds, the structure stays at f_fc"),
        Row("time from the release of section 3 to the first impact (Eq 14)", f"{of.estimated_time_to_impact:.4f}",
            of.time_to_impact, ".4f", "s", "formula; Eq 14 starts from θ alone, not from q_r = θ + (p_l²/g) u",
            is_printed=False),
    ]


def draw(of: Frequencies, path: Path) -> None:
    """Frequency over amplitude, in the layout of Fig 7."""
    figure, axis = figures.subplots(1, 1, 3.4)
    theta, frequency = of.curve
    beyond = np.abs(of.estimated / of.cycles.frequency - 1)[of.cycles.amplitude > EVISON.u_cr]
    axis.plot(1e3 * EVISON.H * theta, frequency, color=figures.SMOOTH, label="Eq 14")
    axis.axhline(EVISON.f_fc, color=figures.FIXED, linestyle="--", linewidth=0.9, label=r"$f_{fc}$")
    axis.plot(1e3 * of.cycles.amplitude, of.cycles.frequency, "o", color=figures.ROCKING, markersize=3,
              label="simulated half cycles")
    axis.axvline(1e3 * EVISON.u_cr, color=figures.QUIET, linestyle=":", linewidth=0.9)
    axis.text(1e3 * EVISON.u_cr, 0.33, r" $u_{cr}$", color=figures.QUIET)
    axis.set(xscale="log", yscale="log", xlim=(0.05, 400), ylim=(0.3, 30),
             xlabel=r"largest lateral displacement of the half cycle, max $\delta_t$ (mm)",
             ylabel=r"effective frequency $f_t$ (Hz)",
             title=f"Beyond $u_{{cr}}$ Eq 14 gives the frequency of each half cycle within {100 * np.max(beyond):.0f} %")
    axis.set_yticks([0.3, 1, 3, 10, 30], ["0.3", "1", "3", "10", "30"])
    axis.set_xticks([0.1, 1, 10, 100], ["0.1", "1", "10", "100"])
    axis.legend(loc="upper right")
    figures.save(figure, path)


def section(folder: Path) -> Section:
    """The section with its figure."""
    of = compute()
    draw(of, folder / "rocking_frequency.png")
    return Section(
        title="Effective rocking frequency against amplitude (Fig 7)",
        introduction=f"""We simulate one decay of Evison's specimen from θ = {AMPLITUDE:g} tan α_cg, near overturning,
to vibration in full contact. As in the paper, f_t is the inverse of twice the time between zero crossings of
δ_t, and the amplitude is the largest δ_t between them. We evaluate Eq 14 at θ = δ_t/H.""",
        rows=rows(of),
        figure="rocking_frequency.png",
        caption="Effective frequency of each half cycle over its largest displacement, with Eq 14 and f_fc (Fig 7).",
        findings=["""Eq 14 is better than the paper claims. From a few u_cr to near overturning it gives the frequency of the full
nonlinear model, because δ_t/H is the rotation of the rocking mode to within (1−χ) u/H. As the paper says, it
fails below u_cr, where the frequency is the frequency of full contact, f_fc."""],
    )
