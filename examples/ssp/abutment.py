"""An abutment behind a gap (m), of a stiffness (N/m): make its FMU with `python -m pythonfmu build -f abutment.py`."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real


class Abutment(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.gap, self.stiffness, self.delta_t, self.force = 0.03, 2e7, 0.0, 0.0
        for name in "gap", "stiffness":
            self.register_variable(Real(name, causality=Fmi2Causality.parameter, variability=Fmi2Variability.fixed))
        self.register_variable(Real("delta_t", causality=Fmi2Causality.input))
        self.register_variable(Real("force", causality=Fmi2Causality.output))

    def do_step(self, time, step):
        self.force = -self.stiffness * max(self.delta_t - self.gap, 0.0)
        return True
