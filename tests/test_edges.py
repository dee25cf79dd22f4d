"""The edges of the parameters' ranges and 100 g, at every level of detail, against the independent integration."""

from dataclasses import asdict, replace
from math import pi

import numpy as np
import pytest
import reference
from host import DISCARD, G, status
from reference import EVISON

LEVELS = {"auto": 1, "nonlinear": 2, "linear": 3, "modal": 4, "rigid": 5, "fixed_base": 6}


def ground(load, t):
    return load.a_g + load.a_g_rate * (t - load.t0)


def linear_rocking(p, s, load):
    """Eqs 7 and 8, solved for the accelerations."""
    gamma, inertia = (p.m + p.m0) / p.m, (p.J0 + p.m0 * p.B**2) / p.m + p.B**2

    def rates(t, y):
        u, u_dot, theta, theta_dot = y.tolist()
        elastic = p.c_u / p.m * u_dot + p.omega_fc**2 * u
        # (8) - H (7)
        theta_ddot = (p.H * elastic + p.g * u - s * gamma * p.g * p.B) / inertia
        return [u_dot, -ground(load, t) - elastic + p.g * theta - p.H * theta_ddot, theta_dot, theta_ddot]

    return rates


def vibration_mode(p):
    """1 - chi, without the digits that chi has lost; omega_u and zeta_u of Eq 18."""
    rest = (p.J0 + (p.m + p.m0) * p.B**2) / p.J_P
    return rest, p.omega_fc / rest**0.5, p.c_u / (2 * (p.k * p.m * rest) ** 0.5)


def modal_rocking(p, s, load):
    """Eqs 11 and 18, and 16 differentiated twice."""
    rest, omega_u, zeta_u = vibration_mode(p)

    def rates(t, y):
        u, u_dot, theta, theta_dot = y.tolist()
        a_g = ground(load, t)
        u_ddot = -2 * zeta_u * omega_u * u_dot - omega_u**2 * u - a_g + s * p.chi / rest * p.g * p.tan_alpha_cg
        q_r = theta + p.p_l**2 / p.g * u
        q_r_ddot = p.p_l**2 * (q_r - a_g / p.g - s * p.tan_alpha_cg)
        return [u_dot, u_ddot, theta_dot, q_r_ddot - p.p_l**2 / p.g * u_ddot]

    return rates


def modal_uplift_margin(p, s):
    """s theta_ddot at theta = theta_dot = 0 by Eqs 11, 16 and 18, over p_l^2/g."""
    rest, omega_u, zeta_u = vibration_mode(p)
    return s * (p.p_l**2 + omega_u**2), s * 2 * zeta_u * omega_u, -p.g * p.tan_alpha_cg / rest


def rigid_rocking(p, s, load):
    """Eq 6 with u = 0."""

    def rates(t, y):
        theta, theta_dot = y.tolist()[2:]
        sn, cs, a_g, M = np.sin(theta), np.cos(theta), ground(load, t), p.m + p.m0
        moment = p.m * p.g * p.H * sn - s * M * p.g * p.B * cs - a_g * (p.m * p.H * cs + s * M * p.B * sn)
        return [0.0, 0.0, theta_dot, moment / p.J_P]

    return rates


#: What the independent integration goes by at each level.
EQUATIONS = {
    "linear": dict(rocking=linear_rocking), "modal": dict(rocking=modal_rocking, uplift_margin=modal_uplift_margin),
    "rigid": dict(rocking=rigid_rocking, impact=lambda p, s, y: ("impact", -s, np.array([0.0, 0.0, 0.0, p.r * y[3]]))),
    "fixed_base": dict(lifts=lambda *_: False, _first_uplift=lambda *_: None),
}


@pytest.fixture
def compare(evison, monkeypatch):
    """Runs both; the largest distance of theta and u over their peaks, or of an overturning's instant, is below `limit`."""

    def compare(level, p, time, a_g, initial, limit):
        for name, of_level in EQUATIONS.get(level, {}).items():
            monkeypatch.setattr(reference, name, of_level)
        exact = reference.integrate(p, time, a_g, initial)
        kinds = [transition.kind.replace("overturned", "overturning") for transition in exact.transitions]
        overturns = kinds[-1:] == ["overturning"]
        count = len(exact.t) - overturns
        values = asdict(p) | dict(zip(("u_0", "u_dot_0", "theta_0", "theta_dot_0"), initial))
        with evison.start(tolerance=1e-11, detail=LEVELS[level], **values) as instance:
            rows = instance.follow(time[:count], a_g[:count])
            assert all(np.isfinite(rows[name]).all() for name in rows.dtype.names)
            if overturns:
                instance.input("a_g", a_g[count - 1], (a_g[count] - a_g[count - 1]) / (time[count] - time[count - 1]))
                assert status(instance.step, time[count]) == DISCARD
                assert instance.events[-1].time == pytest.approx(exact.transitions[-1].time, rel=limit)
            assert [event.kind for event in instance.events] == kinds
        for name in ("theta", "u"):
            expected = getattr(exact, name)
            np.testing.assert_allclose(rows[name], expected[:count], rtol=0, atol=limit * np.abs(expected).max(), err_msg=name)
        return kinds

    return compare


CORNERS = {
    "H/B = 50": dict(H=14.25),
    "f_fc = 1e-3 Hz": dict(f_fc=1e-3),
    "f_fc = 1e4 Hz": dict(f_fc=1e4),
    "m0 = 0": dict(m0=0.0),
    "m0 = 0, f_fc = 1 Hz": dict(m0=0.0, f_fc=1.0),
    "J0 large": dict(J0=1e5),
    "r = 1": dict(r=1.0),
    "zeta = 0": dict(zeta_fc=0.0),
    "zeta = 0.99": dict(zeta_fc=0.99),
}


@pytest.mark.parametrize("corner", CORNERS)
@pytest.mark.parametrize("level", LEVELS)
def test_corners(compare, level, corner):
    """Falls back from a small angle (in full contact on a fixed base) and is shaken, over up to 600 rad of vibration."""
    p = replace(EVISON, **CORNERS[corner])
    duration = 1.0 if level == "rigid" else min(1.0, 600 / vibration_mode(p)[1])
    time = np.linspace(0, duration, 41)
    a_g = 1.5 * G * p.tan_alpha_cg * np.sin(2 * pi * 3 * time / duration)
    theta = 0.0 if level == "fixed_base" else p.tan_alpha_cg * min(1e-3, (0.2 * p.p_l * duration) ** 2)
    u = 0.0 if level == "rigid" else min(0.5 * p.u_cr, 0.1 * p.B)
    # theta is rounded to 1e-16 of tan alpha at the modal level, which decides instants: at 2e5 rad/s u feels it
    limit = 1e-7 if p.f_fc == 1e4 else 1e-8
    assert compare(level, p, time, a_g, (u, 0.0, theta, 0.0), limit) or level == "fixed_base"


@pytest.mark.parametrize("level", LEVELS)
def test_100_g(compare, level):
    """One pulse and back: all levels overturn but the fixed base."""
    time = np.linspace(0, 0.2, 21)
    a_g = -100 * G * np.sin(2 * pi * time / 0.2)
    theta = 1e-3 if level == "rigid" else 0.0
    kinds = compare(level, EVISON, time, a_g, (0.0, 0.0, theta, 0.0), 1e-8)
    assert kinds[-1:] == ([] if level == "fixed_base" else ["overturning"])
