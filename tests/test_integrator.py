"""The FMU under an integrator of the host's: inputs, events, states, what it foresees and sends back."""

import numpy as np
import pytest
from host import DISCARD, OK, PHASES, refused, status

NAN = float("nan")


@pytest.fixture
def model(wall):
    """A new instance in continuous-time mode, or with another record, start or tolerance."""
    return lambda **start_values: wall.start("ModelExchange", **start_values)


def test_inputs_act_as_they_are_set(model):
    """An input that the host changes while it integrates acts at each trial as it is set; one that jumps, from the event on."""
    one = model(zeta_fc=0.0)
    for a_g in (0.0, 2.0, 0.0):
        one.set(a_g=a_g)
        assert one.derivatives() == [0.0, -a_g, 0.0, 0.0] and one.get("der(u_dot)") == -a_g
    one.slave.setTime(0.02)
    assert one.complete() == (False, False)
    one.slave.setTime(0.04)
    one.slave.enterEventMode()
    one.set(a_g=50.0)  # a push that would lift the structure in 10 ms, had it acted before the event
    assert not one.update()[1] and one.states() == [0.0] * 4 and one.get("phase") == PHASES["full contact"]


def test_a_state_can_be_set_as_a_variable(model):
    """By its name while a host integrates; at an event, which puts the states right, it cannot."""
    by_name, at_once = model(theta_0=0.02), model(theta_0=0.02)
    by_name.set_reals(theta=0.015, u_dot=-0.1, a_g=1.0, u=2e-4)
    at_once.set_states([2e-4, -0.1, 0.015, 0.0])
    at_once.set(a_g=1.0)
    before = by_name.bytes()
    assert before == at_once.bytes()
    assert status(lambda: by_name.set_reals(u=1e-3, theta=NAN)) == DISCARD and by_name.bytes() == before, "all of the values or none"
    assert by_name.messages[-1].text == "fmi2SetReal: theta = NaN is out of range: a state must be finite; take a shorter step"
    modal = model(theta_0=0.02, detail=4)
    with refused(modal, "fmi2SetReal: detail = modal has no modes"):
        modal.set_reals(theta=0.015, a_v=1.0)
    by_name.slave.enterEventMode()
    with refused(by_name, "fmi2SetReal: theta cannot be set: it is an output, computed by the FMU"):
        by_name.set(theta=0.01)


def test_a_step_over_an_impact_is_put_right(model, wall):
    """A host that never looks at an indicator, nor at the states, has the floor under it all the same."""
    one, slave = model(theta_0=0.02), wall.start(theta_0=0.02)
    before, _ = one.states(), one.taken()
    one.slave.setTime(0.5)
    assert one.complete() == (True, False)
    assert one.states() == before, "the host's states are its own until the event is dealt with"
    assert one.event()[:2] == (False, True)
    slave.step(0.5)
    assert one.states() == slave.get("u", "u_dot", "theta", "theta_dot")
    assert one.get("transitions") == slave.get("transitions")
    told = one.taken()
    assert len(told) == 1 + slave.get("transitions") and all(message.category == "logEvents" for message in told)
    assert told[-1].text.startswith("t = 0.5 s: the integrator's step from t = 0 s shows nothing of impact left, ")


def test_no_indicator_is_zero_where_integration_starts(wall):
    """After an uplift theta is exactly 0 and grows as t³: neither is that a root, nor is a return within the step missed. The free
    edge rises as the base turns on, to either side, of which the other is none."""
    for u_0, phase in ((8e-4, "rocking right"), (-8e-4, "rocking left")):
        one = wall.instance("ModelExchange").enter(u_0=u_0)
        one.slave.exitInitializationMode()
        assert one.update()[1] is False and one.get("transitions", "phase") == [1, PHASES[phase]]
        assert one.states()[2] == 0
        assert one.indicators() == one.get("phase_indicator", "overturning_indicator") and min(one.indicators()) > 0
        assert one.derivative("uplift", "theta") == pytest.approx(np.sign(u_0) * 2 * one.get("B"), rel=1e-6)


def test_overturning_ends_the_simulation(model, wall):
    one, slave = model(theta_0=1.5, theta_dot_0=1.0), wall.start(theta_0=1.5, theta_dot_0=1.0)
    one.slave.setTime(1.0)
    assert one.complete() == (True, False)
    assert one.event()[0]
    assert status(slave.step, 1.0) == DISCARD
    names = ("overturned", "t_overturned", "theta")
    assert one.get(*names) == slave.get(*names) and one.get("overturned")
    one.slave.setTime(2.0)
    assert one.complete() == (False, True)
    assert one.get("t_overturned") == slave.get("t_overturned") and one.derivatives() == [0.0] * 4
    one.slave.setTime(0.0)
    assert one.complete() == (False, True), "no step is checked any more"


def test_the_jumps_of_a_record_are_foreseen(wall):
    """A kink is foreseen by hosts to which it matters."""
    wall.write("push.csv", "t (s),a\n0,0.5\n1,0.25\n2,1\n")
    for tolerance, expected in ((1e-9, [10.5, 11.5, 11.5, None]), (1e-6, [10.5, 12.5, 12.5, None])):
        one = wall.instance("ModelExchange").enter(tolerance, 10.0, record="push.csv", record_start=0.5)
        one.slave.exitInitializationMode()
        found = []
        for time in (10.0, 10.5, 11.0, 12.5):
            one.slave.setTime(time)
            found.append(one.update()[2])
        assert found == expected


def test_the_end_of_held_contact_is_foreseen(model):
    """Contact that is held after too many impacts ends at an instant before which no push lifts the structure."""
    one = model(detail=5, r=0.9999, theta_0=1e-11)
    period = 1 / one.get("p_l")
    one.slave.setTime(0.9 * period)
    assert one.complete() == (True, False)

    def update(time, a_g):
        one.slave.setTime(time)
        one.slave.enterEventMode()
        one.set(a_g=a_g)
        instant = one.update()[2]
        one.slave.enterContinuousTimeMode()
        return one.get("phase"), instant

    end = update(0.9 * period, 0.0)[1]
    held = "; too many transitions within one vibration period: contact is held for the rest of it"
    (warning,) = [text for text in one.warnings() if text.endswith(held)]
    assert " s: landing in full contact; u = 0 m, u_dot = 0 m/s (before: 0), theta_dot = 0 " in warning
    assert update(0.95 * period, 9.0) == (PHASES["full contact"], pytest.approx(end, rel=1e-14))
    assert end == pytest.approx(period, rel=1e-4)
    assert update(end, 9.0) == (PHASES["rocking left"], None)


def test_a_sample_has_one_instant_however_the_host_gets_there(wall):
    """The next event is the very sample's instant, wherever the host is between two samples, and in an instance that goes on from
    a kept state."""
    samples = [6 * i / 1e3 for i in range(500)]
    wall.write("quake.csv", "t (s),a (m/s2)\n" + "".join(f"{time:.3f},{np.sin(9 * time)}\n" for time in samples))
    one, other = (wall.instance("ModelExchange") for _ in range(2))
    one.initialize(start=0.7, record="quake.csv")

    def follow(one, steps):
        for step in steps:
            time = 0.7 + step * 0.002
            one.slave.setTime(time)
            assert one.event()[2] == next(at for at in (0.7 + (sample - samples[0]) for sample in samples) if at > time + 1e-9), time

    follow(one, range(1, 400))
    other.slave.setFMUstate(other.slave.deSerializeFMUstate(one.bytes()))
    follow(other, range(400, 900))


def test_a_jump_is_still_to_come_until_its_event(wall3):
    """A host that arrives at a jump sees what led there until it enters event mode, which a kept state remembers. A host that never
    enters event mode sees what follows the jump as soon as it has passed the jump."""
    wall3.write("push.csv", "t (s),a_g (m/s2)\n0,4\n1,2\n")
    one = wall3.start("ModelExchange", start=10.0, record="push.csv", record_start=0.5)

    def acts(a_g, slope):
        assert (one.get("a_ground"), one.derivatives()[1]) == (a_g, -a_g)
        assert one.derivative("a_ground", "time") == pytest.approx(slope, rel=1e-12)

    one.slave.setTime(10.5)
    acts(0.0, 0.0)
    assert one.complete() == (False, False)
    acts(0.0, 0.0)
    arrived = one.slave.getFMUState()
    one.slave.enterEventMode()
    acts(4.0, -2.0)
    at_event = one.bytes()
    one.slave.setFMUState(arrived)
    acts(0.0, 0.0)
    one.slave.setFMUState(one.slave.deserializeFMUState(at_event))
    acts(4.0, -2.0)
    assert one.update()[2] == 11.5
    one.slave.enterContinuousTimeMode()
    acts(4.0, -2.0)
    for time, a_g, slope in ((11.5, 2.0, -2.0), (10.5, 4.0, -2.0), (np.nextafter(11.5, 12), 2.0, -2.0), (11.501, 0.0, 0.0)):
        one.slave.setTime(time)
        acts(a_g, slope)


def test_what_no_integrator_should_try_is_sent_back(model):
    one = model(theta_0=0.02)
    before, _ = one.bytes(), one.taken()
    for states, name in ([0.0, NAN, 0.0, 0.0], "u_dot = NaN"), ([0.0, 0.0, -2e12, 0.0], "theta = -2000000000000"):
        assert status(one.set_states, states) == DISCARD
        (message,) = one.taken()
        assert message.text.startswith(f"fmi2SetContinuousStates: {name} is out of range") and one.bytes() == before
    with refused(one, "fmi2SetContinuousStates: nx = 3 is not 4"):
        one.set_states([0.0] * 3)
    with refused(one, "fmi2SetTime: time = inf s is out of range"):
        one.slave.setTime(float("inf"))
    one.slave.setTime(1e-3)
    assert one.complete() == (False, False)
    one.slave.setTime(-0.5)
    with refused(one, "fmi2CompletedIntegratorStep: the integrator's step from t = 0.001 s ends at t = -0.5 s"):
        one.complete()
    one = model(m0=0.0, J0=0.0, theta_0=0.1)
    one.set_states([0.285, 0.0, 0.1, 0.0])
    assert status(one.derivatives) == DISCARD
    one.set_states([0.0, 0.0, 0.1, 0.0])
    assert status(one.derivatives) == OK


def test_a_host_that_ignores_events_is_warned_once(model, wall):
    """A host that enters no event mode, or completes no step, holds a structure down that should rock."""

    obeys, ignores, never, briefly = (model() for _ in range(4))
    for one in (obeys, ignores, never, briefly):
        one.taken()
        one.set(a_g=9.0)
    slave = wall.start()
    slave.input("a_g", 9.0)
    for step in range(1, 20):
        slave.step(0.01 * step)
        obeys.go_to(0.01 * step, slave.get("u", "u_dot", "theta", "theta_dot"))
        ignores.slave.setTime(0.05 * step)
        ignores.complete()
    obeys.slave.terminate()
    assert obeys.get("theta") != 0 == ignores.get("theta") and obeys.warnings() == []
    for step in range(1, 3000):
        never.slave.setTime(0.01 * step)
    briefly.slave.setTime(0.01)
    briefly.slave.terminate()
    for one, text in ((ignores, "t = 0.1 s: the host completes steps but does not enter event mode"),
                      (never, "the host integrates without completing steps"), (briefly, "the host integrates without completing steps")):
        (told,) = one.warnings()
        assert text in told


def test_peaks_and_validity_are_not_watched(model):
    """Peaks between the host's steps are not the FMU's to see."""
    one = model(theta_0=0.02, peaks=True, validity=True)
    text = "= true has no effect in model exchange, where the host integrates: the values are NaN; use co-simulation"
    assert one.warnings() == [f"peaks {text}", f"validity {text}"]
    one.go_to(1e-3, one.states())
    assert np.isnan(one.get("theta_max", "mu_required")).all()


UNKNOWNS = ["der(u)", "der(u_dot)", "der(theta)", "der(theta_dot)", "u", "theta", "delta_t", "R_v"]
KNOWNS = dict(u=1e-6, u_dot=1e-4, theta=1e-6, theta_dot=1e-4, a_g=1e-2, F_t=1.0, a_v=1e-2, time=1e-3)


@pytest.mark.parametrize("states", [[1e-3, -0.1, 0.03, 0.4], [-2e-3, 0.2, -0.01, 0.5], [1e-4, 0.1, 0.0, 0.0]])
def test_directional_derivatives_are_the_slopes_of_the_values(wall3, states):
    """Beside differences of the values, on ground that follows records, whose pieces are straight; in full contact the base does not
    turn."""
    wall3.write("ramp.csv", "0,1\n0.5,-3\n")
    wall3.write("up.csv", "0,2\n0.5,-2\n")
    one = wall3.start("ModelExchange", theta_0=states[2], a_g=3.0, F_t=200.0, record="ramp.csv", record_v="up.csv")
    one.at(0.25, states)
    assert one.derive(["a_ground", "a_v_ground"], ("time", 1.0)) == [-8.0, -8.0]
    for known, step in KNOWNS.items():
        if states[2] == 0 and known.startswith("theta"):
            assert one.derive(["der(u_dot)", "der(theta_dot)"], (known, 1.0)) == [0.0, 0.0]
            continue
        value, shown = one.get(known), []
        for change in (step, -step, 0.0):
            one.slave.setTime(value + change) if known == "time" else one.set(**{known: value + change})
            shown.append(np.array(one.reals(UNKNOWNS)))
        expected = (shown[0] - shown[1]) / (2 * step)
        assert one.derive(UNKNOWNS, (known, 1.0)) == pytest.approx(expected, rel=1e-6, abs=1e-6), known
    assert one.states() == states
