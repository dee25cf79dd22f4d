"""Overturning spectra: maps of pulses that the command line draws."""

import json
import random
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory

import flexible_rocking as fr
import numpy as np
import pandas as pd
from tqdm import tqdm

from .. import ROOT
from ..page import table
from ..paper.specimens import MCMANUS
from ..scenes import PROGRAM

FOLDER = ROOT / "evidence/overturning"
SCENES = {"rigid": FOLDER / "rigid.toml", "specimens": ROOT / "examples/overturning.toml", "stiffness": FOLDER / "stiffness.toml",
          "islands": FOLDER / "islands.toml"}
CLASSES = ["no uplift", "rocks and stands", "overturns without impact", "overturns after one impact",
           "overturns after more impacts", "still rocking"]
RATIOS = [2, 4, 6, 8]  # ω/p_l at which the least amplitude that overturns is shown
AMPLIFIED = ["10", "1e3", "1e6", "1e10"]
CHECKED = 200  # points whose runs are checked against the limits of the model
X, Y = "omega/p_l", "a_p/(g tan alpha_cg)"


def maps(name: str, picture: Path, folder: Path) -> tuple[pd.DataFrame, pd.DataFrame]:
    """The maps of one TOML file: the part of each structure's points that is of each class, and every point."""
    rows = folder / f"{name}.csv"
    command = [PROGRAM, "sweep", SCENES[name], "-o", rows]
    counts = subprocess.check_output([*command, "--picture", picture, "--quiet", "--format", "json"], text=True)
    points = pd.read_csv(rows).sort_values(["structures", X, Y])  # rows stand in the order in which runs ended
    return pd.DataFrame(json.loads(counts)).set_index(["structure", "class"])["part"], points


def part(parts: pd.Series, structure: str, of_class: str) -> str:
    """In %."""
    return f"{100 * parts[structure, of_class]:.1f}" if (structure, of_class) in parts else "–"


def least(points: pd.DataFrame, ratio: float) -> str:
    """The least a_p/(g tan α_cg) that overturns a structure at the ω/p_l of the grid next to `ratio`."""
    ratios = points[X][points["refinement"] == 0].unique()
    column = ratios[np.argmin(np.abs(ratios - ratio))]
    overturned = points[Y][(points[X] == column) & (points["fate"] == "overturns")]
    return f"{overturned.min():.2f}" if len(overturned) else "–"


def beyond(point) -> pd.Series:
    """Of each assumption, whether a point of McManus's map goes beyond it."""
    pulse = fr.pulse(point["shape"], amplitude=point[Y], frequency=point[X], structure=MCMANUS)
    validity = fr.simulate(MCMANUS, pulse).validity
    return pd.Series({name: worst.first_beyond is not None for name, worst in validity.items()})


def values(figures: Path) -> dict:
    figures.mkdir(exist_ok=True)
    with TemporaryDirectory() as folder:
        scenes = {name: maps(name, figures.resolve() / f"{name}.svg", Path(folder)) for name in tqdm(SCENES)}
    one_sine = {structure: (parts, points[points["structures"] == structure]) for name in list(SCENES)[:3]
                for parts, points in [scenes[name]] for structure in parts.index.unique("structure")}

    specimens = scenes["specimens"][1]
    rocks = specimens[(specimens["structures"] == "McManus") & specimens["fate"].isin(["stands", "overturns"])]
    rocks = rocks.iloc[random.Random(1).sample(range(len(rocks)), CHECKED)]
    goes_beyond, overturns, impacts = rocks.apply(beyond, axis=1), rocks["fate"] == "overturns", rocks["impacts"] > 0
    kinds = {"stands": ~overturns, "overturns without impact": overturns & ~impacts,
             "overturns after impacts": overturns & impacts}

    conditions = scenes["islands"][1]["condition"]
    return dict(
        classes=table(["% of the points", *one_sine],
                      [[of_class, *(part(parts, structure, of_class) for structure, (parts, _) in one_sine.items())]
                       for of_class in CLASSES]),
        least=table(["ω/p_l", *one_sine],
                    [[ratio, *(least(points, ratio) for _, points in one_sine.values())] for ratio in RATIOS]),
        amplified=table(["amplified more than", "points"],
                        [[f"{limit} times", f"{100 * (conditions > float(limit)).mean():.2f} %"]
                         for limit in AMPLIFIED]),
        checked=CHECKED, islands=len(conditions), changes=np.isinf(conditions).sum(),
        beyond=table(["the structure", "points", "R_v below 0 at some instant", "friction above 0.5 needed"],
                     [[name, of.sum(), *goes_beyond[of][["R_v_min", "mu_required"]].sum()]
                      for name, of in kinds.items()]),
        largest=conditions[np.isfinite(conditions)].max())
