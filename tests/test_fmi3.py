"""FMI 3.0 beside FMI 2.0: the same scene gives the same bits, and a step can end at a transition."""

import itertools

import monolithic
import numpy as np
import pandas as pd
import pytest
from evidence.coupling import bridge, convergence
from evidence.coupling.early_return import EndedAtTransitions, EventBridge, Pier
from evidence.coupling.masters import extrapolate
from fmpy import simulate_fmu
from host import ERROR, OK, PHASES, events, simulate, status
from pacoima import A_G, END, TIME, distance, rows
from pacoima import OUTPUTS as COMPARED

EVENTS = dict(eventModeUsed=True, earlyReturnAllowed=True)


@pytest.fixture(scope="module")
def mcmanus3(export):
    return export("mcmanus", fmi=3)


@pytest.fixture(scope="module")
def shaken3(export, pacoima_record):
    return export("mcmanus", pacoima_record, fmi=3)


def assert_same_bits(found, expected):
    pd.testing.assert_frame_equal(pd.DataFrame(found), pd.DataFrame(expected), check_exact=True, check_like=True, check_dtype=False)


RESTRAINTS = dict(P_0=100.0, k_t=2e4, xi_d=0.2, c_d=50.0, k_d=1e6, F_y=50.0, a_v=0.5)
ASKED = dict(stop_time=1.99, output_interval=0.01, record_events=False)


@pytest.mark.parametrize("start_values, solver", [
    ({}, dict(solver="CVode", relative_tolerance=1e-8)), ({}, dict(solver="CVode", relative_tolerance=1e-3)),
    ({}, dict(solver="Euler", step_size=5e-4)), (RESTRAINTS, dict(solver="CVode", relative_tolerance=1e-8)),
])
def test_a_host_that_integrates_gets_the_same_bits_and_stays_above_the_floor(shaken, shaken3, start_values, solver):
    asked = ASKED | solver | dict(fmi_type="ModelExchange", start_values=start_values,
                                  output=[*shaken3.outputs, "phase", "transitions", "phase_indicator", "overturning_indicator"])
    found = simulate_fmu(shaken3.path, **asked)
    assert_same_bits(found, simulate_fmu(shaken["mcmanus"].path, **asked))
    assert found["transitions"][-1] > 15
    side = np.select([found["phase"] == PHASES["rocking right"], found["phase"] == PHASES["rocking left"]], [1, -1])
    assert (side * found["theta"]).min() >= 0 and (found["phase_indicator"] > 0).all()


def test_without_strings_the_fmu_follows_its_record(shaken, export, pacoima_record):
    fmu = export("mcmanus", pacoima_record, "--no-strings", fmi=3)
    assert "String" not in {variable.type for variable in fmu.variables.values()}
    assert_same_bits(*(simulate_fmu(of.path, output=fmu.outputs, **ASKED) for of in (fmu, shaken["mcmanus"])))


@pytest.mark.parametrize("goes_back", [False, True])
def test_a_step_ends_at_every_transition(shaken3, goes_back):
    """The motion and its jumps are those of transitions within steps. A master that goes back and steps to the instant that it
    was told, or a few units in the last place beside it, meets the transition at the end of that step. No step has no length:
    an uplift that follows a landing at once is applied with it."""
    expected, messages = simulate(shaken3, stop_time=END, output_interval=2e-3, output=COMPARED)
    transitions = events(messages)
    one = shaken3.instance(**EVENTS).initialize()
    met, found, t = [], [one.get(*COMPARED)], 0.0
    for until in expected["time"][1:]:
        while t < until:
            start = one.slave.getFMUState()
            is_due, terminate, is_early, reached = one.slave.doStep(t, until - t)
            assert (terminate, is_early) == (False, reached < until)
            assert (is_due or reached == until) and reached > t
            for end in reached + np.spacing(reached) * np.array([*range(-4, 5), 0]) if is_due and goes_back else []:
                one.slave.setFMUState(start)
                reached = t + (end - t)
                assert one.slave.doStep(t, end - t) == (True, False, False, reached), len(met)
            one.slave.freeFMUState(start)
            t = reached
            if is_due:
                phase, before = one.get("phase"), one.get("u", "u_dot", "theta_dot")
                one.event()
                met.append((t, *before, *one.get("u", "u_dot", "theta_dot")))
                assert one.get("phase") != phase and one.get("time") == t
        found.append(one.get(*COMPARED))
    at_once = [list(group) for _, group in itertools.groupby(transitions, lambda e: e.time)]
    expected_at = [(a.time, a.u, a.u_dot_before, a.theta_dot_before, b.u, b.u_dot, b.theta_dot)
                   for a, b in ((group[0], group[-1]) for group in at_once)]
    assert len(met) == len(at_once) == 30 and len(transitions) == 31
    np.testing.assert_allclose(met, expected_at, rtol=1e-8, atol=1e-10)
    assert goes_back or [e.kind for e in one.events] == [e.kind for e in transitions]
    assert distance(np.array(found), rows(expected)) < 1e-9


@pytest.mark.parametrize("sets_again", [False, True])
def test_the_rest_of_a_step_follows_the_same_line(mcmanus3, sets_again):
    """Steps of 20 ms that end at transitions and are then completed give what whole ones give, with a force beside a_g."""
    step, late = 20e-3, dict(a_g_late=True, F_t_extrapolated=True)
    time = np.arange(round(END / step)) * step
    a_g, F_t = np.interp(time, TIME, A_G), 100 * np.sin(8 * time)
    plain, master = mcmanus3.start(**late), mcmanus3.instance(**EVENTS).initialize(**late)
    theta = []
    for t, *values in zip(time, a_g, F_t):
        values = dict(zip(("a_g", "F_t"), values))
        until, reached = t + step, t
        for one in (plain, master):
            one.set(**values)
        plain.slave.doStep(t, step)
        while reached < until:
            is_due, _, _, reached = master.slave.doStep(reached, until - reached)
            if is_due:
                master.event()
            if sets_again:
                master.set(**values)
        theta.append((plain.get("theta"), master.get("theta")))
    expected, found = np.transpose(theta)
    assert len(plain.events) == len(master.events) > 20
    assert np.max(np.abs(found - expected)) < 1e-12 * np.max(np.abs(expected))


def test_a_transition_that_the_host_does_not_deal_with_happens(mcmanus3):
    """A host may go on, or back to where a transition was due, by its own state or by bytes."""
    one = mcmanus3.instance(**EVENTS).initialize(theta_0=0.01)
    is_due, _, _, impact = one.slave.doStep(0.0, 1.0)
    assert is_due and abs(one.get("theta")) < 1e-15
    ends = set()
    for kept in (one.slave.getFMUState(), one.slave.deserializeFMUState(one.bytes())):
        for handles in (False, True):
            one.slave.setFMUState(kept)
            if handles:
                one.event()
            assert one.slave.doStep(impact, 1e-3)[3] == impact + 1e-3
            ends.add(one.reals())
    assert len(ends) == one.get("transitions") == 1


@pytest.mark.parametrize("handles_events", [False, True])
def test_overturning_ends_the_simulation(mcmanus3, handles_events):
    one = mcmanus3.instance(eventModeUsed=handles_events, earlyReturnAllowed=handles_events).initialize(theta_0=0.3)
    start = one.slave.getFMUState()
    is_due, terminate, is_early, instant = one.slave.doStep(0.0, 10.0)
    assert (is_due, terminate, is_early) == (False, True, handles_events)
    assert one.get("t_overturned", "time") == [instant, instant] and 0 < instant < 10
    assert one.get("theta") == pytest.approx(np.pi / 2, rel=1e-12)
    assert one.messages[-1].text == f"fmi3DoStep: the structure overturned at t = {instant!r} s; the simulation ends there"
    for end in instant + np.spacing(instant) * np.arange(-4, 5) if handles_events else []:  # it belongs to the step that ends there
        one.slave.setFMUState(start)
        assert one.slave.doStep(0.0, end) == (False, True, False, end)
        assert one.get("t_overturned") == end
    for may_return_early, end in ((True, instant), (False, np.ceil(instant / 0.1) * 0.1)):
        result, _ = simulate(mcmanus3, start_values={"theta_0": 0.3}, stop_time=10, output_interval=0.1, output=["t_overturned"],
                              early_return_allowed=may_return_early, use_event_mode=handles_events)
        assert result["time"][-1] == pytest.approx(end, rel=1e-14)
        assert result["t_overturned"][-1] == pytest.approx(instant, rel=1e-14)


@pytest.mark.parametrize("a_g_late, phase", [(False, "rocking right"), (True, "full contact")])
def test_what_acts_at_an_event_is_what_lifts_off_there(wall3, a_g_late, phase):
    """An acceleration that a host sets at an event lifts a rigid structure off there and then, unless it is to come one step late."""
    one = wall3.instance(**EVENTS).initialize(detail=5, a_g_late=a_g_late)
    one.slave.enterEventMode()
    one.set(a_g=-50.0)
    assert one.update() == (False, False, None)
    assert one.get("phase") == PHASES[phase]


def test_a_step_ends_early_for_hosts_that_take_it_alone(wall3):
    """A host that handles events but no early return gets whole steps, from the start time that it has set, whatever it read before."""
    one = wall3.instance(eventModeUsed=True)
    one.set(theta_0=0.02)
    assert one.get("theta") == 0.02
    one.initialize(start=5.0)
    assert one.slave.doStep(5.0, 1.0) == (False, False, False, 6.0)


@pytest.mark.parametrize("sets, reads", [(True, False), (False, True), (True, True)])
def test_a_host_that_is_called_back_sets_inputs_reads_and_does_no_harm(wall, wall3, sets, reads):
    """It sets inputs before a step is computed, which are lines as those of FMI 2.0 with slopes, and reads afterwards."""
    calls, end = [], 0.0

    def update(_environment, time, set_requested, get_allowed, step_finished, *_):
        one.slave.fmi3FreeInstance(one.slave.component)
        harm = [status(call) for call in (one.slave.terminate, one.slave.reset, one.slave.getFMUState, lambda: one.set(m=end),
                                          lambda: one.set(a_g=np.nan))]
        got = (one.get("theta"), one.rate("theta")) if get_allowed else (status(one.get, "theta"), status(one.rate, "theta"))
        calls.append(((set_requested, get_allowed, step_finished), harm, status(one.slave.setDebugLogging, True, []),
                      status(lambda: one.set(a_g=end)), time, got))

    names = ["a_g"] * sets + ["theta"] * reads
    one = wall3.instance(intermediateUpdate=update, requiredIntermediateVariables=wall3.references(names))
    one.initialize(theta_0=0.3)
    of_2, start = wall.start(theta_0=0.3), 0.0
    for time, end in ((0.0, 2.0), (0.25, -1.0)):
        one.slave.doStep(time, 0.25)
        of_2.input("a_g", start, (end - start) / 0.25 if sets else 0.0)
        of_2.step(time + 0.25)
        start = one.get("a_g")
        assert start == (end if sets else 0.0) and one.reals() == of_2.reals()
        refused, shown = [ERROR] * 5, (one.get("theta"), one.rate("theta"))
        asked = [((True, False, False), refused, OK, OK, time + 0.25, (ERROR, ERROR))] * sets
        assert calls == asked + [((False, True, True), refused, OK, ERROR, time + 0.25, shown)] * reads
        calls.clear()
    end = 1e4
    one.set(a_g=3.0)
    assert status(one.slave.fmi3DoStep, one.slave.component, 0.5, 0.25, False, None, None, None, None) == ERROR
    assert calls == [] and one.get("a_g") == 3, "a step that is refused asks for nothing"
    end = 0.0
    _, terminate, is_early, reached = one.slave.doStep(0.5, 100.0)
    assert (terminate, is_early) == (True, False)
    assert [call[4] for call in calls if call[0][1]] == [reached] * reads, "the host reads last at the instant of overturning"
    for unknown in (0, 2**32 - 1):
        with pytest.raises(RuntimeError, match=f"value reference {unknown} does not exist"):
            wall3.instance(intermediateUpdate=update, requiredIntermediateVariables=[unknown])


def test_a_master_needs_one_further_step_for_a_transition(export):
    """Two piers under a deck, against the three integrated as one system."""
    time, a_g = TIME[:700], A_G[:700]
    system = EventBridge([Pier(export(preset, fmi=3).path) for preset in ("mcmanus", "evison")], bridge.deck(), bridge.linear(time, a_g))
    master = EndedAtTransitions()
    found = convergence.course(system, master, extrapolate, time, 2)
    response = monolithic.integrate(convergence.monolithic_bridge(bridge.deck()), time, a_g)
    transitions = sum(map(len, response.transitions))
    assert system.transitions() == transitions > 20
    assert master.steps - 2 * (len(time) - 1) <= transitions
    assert convergence.error(found, convergence.columns(response)) < 2e-6
