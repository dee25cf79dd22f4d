"""A picture for each failure of a method in the study, and the stable steps of textbook methods."""

from pathlib import Path

import numpy as np
import pandas as pd

from ..figures import COLOURS, save, subplots
from ..page import table
from ..paper.specimens import EVISON, MCMANUS
from ..study import GUIDE, RIGHT, WRONG, curves, named, scientific, tables

MARKS = [{"color": color, "linestyle": "", "marker": mark, "markersize": 5} for color, mark in zip((*COLOURS[:1], *COLOURS[2:4], COLOURS[5]), "os^D")]
CHECKED = {"color": COLOURS[4], "linestyle": "", "marker": "o"}
EXHIBITS = {  # title, description, axes, looks of the curves
    "fall": ("A return right after an impact is missed",
             "θ over time: the exact response lands, the response of the library continues below 0.",
             {"xlabel": "time from the impact, ms", "ylabel": "θ, mrad", "xlim": (-4, 8), "ylim": (-1.2, 0.4)}, [RIGHT, WRONG]),
    "double-crossing": ("A solver that checks θ only every 20 ms misses two crossings",
                        "θ over time: it dips below 0 and returns between two checks; the exact response has an impact instead.",
                        {"xlabel": "time, ms", "ylabel": "θ, mrad", "xlim": (0, 30), "ylim": (-2, 6)}, [CHECKED, RIGHT, WRONG]),
    "chatter": ("Uplift by |u| ≥ u_cr alone never ends",
                "Transitions so far over time: with both conditions the motion continues, with one condition they pile up at an instant.",
                {"xlabel": "time, s", "ylabel": "transitions so far", "xlim": (0, 15), "yscale": "log", "ylim": (1, 2000)}, [RIGHT, WRONG]),
    "zeno": ("A stiffer structure makes more impacts before it lands",
             "Time to the next impact over the number of impacts: it shrinks by r each time; flexible structures land.",
             {"xlabel": "impact", "ylabel": "time to the next impact, s", "yscale": "log", "ylim": (1e-12, 1), "xlim": (0, None)},
             [RIGHT, *MARKS]),
    "grazing": ("At a graze a change of 10⁻¹² in the initial state decides the result",
                "Change of the result against change of the initial state: constant, as the square root, and in proportion.",
                {"xlabel": "relative change of the initial state", "ylabel": "max|Δθ| / max|θ|", "xscale": "log", "yscale": "log",
                 "xlim": (1e-13, 0.1), "ylim": (1e-14, 1)},
                [{"color": color, "marker": mark, "markersize": 4} for color, mark in zip((COLOURS[4], COLOURS[3], COLOURS[2]), "os^")]),
    "near-overturning": ("Near balance a difference grows as e^(p t)",
                         "Difference of two releases over time: it grows by twelve decades in as many seconds.",
                         {"xlabel": "time, s", "ylabel": "|Δθ|, rad", "xlim": (0, 14), "yscale": "log", "ylim": (1e-13, 10)},
                         [{"color": COLOURS[3], "linestyle": "--"}, RIGHT]),
    "energy-gain": ("An impact with r = 0.5 adds {gain:.1f} J",
                    "Energy over time: it falls at the first impact, rises at the second, and falls at the third.",
                    {"xlabel": "time, s", "ylabel": "energy above the energy at rest, J", "xlim": (0, 0.5), "ylim": (0, None)}, [WRONG]),
}


def values(figures: Path) -> dict:
    folder = figures.parent
    tables("failures", folder)
    found = {name: named(rows) for name, rows in pd.read_csv(folder / "failures.csv", dtype=str).groupby("failure")}
    for key, (title, description, axes, looks) in EXHIBITS.items():
        of = found[key.replace("-", "_")]
        instant = {of["time"]: f"this impact: +{of['gain']:.2f} J"} if key == "energy-gain" else {}
        draw(folder / f"failure-{key}.csv", looks, title.format(**of), description, axes, instant)
    for name in ("touch", "clear"):
        found["grazing"][name] = scientific(found["grazing"][name])
    return found | stability(folder)


def draw(path: Path, looks: list[dict], title: str, description: str, axes: dict, instants: dict[float, str]) -> None:
    """The picture of a table of curves, with lines at instants that have names."""
    figure, axis = subplots(1, 1, 4.4)
    curves(axis, path, looks)
    if axes["ylabel"] == "θ, mrad":
        axis.axhline(0, **GUIDE)
    for instant, name in instants.items():
        axis.axvline(instant, **GUIDE, label=name)
    axis.set(title=title, **axes)
    figure.legend(loc="outside lower center", ncols=3)
    save(figure, path.with_suffix(".svg"), title, description)


def stability(folder: Path) -> dict:
    """Largest stable steps, and what happens at uplift."""
    tables("stability", folder)
    trap = named(pd.read_csv(folder / "stability.csv", dtype=str))
    draw(folder / "stability-uplift.csv", [WRONG, RIGHT, {"color": COLOURS[3], "linestyle": "--"}],
         "Stable with the base down, unstable from uplift on",
         "u over time with steps of 12 ms: the central difference diverges after the first uplift.",
         {"xlabel": "time, s", "ylabel": "u, mm", "xlim": (0, 4.2), "ylim": (-2, 2)}, {trap["uplift"]: "first uplift"})
    limits = pd.read_csv(folder / "stability-limits.csv").pivot(index="method", columns="zeta_u", values="limit")
    shown = {0.0: "0", np.inf: "any"}
    methods = pd.read_csv(folder / "stability-limits.csv")["method"].unique()
    rows = [[method, *(shown.get(limit, f"{limit:.3f}") for limit in limits.loc[method])] for method in methods]
    return dict(trap=trap, evison=EVISON, mcmanus=MCMANUS, ratios=[of.f_u / of.f_fc for of in (EVISON, MCMANUS)],
                limits=table(["method", *(f"ζ_u = {zeta}" for zeta in limits.columns)], rows))
