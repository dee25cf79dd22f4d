"""Section 3: eight records, scaled in time and amplitude, on four structures at every level of detail."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

import flexible_rocking as fr
import numpy as np
import pandas as pd
from first_run import G
from scipy.stats import ks_2samp
from validation import figures
from validation.records import horizontal_records
from validation.specimens import EVISON, MCMANUS

STRUCTURES = {
    "McManus": MCMANUS,
    "Evison": EVISON,
    "stiff": MCMANUS.replace(f_fc=30),
    "soft": MCMANUS.replace(f_fc=1.5),
}
TIME_SCALES = [0.2, 0.28, 0.4, 0.55, 0.75, 1.0]
PGAS = np.round(np.geomspace(0.3, 2.5, 12), 4)  # g
STRONGER = 1.001  # factor on the records of the variant that tells what can be known at all
VARIANTS = {"rigid": ("rigid", 1.0), "modal": ("modal", 1.0), "linear": ("linear", 1.0),
            f"auto, records {100 * (STRONGER - 1):.1g} % stronger": ("auto", STRONGER), "auto": ("auto", 1.0)}
PARTED = 0.1  # relative difference of theta_max from which two runs have parted
QUANTILES = [0.5, 0.84]
DRAWS = 400  # of the bootstrap
SEED = 1963


def records(time_scale: float = 1.0) -> dict[str, fr.Record]:
    """The records, each with a peak of 1 g."""
    found = {str(path): fr.Record.read(path, time_scale=time_scale) for path in horizontal_records().values()}
    return {name: record.scaled(G / record.pga) for name, record in found.items()}


def sweep(detail: str, time_scale: float, factor: float) -> pd.DataFrame:
    """Every record at every peak ground acceleration on every structure."""
    found = fr.sweep(STRUCTURES, records(time_scale), scale=factor * PGAS, detail=detail)
    return pd.DataFrame({
        "structure": found["structures"], "record": found["record"], "time_scale": time_scale,
        "pga": (found["scale"] / factor).round(4),
        # an overturned structure has exceeded every rotation
        "theta": found["peak_theta/alpha_cg"].where(found["ending"] != "overturned", np.inf),
    })


def compute(advance: Callable[[], None]) -> pd.DataFrame:
    """theta_max/alpha_cg of every run, a column for each variant."""
    keys, columns = ["structure", "record", "time_scale", "pga"], []
    for name, (detail, factor) in VARIANTS.items():
        parts = []
        for time_scale in TIME_SCALES:
            parts.append(sweep(detail, time_scale, factor))
            advance()
        columns.append(pd.concat(parts).set_index(keys)["theta"].rename(name))
    return pd.concat(columns, axis=1, join="inner").sort_index().reset_index()  # a sweep's rows are in any order


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
    quantiles: np.ndarray  # QUANTILES of theta_max of the runs that rock and stand, over auto's
    quantile_ranges: np.ndarray  # a row for each
    distance: float
    distance_most: float  # 95 % of what other draws give is below


def _overturned(theta) -> float:
    return np.mean(np.isinf(theta))


def _quantiles(theta) -> np.ndarray:
    return np.quantile(theta[np.isfinite(theta) & (theta > 0)], QUANTILES)


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
        found.append((_overturned(a) - _overturned(b), *(_quantiles(a) / _quantiles(b)), distance(a, b)))
    ranges = np.quantile(found, [0.025, 0.975], axis=0).T
    return Comparison(structure, variant, np.mean(np.isinf(theta) != np.isinf(auto)),
                      np.mean(np.abs(theta[both] / auto[both] - 1) > PARTED), (_overturned(theta), _overturned(auto)),
                      ranges[0], _quantiles(theta) / _quantiles(auto), ranges[1:-1], distance(theta, auto),
                      np.quantile([row[-1] for row in found], 0.95))


@dataclass(frozen=True)
class Halves:
    """Half of the records against the others at auto: medians over all ways to halve them."""

    overturned: float  # difference of the part that overturns
    ratios: np.ndarray  # of QUANTILES of theta_max, the larger over the smaller
    distance: float


def between_halves(runs: pd.DataFrame, structure: str) -> Halves:
    """Effect of another choice of records."""
    own = runs[runs["structure"] == structure]
    of_record = {record: group["auto"].to_numpy() for record, group in own.groupby("record")}
    names, found = sorted(of_record), []
    for others in combinations(names[1:], len(names) // 2 - 1):
        half = [names[0], *others]
        first = np.concatenate([of_record[name] for name in half])
        second = np.concatenate([of_record[name] for name in names if name not in half])
        found.append((abs(_overturned(first) - _overturned(second)),
                      *np.abs(np.log(_quantiles(first) / _quantiles(second))), distance(first, second)))
    overturned, *ratios, far = np.median(found, axis=0)
    return Halves(overturned, np.exp(ratios), far)


def comparisons(runs: pd.DataFrame) -> list[Comparison]:
    """Every variant against auto on every structure."""
    return [compare(runs, structure, variant) for structure in STRUCTURES for variant in VARIANTS if variant != "auto"]


def save(runs: pd.DataFrame, found: list[Comparison], path: Path) -> None:
    """Writes the table of all comparisons."""
    lines = []
    for structure in STRUCTURES:
        for of in (comparison for comparison in found if comparison.structure == structure):
            low, high = 100 * of.difference
            overturned = " / ".join(f"{100 * part:.1f}" for part in of.overturned)
            lines.append([structure, of.variant, f"{100 * of.fates:.1f} %", f"{100 * of.parted:.0f} %",
                          f"{overturned} %", f"{low:+.1f} to {high:+.1f}",
                          *(f"{ratio:.2f} ({least:.2f} to {most:.2f})"
                            for ratio, (least, most) in zip(of.quantiles, of.quantile_ranges)),
                          f"{of.distance:.3f} ({of.distance_most:.3f})"])
        halves = between_halves(runs, structure)
        lines.append([structure, "auto, half of the records against the others", "", "", "", f"±{100 * halves.overturned:.1f}",
                      *(f"{ratio:.2f}" for ratio in halves.ratios), f"{halves.distance:.3f}"])
    head = ["structure", "level", "other fate", f"theta_max differs by more than {100 * PARTED:.0f} %", "overturned: level / auto",
            "difference in points, 95 %", *(f"{100 * q:g} % quantile of theta_max over that of auto" for q in QUANTILES),
            "KS distance (95 % below)"]
    pd.DataFrame(lines, columns=head).to_csv(path, index=False)


def summary(runs: pd.DataFrame, found: list[Comparison]) -> dict[str, str]:
    """The numbers of the page's words: ranges over the structures."""
    words = {"stronger_by": f"{100 * (STRONGER - 1):.1g} %"}
    groups = {"modal": ["modal"], "linear": ["linear"], "rigid": ["rigid"],
              "stronger": [variant for variant, (_, factor) in VARIANTS.items() if factor != 1]}
    for name, variants in groups.items():
        of = [one for one in found if one.variant in variants]
        points = [100 * abs(one.overturned[0] - one.overturned[1]) for one in of]
        words |= {
            f"{name}_fates": _range([100 * one.fates for one in of], ".1f"),
            f"{name}_parted": _range([100 * one.parted for one in of], ".0f"),
            f"{name}_points": f"{max(points):.1f}",
            f"{name}_quantiles": _range([ratio for one in of for ratio in one.quantiles], ".2f"),
            f"{name}_distance": f"{max(one.distance for one in of):.3f}",
            f"{name}_told": ", ".join(one.structure for one in of if np.prod(one.difference) > 0) or "none",
        }
    halves = [between_halves(runs, structure) for structure in STRUCTURES]
    rigid = [f"{one.distance:.2f} ({one.structure})" for one in found if one.variant == "rigid"]
    return words | {"halves_distance": _range([one.distance for one in halves], ".2f"),
                    "halves_points": _range([100 * one.overturned for one in halves], ".0f"),
                    "rigid_distances": ", ".join(rigid)}


def _range(values: list[float], form: str) -> str:
    return f"{min(values):{form}} to {max(values):{form}}"


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
    axes[1][0].set_ylabel("fraction of the runs below")
    axes[1][0].legend(loc="upper left")
    title = "Single runs differ; distributions agree, except those of rigid blocks instead of soft structures"
    figure.suptitle(title)
    figures.save(figure, path, title,
                 "Above: the largest rotation of every run at each level against that of auto. Below: its distribution.")
