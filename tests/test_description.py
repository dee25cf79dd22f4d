"""The model description of the FMU."""

import json
from pathlib import Path

import numpy as np
import pytest
from fmpy import simulate_fmu
from fmpy.validation import validate_fmu
from host import output
from pacoima import TIME


def test_nominal_values_are_of_the_magnitude_that_is_met(shaken):
    """Peaks in an earthquake are within a factor of 100 of the nominal values."""
    fmu = shaken["mcmanus"]
    result = simulate_fmu(fmu.path, start_values={"peaks": True}, output=[*fmu.outputs, *fmu.peaks])
    of_restraints = {"P_t", "F_d1", "F_d2", "P_t_max", "F_d1_max", "F_d2_max"}  # 0 here
    for name in set(result.dtype.names) - {"time", "I_h", "I_v", "I_m"} - of_restraints:
        peak, nominal = np.abs(result[name]).max(), float(fmu.variables[name].nominal)
        assert nominal / 100 < peak < 100 * nominal, (name, peak, nominal)


def test_simulating_without_a_word_follows_the_record(shaken, mcmanus, exporter, pacoima_record):
    """The default experiment ends within a step of the end of the command line's run, and its step is no longer than a
    sample; without a record, nothing has been said that would move the structure, and its stop time and step are those of a
    free vibration."""
    experiment = shaken["mcmanus"].description.defaultExperiment
    ends = json.loads(output(exporter, "--quiet", "simulate", "--preset", "mcmanus", "--record", pacoima_record, "--format", "json"))["end"]
    assert 0 <= float(experiment.stopTime) - ends <= 2 * np.diff(TIME).max()
    assert float(experiment.stepSize) <= np.diff(TIME).min() * (1 + 1e-8)
    result = simulate_fmu(shaken["mcmanus"].path)
    assert result["time"][-1] == pytest.approx(float(experiment.stopTime)) and np.abs(result["theta"]).max() > 0.01
    at_rest = simulate_fmu(mcmanus.path)
    assert not at_rest["theta"].any() and not at_rest["u"].any()
    released = simulate_fmu(mcmanus.path, start_values={"theta_0": 0.04})
    assert (np.diff(np.sign(released["theta"])) != 0).sum() > 5, "fewer than five impacts are seen"
    u = released["u"][:200]
    assert (np.diff(np.sign(np.diff(u))) != 0).sum() > 2, "the vibration mode is not resolved"


def test_the_demo_has_the_fmu_of_the_command_line(exporter, export, tmp_path):
    library = exporter.with_name("deps") / "libFlexibleRocking.so"
    demo = tmp_path / "demo.fmu"
    program = export("mcmanus", None, "--library", library, fmi="2").path
    output(exporter.with_name("examples") / "specimen", library, "mcmanus", demo)
    assert demo.read_bytes() == Path(program).read_bytes() and validate_fmu(demo) == []
    assert validate_fmu(export("evison", None, fmi="3").path) == []
