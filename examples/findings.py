"""Prints the findings of README from the tables of docs/evidence/accuracy.md: python examples/findings.py

It runs in a folder with docs/ and the records that `make demo` leaves in out/. rocking-fmu must be on the PATH.
"""

import json
import subprocess
from pathlib import Path

import pandas as pd

EL_CENTRO = "out/RSN6_IMPVALL.I_I-ELC180-hor1.AT2"
SIX_DIGITS = 1e-6


def printed(*arguments: str):
    """What the command line prints as JSON."""
    command = ["rocking-fmu", "--quiet", *arguments, "--format", "json"]
    return json.loads(subprocess.run(command, check=True, capture_output=True).stdout)


def main() -> None:
    slower, at_ends, steps, two_modes = [], [], [], []
    for file in sorted(Path("docs/evidence").glob("accuracy-*.csv")):
        runs = pd.read_csv(file)
        good = runs[runs["error_theta"] <= SIX_DIGITS]
        is_ours = good["method"].str.startswith("this project")
        cost = good["microseconds_per_sample"]
        slower.append(cost[~is_ours].min() / cost[good["method"] == "this project, auto"].min())
        steps.append(1e3 * good["value"][good["method"] == "RK4"].max())
        at_ends.append(runs["error_theta"][runs["method"] == "RK4, transitions at step ends"].min())
        two_modes.append(runs["error_theta"][runs["method"] == "this project, modal"].min())
    right = pd.Series(two_modes).dropna()
    stiff = pd.read_csv("docs/evidence/accuracy-stiff-el-centro.csv").set_index("method")
    fallen = float(stiff.loc["this project, modal", "failure"].iloc[0].removeprefix("overturns at t = ").removesuffix(" s"))
    full = printed("simulate", "--preset", "mcmanus", "--f-fc", "30", "--record", EL_CENTRO)

    print(f"- **Speed.** To six digits of θ the cheapest other method takes {min(slower):.1f} to {max(slower):.1f} times as long as this engine.")
    print("- **Accuracy.** Locating the transitions (uplift, impact, landing) matters most. With transitions located, the Runge-Kutta method RK4 reaches six digits with steps of")
    print(f"  {min(steps):.2f} to {max(steps):.2f} ms. The smallest errors of RK4 with transitions at the ends of steps are {min(at_ends):.0e} to {max(at_ends):.0e} of the peak.")
    print(f"- **Level of detail.** Two uncoupled modes (level `modal`) have errors of {right.min():.0%} to {right.max():.0%} of the peak in the history of θ in {len(right)} of {len(two_modes)} scenes. In")
    print(f"  the fourth, `modal` predicts overturning at {fallen:.0f} s. The full equations predict that the pier is {full['ending']} at {full['end']:.0f} s.")


if __name__ == "__main__":
    main()
