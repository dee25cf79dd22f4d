"""A rocking structure: one instance of the FMU."""

import contextlib
import functools

import numpy as np
from host import Fmu

unpacked = functools.cache(Fmu)


class Structure:
    """Steps under inputs that are lines in time, and goes back to a state when asked. `how` makes the instance."""

    def __init__(self, fmu: str, inputs: list[str], outputs: list[str], **how):
        self.instance = unpacked(fmu).instance(logs=False, **how).initialize()
        self.inputs, self.outputs = inputs, outputs

    def read(self, *names: str) -> tuple[float, ...]:
        return self.instance.reals(names)

    def transitions(self) -> int:
        return self.instance.get("transitions")

    def step(self, t: float, h: float, line) -> tuple[float, ...]:
        """The outputs at the end of the step under `line`, the inputs at its start and at its end."""
        start, end = line
        slopes = np.subtract(end, start) / h
        for name, value, slope in zip(self.inputs, start, slopes.tolist()):
            self.instance.input(name, value, slope)
        self.instance.slave.doStep(t, h)
        return self.read(*self.outputs)

    @contextlib.contextmanager
    def checkpoint(self):
        """The present state, for `restore` to go back to."""
        state = self.instance.slave.getFMUState()
        try:
            yield state
        finally:
            self.instance.slave.freeFMUState(state)

    def restore(self, state) -> None:
        self.instance.slave.setFMUState(state)
