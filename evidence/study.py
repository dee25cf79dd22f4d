"""Tables of the study in Rust, which compares methods and peers, and how its numbers are printed."""

import math
import subprocess
from pathlib import Path

import pandas as pd

from . import ROOT
from .figures import COLOURS
from .scenes import RECORDS

SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
RIGHT, WRONG, GUIDE = {"color": "black", "linewidth": 1.6}, {"color": COLOURS[4]}, {"color": "0.4", "linestyle": "--", "linewidth": 0.8}


def tables(command: str, folder: Path) -> None:
    """Writes the tables of a command into the folder."""
    study = ["cargo", "run", "--release", "--quiet", "--manifest-path", ROOT / "study/Cargo.toml", "--", command]
    subprocess.run([*study, "--records", RECORDS, "--output", folder], check=True)


def curves(axis, path: Path, looks: list[dict]) -> None:
    """Draws the curves of a table, the first on top, each with its look."""
    of = pd.read_csv(path, dtype={"series": str})
    for order, (name, look) in enumerate(zip(of["series"].unique(), looks)):
        points = of[of["series"] == name]
        axis.plot(points["x"], points["y"], zorder=3 - 0.1 * order, **({"label": name} | look))


def named(rows: pd.DataFrame) -> dict:
    """Values by their names: numbers, or words."""
    def value(text: str):
        try:
            return float(text)
        except ValueError:
            return text

    return {name: value(text) for name, text in zip(rows["name"], rows["value"])}


def decade(value: float) -> str:
    """A power of ten."""
    exponent = round(math.log10(value))
    return str(10**exponent) if 0 <= exponent <= 2 else f"10{str(exponent).translate(SUPERSCRIPTS)}"


def scientific(value: float) -> str:
    """Two digits, as 1.5·10⁻⁷."""
    digits, exponent = f"{value:.1e}".split("e")
    return digits if int(exponent) == 0 else f"{digits}·10{str(int(exponent)).translate(SUPERSCRIPTS)}"


def significant(value: float) -> str:
    """Two digits."""
    return f"{value:.{min(max(1 - math.floor(math.log10(abs(value))), 0), 9)}f}"
