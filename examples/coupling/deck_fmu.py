"""The deck on its bearings as an FMU, for pythonfmu. Between two communication points its inputs are held."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real
from swaying_mass import SwayingMass

PIERS = 2


class Deck(Fmi2Slave):
    """a_g and the tops of the piers in; what each bearing exerts on its pier, and the deck's displacement, out."""

    def __init__(self, M=1.0, k=1.0, c=0.0, **kwargs):
        super().__init__(**kwargs)
        self.M, self.k, self.c = M, k, c
        for name in ("M", "k", "c"):
            self.register_variable(Real(name, causality=Fmi2Causality.parameter, variability=Fmi2Variability.tunable))
        self.a_g, self.x = 0.0, 0.0
        self.register_variable(Real("a_g", causality=Fmi2Causality.input))
        self.register_variable(Real("x", causality=Fmi2Causality.output))
        for pier in range(PIERS):
            for name, causality in (("delta_t", "input"), ("v_t", "input"), ("F", "output")):
                setattr(self, f"{name}_{pier}", 0.0)
                self.register_variable(Real(f"{name}_{pier}", causality=Fmi2Causality[causality]))

    def exit_initialization_mode(self):
        self.mass = SwayingMass(self.M, self.k, self.c)

    def do_step(self, current_time, step_size):
        mass = self.mass
        tops = [(getattr(self, f"delta_t_{pier}"), getattr(self, f"v_t_{pier}")) for pier in range(PIERS)]
        force = sum(self.k * delta + self.c * v for delta, v in tops) / PIERS - self.M * self.a_g
        mass.step(step_size, (force, force))
        self.x = mass.x
        for pier, (delta, v) in enumerate(tops):
            setattr(self, f"F_{pier}", (self.k * (mass.x - delta) + self.c * (mass.v - v)) / PIERS)
        return True
