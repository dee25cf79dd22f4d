"""Fragility curves in the formats of the field: pelicun's CSV, OpenQuake's NRML 0.5."""

import csv
from collections.abc import Iterable, Mapping
from os import PathLike
from typing import TYPE_CHECKING
from xml.etree import ElementTree

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._sweep import Fragility

NRML = "http://openquake.org/xmlns/nrml/0.5"
# What each calls a measure of intensity: type and unit of a demand, intensity measure type.
PELICUN = {"PGA[g]": ("Peak Ground Acceleration", "g"), "PGV[m/s]": ("Peak Ground Velocity", "mps"),
           "S_a[g]": ("Peak Spectral Acceleration", "g")}
OPENQUAKE = {"PGA[g]": ("PGA", 1.0), "PGV[m/s]": ("PGV", 100.0)}  # of PGV in cm/s


def write_pelicun(file: str | PathLike[str], components: "Mapping[str, Fragility | Iterable[Fragility]]", *,
                  period: float | None = None) -> None:
    """Writes the damage model parameters of pelicun 3, a row a component, whose limit states are lognormal curves.

    components: by ID, one Fragility or several, the limit state that is exceeded first coming first. period: that of S_a, s, which
    stands in its demand type. Raises ValueError where the curves of a component are over different measures.
    """
    rows = {name: list(of) if isinstance(of, Iterable) else [of] for name, of in components.items()}
    states = range(1, max(map(len, rows.values())) + 1)
    heads = ["ID", "Incomplete", "Demand-Type", "Demand-Unit", "Demand-Offset", "Demand-Directional"]
    with open(file, "w", newline="", encoding="utf-8") as lines:
        table = csv.writer(lines)
        table.writerow(heads + [f"LS{state}-{what}" for state in states for what in ("Family", "Theta_0", "Theta_1")])
        for name, curves in rows.items():
            kind, unit = PELICUN[_measure(name, curves)]
            kind += f"|{_period(period):.2f}" if unit == "g" and "Spectral" in kind else ""
            row = [name, 0, kind, unit, 0, 0]
            table.writerow(row + [cell for of in curves for cell in ("lognormal", of.median, of.dispersion)])


def write_openquake(file: str | PathLike[str], functions: "Mapping[str, Mapping[str, Fragility]]", *,
                    levels: "ArrayLike | None" = None, period: float | None = None,
                    description: str = "structures that rock") -> None:
    """Writes a fragilityModel of NRML 0.5 with discrete functions: probabilities at intensity levels.

    functions: by the taxonomy of their assets, each a Fragility by limit state, the same states in all. Without levels, the probabilities are the counted parts at the intensities of the bins, which need not be lognormal. With
    levels (n,), increasing, in the unit of the curves, the probabilities are those of the curves.
    period: the period of S_a, s, which the type SA(0.5) names. Raises ValueError where
    the limit states of the functions differ, or the measures or the counted runs of one function.
    """
    states = list(next(iter(functions.values())))
    root = ElementTree.Element("nrml", xmlns=NRML)
    model = ElementTree.SubElement(root, "fragilityModel", id="rocking", assetCategory="building", lossCategory="structural")
    ElementTree.SubElement(model, "description").text = description
    ElementTree.SubElement(model, "limitStates").text = " ".join(states)
    for name, curves in functions.items():
        if list(curves) != states:
            raise ValueError(f"{name!r} has the limit states {', '.join(curves)}; the first has {', '.join(states)}")
        measure = _measure(name, list(curves.values()))
        kind, factor = OPENQUAKE[measure] if measure in OPENQUAKE else (f"SA({_period(period)})", 1.0)
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


def _period(period: float | None) -> float:
    if period is None:
        raise ValueError("period is missing: that of S_a, s")
    return period


def _measure(name: str, curves: "list[Fragility]") -> str:
    """The measure that all of `curves` are over."""
    measures = {curve.intensity for curve in curves}
    if len(measures) != 1:
        raise ValueError(f"{name!r} has curves over {', '.join(sorted(measures))}: one measure is needed")
    return measures.pop()
