"""A rocking structure: one instance of the FMU."""

import contextlib
import tempfile
import weakref

import fmpy
import numpy as np
from fmpy.fmi2 import fmi2False
from fmpy.simulation import instantiate_fmu


FMI_3 = {"getReal": "getFloat64", "setReal": "setFloat64", "getInteger": "getInt32", "newDiscreteStates": "updateDiscreteStates",
         "getFMUstate": "getFMUState", "setFMUstate": "setFMUState", "freeFMUstate": "freeFMUState"}


def opened(owner, fmu: str, fmi_type: str = "CoSimulation", updated=(), **options):
    """An instance of the FMU that lasts as long as `owner`, and its value references by name; `updated` are set within a step.

    An instance of FMI 3.0 also has the names of FMI 2.0.
    """
    folder = tempfile.TemporaryDirectory()
    fmpy.extract(fmu, unzipdir=folder.name)
    description = fmpy.read_model_description(folder.name)
    references = {variable.name: variable.valueReference for variable in description.modelVariables}
    instance = instantiate_fmu(folder.name, description, fmi_type, **options,
                               required_intermediate_variables=[references[name] for name in updated])
    weakref.finalize(owner, free, instance, folder)
    if description.fmiVersion.startswith("3"):
        vars(instance).update({name: getattr(instance, of_3) for name, of_3 in FMI_3.items()})
    return instance, references


def free(instance, folder):
    instance.freeInstance()
    folder.cleanup()


class Structure:
    """Steps under inputs that are lines in time, and goes back to a state when asked."""

    def __init__(self, fmu: str, inputs: list[str], outputs: list[str], **options):
        self.instance, self.references = opened(self, fmu, **options)
        if hasattr(self.instance, "setupExperiment"):
            self.instance.setupExperiment()
        self.instance.enterInitializationMode()
        self.instance.exitInitializationMode()
        self.inputs = [self.references[name] for name in inputs]
        self.outputs = [self.references[name] for name in outputs]

    def read(self, *names: str) -> list[float]:
        return self.instance.getReal([self.references[name] for name in names])

    def derivative(self, output: str, of: str) -> float:
        """Of an output by an input, at the present state."""
        return self.instance.getDirectionalDerivative([self.references[output]], [self.references[of]], [1.0])[0]

    def transitions(self) -> int:
        return self.instance.getInteger([self.references["transitions"]])[0]

    def step(self, t: float, h: float, line) -> list[float]:
        """The outputs at the end of the step under `line`, the inputs at its start and at its end."""
        start, end = line
        self.instance.setReal(self.inputs, start)
        self.instance.setRealInputDerivatives(self.inputs, [1] * len(start), (np.subtract(end, start) / h).tolist())
        self.instance.doStep(t, h, fmi2False)
        return self.instance.getReal(self.outputs)

    @contextlib.contextmanager
    def checkpoint(self):
        """The present state, for `restore` to go back to."""
        state = self.instance.getFMUstate()
        try:
            yield state
        finally:
            self.instance.freeFMUstate(state)

    def restore(self, state) -> None:
        self.instance.setFMUstate(state)
