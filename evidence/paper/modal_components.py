"""Section 4: the modal components of Fig 6."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
from PyEMD import EMD

from .. import figures
from ..scenes import G
from .free_vibration import STEP, Release, release
from .rows import Row
from .specimens import EVISON

SAMPLING = 20  # of the release's instants, one goes to the decomposition: 1 kHz
SPECTRUM_LENGTH = 2**20  # the half cycle, padded with zeros


def components(of: Release) -> SimpleNamespace:
    """The half cycle between the first and the second impact (SI), split by the model's modes and by the decomposition."""
    turned = np.flatnonzero(np.diff(np.sign(of.response["theta"])))
    half_cycle = {name: column[turned[0] + 1:turned[1] + 1] for name, column in of.response.items()}
    modes = EVISON.modes(half_cycle)
    side = np.sign(half_cycle["theta"])
    sampled, uplift = half_cycle["time"][::SAMPLING], half_cycle["uplift"][::SAMPLING]
    smooth, oscillation = decompose(sampled, uplift)
    rocking, vibration = (2 * EVISON.B * np.sin(side * modes[name]) for name in ("q_r", "q_u"))
    return SimpleNamespace(
        time=half_cycle["time"], uplift=half_cycle["uplift"], rocking_uplift=rocking, vibration_uplift=vibration, emd_time=sampled,
        emd_smooth=smooth, emd_oscillation=oscillation, a_t=half_cycle["a_t"], a_r=modes["a_r"], a_u=modes["a_u"])


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


def rows(of: Release, c: SimpleNamespace) -> list[Row]:
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


def draw(of: Release, c: SimpleNamespace, path: Path) -> None:
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


def section(folder: Path) -> tuple[list[Row], dict]:
    """The rows, and how alike the two ways are."""
    of = release()
    c = components(of)
    draw(of, c, folder / "modal_components.png")
    model = c.vibration_uplift[::SAMPLING]
    inside = slice(len(model) // 4, 3 * len(model) // 4)
    decrement = np.log(2 / 1.4)
    return rows(of, c), dict(likeness=np.corrcoef(model[inside], c.emd_oscillation[inside])[0, 1],
                             zeta_for_1_4=100 * decrement / np.hypot(np.pi, decrement), zeta_u=100 * EVISON.zeta_u)
