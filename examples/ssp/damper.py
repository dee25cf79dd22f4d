"""A damper of a tendon, whose force grows with a power of the velocity: make its FMU with `python -m pythonfmu build -f damper.py`."""

from math import copysign

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real


class Damper(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.coefficient, self.power, self.v_t, self.other, self.force = 4e5, 0.3, 0.0, 0.0, 0.0
        for name in "coefficient", "power":
            self.register_variable(Real(name, causality=Fmi2Causality.parameter, variability=Fmi2Variability.fixed))
        for name in "v_t", "other":
            self.register_variable(Real(name, causality=Fmi2Causality.input))
        self.register_variable(Real("force", causality=Fmi2Causality.output))

    def do_step(self, time, step):
        self.force = self.other - copysign(self.coefficient * abs(self.v_t) ** self.power, self.v_t)
        return True
