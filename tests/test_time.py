"""Communication steps: how time is cut does not matter, wrong times are refused, overturning ends the run."""

from math import pi

import numpy as np
import pytest
import reference
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import fmi2DoStepStatus, fmi2LastSuccessfulTime, fmi2Terminated
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


def test_without_a_slope_the_input_is_held(mcmanus):
    with mcmanus.start() as held, mcmanus.start() as constant:
        held.load(1.0, 50.0)
        held.step(0.01)
        held.load(1.0)
        constant.load(1.0, 50.0)
        constant.step(0.01)
        constant.slave.setReal([constant.fmu.variables["a_g"].valueReference], [1.0])
        for instance in (held, constant):
            instance.step(0.02)
        assert held.reals() == constant.reals()


REFUSED = {
    "behind": (0.05, 0.01, ("currentCommunicationPoint = 0.05 s", "t = 0.1 s")),
    "ahead": (0.2, 0.01, ("currentCommunicationPoint = 0.2 s", "t = 0.1 s")),
    "zero step": (0.1, 0.0, ("communicationStepSize = 0 s", "positive")),
    "negative step": (0.1, -0.01, ("communicationStepSize = -0.01 s", "positive")),
    "not a number": (0.1, float("nan"), ("communicationStepSize = NaN s",)),
    "infinite": (0.1, float("inf"), ("communicationStepSize = inf s",)),
    "past the stop time": (0.1, 0.5, ("0.6", "stopTime = 0.5 s")),
}


@pytest.mark.parametrize("case", REFUSED)
def test_a_wrong_step_is_refused_and_changes_nothing(mcmanus, case):
    point, size, words = REFUSED[case]
    with mcmanus.start(stop_time=0.5) as instance:
        instance.load(2.0, 10.0)
        instance.step(0.1)
        before = instance.reals()
        with pytest.raises(FMICallException, match="fmi2DoStep failed with status 3"):
            instance.slave.doStep(point, size)
        (message,) = instance.errors
        for word in words:
            assert word in message
        assert instance.reals() == before
        instance.step(0.5)
        assert instance.reals() != before


def test_a_stop_time_met_to_rounding_is_met(mcmanus):
    """fmpy counts 0.1 + 0.1 + 0.1 as 0.30000000000000004."""
    assert 3 * 0.1 > 0.3
    result, _ = simulate(mcmanus, stop_time=0.3, output_interval=0.1, output=["theta"])
    assert result["time"].tolist() == [0, 0.1, 0.2, 3 * 0.1]


def test_time_may_start_anywhere(mcmanus):
    with mcmanus.start() as at_zero, mcmanus.start(start_time=-7.0) as earlier:
        for instance in (at_zero, earlier):
            instance.load(0.2 * G)
            instance.step(instance.time + 1.0)
        assert at_zero.get("transitions") == earlier.get("transitions") > 0
        for event, same in zip(at_zero.events, earlier.events):
            assert same.time + 7.0 == pytest.approx(event.time, abs=1e-9)


@pytest.fixture(scope="module")
def overturning():
    """Evison's specimen under half of gravity, on and on, by the reference: it lifts and does not come back."""
    time = np.linspace(0, 2, 201)
    response = reference.integrate(EVISON, time, np.full_like(time, 0.5 * G))
    assert response.transitions[-1].kind == "overturned"
    return response.transitions[-1]


def test_overturning_is_a_discarded_step_that_terminates(evison, overturning):
    with evison.start(tolerance=1e-11) as instance:
        instance.load(0.5 * G)
        with pytest.raises(FMICallException, match=r"status 2 \(discard\)"):
            instance.step(2.0)
        assert instance.slave.getBooleanStatus(fmi2Terminated)
        instant = instance.slave.getRealStatus(fmi2LastSuccessfulTime)
        assert instant == pytest.approx(overturning.time, rel=1e-9)
        assert instance.get("phase", "overturned") == [4, 1]
        theta, theta_dot = instance.get("theta", "theta_dot")
        assert theta == pytest.approx(-pi / 2, abs=1e-9)
        assert theta_dot == pytest.approx(overturning.after[3], rel=1e-9)
        assert instance.events[-1].kind == "overturning" and instance.events[-1].time == instant
        with pytest.raises(FMICallException, match="status 3"):
            instance.slave.doStep(instant, 0.1)
        assert "overturned" in instance.errors[-1]
        instance.slave.terminate()


def test_fmpy_ends_the_run_at_overturning_and_keeps_the_results(evison, overturning):
    load = np.array([(0.0, 0.5 * G), (2.0, 0.5 * G)], dtype=[("time", float), ("a_g", float)])
    result, events = simulate(evison, stop_time=2.0, output_interval=0.01, input=load,
                              output=["theta", "overturned", "phase"])
    before = int(overturning.time / 0.01)
    assert len(result) == before + 2, "every sample before, and the instant itself"
    assert result["time"][-1] == pytest.approx(overturning.time, rel=1e-8)
    assert result["theta"][-1] == pytest.approx(-pi / 2, abs=1e-8)
    assert not result["overturned"][:-1].any() and result["overturned"][-1]
    assert set(result["phase"][:-1]) <= {1, 2, 3} and result["phase"][-1] == 4
    assert [event.kind for event in events] == ["uplift", "overturning"]


def test_a_step_that_ends_before_overturning_is_no_discard(evison, overturning):
    with evison.start() as instance:
        instance.load(0.5 * G)
        instance.step(overturning.time - 1e-4)
        assert instance.get("overturned") == 0
        assert not instance.slave.getBooleanStatus(fmi2Terminated)
        assert instance.slave.getRealStatus(fmi2LastSuccessfulTime) == instance.time
        with pytest.raises(FMICallException, match="discard"):
            instance.slave.getIntegerStatus(fmi2DoStepStatus)
