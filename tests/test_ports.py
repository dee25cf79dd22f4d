"""The ports for coupling: the force on the top mass and what the structure exerts on the ground, against reference.py."""

from dataclasses import fields

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


def test_a_force_of_zero_changes_no_bit(mcmanus):
    time, a_g = (series[:1000] for series in pacoima("pul164"))
    with mcmanus.start() as alone, mcmanus.start() as coupled:
        assert np.array_equal(alone.follow(time, a_g, NAMES), coupled.follow(time, a_g, NAMES, F_t=0 * time))


@pytest.mark.parametrize("detail", range(1, 7))
def test_directional_derivatives_are_exact_in_every_phase(mcmanus, detail):
    """The outputs are affine in the inputs: a difference over any change is their derivative."""
    outputs = ("a_t", "V_t", "M_t", "R_h", "R_v", "R_m", "theta", "v_t")
    seen = set()
    time, a_g = pacoima("pul164")
    with mcmanus.instance() as instance:
        instance.slave.setInteger([mcmanus.variables["detail"].valueReference], [detail])
        instance.initialize()
        references = {name: mcmanus.variables[name].valueReference for name in ("a_g", "F_t", *outputs)}
        for t0, t1, a0, a1 in zip(time[:600], time[1:], a_g, a_g[1:]):
            instance.load(a0, (a1 - a0) / (t1 - t0))
            instance.step(t1)
            phase = instance.get("phase")
            if phase in seen and round(t1 / (t1 - t0)) % 50:
                continue
            seen.add(phase)
            for known, change in (("a_g", 3.0), ("F_t", 500.0)):
                before, here = np.array(instance.reals(outputs)), instance.get(known)
                instance.set(**{known: here + change})
                slope = (np.array(instance.reals(outputs)) - before) / change
                instance.set(**{known: here})
                found = instance.slave.getDirectionalDerivative([references[name] for name in outputs], [references[known]], [1.0])
                np.testing.assert_allclose(found, slope, rtol=1e-9, atol=1e-11)
                for name, value in zip(outputs, found):
                    # that of a_g to a_t, V_t, M_t is the rigid level's alone
                    feeds = name in outputs[3:6] or name in outputs[:3] and (known == "F_t" or detail == 5)
                    assert feeds or value == 0.0, name
            if phase == 1 and detail != 5:
                at = dict(zip(outputs, found))
                assert at["a_t"] == pytest.approx(1 / MCMANUS.m, rel=1e-12)
                assert at["R_h"] == pytest.approx(0, abs=1e-12)
    assert seen == ({1} if detail == 6 else {1, 2, 3})
