"""The ports for coupling: the force on the top mass and what the structure exerts on the ground, against reference.py."""

import numpy as np
import pytest
import reference
from host import pacoima
from reference import MCMANUS, Load

NAMES = ("theta", "u", "a_t", "delta_t", "v_t", "R_h", "R_v", "R_m", "I_h", "I_v", "I_m")
STATE = ("u", "u_dot", "theta", "theta_dot")


@pytest.fixture(scope="module")
def solved(mcmanus):
    """Two seconds of Pacoima Dam with a neighbour that pulls at the top: the reference, the FMU's rows and what acts."""
    time, a_g = (series[:1000] for series in pacoima("pul164"))
    F_t = 120 * np.sin(7 * time)
    exact = reference.integrate(MCMANUS, time, a_g, F_t=F_t)
    with mcmanus.start() as instance:
        instance.set(a_g=a_g[0])
        rows = instance.follow(time, a_g, NAMES, F_t=F_t).view(np.recarray)
        events = instance.events
    return exact, rows, events, [Load(*acting) for acting in zip(time, a_g, 0 * time, F_t)]


def close(found, expected):
    assert np.max(np.abs(found - expected)) <= 1e-7 * np.max(np.abs(expected))


def test_motion_under_a_force(solved):
    exact, rows, events, loads = solved
    assert [event.kind for event in events] == [transition.kind for transition in exact.transitions]
    assert {"uplift", "impact", "landing"} <= {event.kind for event in events}
    for name in ("theta", "u", "delta_t", "v_t"):
        close(rows[name], getattr(exact, name))
    close(rows.a_t, exact.a_t + np.array([load.F_t for load in loads]) / MCMANUS.m * np.cos(exact.theta))
    without = reference.integrate(MCMANUS, exact.t, [load.a_g for load in loads])
    assert np.max(np.abs(without.theta - exact.theta)) > 0.1 * np.max(np.abs(exact.theta))


def test_reactions_are_those_of_the_free_bodies(solved):
    exact, rows, _, loads = solved
    states = np.column_stack([getattr(exact, name) for name in STATE])
    expected = np.array([reference.reactions(MCMANUS, *each) for each in zip(exact.phase, states, loads)])
    assert set(exact.phase) == {-1, 0, 1}
    for name, values in zip(("R_h", "R_v", "R_m"), expected.T):
        close(rows[name], values)


def test_impulses_are_the_momentum_lost_at_impacts(solved):
    exact, rows, _, _ = solved
    sums = np.cumsum([reference.impulses(MCMANUS, transition) for transition in exact.transitions], axis=0)
    so_far = np.searchsorted([transition.time for transition in exact.transitions], exact.t)
    for name, values in zip(("I_h", "I_v", "I_m"), np.vstack([np.zeros(3), sums])[so_far].T):
        close(rows[name], values)
    assert np.all(np.diff(rows.I_v) >= 0) and rows.I_v[-1] > 0
