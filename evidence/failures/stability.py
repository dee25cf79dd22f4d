"""Stability of fixed steps: limits of the textbook methods, and the trap of uplift."""

from pathlib import Path

import numpy as np
import pandas as pd

from .. import study
from ..figures import COLOURS, save, subplots
from ..page import table
from ..paper.specimens import EVISON, MCMANUS


def values(folder: Path) -> dict:
    """Largest stable steps, and what happens at uplift."""
    study.tables("stability", folder)
    trap = study.named(pd.read_csv(folder / "stability.csv", dtype=str))
    draw(folder / "stability-uplift.csv", trap["uplift"], folder / "stability-uplift.svg")
    limits = pd.read_csv(folder / "stability-limits.csv").pivot(index="method", columns="zeta_u", values="limit")
    shown = {0.0: "0", np.inf: "any"}
    methods = pd.read_csv(folder / "stability-limits.csv")["method"].unique()
    rows = [[method, *(shown.get(limit, f"{limit:.3f}") for limit in limits.loc[method])] for method in methods]
    return dict(trap=trap, evison=EVISON, mcmanus=MCMANUS, ratios=[of.f_u / of.f_fc for of in (EVISON, MCMANUS)],
                limits=table(["method", *(f"ζ_u = {zeta}" for zeta in limits.columns)], rows))


def draw(curves: Path, uplift: float, path: Path) -> None:
    figure, axis = subplots(1, 1, 4.4)
    study.curves(axis, curves, [study.WRONG, study.RIGHT, {"color": COLOURS[3], "linestyle": "--"}])
    axis.axvline(uplift, **study.GUIDE, label="first uplift")
    title = "Stable with the base down, unstable from uplift on"
    axis.set(title=title, xlabel="time, s", ylabel="u, mm", xlim=(0, 4.2), ylim=(-2, 2))
    figure.legend(loc="outside lower center", ncols=4)
    save(figure, path, title, "u over time with steps of 12 ms: the central difference diverges after the first uplift.")
