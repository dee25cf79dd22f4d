"""The FMU of a structure of many masses in fmpy, against independent integrations and against the FMU of one mass."""

import functools
import json
import subprocess
from pathlib import Path

import fmpy
import frames_reference
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu
from frames import FRAMES, Ties, scene, toml
from host import Fmu
from scipy.integrate import solve_ivp

FRAME, N = FRAMES["frame"], 3


@pytest.fixture(scope="module")
def export_frame(exporter, tmp_path_factory):
    """The FMU of the shear frame `frame`, held down by `ties`, on `ground`, with records of time, a_g and a_v inside."""

    def run(frame=FRAME, ties=Ties(), time=None, a_g=None, a_v=None, fmi=2, ground="") -> Fmu:
        folder = tmp_path_factory.mktemp("frame")
        (folder / "frame.toml").write_text(toml(frame, ties, ground))
        command = [exporter, "export", "--parameters", folder / "frame.toml", "--fmi", str(fmi), "-o", folder / "frame.fmu"]
        for option, values in (("--record", a_g), ("--record-v", a_v)):
            if values is not None:
                path = folder / f"{option[2:]}.csv"
                path.write_text("t (s),a (m/s2)\n" + "".join(f"{t!r},{a!r}\n" for t, a in zip(time.tolist(), values.tolist())))
                command += [option, path]
        subprocess.run(command, check=True, capture_output=True)
        return Fmu(folder / "frame.fmu", folder / "unzipped")

    return run


def floors(*names):
    return [f"{name}[{i}]" for name in names for i in range(1, N + 1)]


@functools.cache
def exact_response(tied):
    return frames_reference.simulate(*scene("frame", "El Centro", tied))


@pytest.mark.parametrize("tied", [False, True], ids=["free", "tied"])
@pytest.mark.parametrize("fmi, kind", [(2, "CoSimulation"), (3, "CoSimulation"), (2, "ModelExchange"), (3, "ModelExchange")])
def test_floors_move_as_the_physical_equations_say(export_frame, fmi, kind, tied):
    """θ, and u and a of every floor at every sample, to 1e-9 of the peak; to 1e-5 with fmpy's integrator. Peaks to 1e-8."""
    frame, dt, a_g, a_v, ties = scene("frame", "El Centro", tied)
    time = dt * np.arange(len(a_g))
    fmu = export_frame(frame, ties, time, a_g, a_v if tied else None, fmi)
    assert validate_fmu(fmu.path) == []
    peaks = [*floors("u_max", "a_t_max"), "theta_max", "V_t_max", "M_t_max"]
    found = fmpy.simulate_fmu(fmu.path, fmi_type=kind, stop_time=time[-1], output_interval=dt, start_values={"peaks": True},
                              output=["theta", "transitions", *floors("u", "a_t"), *peaks],
                              relative_tolerance=1e-12 if kind == "CoSimulation" else 1e-9)
    found = found[np.searchsorted(found["time"], time - 1e-9)]
    exact = exact_response(tied)
    assert found["transitions"][-1] == len(exact.transitions) > 5
    limit = 1e-9 if kind == "CoSimulation" else 1e-5
    expected = np.column_stack([exact.theta, exact.u, exact.a]).T
    for name, column in zip(["theta", *floors("u", "a_t")], expected, strict=True):
        np.testing.assert_allclose(found[name], column, rtol=0, atol=limit * np.abs(column).max(), err_msg=name)
    if kind == "CoSimulation":
        np.testing.assert_allclose([found[name][-1] for name in peaks], exact.peaks, rtol=1e-8)


SPRINGS = "f_v = 12\nzeta_v = 0.1\nn_points = 3"


@pytest.mark.parametrize("fmi, kind, tied, ground", [
    (2, "CoSimulation", False, ""), (2, "CoSimulation", True, ""), (2, "CoSimulation", False, SPRINGS),
    (3, "CoSimulation", True, SPRINGS), (2, "ModelExchange", False, SPRINGS), (3, "ModelExchange", True, SPRINGS),
], ids=["free", "tied", "on springs", "tied, on springs", "on springs, model exchange", "tied, on springs, model exchange"])
def test_outputs_at_the_samples_are_those_of_the_librarys_run(exporter, export_frame, fmi, kind, tied, ground):
    """To 1e-12 of the peak of each, up to the last sample, at which the ground stops; to 1e-4 with fmpy's integrator."""
    frame, dt, a_g, a_v, ties = scene("frame", "El Centro", tied)
    time = dt * np.arange(len(a_g))
    fmu = export_frame(frame, ties, time, a_g, a_v if tied else None, fmi, ground)
    folder = Path(fmu.path).parent
    command = [exporter, "--quiet", "simulate", "--parameters", "frame.toml", *(f"--{path.stem}={path}" for path in folder.glob("record*.csv")),
               "--format", "json", f"--duration={time[-1]}", "-o", "response.csv"]
    told = json.loads(subprocess.run(command, cwd=folder, check=True, capture_output=True).stdout)
    expected = np.genfromtxt(folder / "response.csv", delimiter=",", names=True, deletechars="", replace_space=" ")
    columns = {name.rpartition("[")[0]: name for name in expected.dtype.names}
    outputs = [of.variable.name for of in fmu.description.outputs]
    columns = {name: columns[name] for name in outputs if name in columns and not name.startswith("I_")}
    assert len(columns) > 25 and (not ground or {"N_left", "N_right", "settlement", "contact"} <= set(columns))
    found = fmpy.simulate_fmu(fmu.path, fmi_type=kind, stop_time=time[-1], output_interval=dt, output=[*columns, "transitions"],
                              relative_tolerance=1e-9)
    if ground:
        assert validate_fmu(fmu.path) == [] and found["transitions"][-1] == told["transitions"] > 5
    found = found[np.searchsorted(found["time"], time[:-1] - 1e-9)]
    for name, column in columns.items():
        values = expected[column][:-1]
        limit = (1e-12 if kind == "CoSimulation" else 1e-4) * np.abs(values).max()
        np.testing.assert_allclose(found[name], values, rtol=0, atol=limit, err_msg=name)


def test_ground_is_known_and_a_fixed_base_has_no_outputs_of_it(export_frame):
    fmu, k_v = export_frame(ground=SPRINGS), FRAME.m_t * (24 * np.pi) ** 2
    of_ground = ["N_left", "N_right", "N[2]", "pressure", "settlement", "contact", "E_foundation", "settlement_max", "t_N_max[2]"]
    with fmu.start(peaks=True) as free, fmu.start(detail=6, peaks=True) as fixed:
        known = free.get("k_v", "k_r", "f_v", "zeta_v", "y_s")
        assert known == pytest.approx([k_v, k_v * FRAME.B**2 / 3, 12, 0.1, -FRAME.m_t * FRAME.g / k_v], rel=1e-12)
        for instance in free, fixed:
            instance.set(a_g=3.0)
            instance.step(0.2)
        assert np.isfinite(free.get(*of_ground)).all() and np.isnan(fixed.get(*of_ground)).all()
        assert fixed.get("theta", "y", "uplift") == [0, 0, 0] and fixed.get("a_t_max[3]") > 1
    host = fmpy.simulate_fmu(fmu.path, fmi_type="ModelExchange", stop_time=0.2, start_values={"detail": 6}, output=["y", "N_left"])
    assert (host["y"] == 0).all() and np.isnan(host["N_left"]).all()


def test_an_oscillator_on_a_floor_is_the_structure_integrated_as_one(export_frame):
    """A mass on a spring at the second floor, until the first impact; the force over each step is a line."""
    p, k, M, until, steps = FRAME, 2e6, 8e3, 0.15, 3000

    def rates(_, y):
        u, u_dot, (theta, theta_dot, x, v) = y[:N], y[N:2 * N], y[2 * N:]
        sn, cs, d = np.sin(theta), np.cos(theta), p.B - u
        F = np.zeros(N)
        F[1] = k * (x - (p.B * (1 - cs) + u[1] * cs + p.h[1] * sn))
        f = p.elastic @ y[:2 * N]
        moment = (p.m * p.h @ f + theta_dot**2 * (p.B * p.S_1 - p.m * p.h @ u) + 2 * theta_dot * (p.m * d @ u_dot)
                  - (p.m_t * p.B - p.m @ u) * p.g * cs + F @ d * sn)
        theta_ddot = moment / (p.J0 + p.m0 * p.B**2 + p.m @ d**2)  # (M7)
        u_ddot = -f - p.h * theta_ddot - theta_dot**2 * d + p.g * sn + F * cs / p.m
        return [*u_dot, *u_ddot, theta_dot, theta_ddot, v, -F[1] / M]

    start = [*np.zeros(2 * N), 0.02, 0.0, 0.1, 0.0]
    exact = solve_ivp(rates, (0, until), start, method="DOP853", rtol=1e-12, atol=1e-14, dense_output=True).sol
    time, x, v, rows = np.linspace(0, until, steps + 1), 0.1, 0.0, []
    with export_frame().start(theta_0=0.02) as instance:
        for t0, t1 in zip(time[:-1], time[1:]):
            delta, floor_v = instance.reals(["delta_t[2]", "v_t[2]"])
            F, slope, h = k * (x - delta), k * (v - floor_v), t1 - t0
            instance.input("F_t[2]", F, slope)
            instance.step(t1)
            x, v = x + v * h - (F / 2 + slope * h / 6) * h**2 / M, v - (F + slope * h / 2) * h / M
            rows.append([*instance.reals(["theta", *floors("u")]), x])
        assert instance.get("transitions") == 0
    expected = exact(time[1:])[[2 * N, *range(N), 2 * N + 2]].T
    assert expected[:, 0].min() > 0
    peaks = np.abs(expected).max(axis=0)
    np.testing.assert_allclose(rows / peaks, expected / peaks, rtol=0, atol=1e-6)


def test_modes_left_out_and_what_is_fixed_are_told(export_frame):
    fmu = export_frame()
    with fmu.start() as instance:
        frequencies = instance.get(*floors("f"))
        np.testing.assert_allclose(frequencies, FRAME.omega / (2 * np.pi), rtol=1e-12)
        assert instance.get("m_t", "zeta[3]", "h[2]") == pytest.approx([FRAME.m_t, 0.02, 7.0], rel=1e-12)
    with fmu.instance() as instance, pytest.raises(FMICallException):
        instance.initialize(**{"f[1]": 3.0})
    assert fmu.description.variableNamingConvention == "structured"
    (of_a,) = [unknown for unknown in fmu.description.outputs if unknown.variable.name == "a_t[2]"]
    assert {known.name for known in of_a.dependencies} >= {"a_g", *floors("F_t", "q", "q_dot"), "theta"}
