"""Steps of co-simulation: lines that inputs follow, rates of outputs, and the host's clock."""

import numpy as np
import pytest
from host import DISCARD, ERROR, OK, WARNING, refused, status
from reference import EVISON

SHOWN = ["theta", "u", "a_t", "R_h", "a_g", "F_t"]


@pytest.mark.parametrize("name, acting, of_host, of_other, lines", [
    ("a_g", "a_ground", dict(theta_0=0.01), dict(theta_0=0.01), [
        (2.0, 30.0, 0.1, (2.0, 30.0)),
        (None, None, 0.05, (5.0, 0.0)),
        (-1.5, 0.5, 1.0, (-1.5, 0.5)),
        (None, -10.0, 0.1, (-1.0, -10.0)),
        (None, None, 0.1, (-2.0, 0.0)),
    ]),
    ("a_g", "a_ground", dict(a_g=0.5, a_g_late=True, peaks=True), dict(a_g=0.5), [
        (1.5, None, 0.1, (0.5, 10.0)),
        (0.5, None, 0.05, (1.5, -20.0)),
        (None, None, 0.1, (0.5, 0.0)),
        (3.0, -4.0, 0.25, (3.0, -4.0)),
        (-2.0, None, 0.2, (2.0, -20.0)),
        (None, 5.0, 0.1, (-2.0, 5.0)),
        (-1.5, 0.0, 0.1, (-1.5, 0.0)),
        (0.0, None, 0.1, (-1.5, 15.0)),
    ]),
    ("F_t", "F_t", dict(F_t_extrapolated=True), {}, [
        (100.0, None, 0.1, (100.0, 0.0)),
        (200.0, None, 0.05, (200.0, 1000.0)),
        (300.0, None, 0.1, (300.0, 2000.0)),
        (None, None, 0.1, (500.0, 0.0)),
        (450.0, -100.0, 0.2, (450.0, -100.0)),
        (-100.0, 0.0, 0.1, (-100.0, 0.0)),
        (-200.0, None, 0.1, (-200.0, -1000.0)),
    ]),
], ids=["a slope holds for one step", "a_g one step late", "F_t extrapolated"])
def test_an_input_follows_a_line(wall, name, acting, of_host, of_other, lines):
    """Steps of different lengths beside a host that sends the lines themselves. Each line is a value and a slope that are set, the
    step, and the value and the slope that act. Outputs between two steps are those of what acts. A slope holds for one step and its
    end value from then on; late, a_g is followed from the value at the start on to what is set, or on where nothing is; F_t goes on
    with the slope of its last two values. A slope that is set wins."""
    host, other = wall.start(**of_host), wall.start(**of_other)
    assert host.get(acting) == of_host.get(name, 0.0)
    for value, slope, step, (acts, rate) in lines:
        if value is not None:  # again and again, as a master does that iterates: the last value counts
            host.set(**{name: 9.0})
            host.set(**{name: value})
        if slope is not None:
            host.slope(name, slope)
        assert host.get(name, acting) == pytest.approx([acts if value is None else value, acts], rel=1e-13)
        other.slope(name, rate)  # before the value
        other.set(**{name: acts})
        for one in (host, other):
            one.step(one.time + step)
        assert host.reals(SHOWN) == pytest.approx(other.reals(SHOWN), rel=1e-11, abs=1e-15)
        assert host.rate("R_h") == pytest.approx(other.rate("R_h"), rel=1e-9, abs=1e-9)


def test_what_is_late_does_not_act_at_once(wall):
    """It has no feedthrough: what is set changes no output before the next step."""
    one = wall.start(a_g_late=True, theta_0=0.02)
    one.set(a_g=1.0)
    one.step(0.01)
    before = one.reals(["R_h", "a_t", "a_ground"])
    one.set(a_g=5.0)
    assert one.reals(["R_h", "a_t", "a_ground"]) == before
    one.set(a_v=0.5)
    assert one.get("a_v_ground") == one.derivative("R_h", "a_g") == 0
    one.slope("a_g", 0.0)
    assert one.get("a_ground") == 5 and one.derivative("R_h", "a_g") < -1


def test_a_slope_that_leads_out_of_the_range_is_not_followed(wall):
    """A jump over a tiny step has a slope that leads nowhere: the input is held, and the late one where it was."""
    one = wall.start(a_g_late=True, F_t_extrapolated=True)
    jumps = [("a_g", "a_ground", a_g, 1e-6) for a_g in (1e4, -1e4, 1e4)]
    for name, acting, value, step in [("F_t", "F_t", 1.0, 1e-9), ("F_t", "F_t", 1e8, 0.1), *jumps]:
        one.set(**{name: value})
        one.step(one.time + step)
        assert one.get(acting) == value


def test_a_host_that_holds_samples_of_a_motion_is_warned_once(wall):
    """And told what to do; a push, slopes and a_g_late are not."""

    def warnings(one, a_g, slopes=False):
        for step in range(20):
            one.set(a_g=a_g(step))
            if slopes:
                one.slope("a_g", (a_g(step + 1) - a_g(step)) / 0.01)
            one.slave.doStep(step * 0.01, 0.01)
        return [message for message in one.taken() if message.status == WARNING]

    quake = lambda step: float(np.sin(0.3 * step))
    for still in (lambda _: 0.0, lambda _: 2.0, lambda step: float(step >= 3), lambda step: -2.0 * (step == 7)):
        assert warnings(wall.start(), still) == []
    assert warnings(wall.start(a_g_late=True), quake) == warnings(wall.start(), quake, slopes=True) == []
    one = wall.start()
    (told,) = first = warnings(one, quake)
    assert told.category == "logStatusWarning" and all(remedy in told.text for remedy in ("record", "a_g_late", "slope"))
    one.slave.reset()
    assert warnings(one.initialize(), quake) == first, "another simulation is warned again"


RATES = ["theta", "theta_dot", "u_dot", "a_t", "delta_t", "v_t", "P_t", "F_d1", "F_d2", "R_h"]


def test_rates_are_those_of_the_motion(wall):
    """Beside what two tiny steps change, whose error is of the second order, under a slope and with restraints."""
    one = wall.start(tolerance=1e-12, theta_0=0.05, P_0=200.0, k_t=1e5, xi_d=0.2, c_d=50.0, k_d=1e6, F_y=1e3)
    one.input("a_g", 1.0, 20.0)
    one.step(0.05)
    one.input("a_g", 2.0, -15.0)
    rates, before, state = [one.rate(name) for name in RATES], np.array(one.reals(RATES)), one.slave.getFMUState()
    h, after = 2e-6, []
    for step in (h, 2 * h):
        one.slave.setFMUState(state)
        one.slave.doStep(0.05, step)
        after.append(np.array(one.reals(RATES)))
    assert rates == pytest.approx((4 * after[0] - after[1] - 3 * before) / (2 * h), rel=1e-5)


def test_rates_know_the_slope_just_followed(wall):
    """The rate at the end of a ramp is that of the ramp, until the input is set anew or the next step holds it."""
    one = wall.start()
    of_slope = {}
    for slope in (20.0, 0.0, 7.0):
        other = wall.start()
        other.input("a_g", 0.0, 20.0)
        other.step(0.05)
        other.input("a_g", 1.0, slope)
        of_slope[slope] = pytest.approx(other.rate("R_h"), rel=1e-13)
    one.slope("a_g", 20.0)
    one.step(0.05)
    assert one.rate("R_h") == of_slope[20.0] != of_slope[0.0]
    one.set(F_t=0.0)  # of which nothing was followed
    assert one.rate("R_h") == of_slope[20.0]
    state = one.slave.getFMUState()
    for act, slope in ((lambda: one.set(a_g=one.get("a_g")), 0.0), (lambda: one.slope("a_g", 7.0), 7.0)):
        act()
        assert one.rate("R_h") == of_slope[slope]
        one.slave.setFMUState(state)
    one.step(0.06)
    rate = one.rate("R_h")
    one.set(a_g=1.0)
    assert one.get("a_g") == 1 and one.rate("R_h") == rate


def test_the_results_are_the_same_at_every_start_time(wall):
    """To the bit. A host that multiplies is never more than a rounding away, and nothing else is taken for rounding."""

    def run(start):
        one, shown = wall.start(theta_0=0.02, r=0.9, start=start, stop=start + 0.01 * 2000), []
        for i in range(2000):
            one.input("a_g", 6 * np.sin(0.2 * i), 20.0)
            point = start + 0.01 * i
            for wrong in (1.0, 100.0, 0.0075, 0.01, -1.0, -100.0, -0.0075, -0.01):
                assert status(one.slave.doStep, point + wrong, 0.01) == ERROR, (wrong, point)
            one.slave.doStep(point, 0.01)
            assert one.slave.getRealStatus(2) == point + 0.01
            shown.append(one.reals(["theta", "u", "a_t", "R_v", "a_g"]))
        return shown, one.get("transitions")

    expected = run(0.0)
    assert expected[1] > 5
    for start in (-1.0, 10.5 + 1e-9, 1e6, 1.7e9, 1e12):
        assert run(start) == expected, start


def test_a_point_and_the_stop_time_are_met_but_for_rounding(wall):
    """A host that adds its steps up is off by many roundings."""
    one, late, start = wall.start(start=10.0, stop=12.0), wall.start(start=1e12), 1e12
    one.slave.doStep(10.0 + 1e-9, 0.5)
    assert one.slave.getRealStatus(2) == 10.0 + 1e-9 + 0.5
    one.slave.doStep(10.5, 1.5 + 1e-9)
    rounding = np.spacing(start)
    assert status(late.slave.doStep, start + 2 * rounding, 2 * rounding) == ERROR, "a step would be missed"
    last = wall.start(start=1.7e308)
    with refused(last, "communicationStepSize = 1.7e308 s is out of range"):
        last.slave.doStep(1.7e308, 1.7e308)


def test_a_clock_of_single_precision_loses_no_time(wall):
    """Game engines keep one: a step ends at its point plus its duration all the same."""
    one, once = (wall.start(theta_0=0.02, start=500.0) for _ in range(2))
    clock = lambda frame: 500 + frame / 60
    for frame in range(60):
        point, step = float(np.float32(clock(frame))), float(np.float32(clock(frame + 1) - clock(frame)))
        one.slave.doStep(point, step)
        assert one.slave.getRealStatus(2) == point + step
    once.step(one.slave.getRealStatus(2))
    assert once.get("transitions") > 3
    assert one.get("theta") == pytest.approx(once.get("theta"), rel=1e-8)
    one = wall.start(theta_0=0.02)
    one.slave.doStep(0.0, 0.01)
    one.slave.doStep(0.01 + 2e-6, 0.01)
    assert one.slave.getRealStatus(2) == 0.01 + 2e-6 + 0.01


def test_rigid_outputs_are_those_of_the_present_inputs(wall):
    """Eq 27 with the present ground acceleration; at rest the top mass moves with the ground."""
    one = wall.start(detail=5)
    for a_g in (1.5, -0.5):
        one.set(a_g=a_g)
        assert one.get("a_t", "V_t", "M_t") == [a_g, EVISON.m * a_g, EVISON.m * EVISON.H * a_g]


def test_overturning_discards_the_step_and_ends_the_simulation_at_its_instant(wall):
    one = wall.start(theta_0=1.5, theta_dot_0=1.0)
    assert not one.slave.getBooleanStatus(3)
    one.input("a_g", 0.5, 0.25)
    assert status(one.slave.doStep, 0.0, 2.0) == DISCARD
    time = one.slave.getRealStatus(2)
    told = one.messages[-1]
    assert told.text == f"fmi2DoStep: the structure overturned at t = {time!r} s; the simulation ends there"
    assert (told.status, told.category) == (DISCARD, "logStatusDiscard") and one.slave.getBooleanStatus(3)
    assert one.get("t_overturned", "phase", "overturned") == [time, 4, True] and 0 < time < 2
    assert one.get("theta") == pytest.approx(np.pi / 2, rel=1e-12) and one.rate("theta") == 0
    assert one.get("a_g") == pytest.approx(0.5 + 0.25 * time, rel=1e-15)
    with refused(one, 'fmi2DoStep: not allowed in the state "step failed"; allowed in: step complete'):
        one.slave.doStep(time, 0.1)
    assert one.slave.terminate() == OK and one.get("theta") > 1.5


def test_values_during_initialization_follow_what_is_set(wall):
    one = wall.instance().enter(theta_0=-0.04, u_0=1e-3, B=0.3)
    assert one.get("theta", "u", "theta_0") == [-0.04, 1e-3, -0.04]
    assert one.get("uplift") == pytest.approx(0.6 * np.sin(0.04), rel=1e-14)
    assert one.get("alpha_cg") == pytest.approx(np.arctan(EVISON.tan_alpha_cg * 0.3 / EVISON.B), rel=1e-12)
    for theta_0, phase in ((-0.04, 2), (0.04, 3), (0.0, 1)):
        one.set(theta_0=theta_0)
        assert one.get("phase") == phase
    assert one.get("transitions", "overturned") == [0, False]
    one.set(record="a ü.csv")
    assert one.get("record").decode() == "a ü.csv"
