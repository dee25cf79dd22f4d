"""The deck on its bearings as an FMU, for pythonfmu, with the ground motion among its resources."""

from pathlib import Path

import numpy as np
from pythonfmu import Boolean, Fmi2Causality, Fmi2Slave, Fmi2Variability, Real
from swaying_mass import SwayingMass

PIERS = 2


class Deck(Fmi2Slave):
    """The tops of the piers in; what each bearing exerts on its pier, and the deck's displacement, out.

    Between two communication points inputs go on with the slope of their last two values, or are held.
    """

    def __init__(self, M=1.0, k=1.0, c=0.0, **kwargs):
        super().__init__(**kwargs)
        self.M, self.k, self.c, self.extrapolated = M, k, c, True
        tunable = dict(causality=Fmi2Causality.parameter, variability=Fmi2Variability.tunable)
        for name in ("M", "k", "c"):
            self.register_variable(Real(name, **tunable))
        self.register_variable(Boolean("extrapolated", **tunable))
        self.x = 0.0
        self.register_variable(Real("x", causality=Fmi2Causality.output))
        for pier in range(PIERS):
            for name, causality in (("delta_t", "input"), ("v_t", "input"), ("F", "output")):
                setattr(self, f"{name}_{pier}", 0.0)
                self.register_variable(Real(f"{name}_{pier}", causality=Fmi2Causality[causality]))

    def exit_initialization_mode(self):
        self.mass = SwayingMass(self.M, self.k, self.c)
        self.record = np.loadtxt(next(Path(self.resources).glob("*.csv")), delimiter=",", skiprows=1).T
        self.before = np.zeros((PIERS, 2))

    def do_step(self, current_time, step_size):
        mass = self.mass
        tops = np.array([(getattr(self, f"delta_t_{pier}"), getattr(self, f"v_t_{pier}")) for pier in range(PIERS)])
        line = np.array([tops, 2 * tops - self.before if self.extrapolated else tops])
        self.before = tops
        a_g = np.interp((current_time, current_time + step_size), *self.record)
        mass.step(step_size, (self.k * line[..., 0] + self.c * line[..., 1]).mean(axis=1) - self.M * a_g)
        self.x = mass.x
        for pier, (delta, v) in enumerate(line[1].tolist()):
            setattr(self, f"F_{pier}", (self.k * (mass.x - delta) + self.c * (mass.v - v)) / PIERS)
        return True
