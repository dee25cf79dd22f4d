"""Fragility curves and demands in the formats of the field: pelicun's CSV, OpenQuake's NRML 0.5."""

import csv
import re
from collections.abc import Iterable, Mapping
from os import PathLike
from typing import TYPE_CHECKING, TypeVar
from xml.etree import ElementTree

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import ArrayLike

    from ._sweep import Fragility

T = TypeVar("T")
NRML = "http://openquake.org/xmlns/nrml/0.5"
# What each calls a measure of intensity: its type, and its unit or the factor to its unit.
PELICUN = {"PGA[g]": ("Peak Ground Acceleration", "g"), "PGV[m/s]": ("Peak Ground Velocity", "mps")}
OPENQUAKE = {"PGA[g]": ("PGA", 1.0), "PGV[m/s]": ("PGV", 100.0), "CAV[m/s]": ("CAV", 1 / 9.80665), "I_A[m/s]": ("IA", 1.0),
             "D_5_95[s]": ("RSD", 1.0)}  # of PGV in cm/s, of CAV in g.s


def write_pelicun(file: str | PathLike[str], components: "Mapping[str, Fragility | Iterable[Fragility]]") -> None:
    """Writes the damage model parameters of pelicun 3, a row a component, whose limit states are lognormal curves.

    components: by ID, one Fragility or several, the limit state that is exceeded first coming first. The curves of a component are over
    one of PGA, PGV, and a column such as "SA(0.4)" with S_a (g) at this period (s) for the damping ratio 0.05. Raises ValueError for
    other measures.
    """
    rows = {name: list(of) if isinstance(of, Iterable) else [of] for name, of in components.items()}
    kinds = {name: _kind(name, curves, PELICUN, ("Peak Spectral Acceleration|{}", "g")) for name, curves in rows.items()}
    states = range(1, max(map(len, rows.values())) + 1)
    heads = ["ID", "Incomplete", "Demand-Type", "Demand-Unit", "Demand-Offset", "Demand-Directional"]
    with open(file, "w", newline="", encoding="utf-8") as lines:
        table = csv.writer(lines)
        table.writerow(heads + [f"LS{state}-{what}" for state in states for what in ("Family", "Theta_0", "Theta_1")])
        for name, curves in rows.items():
            table.writerow([name, 0, *kinds[name], 0, 0] + [cell for of in curves for cell in ("lognormal", of.median, of.dispersion)])


def write_demands(file: str | PathLike[str], table: "pd.DataFrame") -> None:
    """Writes the demands of a sweep's table as a sample of pelicun 3: a row per run, and below the headings a row of units.

    Columns: 1-PFA-0-1 (ground) and 1-PFA-1-1, ... (floors, mps2), 1-PID-1-1, ... (peak drift ratios of storeys, rad), 1-ROT-0-1 (peak
    rotation of the base, rad) and 1-PGA-0-1 (mps2), or, if the sweep has another intensity, 1-IM-0-1 in its own unit. The index names
    record and scale. One mass is one floor. Runs that overturned or failed have no demands: their probability is `fragility`'s.
    Raises ValueError for structures of different floors.
    """
    ended = table[~table["ending"].isin(["overturned", "failed"])].dropna(axis="columns", how="all")
    g, columns = ended["g[m/s2]"], {("1-PFA-0-1", "mps2"): ended["PGA[g]"] * ended["g[m/s2]"]}
    floors = sum(bool(re.fullmatch(r"peak_a_t\[\d+\]\[m/s2\]", str(name))) for name in ended)
    columns |= {(f"1-PFA-{i}-1", "mps2"): ended[f"peak_a_t[{i}][m/s2]"] for i in range(1, floors + 1)}
    columns |= {(f"1-PID-{i}-1", "rad"): ended[f"peak_drift_ratio[{i}]"] for i in range(1, floors + 1)}
    if not floors:
        columns |= {("1-PFA-1-1", "mps2"): ended["peak_a_t[m/s2]"], ("1-PID-1-1", "rad"): ended["peak_u[m]"] / ended["H[m]"]}
    columns |= {("1-ROT-0-1", "rad"): ended["peak_theta[rad]"], ("1-PGA-0-1", "mps2"): ended["PGA[g]"] * g}
    if (measure := table.attrs.get("intensity", "PGA[g]")) != "PGA[g]":
        columns["1-IM-0-1", measure.rpartition("[")[2].rstrip("]")] = ended[measure]
    if any(column.isna().any() for column in columns.values()):
        raise ValueError("the structures of the table have different floors: write each population by itself")
    with open(file, "w", newline="", encoding="utf-8") as lines:
        rows = csv.writer(lines)
        rows.writerows([["", *(name for name, _ in columns)], ["Units", *(unit for _, unit in columns)]])
        names = [f"{record} x {scale:g}" for record, scale in zip(ended["record"], ended["scale"])]
        rows.writerows(zip(names, *(column.tolist() for column in columns.values())))


def write_openquake(file: str | PathLike[str], functions: "Mapping[str, Mapping[str, Fragility]]", *,
                    levels: "ArrayLike | None" = None, description: str = "structures that rock") -> None:
    """Writes a fragilityModel of NRML 0.5 with discrete functions: probabilities at intensity levels.

    functions: by the taxonomy of their assets, each a Fragility by limit state, the same states in all. Without levels, the probabilities
    are the counted parts at the intensities of the bins, which need not be lognormal. With levels (n,), increasing, in the unit of the
    curves, the probabilities are those of the curves. The curves of a function are over one of PGA, PGV, CAV, I_A, D_5_95, and a column
    such as "SA(0.4)" with S_a (g) at this period (s) for the damping ratio 0.05; the file has them in OpenQuake's units. Raises
    ValueError for other measures, and where the limit states of the functions or the counted runs of one function differ.
    """
    states = list(next(iter(functions.values())))
    root = ElementTree.Element("nrml", xmlns=NRML)
    model = ElementTree.SubElement(root, "fragilityModel", id="rocking", assetCategory="building", lossCategory="structural")
    ElementTree.SubElement(model, "description").text = description
    ElementTree.SubElement(model, "limitStates").text = " ".join(states)
    for name, curves in functions.items():
        if list(curves) != states:
            raise ValueError(f"{name!r} has the limit states {', '.join(curves)}; the first has {', '.join(states)}")
        kind, factor = _kind(name, list(curves.values()), OPENQUAKE, ("SA({})", 1.0))
        at, poes = _counted(name, curves) if levels is None else _of_curves(curves, levels)
        function = ElementTree.SubElement(model, "fragilityFunction", id=name, format="discrete")
        ElementTree.SubElement(function, "imls", imt=kind).text = " ".join(repr(factor * level) for level in at)
        for state in states:
            ElementTree.SubElement(function, "poes", ls=state).text = " ".join(map(repr, poes[state]))
    ElementTree.indent(root)
    ElementTree.ElementTree(root).write(file, encoding="utf-8", xml_declaration=True)


def _of_curves(curves: "Mapping[str, Fragility]", levels: "ArrayLike") -> tuple[list[float], dict[str, list[float]]]:
    """Levels, and by limit state the probabilities there."""
    import numpy as np

    return np.asarray(levels, float).tolist(), {state: of.probability(levels).tolist() for state, of in curves.items()}


def _counted(name: str, curves: "Mapping[str, Fragility]") -> tuple[list[float], dict[str, list[float]]]:
    """Mean intensities of the counted runs, and by limit state the parts that exceed it."""
    bins = [curve.bins for curve in curves.values()]
    if any(not of["mean"].equals(bins[0]["mean"]) for of in bins):
        raise ValueError(f"{name!r} has curves of different runs: give the levels")
    is_known = [all(of["known"][i] > 0 for of in bins) for i in range(len(bins[0]))]
    parts = {state: (of.bins["exceedances"] / of.bins["known"])[is_known].tolist() for state, of in curves.items()}
    return bins[0]["mean"][is_known].tolist(), parts


def _kind(name: str, curves: "list[Fragility]", known: dict[str, tuple[str, T]], spectral: tuple[str, T]) -> tuple[str, T]:
    """Type of the measure that all of `curves` are over, and its unit or factor: one of `known`, or `spectral` at a period."""
    measures = {curve.intensity for curve in curves}
    if len(measures) != 1:
        raise ValueError(f"{name!r} has curves over {', '.join(sorted(measures))}: one measure is needed")
    measure = measures.pop()
    if measure in known:
        return known[measure]
    if period := re.fullmatch(r"SA\((\d+(?:\.\d+)?)\)|S_a\((\d+(?:\.\d+)?) s\)\[g\]", measure):
        period = [period[0], period[1] or period[2]]  # type: ignore[assignment]
        return spectral[0].format(period[1]), spectral[1]
    raise ValueError(f"{name!r} has curves over {measure}, which the format does not have: give fr.fragility an intensity of "
                     f"{', '.join(known)}, S_a(0.4 s), or a column named SA(0.4) with S_a (g) at the period 0.4 s and the damping ratio 0.05")
