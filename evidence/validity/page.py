"""Limits of the model: how often structures exceed them."""

from pathlib import Path

import numpy as np
import pandas as pd

from ..page import table
from ..study import tables


def values(figures: Path) -> dict:
    folder = figures.parent
    tables("validity", folder)
    rows, limits = pd.read_csv(folder / "validity.csv"), pd.read_csv(folder / "validity-limits.csv")
    scenes, structures = rows[rows["scene"].notna()], rows[rows["scene"].isna()]
    beyond = [structures[f"{name}_beyond"].count() for name in limits["name"]]
    return dict(
        structures=len(structures), scenes=scene_table(scenes, limits), limits=limits["limit"], beyond=beyond,
        assumptions=table(["value", "limit", "structures beyond it", "median", "worst"],
                          [assumption(structures, count, *of) for count, of in zip(beyond, limits.itertuples(index=False))]),
        above_b=(structures["u_cr"] > structures["B"]).sum(), pulling=(structures["r"] < structures["pulling_r"]).sum(),
        settlings=(structures["settlings"] > 0).sum())


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
             f"{row['energy_gains']:.0f} of {row['impacts']:.0f}"] for _, row in scenes.iterrows()]
    return table(["scene", *shown["name"], "impacts that gain"], rows)


def assumption(structures: pd.DataFrame, count: int, name: str, limit: float, is_of_impacts: bool) -> list:
    found = structures[structures["impacts"] > 0][name] if is_of_impacts else structures[name]
    worst = found.min() if name == "R_v_min" else found[np.isfinite(found)].max()
    return [f"`{name}`", f"{limit:g}", count, number(middle(found)), number(worst)]
