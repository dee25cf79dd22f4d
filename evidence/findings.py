"""The findings of README, from the tables of docs/evidence/accuracy.md: python -m evidence.findings prints them."""

import flexible_rocking as fr
import numpy as np

from .accuracy.page import AT_STEP_ENDS, SIX_DIGITS, measured, nearest
from .paper.specimens import MCMANUS
from .scenes import RECORDS


def findings() -> str:
    """As they stand in README."""
    runs = measured()
    slower = [nearest(of)[1] for of in runs.values()]
    steps = [1e3 * of["value"][(of["error_theta"] <= SIX_DIGITS) & (of["method"] == "RK4")].max() for of in runs.values()]
    at_ends, two_modes = ([of["error_theta"][of["method"] == method].min() for of in runs.values()]
                          for method in (f"RK4{AT_STEP_ENDS}", "this project, modal"))
    stiff = runs["stiff-el-centro"].set_index("method")
    fallen = float(stiff.loc["this project, modal", "failure"].iloc[0].removeprefix("overturns at t = ").removesuffix(" s"))
    full = fr.simulate(MCMANUS.replace(f_fc=30), fr.Record.read(next(RECORDS.glob("*/RSN6_*ELC180*"))))
    return f"""\
- **Speed.** To six digits of θ the cheapest other method takes {min(slower):.1f} to {max(slower):.1f} times as long as this engine.
- **Accuracy.** Locating the transitions (uplift, impact, landing) matters most. With transitions located, the Runge-Kutta method RK4 reaches six digits with steps of
  {min(steps):.2f} to {max(steps):.2f} ms. The smallest errors of RK4 with transitions at the ends of steps are {min(at_ends):.0e} to {max(at_ends):.0e} of the peak.
- **Level of detail.** Two uncoupled modes (level `modal`) have errors of {np.nanmin(two_modes):.0%} to {np.nanmax(two_modes):.0%} of the peak in the history of θ in {np.isfinite(two_modes).sum()} of {len(two_modes)} scenes. In
  the fourth, `modal` predicts overturning at {fallen:.0f} s. The full equations predict that the pier is {full.ending} at {full.end:.0f} s.
"""


if __name__ == "__main__":
    print(findings(), end="")
