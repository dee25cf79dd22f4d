"""FMU states, kept, restored and serialized; instances beside each other; what they log."""

import ctypes
import re
from concurrent.futures import ThreadPoolExecutor
from ctypes import byref
from itertools import groupby

import numpy as np
import pytest
from host import ERROR, OK, WARNING, refused, status

SHOWN = "theta u a_t theta_dot u_dot e_p1 E_viscous a_v_ground a_ground theta_max R_v_min energy_gain_max".split()


def at2(samples: int) -> str:
    """A quake in g, every 20 ms, that begins at another acceleration than 0."""
    i = np.arange(samples)
    a_g = (1 - i / samples) * (0.4 * np.sin(3.7 * i * i) + 0.5 * np.cos(0.6 * i))
    header = f"PEER\nmade up\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= {samples}, DT= .0200 SEC\n"
    return header + "".join(f"{value!r}\n" for value in a_g.tolist())


def run(one) -> list:
    """A hundred steps of 10 ms; the outputs after each."""
    rows = []
    for _ in range(100):
        a_g = 6 * np.sin(9 * one.time)
        one.input("a_g", a_g, 2.0)
        one.input("a_v", 0.3 * a_g, 0.6)
        one.set(F_t=40 * np.sin(7 * one.time))
        one.step(one.time + 0.01)
        rows.append(one.reals(SHOWN))
    return rows


def rocking(fmu):
    """Amid rocking with dissipators and a record, one input with a slope set and one that goes on with that of its last two values."""
    fmu.write("quake.AT2", at2(600))
    one = fmu.start(theta_0=0.02, r=0.9, xi_d=0.2, c_d=5.0, k_d=1e6, F_y=30.0, F_t_extrapolated=True, peaks=True, validity=True,
                    record="quake.AT2")
    run(one)
    one.input("a_g", 3.0, -40.0)
    return one


def test_going_back_repeats_the_same_bits(wall):
    """In the instance itself and, from bytes, in another, if the record has the same samples. The log has the same messages: no limit
    is told again that was told before."""
    one, other = rocking(wall), wall.instance()
    assert any("R_v_min" in message.text for message in one.taken())
    state, kept = one.slave.getFMUState(), one.bytes()

    def go_on(one):
        one.time = 1.0
        one.step(1.01)
        return one.reals(SHOWN), run(one), one.bytes(), one.taken()

    first = go_on(one)
    assert one.get("transitions") > 3 and np.isfinite(one.rate("R_h")) and first[3]
    assert one.bytes() == first[2], "reading changes nothing"
    for _ in range(2):
        one.slave.setFMUState(state)
        assert go_on(one) == first
        one.slave.terminate()
    state = other.slave.deSerializeFMUstate(kept)
    assert other.bytes() == wall.instance().bytes(), "deserializing alone changes nothing"
    other.slave.setFMUState(state)
    assert other.bytes() == kept and other.get("record", "r", "theta_0", "a_g") == [b"quake.AT2", 0.9, 0.02, 3.0]
    assert go_on(other) == first
    other.slave.reset()
    wall.write("quake.AT2", at2(599))
    with refused(other, 'fmi2SetFMUstate: the samples of record = "quake.AT2" changed after the FMU state was saved'):
        other.slave.setFMUState(state)
    (wall.resources / "quake.AT2").unlink()
    with refused(other, 'record = "quake.AT2" is not in '):
        other.slave.setFMUState(state)


def test_a_state_can_be_overwritten_and_outlives_a_reset_but_is_of_no_other_instance(wall):
    one, other = rocking(wall), wall.instance()
    state, foreign = one.slave.getFMUState(), other.slave.getFMUState()
    handle = state.value
    keep = lambda state: one.slave.fmi2GetFMUstate(one.slave.component, byref(state))
    one.step(1.01)
    later = one.bytes()
    keep(state)
    assert state.value == handle
    one.slave.reset()
    one.slave.setFMUState(state)
    assert one.bytes() == later
    for call in (one.slave.setFMUState, one.slave.serializeFMUstate, one.slave.freeFMUstate, keep):
        with refused(one, f"FMUstate {foreign.value:#x} is not one that this instance has handed"):
            call(foreign)
    for nothing in (byref(ctypes.c_void_p()), None):
        assert one.slave.fmi2FreeFMUstate(one.slave.component, nothing) == OK
    one.slave.setFMUState(one.slave.deSerializeFMUstate(wall.start(stop=1.0).bytes()))
    with refused(one, "the step would end at t = 2 s, past stopTime = 1 s"):
        one.slave.doStep(0.0, 2.0)


def test_bytes_that_are_no_state_of_this_build_are_refused(wall):
    one = rocking(wall)
    kept = one.bytes()
    spoilt = lambda at: kept[:at] + bytes([kept[at] ^ 0x10]) + kept[at + 1:]
    cut = [kept[:length] for length in (38, 53, len(kept) - 1)]
    for reason, wrong in (("it does not begin with the name of this build", [b"", spoilt(20)]),
                          ("its checksum is wrong", [*cut, kept + b"\0", *map(spoilt, range(38, len(kept)))])):
        for each in wrong:
            with refused(one, f"fmi2DeSerializeFMUstate: serializedState is not a serialized state of this FMU: {reason}"):
                one.slave.deSerializeFMUstate(each)
    state, needed = one.slave.getFMUState(), len(kept)
    for given in (0, needed - 1, needed + 1):
        with refused(one, f"fmi2SerializeFMUstate: size = {given} does not fit: the serialized FMU state takes {needed} bytes "
                          "(fmi2SerializedFMUstateSize)"):
            one.slave.fmi2SerializeFMUstate(one.slave.component, state, ctypes.create_string_buffer(given), given)


def test_a_state_is_taken_by_an_instance_of_its_kind_alone(wall3):
    kinds = [wall3.instance("ModelExchange"), wall3.instance(), wall3.instance(eventModeUsed=True, earlyReturnAllowed=True)]
    for of, by in ((0, 1), (1, 2), (2, 0)):
        state = kinds[by].slave.deserializeFMUState(kinds[of].bytes())
        with refused(kinds[by], "fmi3SetFMUState: the FMU state was kept by an instance for the other interface, or with another "
                                "eventModeUsed or earlyReturnAllowed"):
            kinds[by].slave.setFMUState(state)


def test_the_library_says_what_it_is(mcmanus, evison, wall):
    one = wall.instance()
    assert (one.slave.getTypesPlatform(), one.slave.getVersion()) == ("default", "2.0")
    guids = {fmu.description.guid for fmu in (mcmanus, evison)} | {wall.start().bytes()[:38].decode()}
    assert len(guids) == 3 and all(re.fullmatch(r"\{[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}\}", guid) for guid in guids)
    assert wall.description.guid == evison.description.guid


def test_instances_do_not_feel_each_other(wall):
    """One after the other, step by step in turn, and on eight threads."""

    def shaken(ones):
        for t in 0.02 * np.arange(60):
            for one in ones:
                one.set(a_g=8 * np.sin(5 * t))
                one.slave.doStep(t, 0.02)
        return [one.bytes() for one in ones]

    new = lambda: [wall.start(m=100.0 + number) for number in range(8)]
    alone = [shaken([one])[0] for one in new()]
    assert shaken(new()) == alone and alone[0] != alone[1]
    with ThreadPoolExecutor(8) as threads:
        assert [found for (found,) in threads.map(lambda one: shaken([one]), new())] == alone


EVENTS, WARNINGS = ["logStatusError", "logEvents"], ["logStatusWarning"]


@pytest.mark.parametrize("fmi, logs, switched, expected", [
    (2, False, [], "StatusWarning StatusError"),
    (2, True, [], "StatusWarning Events StatusError"),
    (2, False, [(True, [])], "StatusWarning Events StatusError"),
    (2, True, [(False, [])], "StatusWarning StatusError"),
    (2, True, [(False, EVENTS)], "StatusWarning StatusError"),
    (2, False, [(True, EVENTS)], "StatusWarning Events StatusError"),
    (2, True, [(True, WARNINGS)], "StatusWarning StatusError"),
    (3, False, [], "StatusError"),
    (3, True, [], "StatusWarning Events StatusError"),
    (3, False, [(True, [])], "StatusWarning Events StatusError"),
    (3, False, [(True, []), (False, WARNINGS)], "Events StatusError"),
    (3, False, [(True, WARNINGS)], "StatusWarning StatusError"),
    (3, False, [(True, []), (False, [])], "StatusError"),
])
def test_a_host_gets_the_categories_that_it_switches_on(wall, wall3, fmi, logs, switched, expected):
    """In FMI 2.0 events alone are switched, in FMI 3.0 each category by itself; the reasons of refused calls are always logged."""
    one = (wall3 if fmi == 3 else wall).instance(logs=logs)
    for on, categories in switched:
        one.slave.setDebugLogging(on, categories)
    one.initialize(theta_0=0.01, r=0.5).step(0.5)
    assert status(one.slave.doStep, 0.0, 0.5) == ERROR
    assert [name for name, _ in groupby(message.category for message in one.messages)] == [f"log{name}" for name in expected.split()]


PULL, GAIN, SLOW, FAR = "pulls at one of the edges", "can raise the energy", "u_cr = ", "far from the usual frequency"


@pytest.mark.parametrize("values, expected", [
    (dict(r=0.639), [PULL, GAIN]), (dict(r=0.641), [PULL]), (dict(r=0.818), [PULL]), (dict(r=0.820), []), (dict(r=0.998), []),
    (dict(r=0.9981), [GAIN]), (dict(f_fc=0.565), [FAR, SLOW, GAIN]), (dict(f_fc=0.566), [FAR, GAIN]),
    (dict(f_fc=0.565, r=0.5, detail=5), [FAR, PULL]), (dict(f_fc=0.565, r=0.5, detail=6), [FAR]),
])
def test_what_the_parameters_alone_say_is_warned_of(wall, values, expected):
    """At the start, whatever is asked for; the call returns OK, as there are hosts that end a simulation at fmi2Warning. Evison's
    geometry: an edge pulls below r = 0.8191, the energy can grow at u_cr outside 0.6396 to 0.9980, and u_cr is B at 0.5652 Hz."""
    messages = wall.start(**values).messages
    assert len(messages) == len(expected), messages
    for message, text in zip(messages, expected):
        assert text in message.text and (message.status, message.category) == (WARNING, "logStatusWarning"), message


def test_a_reset_instance_logs_as_it_was_instantiated_and_has_no_stop_time(wall):
    """An unknown category is refused, and the others of the call with it."""
    one = wall.instance(logs=False).initialize(stop=0.1)
    one.slave.setDebugLogging(True, [])
    one.slave.reset()
    with refused(one, 'fmi2SetDebugLogging: log category "100 % of ##it" does not exist; see LogCategories in modelDescription.xml'):
        one.slave.setDebugLogging(True, ["logEvents", "100 % of #it"])
    one.initialize(theta_0=0.01).step(0.5)
    assert one.get("transitions") > 0 and one.messages == []
