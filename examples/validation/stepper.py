"""The FMU stepped with its C functions called directly: a microsecond a step, for many runs."""

from ctypes import c_double, c_uint
from dataclasses import dataclass
from pathlib import Path

import fmpy
import numpy as np
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE

DISCARD = 2  # status of the step in which the structure overturns
AUTO, LINEAR, RIGID = 1, 3, 5  # levels of detail


@dataclass(frozen=True)
class History:
    """Lateral displacement of the top mass at evenly spaced instants, and the largest acceleration of all; SI units."""

    time: np.ndarray
    delta_t: np.ndarray
    peak_acceleration: float
    peak_time: float
    transitions: int
    overturned: bool


class Stepper:
    """One instance of the FMU in `folder`, run again and again."""

    def __init__(self, folder: Path, tolerance: float, detail: int = AUTO):
        description = fmpy.read_model_description(str(folder))
        self.tolerance = tolerance
        self.detail = detail
        self.references = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.slave = FMU2Slave(guid=description.guid, unzipDirectory=str(folder),
                               modelIdentifier=description.coSimulation.modelIdentifier, instanceName="stepper")
        self.callbacks = fmi2CallbackFunctions(logger=fmi2CallbackLoggerTYPE(lambda *_: None))
        self.slave.instantiate(callbacks=self.callbacks)

    def run(self, start_values: dict[str, float], h: float, steps: int, record: Path | str = "") -> History:
        """The response in steps of `h` (s) under a record, or with the ground at rest, to overturning at most."""
        slave, library, component = self.slave, self.slave.dll, self.slave.component
        slave.reset()
        slave.setupExperiment(self.tolerance, 0.0, None)
        slave.setString([self.references["record"]], [str(record)])
        slave.setInteger([self.references["detail"]], [self.detail])
        slave.setBoolean([self.references["peaks"]], [True])
        slave.setReal([self.references[name] for name in start_values], list(start_values.values()))
        slave.enterInitializationMode()
        slave.exitInitializationMode()

        delta_t = (c_uint * 1)(self.references["delta_t"])
        values = ((c_double * 1) * (steps + 1))()
        library.fmi2GetReal(component, delta_t, 1, values[0])
        status, done = 0, 0
        while done < steps and not (status := library.fmi2DoStep(component, c_double(done * h), c_double(h), 1)):
            done += 1
            library.fmi2GetReal(component, delta_t, 1, values[done])
        if status not in (0, DISCARD):
            raise RuntimeError(f"the FMU refused the step from {done * h} s with status {status}")
        peak, instant = slave.getReal([self.references[name] for name in ("a_t_max", "t_a_t_max")])
        return History(np.arange(done + 1) * h, np.ctypeslib.as_array(values)[: done + 1, 0], peak, instant,
                       transitions=slave.getInteger([self.references["transitions"]])[0], overturned=status == DISCARD)
