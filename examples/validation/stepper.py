"""One instance of the FMU with its C functions called directly, for many runs of one step each."""

from ctypes import c_double
from dataclasses import dataclass
from pathlib import Path

import fmpy
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE

DISCARD = 2  # status of the step in which the structure overturns
AUTO, LINEAR, RIGID = 1, 3, 5  # levels of detail


@dataclass(frozen=True)
class Outcome:
    """What became of a structure."""

    transitions: int
    overturned: bool


class Stepper:
    """The FMU in `folder`, run again and again."""

    def __init__(self, folder: Path, tolerance: float, detail: int):
        description = fmpy.read_model_description(str(folder))
        self.tolerance = tolerance
        self.detail = detail
        self.references = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.slave = FMU2Slave(guid=description.guid, unzipDirectory=str(folder),
                               modelIdentifier=description.coSimulation.modelIdentifier, instanceName="stepper")
        self.callbacks = fmi2CallbackFunctions(logger=fmi2CallbackLoggerTYPE(lambda *_: None))
        self.slave.instantiate(callbacks=self.callbacks)

    def run(self, start_values: dict[str, float], duration: float, record: Path) -> Outcome:
        """What becomes of it under a record within a duration (s), or until it overturns."""
        slave = self.slave
        slave.reset()
        slave.setupExperiment(self.tolerance, 0.0, None)
        slave.setString([self.references["record"]], [str(record)])
        slave.setInteger([self.references["detail"]], [self.detail])
        slave.setReal([self.references[name] for name in start_values], list(start_values.values()))
        slave.enterInitializationMode()
        slave.exitInitializationMode()
        status = slave.dll.fmi2DoStep(slave.component, c_double(0.0), c_double(duration), 1)
        if status not in (0, DISCARD):
            raise RuntimeError(f"the FMU refused a step of {duration} s with status {status}")
        return Outcome(slave.getInteger([self.references["transitions"]])[0], status == DISCARD)
