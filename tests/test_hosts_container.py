"""Two exports in one `fmucontainer` of the FMU Manipulation Toolbox: each moves there as it does alone."""

import sys
from pathlib import Path

import numpy as np
from fmpy import read_model_description, simulate_fmu
from fmpy.util import read_csv
from host import output

FMUCONTAINER = Path(sys.executable).with_name("fmucontainer")
PIERS = {"Pier1": "mcmanus", "Pier2": "evison"}
NAMES = ("theta", "a_t")
STEP = 0.01


def test_two_exports(export, pacoima_record, tmp_path):
    paths = {name: export(preset, pacoima_record, "--name", name).path for name, preset in PIERS.items()}
    for name, path in paths.items():
        (tmp_path / f"{name}.fmu").symlink_to(path)
    rows = [f"OUTPUT;{pier}.fmu;{name};;{pier}_{name}\n" for pier in PIERS for name in NAMES]
    (tmp_path / "both.csv").write_text("rule;from_fmu;from_port;to_fmu;to_port\n" + "".join(rows))
    output(FMUCONTAINER, "-container", f"both.csv:{STEP}", "-no-auto-input", "-no-auto-output", cwd=tmp_path)
    both = tmp_path / "both.fmu"
    assert {variable.name for variable in read_model_description(both).modelVariables} >= {"Pier1_theta", "Pier2_a_t"}
    # In a process of its own: the container talks, and fmpy has one logger per process.
    output(sys.executable, "-m", "fmpy", "simulate", both, "--output-file", "both_out.csv", "--stop-time", 3, "--output-interval", STEP,
           cwd=tmp_path)
    together = read_csv(tmp_path / "both_out.csv")
    for pier, path in paths.items():
        alone = simulate_fmu(path, stop_time=3.0, output_interval=STEP, output=NAMES)
        for name in NAMES:
            peak = np.abs(alone[name]).max()
            assert peak > 1e-3
            np.testing.assert_allclose(together[f"{pier}_{name}"] / peak, alone[name] / peak, rtol=0, atol=1e-11)
