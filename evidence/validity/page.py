"""Limits of the model: how often structures exceed them, and what a repaired rule of uplift changes."""

from pathlib import Path

import numpy as np
import pandas as pd

from ..page import table
from ..study import scientific, tables

CHANGED = 0.05  # relative difference from which a peak has changed


def values(figures: Path) -> dict:
    """The paper's scenes, and many structures."""
    folder = figures.parent
    tables("validity", folder)
    rows, limits = pd.read_csv(folder / "validity.csv"), pd.read_csv(folder / "validity-limits.csv")
    for name in ("theta", "a_t"):
        before, after = rows[f"peak_{name}"], rows[f"peak_{name}_repaired"]
        rows[name] = ((after - before).abs() / before).where(after != before, 0.0).clip(upper=1)
    scenes, structures = rows[rows["scene"].notna()], rows[rows["scene"].isna()]
    lifted = structures[structures["transitions"] + structures["transitions_repaired"] > 0]
    overturned, repaired = structures["overturned"], structures["overturned_repaired"]
    beyond = [structures[f"{name}_beyond"].count() for name in limits["name"]]
    return dict(
        structures=len(structures), scenes=scene_table(scenes, limits), limits=limits["limit"], beyond=beyond,
        assumptions=table(["value", "limit", "structures beyond it", "median", "worst"],
                          [assumption(structures, count, *of) for count, of in zip(beyond, limits.itertuples(index=False))]),
        above_b=(structures["u_cr"] > structures["B"]).sum(), pulling=(structures["r"] < structures["pulling_r"]).sum(),
        settlings=(structures["settlings"] > 0).sum(), rocking=len(lifted),
        theta_beyond=(lifted["theta"] > CHANGED).sum(), theta_median=percent(middle(lifted["theta"])),
        a_t_beyond=(lifted["a_t"] > CHANGED).sum(), a_t_median=percent(middle(lifted["a_t"])),
        overturned=overturned.sum(), overturned_repaired=repaired.sum(), changed_fate=(overturned != repaired).sum(),
        tension=scientific(max(structures["tension_repaired"].max(), 0.0)))


def middle(values: pd.Series) -> float:
    """The median; of two middle values the larger."""
    return values.sort_values().iloc[len(values) // 2]


def number(value: float) -> str:
    return {np.inf: "∞", -np.inf: "none"}.get(value, f"{value:.3f}").replace("-", "−")


def percent(part: float) -> str:
    return f"{100 * part:.2f} %" if part else "0 %"


def scene_table(scenes: pd.DataFrame, limits: pd.DataFrame) -> str:
    """The values of each scene; in brackets the part of the run beyond the limit."""
    def cell(row, name: str, is_of_impacts: bool) -> str:
        if is_of_impacts:
            return number(row[name]) if row["impacts"] else "–"
        share = row[f"{name}_beyond"]
        return number(row[name]) + ("" if np.isnan(share) else f" ({percent(share)})")

    shown = limits[limits["name"] != "energy_gain_max"]
    rows = [[row["scene"], *(cell(row, name, is_of_impacts) for name, _, is_of_impacts in shown.itertuples(index=False)),
             f"{row['energy_gains']:.0f} of {row['impacts']:.0f}", percent(row["theta"]), percent(row["a_t"]),
             f"{row['transitions']:.0f} → {row['transitions_repaired']:.0f}"] for _, row in scenes.iterrows()]
    return table(["scene", *shown["name"], "impacts that gain", "peak of θ", "peak of a_t", "transitions"], rows)


def assumption(structures: pd.DataFrame, count: int, name: str, limit: float, is_of_impacts: bool) -> list:
    found = structures[structures["impacts"] > 0][name] if is_of_impacts else structures[name]
    worst = found.min() if name == "R_v_min" else found[np.isfinite(found)].max()
    return [f"`{name}`", f"{limit:g}", count, number(middle(found)), number(worst)]
