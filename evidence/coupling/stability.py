"""Stability limit of weak coupling of the bridge, and sweeps of the iterated master, over mass ratio and step.

Theory beside measurement: the masters themselves, run for one step on piers with linear equations from every unit
state, give the matrix that the errors are multiplied by.
"""

import contextlib
import functools
import itertools
import multiprocessing
import warnings
from pathlib import Path

import monolithic
import numpy as np
from fmpy.fmi1 import FMICallException
from matplotlib.colors import BoundaryNorm, LogNorm
from scipy.interpolate import PPoly
from scipy.linalg import expm

from ..figures import save, subplots
from ..page import spread
from ..scenes import pacoima_dam
from .bridge import Bridge, deck, pier
from .convergence import STRUCTURES, monolithic_bridge
from .masters import MASTERS, Diverged, extrapolate, gauss_seidel, hold, jacobi

FREQUENCY = 8.0  # Hz, of the deck on piers that do not move
SAMPLES = 1250  # of the record: all strong motion
RATIOS = np.geomspace(0.03, 30, 7)  # mass of the deck over the top masses of both piers
STEPS = np.geomspace(0.25e-3, 16e-3, 13)  # s
WEAK = {
    "Jacobi, held": (jacobi, hold),
    "Gauss-Seidel, held": (gauss_seidel, hold),
    "Jacobi, extrapolated": (jacobi, extrapolate),
    "Gauss-Seidel, extrapolated": (gauss_seidel, extrapolate),
}
ITERATED = {"fixed point": MASTERS["fixed-point"], "Anderson": MASTERS["anderson"], "IQN-ILS": MASTERS["iqn-ils"]}
BLOWN_UP = (Diverged, FMICallException, OverflowError)  # FMICallException: overturned, or an input out of range
GROWTH = 5.0  # 1/s; the fall of a rocking pier grows by p_l, up to 2.9/s


def mass(ratio: float) -> float:
    return ratio * sum(p.m for p in STRUCTURES)


@functools.cache
def propagator(p, rocking: bool, h: float) -> np.ndarray:
    """Matrices that give u, u_dot, theta, theta_dot at the end of a step from their start values, the force per top mass, and its slope.

    By Eq 1, or rocking by Eqs 7 and 8 without their constant load.
    """
    rates = np.zeros((6, 6))
    rates[0, 1] = rates[2, 3] = rates[4, 5] = 1.0
    if rocking:
        forces = [[-p.omega_fc**2, -p.c_u / p.m, p.g, 0, 1, 0], [p.g, 0, p.g * p.H, 0, p.H, 0]]
        rates[[1, 3]] = np.linalg.solve([[1, p.H], [p.H, p.J_P / p.m]], forces)
    else:
        rates[1] = [-p.omega_fc**2, -2 * p.zeta_fc * p.omega_fc, 0, 0, 1, 0]
    return expm(rates * h)[:4]


class LinearPier:
    """A pier that stays in its phase: base down, or rocking by small angles."""

    def __init__(self, p, rocking: bool):
        self.p, self.rocking, self.motion = p, rocking, np.zeros(4)

    def step(self, t, h, line):
        start, end = (F_t / self.p.m - a_g for a_g, F_t in line)
        self.motion = propagator(self.p, self.rocking, h) @ [*self.motion, start, (end - start) / h]
        u, u_dot, theta, theta_dot = self.motion
        return [u + self.p.H * theta, u_dot + self.p.H * theta_dot]


def linear_bridge(ratio: float, frequency: float, rocking: bool, moments: bool) -> Bridge:
    piers = [LinearPier(p, rocking) for p in STRUCTURES]
    return Bridge(piers, deck(mass(ratio), frequency), lambda t, h: np.zeros(2), moments)


def growth(master, guess, ratio: float, h: float, rocking: bool, frequency: float = FREQUENCY) -> float:
    """Rate (1/s) at which the fastest of the motions grows."""
    bridge = linear_bridge(ratio, frequency, rocking, moments=False)

    def state():
        motions = [pier.motion for pier in bridge.piers]
        return np.concatenate([*motions, [bridge.deck.x, bridge.deck.v], bridge.w.ravel(), bridge.y.ravel()])

    columns = []
    for unit in np.eye(len(state())):
        *motions, of_deck, w, y = np.split(unit, [4, 8, 10, 14])
        for linear, motion in zip(bridge.piers, motions):
            linear.motion = motion
        bridge.deck.x, bridge.deck.v = of_deck
        bridge.w, bridge.y = w.reshape(2, 2), y.reshape(2, 4)
        master(bridge, 0.0, h, guess)
        columns.append(state())
    return np.log(np.max(np.abs(np.linalg.eigvals(np.transpose(columns))))) / h


def contraction(ratio: float, h: float, rocking: bool, frequency: float = FREQUENCY) -> float:
    """Factor by which a sweep multiplies the error of its w."""
    columns = []
    for unit in np.eye(4):
        bridge = linear_bridge(ratio, frequency, rocking, moments=True)
        columns.append(bridge.second(0.0, h, bridge.first(0.0, h, unit.reshape(2, 2))).ravel())
    return np.max(np.abs(np.linalg.eigvals(np.transpose(columns))))


def first_unstable(unstable, steps=np.geomspace(0.05e-3, 64e-3, 100)) -> float:
    """The least of the steps that is `unstable`, nan if none is."""
    return next((h for h in steps if unstable(h)), np.nan)


def lines(time, a_g, h: float) -> np.ndarray:
    """The ground motion, linear between samples, as lines of the same moments over steps of h."""
    velocity = PPoly([np.diff(a_g) / np.diff(time), a_g[:-1]], time).antiderivative()
    displacement = velocity.antiderivative()
    ends = h * np.arange(int(time[-1] / h) + 1)
    v, d = velocity(ends), displacement(ends)
    mean, half = np.diff(v) / h, 6 * ((v[:-1] + v[1:]) / 2 - np.diff(d) / h) / h
    return np.transpose([mean - half, mean + half])


@functools.cache
def reference_deck(ratio: float) -> tuple[np.ndarray, np.ndarray]:
    """Time and the deck's displacement, integrated as one system."""
    time, a_g = (values[:SAMPLES] for values in pacoima_dam())
    response = monolithic.integrate(monolithic_bridge(deck(mass(ratio), FREQUENCY)), time, a_g, rtol=1e-9, atol=1e-12)
    return time, response.y[:, 0]


def measure(case) -> float:
    """The error of the deck's displacement over its peak (weak coupling), or the sweeps per step (iterated)."""
    fmus, name, ratio, h = case
    time, expected = reference_deck(ratio)
    motion = lines(*(values[:SAMPLES] for values in pacoima_dam()), h)
    of_deck = deck(mass(ratio), FREQUENCY)
    bridge = Bridge([pier(fmu) for fmu in fmus], of_deck, lambda t, h: motion[round(t / h)], moments=name in ITERATED)
    step, guess = WEAK.get(name) or (ITERATED[name](), extrapolate)
    peak, largest, steps = np.max(np.abs(expected)), 0.0, len(motion)
    with warnings.catch_warnings(action="ignore", category=RuntimeWarning), contextlib.redirect_stdout(None):
        for n in range(steps):
            try:
                step(bridge, n * h, h, guess)
            except BLOWN_UP:
                return np.inf
            largest = max(abs(of_deck.x - np.interp((n + 1) * h, time, expected)) / peak, largest)
            if not largest < 10:
                return np.inf
    return step.sweeps / steps if name in ITERATED else largest


def study(fmus, update=lambda: None) -> dict[str, np.ndarray]:
    """By master: what `measure` finds, ratios by steps."""
    cases = [(fmus, name, ratio, h) for name, ratio, h in itertools.product([*WEAK, *ITERATED], RATIOS, STEPS)]
    found = []
    with multiprocessing.get_context("spawn").Pool() as pool:
        for value in pool.imap(measure, cases, chunksize=len(STEPS)):
            found.append(value)
            update()
    names = [*WEAK, *ITERATED]
    return dict(zip(names, np.reshape(found, (len(names), len(RATIOS), len(STEPS)))))


def findings(found: dict[str, np.ndarray]) -> dict:
    """Numbers of the maps, by their names on the page."""
    told, at_half_limit = {}, []
    for name, short in (("Jacobi, extrapolated", "jacobi"), ("Gauss-Seidel, extrapolated", "gauss_seidel")):
        master, guess = WEAK[name]
        limits = np.array([first_unstable(lambda h: growth(master, guess, ratio, h, False) > 1e-6) for ratio in RATIOS])
        k = mass(RATIOS) * (2 * np.pi * FREQUENCY) ** 2 / len(STRUCTURES)
        told[f"{short}_limit"] = spread((limits * np.sqrt(k / min(p.m for p in STRUCTURES)))[RATIOS > 0.9], ".1f")
        halves = [np.flatnonzero(limit / 2 >= STEPS)[-1] for limit in limits]
        at_half_limit += [found[name][i, j] for i, j in enumerate(halves)]
    finite = np.isfinite(found["Anderson"])
    return told | dict(
        half_limit_least=np.min(at_half_limit), half_limit_most=np.max(at_half_limit),
        anderson=spread(found["Anderson"].ravel(), ".1f"), anderson_cells=f"{np.count_nonzero(finite)} of {finite.size} cells",
        iqn_ils=spread(found["IQN-ILS"].ravel(), ".1f"), iqn_ils_short=spread(found["IQN-ILS"][:, STEPS < 1e-3].ravel(), ".1f"))


def plot_weak(path: Path, found: dict[str, np.ndarray]) -> None:
    figure, axes = subplots(2, 2, 6.4, sharex=True, sharey=True)
    norm = BoundaryNorm([1e-4, 1e-3, 1e-2, 1e-1, 1, 10], 256)
    for axis, (name, (master, guess)) in zip(axes.flat, WEAK.items()):
        colors = mesh(axis, found[name], norm, "YlOrRd")
        for rocking, style in ((False, "-"), (True, "--")):
            threshold = GROWTH if rocking else 1e-6
            limits = [first_unstable(lambda h: growth(master, guess, ratio, h, rocking) > threshold) for ratio in RATIOS]
            axis.loglog(RATIOS, 1e3 * np.array(limits), style, color="black",
                        label="limit in theory, " + ("rocking" if rocking else "bases down"))
        axis.set_title(name)
    finish(axes, [0.03, 0.1, 0.3, 1, 3, 10, 30])
    figure.suptitle("Held values become unstable at shorter steps than extrapolated values")
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    bar = figure.colorbar(colors, ax=axes, extend="both", shrink=0.8)
    bar.set_label("largest error of the deck's displacement, over its peak; grey: blown up")
    bar.set_ticks([1e-4, 1e-3, 1e-2, 1e-1, 1, 10], labels=["0.01 %", "0.1 %", "1 %", "10 %", "100 %", ""])
    save(figure, path)


def plot_iterated(path: Path, found: dict[str, np.ndarray]) -> None:
    figure, axes = subplots(1, 3, 3.6, sharex=True, sharey=True)
    norm = LogNorm(2, 64)
    for axis, name in zip(axes.flat, ITERATED):
        colors = mesh(axis, found[name], norm, "viridis_r")
        for (i, ratio), (j, h) in itertools.product(enumerate(RATIOS), enumerate(STEPS)):
            if i % 2 == 1 and j % 3 == 0 and np.isfinite(found[name][i, j]):
                axis.text(ratio, 1e3 * h, f"{found[name][i, j]:.1f}", ha="center", va="center", fontsize=7.5,
                          color="white" if found[name][i, j] > 12 else "black")
        if name == "fixed point":
            limits = [first_unstable(lambda h: contraction(ratio, h, True) > 1) for ratio in RATIOS]
            axis.loglog(RATIOS, 1e3 * np.array(limits), "--", color="black", label="diverges beyond, in theory")
        axis.set_title(name)
    finish(axes.reshape(1, -1), [0.1, 1, 10])
    figure.suptitle("The fixed point diverges; IQN-ILS needs the fewest sweeps")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center")
    bar = figure.colorbar(colors, ax=axes, shrink=0.9)
    bar.set_label("sweeps per step; grey: diverged")
    bar.set_ticks([2, 4, 8, 16, 32, 64], labels=["2", "4", "8", "16", "32", "64"])
    bar.minorticks_off()
    save(figure, path)


def mesh(axis, values, norm, colors):
    """Values over ratios and steps, grey where they are infinite."""
    axis.set(xscale="log", yscale="log", facecolor="0.35")
    cells = np.ma.masked_invalid(values).T
    return axis.pcolormesh(edges(RATIOS), 1e3 * edges(STEPS), cells, norm=norm, cmap=colors)


def edges(values: np.ndarray) -> np.ndarray:
    """Of the cells around evenly spaced logarithms."""
    half = np.sqrt(values[1] / values[0])
    return np.append(values / half, values[-1] * half)


def finish(axes, ratios) -> None:
    for axis in axes.flat:
        axis.grid(False)
        axis.set(xlim=edges(RATIOS)[[0, -1]], ylim=1e3 * edges(STEPS)[[0, -1]])
        axis.set_yticks([0.25, 0.5, 1, 2, 4, 8, 16], ["0.25", "0.5", "1", "2", "4", "8", "16"])
        axis.set_xticks(ratios, map(str, ratios))
        axis.minorticks_off()
    for axis in axes[-1]:
        axis.set_xlabel("deck / top masses")
    for axis in axes[:, 0]:
        axis.set_ylabel("communication step (ms)")
