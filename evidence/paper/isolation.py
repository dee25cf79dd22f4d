"""Section 6: McManus's shake table tests of Fig 9 and the isolation they show."""

from pathlib import Path
from typing import NamedTuple

import flexible_rocking as fr
import numpy as np
from scipy.optimize import brentq

from .. import figures
from ..scenes import G, pacoima_dam
from .free_vibration import STEP, release
from .rows import Row
from .specimens import MCMANUS, TOLERANCE

DRAWN = 32001  # instants
FREE = 3.0  # s of free vibration after the pulse
FIRST_TERM_BUCHAREST = 0.02  # g
FIXED_BASE_BUCHAREST = 1.1  # g


class Test(NamedTuple):
    """One ground motion with the runs under it, and the estimates without a history."""

    ground: fr.Record
    rocking: fr.Run
    fixed: fr.Run
    estimate: fr.Estimate


def single_pulse(T_p: float, peak: float) -> fr.Record:
    """A Mavroeidis-Papageorgiou velocity pulse of one cycle (gamma = 1, nu = 0) with the peak acceleration `peak` (m/s2)."""
    pulse = fr.pulse("mavroeidis_papageorgiou", amplitude=1, frequency=1 / T_p, cycles=1 + 1e-9)  # the library's gamma exceeds 1
    return pulse.scaled(peak / pulse.pga)


def stand_in() -> tuple[fr.Record, float]:
    """A pulse with the peak and the fixed-base response that the text gives for Bucharest, and its period (s)."""
    peak = FIRST_TERM_BUCHAREST / (1 - MCMANUS.chi) * G

    def excess(T_p: float) -> float:
        return fr.estimate(MCMANUS, single_pulse(T_p, peak))["S_a(T_fc, zeta_fc)"] - FIXED_BASE_BUCHAREST * G

    T_p = brentq(excess, 0.40, 0.50, xtol=1e-5)
    return single_pulse(T_p, peak), T_p


def _test(ground: fr.Record, free: float = 0.0) -> Test:
    """With so many seconds of free vibration after it."""
    rocking, fixed = (fr.simulate(MCMANUS, ground, duration=ground.duration + free, detail=detail, tolerance=TOLERANCE)
                      for detail in ("auto", "fixed_base"))
    return Test(ground, rocking, fixed, fr.estimate(MCMANUS, ground))


def rows(dam: Test, pulse: Test) -> list[Row]:
    """Statements of the text about both tests; for Bucharest only those that do not define the stand-in."""
    e, p = dam.estimate, pulse.estimate
    chi_of_ground = e["(1-chi) S_a"] / e["S_a(T_u, zeta_u)"]
    second = (e["chi g tan"] + e["C chi g tan"]) / G
    return [
        Row("Pacoima Dam: peak a_t on a fixed base", "2.1", dam.fixed.peaks["a_t"] / G, ".3f", "g", "Eq 1"),
        Row("Pacoima Dam: peak a_t, rocking", "0.5", dam.rocking.peaks["a_t"] / G, ".3f", "g", "“limited to 0.5 g”"),
        Row("Pacoima Dam: peak a_t, rocking, measured", "0.55", dam.rocking.peaks["a_t"] / G, ".3f", "g", "“around 0.55 g”"),
        Row("Pacoima Dam: peak uplift", None, 1e3 * dam.rocking.peaks["uplift"], ".2f", "mm"),
        Row("Pacoima Dam: Eq 22, first term (1−χ) S_a(T_u, ζ_u)", "0.10", e["(1-chi) S_a"] / G, ".3f", "g",
            f"the printed value is (1−χ) PGA; S_a(T_u, ζ_u) is {e['S_a(T_u, zeta_u)'] / G:.2f} g"),
        Row("Pacoima Dam: (1−χ) PGA", "0.10", chi_of_ground * dam.ground.pga / G, ".3f", "g", "what the printed value is"),
        Row("Eq 22, second term, C = 2", "0.66", second, ".4f", "g"),
        Row("Pacoima Dam: Eq 22, C = 2", "0.76", e["a_t"] / G, ".3f", "g",
            f"{chi_of_ground * dam.ground.pga / G + second:.2f} g with the printed first term"),
        Row("Bucharest stand-in: peak a_t, rocking", "0.5", pulse.rocking.peaks["a_t"] / G, ".3f", "g", "stand-in",
            is_printed=False),
        Row("Bucharest stand-in: peak a_t, rocking, measured", "0.55", pulse.rocking.peaks["a_t"] / G, ".3f", "g", "stand-in",
            is_printed=False),
        Row("Bucharest stand-in: Eq 22, first term (1−χ) S_a(T_u, ζ_u)", "0.02", p["(1-chi) S_a"] / G, ".3f", "g",
            "stand-in; (1−χ) PGA is 0.02 g by its definition", is_printed=False),
        Row("Bucharest stand-in: Eq 22, C = 2", "0.68", p["a_t"] / G, ".3f", "g", "stand-in", is_printed=False),
    ]


def draw(dam: Test, pulse: Test, path: Path) -> None:
    """Ground motion, uplift, acceleration rocking and on a fixed base (Fig 9)."""
    figure, axes = figures.subplots(4, 2, 7.0, sharex="col", sharey="row")
    titles = ["stand-in for Bucharest (pulse)", "Pacoima Dam 1971, 164"]
    for column, (test, title) in enumerate(zip((pulse, dam), titles)):
        ground, uplift, rocking, fixed = axes[:, column]
        time = np.linspace(0, test.rocking.end, DRAWN)
        response = test.rocking.at(time)
        ground.plot(time, response["a_g"] / G, color=figures.QUIET)
        uplift.plot(time, 1e3 * response["uplift"], color=figures.ROCKING)
        rocking.plot(time, response["a_t"] / G, color=figures.ROCKING, linewidth=0.8)
        fixed.plot(time, test.fixed.at(time)["a_t"] / G, color=figures.FIXED, linewidth=0.8)
        demand = test.estimate["a_t"] / G
        for level in (demand, -demand):
            rocking.axhline(level, color=figures.SMOOTH, linestyle="--", linewidth=0.9)
        rocking.text(time[-1], demand, f"Eq 22: {demand:.2f} g", color=figures.SMOOTH, ha="right", va="bottom",
                     fontsize=8)
        for axis, peak in ((ground, test.ground.pga), (rocking, test.rocking.peaks["a_t"]), (fixed, test.fixed.peaks["a_t"])):
            axis.text(0.98, 0.05, f"peak {peak / G:.2f} g", transform=axis.transAxes, ha="right", fontsize=8)
        ground.set(title=title)
        fixed.set(xlabel="time (s)", xlim=(0, time[-1]))
    axes[0, 0].set_ylabel("ground\nacceleration (g)")
    axes[1, 0].set_ylabel("uplift (mm)")
    axes[1, 0].set_ylim(0, None)
    axes[2, 0].set_ylabel("acceleration,\nrocking (g)")
    axes[3, 0].set_ylabel("acceleration,\nfixed base (g)")
    axes[2, 0].set_ylim(-1.2, 1.2)
    figure.suptitle("Rocking caps the acceleration that a fixed base amplifies")
    figure.align_ylabels()
    figures.save(figure, path)


def section(folder: Path) -> tuple[list[Row], dict]:
    """The rows, and the numbers of both tests."""
    dam = _test(fr.Record(*pacoima_dam()))
    bucharest, T_p = stand_in()
    pulse = _test(bucharest, FREE)
    draw(dam, pulse, folder / "isolation.png")
    of, a_t = dam.estimate, dam.rocking.peaks["a_t"] / G
    return rows(dam, pulse), dict(
        first_term=FIRST_TERM_BUCHAREST, fixed_base=FIXED_BASE_BUCHAREST, pulse_pga=bucharest.pga / G, T_p=T_p, a_t=a_t,
        dam_pga=dam.ground.pga / G, dam_fixed=dam.fixed.peaks["a_t"] / G,
        second_terms=STEP / (of["chi g tan"] / G), peaks=release().first_peak / a_t, T_u=of["T_u"], dam_zeta_u=100 * of["zeta_u"],
        S_a=of["S_a(T_u, zeta_u)"] / G, dam_first_term=of["(1-chi) S_a"] / G)
