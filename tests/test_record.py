"""A record inside: the same as the record through a_g with slopes, whatever the steps; its peaks; where it cannot be had."""

import json
import subprocess

import fmpy
import numpy as np
import pytest
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


def extrapolated(fmu, step: float, on: bool) -> float:
    """Error of theta and u on a smooth ground motion that is set without slopes."""
    ground = lambda t: 4.0 * np.exp(-((t - 1.0) / 0.3) ** 2) * np.sin(12 * t)
    time = np.arange(round(1.5 / step) + 1) * step
    with fmu.instance() as instance, start(fmu) as exact:
        instance.slave.setBoolean([fmu.variables["extrapolate"].valueReference], [on])
        instance.initialize()
        for t in time[:-1]:
            instance.set(a_g=ground(t))
            instance.step(t + step)
        fine = np.linspace(0, 1.5, 30_001)
        expected = exact.follow(fine, ground(fine), ("theta", "u"))
        assert exact.get("transitions") >= 2
        return max(abs(instance.get(name) - expected[name][-1]) / np.max(np.abs(expected[name])) for name in ("theta", "u"))


def test_extrapolation_is_of_second_order(mcmanus):
    steps = (4e-3, 2e-3, 1e-3)
    held, continued = ([extrapolated(mcmanus, step, on) for step in steps] for on in (False, True))
    assert all(3.5 < earlier / later < 4.5 for earlier, later in zip(continued, continued[1:]))
    assert all(1.8 < earlier / later < 2.2 for earlier, later in zip(held, held[1:]))
    assert continued[-1] < held[-1] / 10
