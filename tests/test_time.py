"""Communication steps against an independent integration: how time is cut does not matter, overturning ends the run."""

from math import pi

import numpy as np
import pytest
import reference
from host import G, simulate
from reference import EVISON, MCMANUS

LOADS = {"constant": (0.2 * G, 0.0), "linear": (0.2 * G, -0.03 * G)}  # at t = 0, m/s2, and rate, m/s3


@pytest.mark.parametrize("load", LOADS)
@pytest.mark.parametrize("tolerance", [1e-9, 1e-11])
def test_one_step_or_ten_thousand(mcmanus, load, tolerance):
    """The same transitions and the same end, to the tolerance times 1e2, by which errors grow over the impacts here."""
    a0, slope = LOADS[load]
    with mcmanus.start(tolerance=tolerance) as one, mcmanus.start(tolerance=tolerance) as many:
        one.load(a0, slope)
        one.step(10.0)
        for i in range(10_000):
            many.load(a0 + slope * (0.001 * i), slope)
            many.step(0.001 * (i + 1))
        ends = [(*instance.get("phase", "transitions"), *instance.reals(("theta", "u"))) for instance in (one, many)]
        logs = [one.events, many.events]
    time = np.linspace(0, 10, 101)
    exact = reference.integrate(MCMANUS, time, a0 + slope * time)
    assert len(exact.transitions) > 15, "the load is to make it rock"
    for (phase, transitions, theta, u), events in zip(ends, logs):
        assert [event.kind for event in events] == [transition.kind for transition in exact.transitions]
        instants = [transition.time for transition in exact.transitions]
        np.testing.assert_allclose([event.time for event in events], instants, rtol=1e2 * tolerance)
        assert (phase, transitions, theta) == (1, len(exact.transitions), 0.0), "at rest on both edges after 10 s"
        assert u == pytest.approx(exact.u[-1], abs=1e2 * tolerance * MCMANUS.u_cr)


@pytest.fixture(scope="module")
def overturning():
    """Evison's specimen under half of gravity, on and on, by the reference: it lifts and does not come back."""
    time = np.linspace(0, 2, 201)
    response = reference.integrate(EVISON, time, np.full_like(time, 0.5 * G))
    assert response.transitions[-1].kind == "overturned"
    return response.transitions[-1]


def test_fmpy_ends_the_run_at_overturning_and_keeps_the_results(evison, overturning):
    load = np.array([(0.0, 0.5 * G), (2.0, 0.5 * G)], dtype=[("time", float), ("a_g", float)])
    result, events = simulate(evison, stop_time=2.0, output_interval=0.01, input=load,
                              output=["theta", "theta_dot", "overturned", "phase"])
    before = int(overturning.time / 0.01)
    assert len(result) == before + 2, "every sample before, and the instant itself"
    assert result["time"][-1] == pytest.approx(overturning.time, rel=1e-8)
    assert result["theta"][-1] == pytest.approx(-pi / 2, abs=1e-8)
    assert result["theta_dot"][-1] == pytest.approx(overturning.after[3], rel=1e-8)
    assert not result["overturned"][:-1].any() and result["overturned"][-1]
    assert set(result["phase"][:-1]) <= {1, 2, 3} and result["phase"][-1] == 4
    assert [event.kind for event in events] == ["uplift", "overturning"]
