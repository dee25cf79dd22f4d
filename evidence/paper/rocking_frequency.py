"""Section 5: effective rocking frequency against amplitude, Fig 7."""

from pathlib import Path

import numpy as np

from .. import figures
from .free_vibration import TANGENT, release
from .rows import Row
from .specimens import EVISON, HalfCycles, free_vibration, half_cycles

AMPLITUDE = 0.9  # of tan alpha_cg, to start from
DURATION, INTERVAL = 20.0, 2e-4  # s
LARGE = 5.0  # amplitudes over u_cr from here on count as large


def eq_14(amplitudes: np.ndarray) -> np.ndarray:
    """Frequency (Hz) at the rotations `amplitudes` (rad)."""
    return np.array([EVISON.effective_frequency(theta) for theta in amplitudes])


def decay() -> tuple[HalfCycles, np.ndarray]:
    """The half cycles of one decay from near overturning to full contact; Eq 14 at theta = delta_t/H of each."""
    response = free_vibration(EVISON, DURATION, INTERVAL, theta_0=AMPLITUDE * TANGENT, u_0=EVISON.u_cr)
    cycles = half_cycles(response["time"], response["delta_t"])
    return cycles, eq_14(cycles.amplitude / EVISON.H)


def rows(cycles: HalfCycles, estimated: np.ndarray) -> list[Row]:
    """Eq 14 and the limit of small amplitudes against the simulated half cycles."""
    error = 100 * np.abs(estimated / cycles.frequency - 1)
    large = cycles.amplitude > LARGE * EVISON.u_cr
    between = (cycles.amplitude > EVISON.u_cr) & ~large
    thetas = np.geomspace(1e-4, 0.95, 200) * TANGENT
    crossing = np.interp(-EVISON.f_fc, -eq_14(thetas), thetas) * EVISON.H
    of = release().response
    turned = np.argmax(of["theta"] < 0)
    time_to_impact = of["time"][turned] - of["theta"][turned] / of["theta_dot"][turned]
    return [
        Row("frequency of the smallest half cycles (full contact)", f"{EVISON.f_fc:.0f}",
            np.mean(cycles.frequency[cycles.amplitude < 0.5 * EVISON.u_cr]), ".3f", "Hz",
            f"the paper's limit; with its damping {EVISON.f_fc * np.sqrt(1 - EVISON.zeta_fc**2):.3f} Hz"),
        Row(f"largest error of Eq 14 for amplitudes above {LARGE:g} u_cr ({np.sum(large)} half cycles)", None,
            np.max(error[large]), ".1f", "%", "“adequately describes … for large displacements”"),
        Row(f"largest error of Eq 14 from u_cr to {LARGE:g} u_cr ({np.sum(between)} half cycles)", None,
            np.max(error[between]), ".0f", "%", "“less accurate for small displacements”"),
        Row("amplitude at which Eq 14 gives f_fc, over u_cr", None, crossing / EVISON.u_cr, ".2f", "",
            "below it Eq 14 grows beyond all bounds, the structure stays at f_fc"),
        Row("time from the release of section 3 to the first impact (Eq 14)",
            f"{1 / (4 * EVISON.effective_frequency(of['theta'][0])):.4f}", time_to_impact, ".4f", "s",
            "formula; Eq 14 starts from θ alone, not from q_r = θ + (p_l²/g) u", is_printed=False),
    ]


def draw(cycles: HalfCycles, estimated: np.ndarray, path: Path) -> None:
    """Frequency over amplitude, in the layout of Fig 7."""
    figure, axis = figures.subplots(1, 1, 3.4)
    theta = np.geomspace(1e-4, 0.95, 200) * TANGENT
    beyond = np.abs(estimated / cycles.frequency - 1)[cycles.amplitude > EVISON.u_cr]
    axis.plot(1e3 * EVISON.H * theta, eq_14(theta), color=figures.SMOOTH, label="Eq 14")
    axis.axhline(EVISON.f_fc, color=figures.FIXED, linestyle="--", linewidth=0.9, label=r"$f_{fc}$")
    axis.plot(1e3 * cycles.amplitude, cycles.frequency, "o", color=figures.ROCKING, markersize=3, label="simulated half cycles")
    axis.axvline(1e3 * EVISON.u_cr, color=figures.QUIET, linestyle=":", linewidth=0.9, label=r"$u_{cr}$")
    axis.set(xscale="log", yscale="log", xlim=(0.05, 400), ylim=(0.3, 30),
             xlabel=r"largest lateral displacement of the half cycle, max $\delta_t$ (mm)",
             ylabel=r"effective frequency $f_t$ (Hz)",
             title=f"Beyond $u_{{cr}}$ Eq 14 gives the frequency of each half cycle within {100 * np.max(beyond):.0f} %")
    axis.set_yticks([0.3, 1, 3, 10, 30], ["0.3", "1", "3", "10", "30"])
    axis.set_xticks([0.1, 1, 10, 100], ["0.1", "1", "10", "100"])
    axis.legend(loc="upper right")
    figures.save(figure, path)


def section(folder: Path) -> tuple[list[Row], dict]:
    of = decay()
    draw(*of, folder / "rocking_frequency.png")
    return rows(*of), {"amplitude": AMPLITUDE}
