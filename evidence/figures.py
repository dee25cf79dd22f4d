"""How the pictures look: letters of at least 10 px at the width of a page."""

from html import escape
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

ROCKING, FIXED, SMOOTH, QUIET = "#1f5fa8", "#c0392b", "#d98200", "0.45"
# Okabe and Ito's, where they are too light darkened: all have a contrast of 3 to 1 on white and on pale grey.
COLOURS = ["#a06e00", "#1c78b4", "#009169", "#005a96", "#d55e00", "#b4508c", "#7d3c14", "#646464"]

STYLE = {
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.linewidth": 0.3,
    "grid.color": "0.85",
    "lines.linewidth": 1.0,
    "legend.frameon": False,
    "legend.fontsize": 8,
    "svg.hashsalt": "figure",
}


def subplots(rows: int, columns: int, height: float, **options):
    """A figure of the page's width (inches) with its axes."""
    plt.rcParams.update(STYLE)
    return plt.subplots(rows, columns, figsize=(7.2, height), layout="constrained", **options)


def save(figure, path: Path, title: str = "", description: str = "") -> None:
    """Writes the figure; the same data give the same bytes. An SVG file has `title` and `description`."""
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=180, metadata={{".png": "Software", ".svg": "Date"}[path.suffix]: None})
    if path.suffix == ".svg":
        told = f"<title>{escape(title)}</title>\n <desc>{escape(description)}</desc>\n <metadata>"
        path.write_text(path.read_text(encoding="utf-8").replace("<metadata>", told, 1), encoding="utf-8")
    plt.close(figure)
