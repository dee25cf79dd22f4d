"""The record inside: the same at any steps, where it is placed, what is refused; peaks, and limits that the motion passes."""

import json

import numpy as np
import pytest
from host import output, refused, write
from reference import EVISON
from test_states import at2

SHOWN = ["theta", "u", "a_t", "theta_dot", "u_dot", "R_h"]


def stepped(one, steps) -> np.ndarray:
    """SHOWN after each step."""
    rows = []
    for step in steps:
        one.step(one.time + step)
        rows.append(one.reals(SHOWN))
    return np.array(rows)


@pytest.mark.parametrize("detail", range(1, 7))
@pytest.mark.parametrize("name", ["even.AT2", "uneven.csv"])
def test_any_step_meets_every_sample(wall, name, detail):
    """One step over everything, steps of the samples, and steps that miss them all: the same, with the same peaks."""
    if name == "even.AT2":
        time = 0.02 * np.arange(600)
        wall.write(name, at2(600))
    else:
        i = np.arange(400)
        time = 3.0 + 0.015 * i + 0.006 * np.sin(3.7 * i * i)
        write(wall.resources / name, "m/s2", time, 9.0 * (1 - i / 400) * (0.4 * np.sin(3.7 * i * i) + 0.5 * np.cos(0.6 * i)))
    following = lambda: wall.start(tolerance=1e-12, detail=detail, record=name, record_time_scale=0.4, record_scale=1.25, peaks=True)
    of_samples, time = following(), 0.4 * time
    shown, names = stepped(of_samples, np.diff(time)), wall.peaks
    peaks, instants = of_samples.reals(names), of_samples.reals([f"t_{name}" for name in names])
    largest = np.abs(shown).max(axis=0)
    assert detail == 6 or of_samples.get("transitions") > 20
    for count, tolerance in ((1, 1e-12), (7, 1e-9), (1000, 1e-9)):
        one = following()
        duration = one.get("record_duration")
        assert duration == pytest.approx(time[-1] - time[0], rel=1e-14)
        found = stepped(one, [duration / count] * count)[-1]
        assert (np.abs(found - shown[-1]) <= tolerance * largest).all(), count
        assert one.reals(names) == pytest.approx(peaks, rel=tolerance, abs=0)
        assert one.reals([f"t_{name}" for name in names]) == pytest.approx(instants, rel=1e-9, abs=1e-9)


def test_a_record_comes_when_it_is_asked_for(wall):
    """The ground is at rest before the record and after it; both jumps are where they belong, in the reactions and in the rates as
    well, whatever the start time."""
    wall.write("steps.csv", "t (s),a\n5,2\n6,4\n7,1\n")
    shown = []
    for start in (0.0, -7.0, 1048576.0):
        one = wall.start(start=start, record="steps.csv", record_scale=-0.5, record_time_scale=0.5, record_start=0.25, peaks=True)
        assert one.get("record_duration", "a_ground") == [1.0, 0.0]
        shown.append([])
        for step, a_ground, slope in ((0.125, 0.0, 0.0), (0.125, -1.0, -2.0), (0.25, -1.5, -2.0), (0.25, -2.0, 3.0),
                                      (0.375, -0.875, 3.0), (0.125, 0.0, 0.0), (10.0, 0.0, 0.0)):
            one.set(a_g=0.75)
            one.step(one.time + step)
            assert (one.get("a_ground", "a_g"), one.rate("a_ground")) == ([a_ground + 0.75, 0.75], slope)
            shown[-1].append((one.reals(SHOWN), one.rate("R_h")))
        assert one.get("t_u_max") - start == pytest.approx(0.85, abs=0.4)
    assert shown[0] == shown[1] == shown[2]
    one = wall.instance().enter(record="steps.csv", record_start=-0.25)  # in its midst at the start
    assert one.get("a_ground") == 2.5 and one.get("R_h") == pytest.approx(-EVISON.m0 * 2.5, rel=1e-12)


def test_the_input_adds_to_the_record(wall):
    """Each followed along its slope, as a host follows their sum."""
    wall.write("line.csv", "t (s),a\n0,1\n1,2\n2,0\n")
    one, other = wall.start(record="line.csv"), wall.start()
    one.input("a_g", 0.5, -0.25)
    one.input("F_t", 30.0, 8.0)
    one.step(1.5)
    for until, a_g, F_t, slope in ((1.0, 1.5, 30.0, 0.75), (1.5, 2.25, 38.0, -2.25)):
        other.input("a_g", a_g, slope)
        other.input("F_t", F_t, 8.0)
        other.step(until)
    assert one.get("theta", "u", "u_dot") == other.get("theta", "u", "u_dot")
    assert one.get("a_g", "a_ground") == pytest.approx([0.125, 1.125], rel=1e-14)


def test_a_record_that_cannot_be_followed_is_refused(wall):
    """When initialization ends, or before if its values are asked for; nothing changes."""
    wall.write("broken.csv", "t,a\n0,1\n0.1,root:x:0\n0.2,3\n")
    wall.write("strong.csv", "t (s),a\n0,1\n1,-6000\n")
    (wall.resources / "folder.csv").mkdir()
    one, folder = wall.instance().enter(record_scale=2.0), wall.resources
    for record, record_v, text in [
        ("broken.csv", "", f'{folder}/broken.csv, line 3: the acceleration "root:x:0" is not a number'),
        ("strong.csv", "", "the record, as it is scaled: a_g = 12000 m/s2 is out of range: it must lie between"),
        ("", "up.csv", f'record_v = "up.csv" is not in {folder}; a path on disk needs a separator: ./up.csv'),
        ("..", "", f"record: {folder}/.. is not a file"),
        ("folder.csv", "", f"record: {folder}/folder.csv is not a file"),
        ("file:a.csv", "", 'record = "file:a.csv" is not a file URI of this machine, such as file:///tmp/record.A'),
        ("./absent.AT2", "", "record: the record ./absent.AT2 cannot be read: No such file or directory (os error"),
    ]:
        one.set(record=record, record_v=record_v)
        for call in (one.exit, lambda: one.get("a_ground")):
            with refused(one, text):
                call()
        assert one.get("record_scale", "record") == [2.0, record.encode()]
    one.set(record="strong.csv", record_v="", record_scale=-1.0)
    one.exit()
    assert one.get("a_ground", "record_duration") == [-1.0, 1.0]


def test_the_ground_carries_the_weight_under_both_accelerations(wall):
    """The vertical component alone: (m + m0) (g + a_v)."""
    wall.write("up.csv", "t/s,a (cm/s2)\n0,0\n1,100\n2,0\n")
    one = wall.start(record_v="up.csv", record_scale=2.0)
    one.step(0.75)
    one.set(a_v=-12.0)
    assert one.get("a_v_ground") == pytest.approx(1.5 - 12.0, rel=1e-14)
    assert one.get("R_v") == pytest.approx((EVISON.m + EVISON.m0) * (9.81 + 1.5 - 12.0), rel=1e-12)


@pytest.mark.parametrize("text, found, scale, doubts", [
    ("t (s),a (g)\n0,0.1\n0.01,0.2\n", "table, ", 1.0, 0),
    ("t (s),a\n0,0.1\n0.01,0.2\n", "m/s2 assumed", 1.0, 1),
    ("t (s),a (g)\n0,90\n0.01,0\n", "table, ", 1.0, 2),
    ("t (s),a (g)\n0,90\n0.01,0\n", "table, ", 1e-3, 0),
])
def test_what_was_found_and_assumed_of_a_record_is_logged_before_the_run(wall, text, found, scale, doubts):
    """The content if events are asked for, and what is doubtful in any case."""
    wall.write("a.csv", text)
    first, *others = wall.start(record="a.csv", record_scale=scale).messages
    assert first.text.startswith("a.csv: ") and found in first.text and first.category == "logEvents"
    assert [message.category for message in others] == ["logStatusWarning"] * doubts, others


# With full restitution a structure gains energy at impacts, and without stiffness it takes tension to hold its base down.
LIVELY = dict(r=1.0, f_fc=4.0)
LIMITS = ["tension_max", "R_v_min", "mu_required", "mu_impact", "tension_impact", "energy_gain_max", "weight_min"]


@pytest.fixture
def lively(wall):
    """Makes an instance whose ground is about to quake for 5 s, if it is the record."""
    time = 0.02 * np.arange(251)
    write(wall.resources / "quake.csv", "m/s2", time, 3 * np.sin(9 * time) + 2 * np.sin(31 * time))
    return lambda is_watched: wall.start(record="quake.csv", validity=is_watched, peaks=is_watched, **LIVELY)


def test_what_is_gone_beyond_is_that_of_a_run_and_told_once(lively, wall, exporter):
    """Whatever the steps, the values are those of the command line's run."""
    options = [f"--{name.replace('_', '-')}={value}" for name, value in LIVELY.items()]
    told = json.loads(output(exporter, "--quiet", "simulate", "--preset", "evison", "--record", wall.resources / "quake.csv", "--duration", 5,
                             "--format", "json", *options))
    expected = {row["name"]: row for row in told["validity"]}
    passed = [name for name in LIMITS if expected[name]["first_beyond"] is not None]
    assert passed == ["tension_max", "R_v_min", "mu_required", "energy_gain_max"]
    for steps in ([5.0], [0.1] * 50, [0.013, 1.7, 0.5, 2.787]):
        one = lively(True)
        one.taken()
        stepped(one, steps)
        for name in LIMITS:
            row = expected[name]
            assert one.get(name, f"t_{name}") == pytest.approx([float(row["value"]), row["time"]], rel=1e-9)
        assert one.get("energy_gains") > 0
        warnings = one.warnings()
        instants = {text.split(" is ")[0].split()[-1]: float(text.split()[2]) for text in warnings}
        assert len(warnings) == len(passed) and instants == pytest.approx({name: expected[name]["first_beyond"] for name in passed}, rel=5e-6)


def test_limits_are_known_at_the_start(wall):
    """Of the start itself, before any step."""
    one = wall.start(theta_0=0.02, validity=True)
    assert one.get("R_v_min") == one.get("R_v") / ((125.8 + 44.02) * 9.81)
    assert one.get("tension_max", "energy_gain_max") == [-np.inf, 0.0], "the base has not been down"


def test_what_nobody_asks_for_is_not_watched(lively):
    """And changes no bit."""
    watched, silent = lively(True), lively(False)
    silent.taken()
    for one in (watched, silent):
        one.step(5.0)
    assert watched.reals() == silent.reals() and watched.get("transitions") == silent.get("transitions")
    names = [*LIMITS, *watched.fmu.peaks]
    assert np.isnan(silent.reals([*names, *(f"t_{name}" for name in names)])).all() and silent.get("energy_gains") == 0
    assert watched.get("theta_max") > 0 and silent.warnings() == []
