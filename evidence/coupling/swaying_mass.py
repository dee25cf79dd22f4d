"""A mass on a spring and a dashpot that sways over the ground: a bridge deck on its bearings, a foundation on soil."""

TERMS = 30  # of the power series; exact to rounding for steps of up to half a period


class SwayingMass:
    """Mass M (kg) on stiffness k (N/m) and damping c (N s/m), at rest at the start."""

    def __init__(self, M: float, k: float, c: float):
        self.M, self.k, self.c = M, k, c
        self.x, self.v = 0.0, 0.0  # displacement and velocity, relative to the ground

    def step(self, h: float, force, added: float = 0.0) -> None:
        """Exactly, under a force that is a line, from its values at the start and at the end; with mass added to M."""
        start, end = map(float, force)
        term, following = self.x, self.v * h
        x, change = term + following, following
        for n in range(TERMS):
            load = (start, end - start)[n] if n < 2 else 0.0
            rest = h * load - self.c * (n + 1) * following - h * self.k * term
            term, following = following, h * rest / ((self.M + added) * (n + 1) * (n + 2))
            x += following
            change += (n + 2) * following
        self.x, self.v = x, change / h
