"""Speed against accuracy: error against cost of every method, from the runs that `make measure WHAT=precision` has measured."""

import shutil
from pathlib import Path

import numpy as np
import pandas as pd

from .. import ROOT
from ..figures import COLOURS, save, subplots
from ..page import table
from ..study import decade, scientific, significant, tables

SIX_DIGITS = 1e-6  # error in θ at which engine and peers are compared
PERTURBATION = 1e-12  # of the input, for the conditioning
MEANINGLESS, FAILED, TOP = 10.0, 20.0, 40.0  # errors beyond the first are drawn there; failed runs above, below the end of the axis
AUTO, HELD, LINEAR = (f"this project, {name}" for name in ("auto", "input held", "linear"))
AT_STEP_ENDS = ", transitions at step ends"
PANELS = {"textbook methods, transitions at step ends": "ends", "textbook methods, transitions located": "located",
          "solvers of other libraries": "library", "this engine's other levels, and its input held": "ours"}


def measured(folder: Path = ROOT / "docs/evidence") -> dict[str, pd.DataFrame]:
    """The runs of each scene, by its key; `is_peer` and `group` say whose a method is."""
    found = {}
    for path in sorted(folder.glob("accuracy-*.csv")):
        runs = found[path.stem.removeprefix("accuracy-")] = pd.read_csv(path)
        ends = runs["method"].str.endswith(AT_STEP_ENDS)
        textbook = runs["method"].isin(runs["method"][ends].str.removesuffix(AT_STEP_ENDS))
        runs["is_peer"] = ~runs["method"].str.startswith("this project")
        runs["group"] = np.select([ends, textbook, runs["is_peer"]], ["ends", "located", "library"], "ours")
    return found


def cheapest(runs: pd.DataFrame, error: float = SIX_DIGITS) -> pd.DataFrame:
    """Of each method the cheapest run with an error in θ of at most `error`."""
    good = runs[runs["error_theta"] <= error]
    return good.loc[good.groupby("method")["microseconds_per_sample"].idxmin()].set_index("method")


def nearest(runs: pd.DataFrame) -> tuple[str, float]:
    """The cheapest other method with six digits, and how many times as long as `auto` it takes."""
    cost = cheapest(runs)["microseconds_per_sample"]
    peers = cost[cost.index.isin(runs["method"][runs["is_peer"]])]
    return peers.idxmin(), peers.min() / cost[AUTO]


def undercut(runs: pd.DataFrame) -> float:
    """The smallest error below 1 at which another method is cheaper than `auto`; infinite if there is none."""
    auto, peers = runs[runs["method"] == AUTO], runs[runs["is_peer"] & (runs["error_theta"] < 1)]
    cost = [auto["microseconds_per_sample"][auto["error_theta"] <= error].min() for error in peers["error_theta"]]
    return peers["error_theta"][peers["microseconds_per_sample"] < cost].min()


def values(figures: Path) -> dict:
    """Pictures and tables of the runs that are in docs/; the scenes are computed."""
    folder = figures.parent
    if folder != ROOT / "docs/evidence":
        for path in (ROOT / "docs/evidence").glob("accuracy-*.csv"):
            shutil.copy(path, folder)
    tables("scenes", folder)
    scenes, runs = pd.read_csv(folder / "accuracy.csv"), measured(folder)
    for scene in scenes.itertuples():
        draw(runs[scene.key], scene, folder / f"accuracy-{scene.key}.svg")
    runs = {key: runs[key] for key in scenes["key"]}
    ratios = [nearest(of)[1] for of in runs.values()]
    times = [cheapest(of)["microseconds_per_sample"][AUTO] for of in runs.values()]
    first_held = [of[of["method"] == HELD].iloc[0]["error_theta"] for of in runs.values()]
    held = [error for error, least in zip(first_held, scenes["theta"]) if error > least]  # the ground moves
    error = min(map(undercut, runs.values()))
    return dict(
        times=f"{significant(min(times))} to {significant(max(times))}", ratios=f"{min(ratios):.1f} to {max(ratios):.1f}",
        perturbation=decade(PERTURBATION), held=f"{scientific(min(held))} to {scientific(max(held))}", costs=costs(scenes, runs),
        scenes="\n\n".join(section(scene, runs[scene.key]) for scene in scenes.itertuples()),
        undercut=f"""`auto` is not the cheapest at low accuracy. The smallest error in θ at which another method is cheaper is {scientific(error)}. Such a
large error needs only one or a few evaluations per sample.""" if np.isfinite(error)
        else "No other method on this page is cheaper than `auto` at any error below 1.")


def finding(scene, runs: pd.DataFrame) -> str:
    method, ratio = nearest(runs)
    return f"{scene.title}: the cheapest other method with six digits, {method}, takes {ratio:.1f} times as long"


def section(scene, runs: pd.DataFrame) -> str:
    theta, u, a_t = map(scientific, (scene.theta, scene.u, scene.a_t))
    return f"""## {scene.title}

![{finding(scene, runs)}](accuracy-{scene.key}.svg)

{scene.transitions:.0f} transitions, samples every {significant(1e3 * scene.dt)} ms. Conditioning: {theta} for θ, {u} for u,
{a_t} for a_t. [All numbers](accuracy-{scene.key}.csv), with evaluations, failures and the errors of u and a_t."""


def costs(scenes: pd.DataFrame, runs: dict[str, pd.DataFrame]) -> str:
    """The table of the cheapest runs with six digits."""
    def cell(best: pd.DataFrame, method: str) -> str:
        if method not in best.index:
            return "–"
        of = best.loc[method]
        setting = decade(of["value"]) if of["setting"] == "tolerance" else f"{significant(1e3 * of['value'])} ms"
        return f"{significant(of['microseconds_per_sample'])} ({setting})"

    best, first = [cheapest(of) for of in runs.values()], next(iter(runs.values()))
    methods = [method for method in first["method"].unique() if method != HELD and any(method in of.index for of in best)]
    rows = [[f"**{method}**" if method == AUTO else method, *(cell(of, method) for of in best)] for method in methods]
    any_error = [cheapest(of, np.inf)["microseconds_per_sample"].get(LINEAR) for of in runs.values()]
    rows.append([f"{LINEAR}, any error", *("overturns" if cost is None else significant(cost) for cost in any_error)])
    return table(["method", *scenes["title"]], rows)


def draw(runs: pd.DataFrame, scene, path: Path) -> None:
    """Error of θ over time per sample: four groups of methods, each beside this engine."""
    figure, axes = subplots(4, 1, 10.5, sharex=True)
    errors, cost = runs["error_theta"], runs["microseconds_per_sample"]
    bottom = 10 ** np.floor(np.log10(max(min(scene.theta, errors[errors > 0].min()), scene.theta / 100)))
    across = 10 ** np.floor(np.log10(cost.min())), 10 ** (np.floor(np.log10(cost.max())) + 1)
    for axis, (title, group) in zip(axes, PANELS.items()):
        axis.axhspan(bottom, scene.theta, color="0.9", linewidth=0)
        axis.axhspan(MEANINGLESS, TOP, color="0.9", linewidth=0)
        methods = [method for method in runs["method"][runs["group"] == group].unique() if method != AUTO]
        looks = zip(COLOURS * 2, "os^Dos^Dos^D")
        for method, (color, marker) in zip(methods, looks):
            of = runs[runs["method"] == method]
            name = method.removeprefix("this project, ").removesuffix(AT_STEP_ENDS)
            good = of[of["error_theta"].notna()]
            axis.plot(good["microseconds_per_sample"], good["error_theta"].clip(bottom, MEANINGLESS), color=color, marker=marker, markersize=4,
                      fillstyle="full" if marker == "o" else "none", label=name.replace(", ", ",\n"))
            failed = of["microseconds_per_sample"][of["error_theta"].isna()]
            axis.plot(failed, np.full(len(failed), FAILED), "x", color=color, markersize=5)
        x, y = cost[runs["method"] == AUTO], errors[runs["method"] == AUTO].clip(bottom)
        axis.plot(x, y, "*", color="black", markersize=13, zorder=1.9, clip_on=False)
        axis.annotate("this engine", (x.max(), y.min()), (7, 3), textcoords="offset points", weight="bold")
        axis.plot([], [], "x", color="black", label="fails")
        axis.set(title=title, xscale="log", yscale="log", xlim=across, ylim=(bottom, TOP), ylabel="largest error of θ\nover its peak")
        axis.legend(loc="center left", bbox_to_anchor=(1, 0.5))
    axes[-1].set_xlabel("computing time per sample of the record, µs")
    figure.suptitle(finding(scene, runs).replace(": ", ":\n"), fontsize=9)
    save(figure, path, finding(scene, runs), "Error of θ against computing time per sample, one curve a method, one mark a run.")
