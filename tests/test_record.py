"""A record inside: the same as the record through a_g with slopes, whatever the steps; its peaks; where it cannot be had."""

import json
import subprocess
import sys

import fmpy
import numpy as np
import pytest
from first_run import PACOIMA_DAM
from fmpy.fmi1 import FMICallException
from host import Instance, ground_motion
from pacoima import write_record

LEVELS = {"auto": 1, "nonlinear": 2, "linear": 3, "modal": 4, "rigid": 5, "fixed_base": 6}
RECORDS = {  # with a scale factor under which McManus's specimen rocks
    "Pacoima Dam": ("sanFernando_pacoidaDam_1971", "pul164", dict(time_scale=5, scale=5 * 0.29)),
    "El Centro": ("imperialValley_elCentro_1940", "elc180", {}),
    "Corralitos": ("lomaPrieta_corralitos_1989", "cls000", dict(scale=0.7)),
    "Sylmar": ("northridge_sylmar_1994", "syl360", dict(scale=4.0)),
}
SEEN = ("theta", "u", "a_t", "V_t", "M_t", "uplift", "delta_t", "v_t", "R_h", "R_v", "R_m", "I_h", "I_v", "I_m",
        "theta_dot", "u_dot", "a_ground")
PEAKS = [f"{time}{name}_max" for time in ("", "t_") for name in ("theta", "u", "delta_t", "uplift", "a_t", "V_t", "M_t")]


def start(fmu, record="", detail="auto", **start_values) -> Instance:
    instance = fmu.instance()
    instance.slave.setString([fmu.variables["record"].valueReference], [str(record)])
    instance.slave.setInteger([fmu.variables["detail"].valueReference], [LEVELS[detail]])
    instance.slave.setBoolean([fmu.variables["peaks"].valueReference], [True])
    return instance.initialize(**start_values)


@pytest.fixture(scope="module", params=RECORDS)
def record(request, tmp_path_factory):
    """Its file, time and acceleration."""
    event, component, scales = RECORDS[request.param]
    time, a_g = ground_motion(event, component, **scales)
    path = tmp_path_factory.mktemp("records") / f"{request.param}.csv"
    write_record(path, time, a_g)
    return path, time, a_g


def follow(instance: Instance, time, a_g=None) -> np.ndarray:
    """SEEN at every sample between the first and the last, or to overturning; a_g is passed on with its slopes."""
    found = []
    for i, (t0, t1) in enumerate(zip(time[:-1], time[1:])):
        if a_g is not None:
            instance.load(a_g[i], (a_g[i + 1] - a_g[i]) / (t1 - t0))
        try:
            instance.step(t1)
        except FMICallException as exception:
            assert exception.status == 2
            break
        finally:
            found.append(instance.reals(SEEN))
    return np.array(found[:-1])  # from its last sample on a record is at rest


@pytest.mark.parametrize("detail", LEVELS)
def test_inside_and_through_a_g_are_the_same(mcmanus, record, detail):
    path, time, a_g = record
    with start(mcmanus, path, detail) as inside, start(mcmanus, detail=detail) as outside:
        assert inside.get("record_duration") == pytest.approx(time[-1], rel=1e-15)
        found, expected = follow(inside, time), follow(outside, time, a_g)
        assert len(found) == len(expected)
        assert inside.get("transitions") == outside.get("transitions")
        assert (inside.get("transitions") > 4) == (detail != "fixed_base")
        largest = np.max(np.abs(expected), axis=0)
        assert np.all(np.abs(found - expected) <= 1e-12 * largest)
        assert inside.get(*PEAKS) == pytest.approx(outside.get(*PEAKS), rel=1e-12)


def test_half_through_a_g(mcmanus, record):
    """The ground feels the sum of both."""
    path, time, a_g = record
    with start(mcmanus, path) as whole, start(mcmanus, path, record_scale=0.5) as half:
        expected, found = follow(whole, time[:2000]), follow(half, time[:2000], a_g / 2)
    assert np.max(np.abs(found - expected) / np.max(np.abs(expected), axis=0)) < 1e-9


def test_one_step_has_the_peaks_of_the_command_line(mcmanus, record, exporter):
    """Those of a structure that overturns are until it begins to fall."""
    path, time, _ = record
    printed = subprocess.run([exporter, "simulate", "--preset", "mcmanus", "--record", path, "--duration", str(time[-1]),
                              "--format", "json"], check=True, capture_output=True, text=True)
    told = json.loads(printed.stdout)
    _, *peaks = told["peaks"]  # without the ground's
    assert len(peaks) == 7
    with start(mcmanus, path) as instance:
        instance.step(told["fall"] or time[-1])
        for peak in peaks:
            found = instance.get(f"{peak['name']}_max", f"t_{peak['name']}_max")
            assert found == pytest.approx([peak["peak"], peak["time"]], rel=1e-9), peak["name"]


def test_scales_and_start(mcmanus, pacoima_record):
    """The record twice as slow and half as strong, from 0.3 s on, and from its middle on."""
    time, a_g = np.loadtxt(pacoima_record, delimiter=",", skiprows=1).T
    for delay in (0.3, -2.0):
        with start(mcmanus, pacoima_record, record_scale=0.5, record_time_scale=2.0, record_start=delay) as instance:
            assert instance.get("record_duration") == pytest.approx(2 * time[-1])
            for until in np.linspace(0, 5, 21)[1:]:
                instance.step(until)
                expected = np.interp(until, 2 * time + delay, 0.5 * a_g, left=0.0, right=0.0)
                assert instance.get("a_ground") == pytest.approx(expected, abs=1e-12)


def test_a_record_that_is_not_there(mcmanus, tmp_path):
    instance = mcmanus.instance()
    with instance:
        instance.slave.setString([mcmanus.variables["record"].valueReference], [str(tmp_path / "none.csv")])
        instance.slave.setupExperiment()
        instance.slave.enterInitializationMode()
        with pytest.raises(FMICallException, match="fmi2ExitInitializationMode failed with status 3"):
            instance.slave.exitInitializationMode()
        assert str(tmp_path / "none.csv") in instance.errors[-1]


def test_the_line_that_is_no_sample_is_named(mcmanus, tmp_path):
    broken = tmp_path / "broken.csv"
    broken.write_text("time,a_g\n0,0\n0.01,1\n0.02,one\n")
    messages = []
    with pytest.raises(FMICallException):
        fmpy.simulate_fmu(mcmanus.path, stop_time=1.0, start_values={"record": str(broken)},
                          logger=lambda *message: messages.append(message[-1].decode()))
    assert any("broken.csv" in text and "line 4" in text and "one" in text for text in messages), messages


@pytest.mark.parametrize("step", [2e-3, 10e-3])
def test_late_is_the_record_one_step_later(mcmanus, step):
    """Set without slopes, a_g leads to what the record inside shows one step before, and to its peaks; held it does not."""
    time, a_g = ground_motion("imperialValley_elCentro_1940", "elc180")
    time, a_g = np.arange(0, 20, step), np.interp(np.arange(0, 20, step), time, a_g - a_g[0])
    names = ("theta", "u", "a_t", "R_h")
    with start(mcmanus) as exact, mcmanus.instance() as late, start(mcmanus) as held:
        for switch in ("a_g_late", "peaks"):
            late.slave.setBoolean([mcmanus.variables[switch].valueReference], [True])
        late.initialize()
        expected = exact.follow(time, a_g, names)
        found = {late: [], held: []}
        for instance, rows in found.items():
            for t, value in zip(time, a_g):
                instance.set(a_g=value)
                instance.step(t + step)
                rows.append(instance.reals(names))
        expected = np.array(expected.tolist())
        largest = np.max(np.abs(expected), axis=0)
        assert exact.get("transitions") > 20
        assert np.max(np.abs(np.array(found[late]) - expected) / largest) < 1e-9
        assert np.max(np.abs(np.array(found[held])[:-1] - expected[1:]) / largest) > 1e-2
        assert late.get(*PEAKS[:7]) == pytest.approx(exact.get(*PEAKS[:7]), rel=1e-9)


RUNS = """
import sys
from fmpy import extract, read_model_description, simulate_fmu

folder, record, runs = sys.argv[1], sys.argv[2], int(sys.argv[3])
description = read_model_description(folder)


def resident():
    return int(open("/proc/self/statm").read().split()[1]) * 4096


def logger(*message):
    pass


for run in range(runs):
    if run == runs // 3:
        before = resident()
    simulate_fmu(folder, model_description=description, stop_time=0.02, output_interval=0.01, output=["theta"],
                 start_values={"record": record}, logger=logger)
print(resident() - before)
"""


def test_nothing_is_left_of_a_run(mcmanus):
    """fmpy unloads the library after each: a record of 4172 samples, left behind, would be 67 kB."""
    command = [sys.executable, "-c", RUNS, mcmanus.folder, PACOIMA_DAM["record"], "300"]
    grown = int(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    assert grown < 200 * 5_000
