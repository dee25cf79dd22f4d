"""The FMU stepped with its C functions called directly: a few microseconds a step, for many runs."""

from ctypes import c_double, c_int, c_uint
from dataclasses import dataclass
from pathlib import Path

import fmpy
import numpy as np
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from scipy.interpolate import CubicHermiteSpline

DISCARD = 2  # status of the step in which the structure overturns


@dataclass(frozen=True)
class History:
    """Lateral displacement and acceleration of the top mass at evenly spaced instants, with their rates; SI units."""

    time: np.ndarray
    delta_t: np.ndarray
    a_t: np.ndarray
    delta_t_dot: np.ndarray
    a_t_dot: np.ndarray
    transitions: int
    overturned: bool

    @property
    def peak_acceleration(self) -> float:
        """Largest |a_t|, also between the instants: of the cubics through values and rates."""
        spline = CubicHermiteSpline(self.time, self.a_t, self.a_t_dot)
        extrema = spline.derivative().roots(discontinuity=False, extrapolate=False)
        return float(max(np.max(np.abs(self.a_t)), np.nanmax(np.abs(spline(extrema)), initial=0.0)))


class Stepper:
    """One instance of the FMU in `folder`, run again and again."""

    def __init__(self, folder: Path, tolerance: float):
        description = fmpy.read_model_description(str(folder))
        self.tolerance = tolerance
        self.references = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.slave = FMU2Slave(guid=description.guid, unzipDirectory=str(folder),
                               modelIdentifier=description.coSimulation.modelIdentifier, instanceName="stepper")
        self.callbacks = fmi2CallbackFunctions(logger=fmi2CallbackLoggerTYPE(lambda *_: None))
        self.slave.instantiate(callbacks=self.callbacks)

    def run(self, start_values: dict[str, float], a_g: np.ndarray, dt: float, per_sample: int) -> History:
        """The response to `a_g` (m/s2), sampled every `dt` (s) and linear between, to overturning at most."""
        slave, library, component = self.slave, self.slave.dll, self.slave.component
        slave.reset()
        slave.setupExperiment(self.tolerance, 0.0, None)
        slave.setReal([self.references[name] for name in start_values], list(start_values.values()))
        slave.enterInitializationMode()
        slave.exitInitializationMode()

        h = dt / per_sample
        slopes = (np.diff(a_g) / dt).tolist()
        loads = [(value + slope * h * part, slope) for value, slope in zip(a_g.tolist(), slopes)
                 for part in range(per_sample)]
        load_reference = (c_uint * 1)(self.references["a_g"])
        references = (c_uint * 2)(self.references["delta_t"], self.references["a_t"])
        orders = (c_int * 2)(1, 1)
        value, slope = (c_double * 1)(), (c_double * 1)()
        values = ((c_double * 2) * (len(loads) + 1))()
        rates = ((c_double * 2) * (len(loads) + 1))()
        done = 0
        library.fmi2GetReal(component, references, 2, values[0])
        for value[0], slope[0] in loads:  # the two arrays that the calls below read
            library.fmi2SetReal(component, load_reference, 1, value)
            library.fmi2SetRealInputDerivatives(component, load_reference, 1, orders, slope)
            status = library.fmi2DoStep(component, done * h, h, 1)
            if status:
                break
            done += 1
            library.fmi2GetReal(component, references, 2, values[done])
            library.fmi2GetRealOutputDerivatives(component, references, 2, orders, rates[done])
        else:
            status = 0
        if status not in (0, DISCARD):
            raise RuntimeError(f"the FMU refused the step from {done * h} s with status {status}")
        delta_t, a_t = np.ctypeslib.as_array(values)[:done + 1].T
        delta_t_dot, a_t_dot = np.ctypeslib.as_array(rates)[:done + 1].T
        return History(np.arange(done + 1) * h, delta_t, a_t, delta_t_dot, a_t_dot,
                       transitions=slave.getInteger([self.references["transitions"]])[0], overturned=status == DISCARD)
