"""Refused calls: each says why and changes nothing."""

import ctypes
from ctypes import POINTER, c_char_p, c_double, c_uint, c_void_p, cast

import numpy as np
from host import _LOGS, DISCARD, ERROR, _callbacks, refused, status

NAN, INF = float("nan"), float("inf")


def raw(one, name, *arguments):
    """A function of C by its name without the version."""
    return getattr(one.slave, f"fmi{2 + one.is_3}{name}")(one.slave.component, *arguments)


def reals(one, value, count=1):
    """Reads variable 1 into `value`."""
    return raw(one, "GetFloat64" if one.is_3 else "GetReal", (c_uint * 1)(1), count, value, *[count] * one.is_3)


# The message in the log, in the words of FMI 2.0, and the call.
INSTANTIATED = [
    ("tolerance = 1 is out of range: it must be between 0 and 1, such as 1e-9", lambda one: one.enter(1.0)),
    ("startTime = NaN is out of range: it must be finite", lambda one: one.enter(start=NAN)),
    ("stopTime = 1.9 is out of range: it must be finite and not before startTime = 2 s", lambda one: one.enter(start=2.0, stop=1.9)),
    ("category must be a valid pointer", lambda one: raw(one, "SetDebugLogging", True, 1, (c_char_p * 1)(None))),
]

# None of the values of a call is taken over; the first that is wrong is told.
INITIALIZING = [
    ("r = 0 is out of range: it must lie between 0.001 and 1 (", lambda one: one.set_reals(H=2.0, a_g=1.0, r=0.0)),
    ("a_g = 20000 m/s2 is out of range: it must lie between", lambda one: one.set(a_g=2e4)),
    ("theta cannot be set: it is an output, computed by the FMU", lambda one: one.set_reals(u_0=1e-3, theta=0.1)),
    ("chi cannot be set: it is a calculated parameter, computed by the FMU", lambda one: one.set(chi=NAN)),
    ("phase cannot be set: it is a local variable, computed by the FMU", lambda one: one.set(phase=1)),
    ("detail = 0 is out of range: 1 = auto", lambda one: one.set(detail=0)),
    ("record is a string: call fmi2GetString or fmi2SetString instead", lambda one: one.set_reals(record=1.0)),
    ("phase is an enumeration: call fmi2GetInteger or fmi2SetInteger instead", lambda one: one.reals(["phase"])),
    ("overturned is a Boolean: call fmi2GetBoolean or fmi2SetBoolean instead", lambda one: one.reals(["theta", "overturned"])),
    ("theta cannot be a known of a directional derivative: only the inputs can, before the simulation starts real",
     lambda one: one.derivative("a_t", "theta")),
    ("m is a real number: call fmi2GetReal or fmi2SetReal instead",
     lambda one: getattr(one.slave, "setInt64" if one.is_3 else "setInteger")([one.reference("m")], [1])),
    ("transitions is an integer: call fmi2GetInteger instead", lambda one: one.slave.getBoolean([one.reference("transitions")])),
    ("value reference 4000000000 does not exist; they run from 0 to ",
     lambda one: getattr(one.slave, "setFloat64" if one.is_3 else "setReal")([4_000_000_000, one.reference("phase")], [1.0] * 2)),
    ("value must be a valid pointer; it is null or misaligned",
     lambda one: raw(one, "SetString", (c_uint * 1)(one.reference("record")), 1, (c_char_p * 1)(None), *[1] * one.is_3)),
    ("value must be a valid pointer; it is null or misaligned", lambda one: reals(one, cast(9, POINTER(c_double)))),
    ("18446744073709551615 values are too many for one call: at most 16777216", lambda one: reals(one, (c_double * 1)(), 2**64 - 1)),
]

# From 10 s to 12 s, at 10.5 s.
STEPPING = [
    ("m is fixed once the simulation has started: set it before fmi2ExitInitializationMode, or call fmi2Reset",
     lambda one: one.set_reals(a_g=1.0, m=0.5)),
    ("record is fixed once the simulation has started", lambda one: one.set(record="b.csv")),
    ("peaks is fixed once the simulation has started", lambda one: one.set(peaks=True)),
    ("order = 2 for theta is out of range: only derivatives of order 1 exist", lambda one: one.rate("theta", 2)),
    ("phase has no derivative: only continuous real outputs have", lambda one: one.rate("phase")),
    ("m cannot be a known of a directional derivative: only the inputs can, before", lambda one: one.derivative("a_t", "m")),
    ("delta_t cannot be a known of a directional derivative: only the inputs can, before the simulation starts real parameters and, "
     "once it has started, u, u_dot, theta, theta_dot and time", lambda one: one.derivative("a_t", "delta_t")),
    ("the derivative of a_g, NaN, is out of range: it must be finite", lambda one: one.derive(["a_t"], ("a_g", NAN))),
    ("a_g has no derivative: only continuous real outputs have", lambda one: one.rate("a_g")),
    ("I_v has no derivative: only continuous real outputs have", lambda one: one.rate("I_v")),
    ("currentCommunicationPoint = 10 s differs from the time of the FMU, t = 10.5 s: step from there, or go back with "
     "fmi2SetFMUstate", lambda one: one.slave.doStep(10.0, 0.5)),
    ("currentCommunicationPoint = 10.501 s differs from the time of the FMU", lambda one: one.slave.doStep(10.501, 0.5)),
    ("communicationStepSize = 0 s is out of range: it must be positive, finite, large enough to move t = 10.5 s, and end",
     lambda one: one.slave.doStep(10.5, 0.0)),
    ("communicationStepSize = NaN s is out of range", lambda one: one.slave.doStep(10.5, NAN)),
    ("communicationStepSize = 1e-16 s is out of range", lambda one: one.slave.doStep(10.5, 1e-16)),
    ("the step would end at t = 12.1 s, past stopTime = 12 s given to fmi2SetupExperiment: shorten it",
     lambda one: one.slave.doStep(10.5, 1.6)),
]

# At 10.5 s, under a = 1 m/s2 that grows by 1e5 m/s3.
OF_FMI_2 = [
    ("order = 2 for a_g is out of range: only derivatives of order 1 exist",
     lambda one: one.slave.setRealInputDerivatives([one.reference("a_g")], [2], [1.0])),
    ("the derivative of a_g, NaN, is out of range: it must be finite", lambda one: one.slope("a_g", NAN)),
    ("theta has no derivative that can be set: only the inputs have", lambda one: one.slope("theta", 1.0)),
    ("at the end of the step, a_g = 20001 m/s2 is out of range: it must lie between -10000 and 10000 m/s2 (",
     lambda one: one.slave.doStep(10.5, 0.2)),
    ("fmi2StatusKind = 4 is not one of 0 (fmi2DoStepStatus), 1 (fmi2PendingStatus), 2 (fmi2Last", lambda one: one.slave.getStatus(4)),
    ("loggingOn = 2 is not one of 0 (fmi2False), 1 (fmi2True)", lambda one: raw(one, "SetDebugLogging", 2, 0, None)),
]

OF_FMI_3 = [
    ("fmi3GetFloat64: nValues = 2 is not 1", lambda one: raw(one, "GetFloat64", (c_uint * 1)(2), 1, (c_double * 2)(), 2)),
    ("fmi3GetDirectionalDerivative: nSeed = 2 is not 1", lambda one: one.slave.getDirectionalDerivative([2], [1], [1.0] * 2)),
    ("fmi3GetUInt8: this FMU has no variables of this type", lambda one: one.slave.getUInt8([1])),
    ('fmi3GetAdjointDerivative: not allowed in the state "step complete"; allowed in: no state: this instance does not provide',
     lambda one: one.slave.getAdjointDerivative([2], [1], [1.0])),
    ("fmi3EnterEventMode: there is no event mode: the instance was made with eventModeUsed = false",
     lambda one: one.slave.enterEventMode()),
]

# The words of FMI 3.0 that say the same as those of FMI 2.0.
WORDS = {"value must": "values must", "from 0 to": "from 1 to", "GetInteger instead": "GetInt32 instead", "Integer": "Int64",
         "Real": "Float64", "FMUstate": "FMUState", "SetupExperiment": "EnterInitializationMode", "fmi2": "fmi3"}


def test_a_refused_call_says_why_and_changes_nothing(wall, wall3):

    def check(one, calls):
        for text, call in calls:
            for of_2, of_3 in WORDS.items() if one.is_3 else ():
                text = text.replace(of_2, of_3)
            with refused(one, text):
                call(one)

    for fmu in (wall, wall3):
        check(fmu.instance(), INSTANTIATED)
        check(fmu.instance().enter(), INITIALIZING)
        stepping = fmu.start(start=10.0, stop=12.0)
        stepping.step(10.5)
        check(stepping, STEPPING)
    of_2, of_3 = wall.start(start=10.5), wall3.start()
    of_2.input("a_g", 1.0, 1e5)
    check(of_2, OF_FMI_2)
    check(of_3, OF_FMI_3)
    assert of_3.slave.getUInt8([]) == [] and of_3.slave.setBinary([], []) is None


def test_a_fixed_parameter_may_be_set_to_the_value_that_it_has(wall):
    """Hosts set all start values again, also after the start."""
    one = wall.start(theta_0=0.02)
    one.step(0.1)
    before = one.bytes()
    one.set_reals(m=one.get("m"), theta_0=0.02)
    one.set(record="", peaks=False, detail=1)
    assert one.bytes() == before


def test_a_status_that_is_never_there_is_discarded(wall):
    one = wall.start()
    assert status(one.slave.getStringStatus, 1) == DISCARD
    assert one.messages[-1].text == ("fmi2GetStringStatus: fmi2PendingStatus has no answer here: fmi2DoStep never returns fmi2Pending, "
                                     "fmi2GetRealStatus knows fmi2LastSuccessfulTime, fmi2GetBooleanStatus knows fmi2Terminated")


def test_contradictions_are_refused_when_initialization_ends_and_can_be_put_right(wall):
    one = wall.instance().enter(theta_dot_0=0.5)
    text = ("theta_dot_0 = 0.5 rad/s contradicts theta_0 = 0 (full contact, where theta and theta_dot are both 0): set theta_dot_0 to "
            "0, or theta_0 to an angle with the sign of the pivot that the structure rocks about")
    for call in (one.exit, lambda: one.reals(["m", "theta"])):
        with refused(one, text):
            call()
    assert one.get("theta_dot_0") == 0.5
    one.set_reals(theta_0=0.02, H=1000.0, B=0.5)
    with refused(one, "H/B = 2000 is out of range: H must not exceed 1000 B; lower H or raise B"):
        one.exit()
    one.set(B=500.0)
    one.exit()
    assert one.get("theta", "theta_dot", "H") == [0.02, 0.5, 1000.0]


def test_an_instance_that_cannot_be_made_is_null_and_the_log_says_why(wall, mcmanus):
    one = wall.instance()
    own, other, build = wall.description.guid, mcmanus.description.guid, one.bytes()[:38].decode()
    wrong = lambda guid: f'fmuGUID = "{guid}" is not {own}: modelDescription.xml, the library '

    def instantiate(name="wall", kind=1, guid=own, location=wall.resources.as_uri(), logs=0):
        callbacks = ctypes.byref(_callbacks())
        return one.slave.fmi2Instantiate(name.encode(), kind, guid.encode(), location.encode(), callbacks, 0, logs)

    for changed, text in [
        (dict(guid=build), wrong(build)),
        (dict(guid=other), wrong(other)),
        (dict(name=""), "instanceName must not be empty"),
        (dict(kind=2), "fmuType = 2 is not one of 0 (fmi2ModelExchange), 1 (fmi2CoSimulation)"),
        (dict(logs=2), "loggingOn = 2 is not one of 0 (fmi2False), 1 (fmi2True)"),
        (dict(location="file:///nowhere/100%25"),
         "/nowhere/100%/contents.bin: No such file or directory (os error 2); unpack the whole archive and pass "),
        (dict(location="/nowhere"), 'fmuResourceLocation = "/nowhere" is not a file URI of this machine, such as file:///tmp/fmu/resources'),
    ]:
        messages = _LOGS[changed.get("name", "wall").encode()] = []
        assert instantiate(**changed) is None
        (message,) = messages
        assert message.text.startswith(f"fmi2Instantiate: {text}"), message
        assert (message.status, message.category) == (ERROR, "logStatusError")
    assert one.slave.fmi2Instantiate(b"a", 1, None, None, None, 0, 0) is None


def test_what_is_no_component_is_an_error_and_freeing_it_does_nothing(wall, wall3):
    """Null, other memory, a misaligned pointer, and an instance of the other version."""
    memory, of_2, of_3 = np.zeros(64, dtype=np.uint64), wall.start(), wall3.start("ModelExchange")
    before = of_2.bytes(), of_3.bytes()
    other = memory.ctypes.data
    for c in (None, other, other + 4, of_3.slave.component):
        assert status(of_2.slave.fmi2DoStep, c_void_p(c), 0.0, 1.0, 0) == ERROR
        assert status(of_2.slave.fmi2GetReal, c_void_p(c), (c_uint * 1)(1), 1, (c_double * 1)()) == ERROR
        of_2.slave.fmi2FreeInstance(c_void_p(c))
    assert status(of_3.slave.fmi3Reset, of_2.slave.component) == ERROR
    of_3.slave.fmi3FreeInstance(of_2.slave.component)
    assert (of_2.bytes(), of_3.bytes()) == before
