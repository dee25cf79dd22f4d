"""Section 4: eight records, scaled in time and amplitude, on four structures at every level of detail, by `sweep`."""

import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

import numpy as np
import pandas as pd
from first_run import G
from scipy.stats import ks_2samp
from validation import figures
from validation.project import Project
from validation.records import horizontal_records
from validation.report import table

STRUCTURES = {
    "McManus": 'preset = "mcmanus"',
    "Evison": 'preset = "evison"',
    "stiff": "parameters = { m = 130.1, m0 = 65.4, H = 1.84, B = 0.285, J0 = 10.7, f_fc = 30, zeta_fc = 0.02, r = 0.99 }",
    "soft": "parameters = { m = 130.1, m0 = 65.4, H = 1.84, B = 0.285, J0 = 10.7, f_fc = 1.5, zeta_fc = 0.02, r = 0.99 }",
}
TIME_SCALES = [0.2, 0.28, 0.4, 0.55, 0.75, 1.0]
PGAS = np.round(np.geomspace(0.3, 2.5, 12), 4)  # g
STRONGER = 1.001  # factor on the records of the variant that tells what can be known at all
VARIANTS = {"rigid": ("rigid", 1.0), "modal": ("modal", 1.0), "linear": ("linear", 1.0),
            f"auto, records {100 * (STRONGER - 1):.1g} % stronger": ("auto", STRONGER), "auto": ("auto", 1.0)}
PARTED = 0.1  # relative difference of theta_max from which two runs have parted
DRAWS = 400  # of the bootstrap
SEED = 1963


def sweep(project: Project, detail: str, time_scale: float, factor: float) -> pd.DataFrame:
    """Every record at every peak ground acceleration on every structure."""
    records = ", ".join(f'{{ file = "{record.path}", scale = {float(G / np.max(np.abs(record.a_g)))!r} }}'
                        for record in horizontal_records())
    structures = "".join(f'[[structures]]\nname = "{name}"\n{which}\n' for name, which in STRUCTURES.items())
    file, rows = project.folder / "ensemble.toml", project.folder / "ensemble.csv"
    file.write_text(f'records = [{records}]\ntime_scale = {time_scale}\nscale = {[float(factor * a) for a in PGAS]}\n'
                    f'detail = "{detail}"\n{structures}')
    rows.unlink(missing_ok=True)
    subprocess.run([project.exporter, "sweep", file, "--output", rows, "--quiet"], check=True, capture_output=True)
    found = pd.read_csv(rows)
    return pd.DataFrame({
        "structure": found["structures"], "record": found["record"], "time_scale": time_scale,
        "pga": (found["scale"] / factor).round(4),
        # an overturned structure has exceeded every rotation
        "theta": found["peak_theta/alpha_cg"].where(found["ending"] != "overturned", np.inf),
    })


def compute(project: Project, advance: Callable[[], None]) -> pd.DataFrame:
    """theta_max/alpha_cg of every run, a column for each variant."""
    keys, columns = ["structure", "record", "time_scale", "pga"], []
    for name, (detail, factor) in VARIANTS.items():
        parts = []
        for time_scale in TIME_SCALES:
            parts.append(sweep(project, detail, time_scale, factor))
            advance()
        columns.append(pd.concat(parts).set_index(keys)["theta"].rename(name))
    return pd.concat(columns, axis=1, join="inner").reset_index()


def distance(first, second) -> float:
    """Kolmogorov-Smirnov: the largest difference of two distributions."""
    return ks_2samp(first, second, method="asymp").statistic


@dataclass(frozen=True)
class Comparison:
    """One variant beside auto on one structure; a range holds 95 % of what other draws of the records give."""

    structure: str
    variant: str
    fates: float  # part of the runs in which one overturns and the other does not
    parted: float  # part of those in which both rock and stand and theta_max parts
    overturned: tuple[float, float]  # by the variant, by auto
    difference: np.ndarray  # of the overturned, range
    median: float  # of theta_max of the runs that rock and stand, over auto's
    median_range: np.ndarray
    distance: float
    distance_most: float  # 95 % of what other draws give is below


def _overturned(theta) -> float:
    return np.mean(np.isinf(theta))


def _median(theta) -> float:
    return np.median(theta[np.isfinite(theta) & (theta > 0)])


def compare(runs: pd.DataFrame, structure: str, variant: str) -> Comparison:
    """The variant against auto; the bootstrap draws records, whose scaled versions are no independent motions."""
    own = runs[runs["structure"] == structure]
    theta, auto = own[variant].to_numpy(), own["auto"].to_numpy()
    both = np.isfinite(theta) & np.isfinite(auto) & (theta > 0) & (auto > 0)
    of_record = [np.flatnonzero(own["record"] == record) for record in sorted(set(own["record"]))]
    draws = np.random.default_rng(SEED).integers(len(of_record), size=(DRAWS, len(of_record)))
    found = []
    for draw in draws:
        rows = np.concatenate([of_record[i] for i in draw])
        a, b = theta[rows], auto[rows]
        found.append((_overturned(a) - _overturned(b), _median(a) / _median(b), distance(a, b)))
    ranges = np.quantile(found, [0.025, 0.975], axis=0).T
    return Comparison(structure, variant, np.mean(np.isinf(theta) != np.isinf(auto)),
                      np.mean(np.abs(theta[both] / auto[both] - 1) > PARTED), (_overturned(theta), _overturned(auto)),
                      ranges[0], _median(theta) / _median(auto), ranges[1], distance(theta, auto),
                      np.quantile([row[2] for row in found], 0.95))


def between_halves(runs: pd.DataFrame, structure: str) -> tuple[float, float]:
    """What four records and the other four give at auto, over all ways to halve them: median distance, and of the median
    theta_max the typical ratio."""
    own = runs[runs["structure"] == structure]
    of_record = {record: group["auto"].to_numpy() for record, group in own.groupby("record")}
    names = sorted(of_record)
    distances, ratios = [], []
    for others in combinations(names[1:], len(names) // 2 - 1):
        half = [names[0], *others]
        first = np.concatenate([of_record[name] for name in half])
        second = np.concatenate([of_record[name] for name in names if name not in half])
        distances.append(distance(first, second))
        ratios.append(abs(np.log(_median(first) / _median(second))))
    return np.median(distances), np.exp(np.median(ratios))


def comparisons(runs: pd.DataFrame) -> list[Comparison]:
    """Every variant against auto on every structure."""
    return [compare(runs, structure, variant) for structure in STRUCTURES for variant in VARIANTS if variant != "auto"]


def rows(runs: pd.DataFrame, found: list[Comparison]) -> str:
    """The one table."""
    lines = []
    for structure in STRUCTURES:
        for of in (comparison for comparison in found if comparison.structure == structure):
            low, high = 100 * of.difference
            lines.append([structure, of.variant, f"{100 * of.fates:.1f} %", f"{100 * of.parted:.0f} %",
                          f"{100 * of.overturned[0]:.1f} / {100 * of.overturned[1]:.1f} %", f"{low:+.1f} to {high:+.1f}",
                          f"{of.median:.2f} ({of.median_range[0]:.2f} to {of.median_range[1]:.2f})",
                          f"{of.distance:.3f} ({of.distance_most:.3f})"])
        far, ratio = between_halves(runs, structure)
        lines.append([structure, "*auto, half of the records against the others*", "", "", "", "", f"{ratio:.2f}", f"{far:.3f}"])
    return table(["structure", "level", "other fate", f"θ_max parts by {100 * PARTED:.0f} %", "overturned: level / auto",
                  "95 % of the difference", "median θ_max over auto's", "KS distance (95 % of draws below)"],
                 [[cell.replace("-", "−") for cell in line] for line in lines], texts=(0, 1))


def summary(runs: pd.DataFrame, found: list[Comparison]) -> dict[str, str]:
    """The numbers of the page's words."""
    of = {variant: [one for one in found if one.variant == variant] for variant in VARIANTS}
    stronger = next(variant for variant, (_, factor) in VARIANTS.items() if factor != 1)
    elastic = of["modal"] + of["linear"]

    def percent(ones, name):
        values = [100 * getattr(one, name) for one in ones]
        return f"{min(values):.1f} to {max(values):.1f} %"

    halves = [between_halves(runs, structure)[0] for structure in STRUCTURES]
    return {
        "elastic_fates": percent(elastic, "fates"), "elastic_parted": percent(elastic, "parted"),
        "elastic_distance": f"{max(one.distance for one in elastic):.3f}",
        "stronger_fates": percent(of[stronger], "fates"), "stronger_parted": percent(of[stronger], "parted"),
        "stronger_distance": f"{max(one.distance for one in of[stronger]):.3f}",
        "stronger": f"{100 * (STRONGER - 1):.1g} %",
        "halves_distance": f"{min(halves):.2f} to {max(halves):.2f}",
        "rigid_fates": percent(of["rigid"], "fates"), "rigid_parted": percent(of["rigid"], "parted"),
        "rigid_distances": ", ".join(f"{one.distance:.2f} ({one.structure})" for one in of["rigid"]),
    }


def draw(runs: pd.DataFrame, path: Path) -> None:
    """Above: run by run; below: distributions."""
    figure, axes = figures.subplots(2, len(STRUCTURES), 4.4, sharey="row", sharex="row")
    colors = {"rigid": figures.SMOOTH, "modal": figures.FIXED, "linear": figures.ROCKING, "auto": "black"}
    for (above, below), structure in zip(axes.T, STRUCTURES):
        own = runs[runs["structure"] == structure]
        for level, color in colors.items():
            if level != "auto":
                above.plot(own["auto"].clip(2e-3, 1.5), own[level].clip(2e-3, 1.5), ".", color=color, markersize=2,
                           rasterized=True)
            theta = np.sort(own[level])
            below.plot(theta, np.arange(1, len(theta) + 1) / len(theta), color=color, label=level)
        above.set(title=structure, xscale="log", yscale="log", xlabel="auto: $\\theta_{max}/\\alpha$")
        below.set(xlim=(2e-3, 1.5), xscale="log", ylim=(0, 1), xlabel="$\\theta_{max}/\\alpha$")
    axes[0][0].set_ylabel("level: $\\theta_{max}/\\alpha$")
    axes[1][0].set_ylabel("part of the runs below")
    axes[1][0].legend(loc="upper left")
    figures.save(figure, path)
