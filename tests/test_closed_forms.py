"""The FMU against closed forms: full contact, energy between impacts, the laws of each transition, the outputs."""

from dataclasses import replace
from math import cos, exp, sin, sqrt

import numpy as np
import pytest
from host import REALS, pacoima
from reference import EVISON, MCMANUS

STATE = ("u", "u_dot", "theta", "theta_dot")


def damped_oscillator(p, time, a_g):
    """u at the samples of a_g, linear between them, by Eq 1 from rest: the exact solution from sample to sample.

    Under -a_g = -(a + b t) the particular solution is c0 + c1 t; what is left over oscillates freely.
    """
    omega, zeta = p.omega_fc, p.zeta_fc
    omega_d = omega * sqrt(1 - zeta**2)
    u, u_dot, history = 0.0, 0.0, [0.0]
    for t0, t1, a0, a1 in zip(time[:-1], time[1:], a_g[:-1], a_g[1:]):
        h, slope = t1 - t0, (a1 - a0) / (t1 - t0)
        c1 = -slope / omega**2
        c0 = (-a0 - 2 * zeta * omega * c1) / omega**2
        A = u - c0
        B = (u_dot - c1 + zeta * omega * A) / omega_d
        decay, c, s = exp(-zeta * omega * h), cos(omega_d * h), sin(omega_d * h)
        u = c0 + c1 * h + decay * (A * c + B * s)
        u_dot = c1 + decay * ((omega_d * B - zeta * omega * A) * c - (omega_d * A + zeta * omega * B) * s)
        history.append(u)
    return np.array(history)


@pytest.mark.parametrize(("tolerance", "limit"), [(None, 1e-6), (1e-11, 1e-9)], ids=["default", "1e-11"])
def test_full_contact(mcmanus, tolerance, limit):
    time, a_g = pacoima("pul164")
    a_g = 0.05 * a_g
    exact = damped_oscillator(MCMANUS, time, a_g)
    assert np.max(np.abs(exact)) < MCMANUS.u_cr, "the record is to leave the base down"
    with mcmanus.start(tolerance=tolerance) as instance:
        rows = instance.follow(time, a_g)
        assert instance.get("phase", "transitions") == [1, 0]
    assert np.max(np.abs(rows["u"] - exact)) <= limit * np.max(np.abs(exact))
    assert not rows["theta"].any() and not rows["theta_dot"].any()


def energy(p, side, u, u_dot, theta, theta_dot):
    """Mechanical energy while rocking about `side`, J, from its value at rest upright."""
    arm = side * p.B - u
    kinetic = 0.5 * p.m * ((u_dot + p.H * theta_dot) ** 2 + arm**2 * theta_dot**2)
    kinetic += 0.5 * (p.J0 + p.m0 * p.B**2) * theta_dot**2
    height = arm * np.sin(theta) - 2 * p.H * np.sin(theta / 2) ** 2
    return kinetic + 0.5 * p.k * u**2 + p.m * p.g * height + side * p.m0 * p.g * p.B * np.sin(theta)


RELEASE = dict(u_0=EVISON.u_cr, theta_0=0.04)


@pytest.mark.parametrize("undamped", [{"zeta_fc": 0.0}, {"c_ratio": 0.0}], ids=lambda undamped: next(iter(undamped)))
@pytest.mark.parametrize("tolerance", [1e-9, 1e-11])
def test_energy_is_kept_between_impacts_and_lost_by_the_formula_at_them(evison, undamped, tolerance):
    p = replace(EVISON, **undamped)
    names = (*STATE, "transitions")
    with evison.start(tolerance=tolerance, **RELEASE, **undamped) as instance:
        rows = []
        for instant in np.linspace(0, 1.5, 1501)[1:]:
            rows.append((*instance.reals(STATE), instance.get("transitions")))
            instance.load(0.0)
            instance.step(instant)
        events = instance.events
    rows = np.array(rows, dtype=[(name, float) for name in names])
    assert [event.kind for event in events] == 5 * ["impact"], "rocking on from side to side"
    scale = energy(p, 1, *(rows[name][0] for name in STATE))

    mean, side = [], 1
    for i in range(len(events) + 1):
        between = rows[rows["transitions"] == i]
        E = energy(p, side, *(between[name] for name in STATE))
        assert np.ptp(E) <= tolerance * scale, f"after {i} impacts E drifts by {np.ptp(E) / scale:.1e} of its start value"
        mean.append(np.mean(E))
        side = -side
    for i, event in enumerate(events):
        side = 1 if i % 2 == 0 else -1
        before = energy(p, side, event.u, event.u_dot_before, 0.0, event.theta_dot_before)
        after = energy(p, -side, event.u, event.u_dot_before, 0.0, p.r * event.theta_dot_before)
        assert mean[i] - mean[i + 1] == pytest.approx(before - after, abs=2 * tolerance * scale), f"loss at impact {i + 1}"


def angular_momentum(p, event):
    """About the pivot that comes down, just before."""
    u, u_dot, theta_dot = event.u, event.u_dot_before, event.theta_dot_before
    return p.m * p.H * (u_dot + p.H * theta_dot) - (p.m * (p.B**2 - u**2) + p.m0 * p.B**2 - p.J0) * theta_dot


def test_every_transition_follows_its_law(mcmanus):
    p = MCMANUS
    time, a_g = pacoima("pul254")
    with mcmanus.start() as instance:
        instance.follow(time, a_g)
        events = instance.events
    assert {event.kind for event in events} == {"uplift", "impact", "landing"}
    for event in events:
        if event.kind == "uplift":
            assert (event.u_dot, event.theta_dot) == (event.u_dot_before, 0.0), event
            s = np.sign(event.u)
            # (6) - H (5) at theta = theta_dot = 0
            moment = p.H * (p.c_u * event.u_dot + p.k * event.u) + p.m * p.g * event.u - s * (p.m + p.m0) * p.g * p.B
            assert abs(event.u) >= p.u_cr * (1 - 1e-9) and s * moment > 0, event
        elif event.kind == "impact":
            assert (event.u_dot, event.theta_dot) == (event.u_dot_before, p.r * event.theta_dot_before), event
            assert angular_momentum(p, event) * event.theta_dot_before > 0, event
        else:
            u_dot = event.u_dot_before + p.H * event.theta_dot_before
            assert (event.u_dot, event.theta_dot) == (pytest.approx(u_dot, rel=1e-14, abs=1e-15), 0.0), event
            assert angular_momentum(p, event) * event.theta_dot_before <= 0, event


def test_outputs_follow_from_the_state(evison):
    """c_ratio and J0 are not those of the specimen, so that c_u and c_fc differ."""
    p = replace(EVISON, c_ratio=0.5, J0=3.0)
    time, a_g = pacoima("pul164")
    with evison.start(c_ratio=p.c_ratio, J0=p.J0) as instance:
        for a0, a1, instant, until in zip(a_g[:-1], a_g[1:], time[:-1], time[1:]):
            instance.load(a0, (a1 - a0) / (until - instant))
            instance.step(until)
            o = dict(zip(REALS, instance.reals()))
            phase = instance.get("phase")
            s = {1: 0, 2: -1, 3: 1}[phase]
            assert s == np.sign(o["theta"])
            c = p.c_fc if phase == 1 else p.c_u
            a_t = p.g * sin(o["theta"]) - (c * o["u_dot"] + p.k * o["u"]) / p.m
            assert o["a_t"] == pytest.approx(a_t, rel=1e-12, abs=1e-12)
            assert o["V_t"] == pytest.approx(p.m * o["a_t"], rel=1e-14)
            assert o["M_t"] == pytest.approx(p.m * p.H * o["a_t"], rel=1e-14)
            assert o["uplift"] == pytest.approx(2 * p.B * sin(abs(o["theta"])), rel=1e-14)
            delta_t = s * p.B * 2 * sin(o["theta"] / 2) ** 2 + o["u"] * cos(o["theta"]) + p.H * sin(o["theta"])
            assert o["delta_t"] == pytest.approx(delta_t, rel=1e-12, abs=1e-15)
        assert instance.get("transitions") > 10


def test_output_derivatives_satisfy_the_equations_of_motion(evison):
    """Eqs 5 and 6 and the definition of a_t (Eq 27), with the accelerations that the FMU gives."""
    p = replace(EVISON, c_ratio=0.5, J0=3.0)
    time, a_g = pacoima("pul164")
    phases = set()
    with evison.start(c_ratio=p.c_ratio, J0=p.J0) as instance:
        references = [instance.fmu.variables[name].valueReference for name in STATE]
        for a0, a1, instant, until in zip(a_g[:-1], a_g[1:], time[:-1], time[1:]):
            instance.load(a0, (a1 - a0) / (until - instant))
            instance.step(until)
            a = a1
            u, u_dot, theta, theta_dot, a_t = instance.reals((*STATE, "a_t"))
            du, ddu, dtheta, ddtheta = instance.slave.getRealOutputDerivatives(references, [1] * 4)
            assert (du, dtheta) == (u_dot, theta_dot)
            phase = instance.get("phase")
            phases.add(phase)
            if phase == 1:
                assert a_t == pytest.approx(ddu + a, rel=1e-9, abs=1e-9)
                continue
            s = 1 if phase == 3 else -1
            arm = s * p.B - u
            assert a_t == pytest.approx(ddu + p.H * ddtheta + theta_dot**2 * arm + a * cos(theta), rel=1e-9, abs=1e-9)
            left = p.m * p.H * ddu + (p.J0 + p.m * p.H**2 + p.m * arm**2 + p.m0 * p.B**2) * ddtheta
            M = p.m + p.m0
            right = (2 * p.m * arm * u_dot * theta_dot + p.m * p.g * p.H * sin(theta) + p.m * p.g * u * cos(theta)
                     - s * M * p.g * p.B * cos(theta)
                     - a * (p.m * p.H * cos(theta) + (s * M * p.B - p.m * u) * sin(theta)))
            assert left == pytest.approx(right, rel=1e-9, abs=1e-9 * p.m * p.g * p.H)
    assert phases == {1, 2, 3}, "full contact and both sides are to be seen"
