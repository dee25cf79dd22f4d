"""Section 4: the modal components of Fig 6."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from first_run import G
from PyEMD import EMD

from . import figures
from .free_vibration import STEP, Release, release
from .report import Row, Section
from .specimens import EVISON

SAMPLING = 20  # of the release's instants, one goes to the decomposition: 1 kHz
SPECTRUM_LENGTH = 2**20  # the half cycle, padded with zeros


@dataclass(frozen=True)
class Components:
    """The half cycle after the first impact, split into its two modes."""

    time: np.ndarray  # s
    uplift: np.ndarray  # m
    rocking_uplift: np.ndarray  # of the model's rocking mode, m
    vibration_uplift: np.ndarray  # of the model's vibration mode, m
    emd_time: np.ndarray  # s
    emd_smooth: np.ndarray  # m
    emd_oscillation: np.ndarray  # m
    a_t: np.ndarray  # m/s2
    a_r: np.ndarray  # m/s2
    a_u: np.ndarray  # m/s2


def compute() -> Components:
    """Splits the half cycle between the first and the second impact of the release."""
    of = release()
    turned = np.flatnonzero(np.diff(np.sign(of.response["theta"])))
    half_cycle = {name: column[turned[0] + 1:turned[1] + 1] for name, column in of.response.items()}
    modes = EVISON.modes(half_cycle)
    side = np.sign(half_cycle["theta"])
    sampled, uplift = half_cycle["time"][::SAMPLING], half_cycle["uplift"][::SAMPLING]
    smooth, oscillation = decompose(sampled, uplift)
    return Components(
        half_cycle["time"], half_cycle["uplift"], 2 * EVISON.B * np.sin(side * modes["q_r"]),
        2 * EVISON.B * np.sin(side * modes["q_u"]), sampled, smooth, oscillation, half_cycle["a_t"], modes["a_r"],
        modes["a_u"])


def decompose(time: np.ndarray, signal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The smooth and the oscillatory part of a signal by empirical mode decomposition."""
    decomposition = EMD()
    decomposition.emd(signal, time)
    oscillations, smooth = decomposition.get_imfs_and_residue()
    return smooth, np.sum(oscillations, axis=0)


def dominant_frequency(time: np.ndarray, signal: np.ndarray) -> float:
    """Frequency of the largest spectral value of a signal, Hz."""
    tapered = (signal - np.mean(signal)) * np.hanning(len(signal))
    spectrum = np.abs(np.fft.rfft(tapered, SPECTRUM_LENGTH))
    return np.fft.rfftfreq(SPECTRUM_LENGTH, time[1] - time[0])[np.argmax(spectrum)]


def rows(of: Release, c: Components) -> list[Row]:
    """Statements of the text about Fig 6."""
    second_cycle = of.peak("a_t", 0) / G
    return [
        Row("step of the rocking mode, χ tan α_cg (Eq 13)", "0.34", STEP, ".4f", "g",
            "0.337 with the printed χ = 0.92 (section 2)"),
        Row("mean of the rocking mode's a_r over the half cycle (Eq 12)", None, np.mean(np.abs(c.a_r)) / G, ".3f", "g",
            f"from {np.min(np.abs(c.a_r)) / G:.3f} to {np.max(np.abs(c.a_r)) / G:.3f} g: “near-constant”"),
        Row("vibration frequency while rocking, f_fc/√(1−χ) (Eq 18)", "39", EVISON.f_u, ".2f", "Hz",
            "38.9 with the printed χ = 0.92; measured 35"),
        Row("frequency in the spectrum of a_t", "35", dominant_frequency(c.time, c.a_t), ".1f", "Hz",
            "measured; a half cycle of 0.32 s resolves 3 Hz"),
        Row("frequency of the uplift's oscillation, by empirical mode decomposition", "35",
            dominant_frequency(c.emd_time, c.emd_oscillation), ".1f", "Hz", "measured; the same"),
        Row("peak acceleration of the vibration after the first impact, a_t less the step", "0.48",
            second_cycle - STEP, ".3f", "g", "measured; the transition takes time in the test, none in the model"),
        Row("C from the first vibration cycle after the impact, a_t/(χ tan α_cg) − 1", "1.4",
            second_cycle / STEP - 1, ".2f", "",
            "measured; half a vibration cycle at ζ_u = 5 % leaves 2 exp(−π ζ_u) = 1.71 of 2"),
        Row("C at the instant of the impact, a_u/(χ tan α_cg)", "2", abs(c.a_u[0]) / G / STEP, ".2f", "",
            "an instant transition (Eq 21)"),
    ]


def draw(of: Release, c: Components, path: Path) -> None:
    """Uplift and acceleration with their components, in the layout of Fig 6."""
    figure, axes = figures.subplots(2, 2, 4.6, sharex="col", height_ratios=[1.5, 1])
    (uplift, acceleration), (oscillation, vibration) = axes
    uplift.plot(c.time, 1e3 * c.uplift, color=figures.ROCKING, label="uplift")
    uplift.plot(c.time, 1e3 * c.rocking_uplift, color=figures.SMOOTH, label="rocking mode")
    uplift.plot(c.emd_time, 1e3 * c.emd_smooth, color=figures.FIXED, linestyle="--", label="smooth part, EMD")
    uplift.set(ylabel=r"uplift $\delta_u$ (mm)", title="half cycle after the first impact")
    uplift.legend(loc="lower center")
    oscillation.plot(c.time, 1e3 * (c.vibration_uplift - np.mean(c.vibration_uplift)), color=figures.SMOOTH,
                     label="vibration mode less its mean")
    oscillation.plot(c.emd_time, 1e3 * c.emd_oscillation, color=figures.FIXED, linestyle="--", label="EMD")
    oscillation.set(ylabel=r"oscillatory part (mm)", xlabel="time (s)", ylim=(-0.8, 1.2))
    oscillation.legend(loc="upper center", ncols=2)

    shown = of.response["time"] <= c.time[-1]
    time = of.response["time"][shown]
    acceleration.plot(time, of.response["a_t"][shown] / G, color=figures.ROCKING, label=r"$a_t$")
    step = np.where(of.response["theta"][shown] > 0, -STEP, STEP)
    acceleration.plot(time, step, color=figures.SMOOTH, label=r"rocking mode, $\chi\,\tan\alpha_{cg}$")
    acceleration.set(ylabel=r"acceleration (g)", title="release to second impact")
    acceleration.legend(loc="lower right")
    vibration.plot(c.time, c.a_u / G, color=figures.SMOOTH, label=r"vibration mode, $a_u$")
    vibration.set(ylabel="acceleration (g)", xlabel="time (s)")
    vibration.legend(loc="upper right")
    figure.suptitle("Between impacts a rocking mode and a vibration mode are the whole motion")
    figures.save(figure, path)


def section(folder: Path) -> Section:
    """The section with its figure."""
    of, c = release(), compute()
    draw(of, c, folder / "modal_components.png")
    model = c.vibration_uplift[::SAMPLING]
    inside = slice(len(model) // 4, 3 * len(model) // 4)
    decrement = np.log(2 / 1.4)
    zeta_for_1_4 = decrement / np.hypot(np.pi, decrement)
    likeness = np.corrcoef(model[inside], c.emd_oscillation[inside])[0, 1]
    return Section(
        title="Modal components (Fig 6)",
        introduction="""We split the half cycle between the first and the second impact in two ways. The first way uses the model's own
modes, θ = q_r + q_u and q_u = −(p_l²/g) u (Eq 16; accelerations by Eqs 12 and 19). The second way is the paper's: empirical mode
decomposition of the uplift, without the model.""",
        rows=rows(of, c),
        figure="modal_components.png",
        caption="""Left: uplift and its smooth and oscillatory parts. Right: acceleration from the release to the
second impact with the rocking mode's step, and the vibration mode's part after the first impact. Layout of Fig 6.""",
        findings=[f"""The decomposition of the signal finds the model's two modes, one smooth part and one oscillation. The correlation of
the oscillation with the model's vibration mode is {likeness:.3f} over the middle half of the half cycle. At the ends the
decomposition is less exact, because it has no neighbouring cycles. Both oscillate at f_u,
{EVISON.f_u:.1f} Hz, not at the 11 Hz of full contact. The measured 35 Hz is nearer to the model's frequency than to the printed
39 Hz, which follows from the printed χ = 0.92.""",
                  f"""Model and test differ in C. In the model the weight changes sides without delay, C = 2, and damping reduces C to 1.7 at
the first peak. The test had 1.4. The paper concludes that the transition in the test was
gradual. In the model the same peak would need ζ_u = {100 * zeta_for_1_4:.0f} % instead of {100 * EVISON.zeta_u:.0f} %.
For McManus's tests the paper suspects that its damping while rocking is too high."""],
    )
