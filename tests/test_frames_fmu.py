"""The FMU of a structure of many masses in fmpy, against independent integrations and against the FMU of one mass."""

import functools
import json
import re
from dataclasses import replace
from pathlib import Path

import fmpy
import frames_reference
import numpy as np
import pandas as pd
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu
from frames import FRAMES, Ties, scene, ties_of, toml
from host import Fmu, output, simulate, write
from test_ground import MCMANUS, record

FRAME, N = FRAMES["frame"], 3


@pytest.fixture(scope="module")
def export_frame(export, tmp_path_factory):
    """The FMU of the shear frame `frame`, held down by `ties`, on `ground`, with records of time, a_g and a_v inside, and their files."""

    def run(frame=FRAME, ties=Ties(), time=None, a_g=None, a_v=None, fmi=2, ground=""):
        folder = tmp_path_factory.mktemp("frame")
        (folder / "frame.toml").write_text(toml(frame, ties, ground))
        records = [f"--{name}={write(folder / name, 'm/s2', time, a)}" for name, a in (("record", a_g), ("record-v", a_v)) if a is not None]
        options = [f"--parameters={folder}/frame.toml", *records]
        return export(None, None, *options, fmi=fmi), options

    return run


def floors(*names):
    return [f"{name}[{i}]" for name in names for i in range(1, N + 1)]


SPRINGS = "f_v = 12\nzeta_v = 0.1\nn_points = 3"
MOVES = "f_v = 12\nzeta_v = 0.1\nn_points = 11\nmu_c = 0.25\nfs = 3"
INTERFACES = [(fmi, kind) for fmi in (2, 3) for kind in ("CoSimulation", "ModelExchange")]


@functools.cache
def exact_response(tied):
    return frames_reference.simulate(*scene("frame", "El Centro", tied))


@pytest.mark.parametrize("fmi, kind, tied, ground", [
    *((*interface, tied, "") for interface in INTERFACES for tied in (False, True)),
    *((*interface, tied, SPRINGS) for interface, tied in zip(INTERFACES, (False, False, True, True))),
    *((*interface, tied, MOVES) for interface, tied in zip(INTERFACES, (True, False, False, True))),
], ids=lambda of: {SPRINGS: "springs", MOVES: "slides and settles"}.get(of, str(of)))
def test_the_fmu_moves_as_the_librarys_run_and_as_the_physical_equations_say(exporter, export_frame, fmi, kind, tied, ground):
    """All outputs at the samples to 1e-12 of the peak of each, up to the last sample, at which the ground stops; on rigid ground θ, and u
    and a of every floor, to 1e-9 of the peaks. To 1e-4 and 1e-5 with fmpy's integrator. Peaks to 1e-8 of the run's."""
    frame, dt, a_g, a_v, ties = scene("frame", "El Centro", tied)
    time, is_exact = dt * np.arange(len(a_g)), kind == "CoSimulation"
    fmu, options = export_frame(frame, ties, time, a_g, a_v if tied else None, fmi, ground)
    assert validate_fmu(fmu.path) == []
    table = Path(fmu.path).with_name("response.csv")
    told = json.loads(output(exporter, "--quiet", "simulate", *options, "--format", "json", f"--duration={time[-1]}", "--tolerance=1e-12",
                             "-o", table))
    expected = pd.read_csv(table)
    columns = {name.rpartition("[")[0]: name for name in expected}
    outputs = [of.variable.name for of in fmu.description.outputs if not of.variable.name.startswith("I_")]
    columns = {name: columns[name] for name in outputs if name in columns}
    assert len(columns) > 25 and (not ground or {"N_left", "N_right", "settlement", "contact"} <= set(columns))
    assert ground != MOVES or {"x", "x_dot", "slip_path", "E_friction", "settled", "tilt", "E_plastic", "s[11]"} <= set(columns)
    peaks = [*floors("u_max", "a_t_max"), "theta_max", "V_t_max", "M_t_max", *["x_max"] * (ground == MOVES)]
    found = fmpy.simulate_fmu(fmu.path, fmi_type=kind, stop_time=time[-1], output_interval=dt, start_values={"peaks": True},
                              output=[*columns, *peaks, "transitions"], relative_tolerance=1e-12 if is_exact else 1e-9)
    found = found[np.searchsorted(found["time"], time - 1e-9)]
    assert found["transitions"][-1] == told["transitions"] > 5
    for name, column in columns.items():
        values = expected[column][:-1]
        limit = (1e-12 if is_exact else 1e-4) * np.abs(values).max()
        np.testing.assert_allclose(found[name][:-1], values, rtol=0, atol=limit, err_msg=name)
    if is_exact:
        run = {of["name"]: of["peak"] for of in told["peaks"]}
        np.testing.assert_allclose([found[name][-1] for name in peaks], [run[name.replace("_max", "")] for name in peaks], rtol=1e-8)
    if not ground:
        exact = exact_response(tied)
        assert told["transitions"] == len(exact.transitions)
        for name, column in zip(["theta", *floors("u", "a_t")], np.column_stack([exact.theta, exact.u, exact.a]).T, strict=True):
            limit = (1e-9 if is_exact else 1e-5) * np.abs(column).max()
            np.testing.assert_allclose(found[name], column, rtol=0, atol=limit, err_msg=name)


def test_ground_is_known_and_a_fixed_base_has_no_outputs_of_it(export_frame):
    (fmu, _), k_v = export_frame(ground=SPRINGS), FRAME.m_t * (24 * np.pi) ** 2
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


def over_one_fmu(export_frame, fmi, cases) -> Fmu:
    """The FMU of a frame on springs, over which values that a host sets give the bits of an FMU that was exported with them: the motion, and
    all that is calculated."""
    base, _ = export_frame(ground=springs(5e8), fmi=fmi)
    calculated = [of.name for of in base.description.modelVariables if of.causality == "calculatedParameter"]
    names = [*calculated, "theta", "y", "P_t", "V_t", *floors("u", "a_t"), "P_t_max", "N_left", "x", "s[3]"]

    def moved(instance):
        instance.set(a_g=6.0)
        instance.step(0.1)
        instance.set(a_g=-5.0)
        instance.step(0.4)
        return instance.get(*names)

    for values, (frame, ties, ground) in cases:
        exported, _ = export_frame(frame, ties, ground=ground, fmi=fmi)
        with base.start(peaks=True, **values) as one, exported.start(peaks=True) as other:
            np.testing.assert_array_equal(moved(one), moved(other), err_msg=str(values))
    return base


def springs(k_v: float, others: str = "zeta_v = 0.1", mu_c: float = 0.4, fs: float = 5.0) -> str:
    return f"k_v = {k_v!r}\n{others}\nn_points = 3\nmu_c = {mu_c}\nfs = {fs}"


def softer(k: float, **others):
    """The frame with this stiffness of its second storey."""
    return replace(FRAME, stiffness=(FRAME.stiffness[0], k, FRAME.stiffness[2]), **others)


@pytest.mark.parametrize("fmi", (2, 3))
def test_numbers_that_a_host_sets_are_those_that_an_export_has(export_frame, fmi):
    """To the last bit. A refusal names the number."""
    taller = replace(FRAME, masses=(5e4, *FRAME.masses[1:]), heights=(*FRAME.heights[:2], 11.5), zeta=0.03)
    base = over_one_fmu(export_frame, fmi, [
        ({"B": 1.7}, (replace(FRAME, B=1.7), Ties(), springs(5e8))), ({"k[2]": 3e7}, (softer(3e7), Ties(), springs(5e8))),
        ({"m[1]": 5e4, "h[3]": 11.5, "zeta": 0.03}, (taller, Ties(), springs(5e8))),
        ({"k_v": 7e8, "zeta_v": 0.3, "kr_ratio": 0.5}, (FRAME, Ties(), springs(7e8, "zeta_v = 0.3\nkr_ratio = 0.5"))),
        ({"mu_c": 0.1, "fs": 1.2}, (FRAME, Ties(), springs(5e8, mu_c=0.1, fs=1.2))),
        ({"P_0": 4e5, "k_t": 1e6}, (FRAME, Ties(P_0=4e5, k_t=1e6), springs(5e8)))])
    with base.instance() as instance:
        with pytest.raises(FMICallException):
            instance.initialize(**{"h[2]": 3.0})
        assert "floor 2 is at h = 3 m and the floor below it at 3.5 m" in instance.messages[-1].text


@pytest.mark.parametrize("fmi", (2, 3))
def test_derivatives_by_numbers_of_a_building_on_springs_are_their_differences(export_frame, fmi):
    """While the base rocks on some of its points: of what is calculated, of accelerations and of forces."""
    fmu, _ = export_frame(ties=Ties(P_0=4e5, k_t=1e6), ground="k_v = 5e8\nzeta_v = 0.1\nn_points = 3", fmi=fmi)
    at = dict(zip(floors("u_0", "u_dot_0"), (1e-3, 2e-3, -1e-3, 0.1, -0.2, 0.3))) | {"theta_0": 0.01, "theta_dot_0": 0.1}
    unknowns = ["f[1]", "f_u[2]", "y_s", "chi[1]", "alpha_cg", "der(theta_dot)", "der(y_dot)", *floors("a_t"), "M_t", "P_t", "N_left", "N_right", "R_v"]
    with fmu.instance() as instance:
        instance.enter(**at)
        for name in ("B", "k[2]", "m[1]", "h[3]", "zeta", "k_v", "zeta_v", "kr_ratio", "P_0"):
            value, found = instance.get(name), instance.derive(unknowns, (name, 1.0))
            ends = []
            for change in (1e-5, -1e-5):
                with fmu.instance() as beside:
                    ends.append(np.array(beside.enter(**at, **{name: value * (1 + change)}).get(*unknowns)))
            expected, scale = (ends[0] - ends[1]) / (2e-5 * value), (np.abs(ends[0]) + np.abs(ends[1])) / value
            assert (np.abs(found - expected) <= 1e-6 * scale).all() and expected.any(), (name, found, expected)


def test_a_pier_has_its_names_and_its_parameters_on_springs(export, tmp_path):
    (tmp_path / "pier.toml").write_text("m = 130.1\nm0 = 65.4\nH = 1.84\nB = 0.285\nJ0 = 10.7\nf_fc = 5\nzeta_fc = 0.02\n[ground]\nf_v = 12\n")
    for fmi in 2, 3:
        fmu = Fmu(export(None, None, "--parameters", tmp_path / "pier.toml", fmi=fmi).path)
        states = [of.derivative.name for of in fmu.description.modelVariables if of.derivative]
        assert states == ["u", "y", "u_dot", "y_dot", "theta", "theta_dot"]
        with fmu.start(H=1.9, f_fc=4.0, f_v=20.0) as instance:
            instance.set(a_g=4.0)
            instance.step(0.2)
            theta, u, a_t, V_t, M_t, N_left, N_right = instance.get("theta", "u", "a_t", "V_t", "M_t", "N_left", "N_right")
            assert abs(theta) > 1e-3 and abs(u) > 1e-4 and N_left * N_right == 0
            assert (V_t, M_t) == pytest.approx((130.1 * a_t, 130.1 * 1.9 * a_t), rel=1e-12)


def test_forces_on_floors_accelerate_as_the_physical_equations_say(export_frame):
    """While the base rocks; and over a step from rest."""
    p, F, theta, theta_dot = FRAME, np.array([3e4, -2e5, 1e5]), 0.02, 0.3
    fmu, _ = export_frame()
    with fmu.start("ModelExchange", theta_0=theta) as one:

        def displaced(q):
            one.set_states([*q, *np.zeros(N), theta, theta_dot])
            return one.get(*floors("u"))

        phi, u = np.column_stack([displaced(q) for q in np.eye(N)]), np.array(displaced([0.5, -0.2, 0.1]))
        one.set(**dict(zip(floors("F_t"), F)))
        rates = np.array(one.derivatives())
    sn, cs, d, f = np.sin(theta), np.cos(theta), p.B - u, p.elastic @ np.append(u, np.zeros(N))
    moment = p.m * p.h @ f + theta_dot**2 * (p.B * p.S_1 - p.m * p.h @ u) - (p.m_t * p.B - p.m @ u) * p.g * cs + F @ d * sn
    theta_ddot = moment / (p.J0 + p.m0 * p.B**2 + p.m @ d**2)  # (M7)
    u_ddot = -f - p.h * theta_ddot - theta_dot**2 * d + p.g * sn + F * cs / p.m
    assert [*(phi @ rates[N:2 * N]), rates[-1]] == pytest.approx([*u_ddot, theta_ddot], rel=1e-11)
    with fmu.start() as one:
        one.input("F_t[2]", 0.0, 1e9)  # N/s
        one.step(1e-4)
        assert one.get(*floors("u")) == pytest.approx([0, 1e9 * 1e-12 / (6 * p.m[1]), 0], rel=1e-2, abs=1e-11)


def test_modes_left_out_and_what_is_fixed_are_told(export_frame):
    fmu, _ = export_frame()
    with fmu.start() as instance:
        frequencies = instance.get(*floors("f"))
        np.testing.assert_allclose(frequencies, FRAME.omega / (2 * np.pi), rtol=1e-12)
        assert instance.get("m_t", "zeta[3]", "h[2]") == pytest.approx([FRAME.m_t, 0.02, 7.0], rel=1e-12)
    with fmu.instance() as instance, pytest.raises(FMICallException):
        instance.initialize(**{"f[1]": 3.0})
    assert fmu.description.variableNamingConvention == "structured"
    (of_a,) = [unknown for unknown in fmu.description.outputs if unknown.variable.name == "a_t[2]"]
    assert {known.name for known in of_a.dependencies} >= {"a_g", *floors("F_t", "q", "q_dot"), "theta"}


BOTH = "f_v = 40\nzeta_v = 0.2\nmu_c = 0.2\nfs = 2"


@pytest.mark.parametrize("fmi", (2, 3))
def test_amid_a_slip_and_a_settlement_rates_are_known_and_a_state_goes_on_to_the_same_bits(export_frame, fmi):
    """Friction is mu_c N against the slip, a point settles by (f - q)/c; a base to which a host gives a velocity slides."""
    dt, a_g, _ = record("imperialValley_elCentro_1940", 150, 150, 0.7)
    fmu, _ = export_frame(MCMANUS, time=dt * np.arange(len(a_g)), a_g=a_g, fmi=fmi, ground=BOTH)
    states = [of.derivative.name for of in fmu.description.modelVariables if of.derivative]
    assert states == ["q[1]", "y", "x", "q_dot[1]", "y_dot", "x_dot", "theta", "theta_dot", "s[1]", "s[2]"]
    shown = ["x", "x_dot", "theta", "s[1]", "s[2]", "slip_path", "E_friction", "E_plastic", "E_foundation", "R_h", "transitions"]
    with fmu.start() as one, fmu.start() as other:
        for name, until in ("x_dot", 0.63), ("der(s[1])", 0.8075):
            one.step(until)
            before = one.get(*shown)
            x_dot, N, s_dot = one.get("x_dot"), sum(one.get("N_left", "N_right")), np.array(one.get("der(s[1])", "der(s[2])"))
            assert one.get(name) != 0 and (name == "x_dot") == (x_dot != 0)
            if x_dot:
                assert one.get("R_h") == pytest.approx(np.sign(x_dot) * 0.2 * N, rel=1e-12)
                assert one.derivative("der(x_dot)", "a_g") == pytest.approx(-1, rel=1e-12)
            q = FRAME.g * MCMANUS.m_t  # fs / 2 of all
            expected = [x_dot, *s_dot, abs(x_dot), 0.2 * N * abs(x_dot), q * s_dot.sum()]
            names = ["x", "s[1]", "s[2]", "slip_path", "E_friction", "E_plastic"]
            assert [one.rate(of) for of in names] == pytest.approx(expected, rel=1e-12, abs=1e-15)
            state = other.slave.deserializeFMUState(one.bytes())
            other.slave.setFMUState(state)
            other.slave.freeFMUState(state)
            other.time = until
            assert other.get(*shown) == before
            for instance in one, other:
                instance.step(until + 0.1)
            assert one.get(*shown) == other.get(*shown) != before
    with fmu.start("ModelExchange") as one:
        (sticks, R_h), states = one.get("der(x_dot)", "R_h"), one.states()
        states[5] = -0.1
        one.set_states(states)
        assert sticks == 0 and abs(R_h) < 0.1 * FRAME.g * MCMANUS.m_t
        assert one.complete() == (False, False) and one.derivatives()[5] > 0
        assert one.get("R_h") == pytest.approx(-0.2 * FRAME.g * MCMANUS.m_t, rel=1e-12)


# Structure, what ties it down, scales of El Centro along and up, ground.
KINDS = {
    "one mass": (MCMANUS, Ties(), 0.7, 0, "f_v = 40\nzeta_v = 0.2"),
    "one mass on a bed": (MCMANUS, Ties(), 0.35, 0, "f_v = 40\nzeta_v = 0\nn_points = 5"),
    "tied": (MCMANUS, ties_of(MCMANUS, 0.1), 1.4, 0, "f_v = 40\nzeta_v = 0.2"),
    "one mass that slides": (MCMANUS, Ties(), 0.7, 0, "f_v = 40\nzeta_v = 0.2\nmu_c = 0.2"),
    "one mass that settles": (MCMANUS, Ties(), 0.7, 0, "f_v = 40\nzeta_v = 0\nfs = 3"),
    "one mass that slides and settles": (MCMANUS, Ties(), 0.8, 0, BOTH),
    "storeys that slide": (FRAME, Ties(), 2, 2, "f_v = 12\nzeta_v = 0.1\nmu_c = 0.3"),
    "thrown up": (MCMANUS, Ties(), 0, 8, "f_v = 20\nzeta_v = 0.2"),
    "storeys": (FRAME, Ties(), 1.6, 0, "f_v = 12\nzeta_v = 0.1"),
    "storeys on a bed": (FRAME, Ties(), 1.6, 0, "f_v = 12\nzeta_v = 0.1\nn_points = 5"),
    "storeys, tied, on rigid ground": (FRAME, ties_of(FRAME, 0.1), 1.6, 0, ""),
}
EVENTS, MODEL = dict(use_event_mode=True, early_return_allowed=True), dict(fmi_type="ModelExchange")
EULER = MODEL | dict(solver="Euler", step_size=1e-4, output_interval=1e-4)


def told(fmu, names, **asked):
    """Instants and kinds of the transitions in the log, and a function: the values of `names` that a host has from an instant on."""
    rows, log = simulate(fmu, output=names, **asked)
    found = [re.match(r"t = (\S+) s: ([^;]+); .*theta_dot", message.text) for message in log]
    times, kinds = zip(*((float(of[1]), of[2]) for of in found if of))
    values = np.column_stack([rows[name] for name in names])
    return np.array(times), kinds, lambda instants: values[np.searchsorted(rows["time"], instants + 1e-9, side="right") - 1]


@pytest.mark.parametrize("kind", KINDS)
def test_every_interface_tells_the_same_transitions(export_frame, kind):
    """Kinds, instants, and phase and contact at the samples. After event mode the host sees the transitions of that instant, all of them."""
    frame, ties, along, up, ground = KINDS[kind]
    dt, a_g, a_v = record("imperialValley_elCentro_1940", 150, 150, 1)
    time = dt * np.arange(len(a_g))
    two, three = (export_frame(frame, ties, time, along * a_g, up * a_v, fmi, ground)[0] for fmi in (2, 3))
    names = ["transitions", "phase", *["contact"] * bool(ground)]
    asked = dict(names=names, stop_time=time[-1], output_interval=dt)
    times, kinds, seen = told(two, **asked)
    assert len(kinds) == seen(time)[-1, 0] > 3
    for fmu, how, limit in [(three, {}, 1e-12), (three, EVENTS, 1e-12), (three, EVENTS | dict(output_interval=0.37 * dt), 1e-12),
                            (two, MODEL, 1e-6), (three, MODEL, 1e-6), (two, EULER, 1e-2)]:
        found, found_kinds, found_seen = told(fmu, **asked | how)
        assert found_kinds == kinds, how
        np.testing.assert_allclose(found, times, rtol=0, atol=limit)
        assert how is EULER or np.array_equal(found_seen(time), seen(time)), how
        if "use_event_mode" in how:
            np.testing.assert_array_equal(found_seen(found)[:, 0], np.searchsorted(found, found + 1e-9))
