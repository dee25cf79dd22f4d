"""A structure on soil: McManus's specimen on a foundation mass that sways, under Pacoima Dam 1971.

The foundation mass stands on soil (spring and dashpot). It feels the structure's horizontal reaction R_h and gives
back its own acceleration as the structure's a_g: an algebraic loop, since R_h holds -m0 a_g. Passed around as it is,
the pair blows up at any step if the foundation mass is less than m0. So the part of R_h that follows a_g at once, which
the directional derivative of the FMU tells, is taken over to the foundation as mass: solved exactly, without iteration.
One sweep per step is then stable, and needs no rollback.
"""

from pathlib import Path

import numpy as np

from ..figures import FIXED, QUIET, ROCKING
from ..scenes import G, pacoima_dam
from .bridge import Coupled, histories, linear, simulate
from .masters import extrapolate, gauss_seidel
from .structure import Structure
from .swaying_mass import SwayingMass

MASS, STIFFNESS, DAMPING = 50.0, 2e5, 3e3  # of the foundation mass on its soil: kg, N/m, N s/m


def structure(fmu: str) -> Structure:
    return Structure(fmu, ["a_g"], ["R_h", "I_h"])


class OnSoil(Coupled):
    """The first side is the structure: a_g in, R_h and I_h out. The second side is the foundation."""

    def __init__(self, structure: Structure, foundation: SwayingMass, ground, solve_loop: bool = True):
        """`ground` gives the acceleration of the ground far away at the start and the end of a step."""
        super().__init__([structure], foundation, np.zeros((2, 1)), np.zeros((2, 2)))
        self.structure, self.foundation, self.ground, self.solve_loop = structure, foundation, ground, solve_loop
        m, m0 = structure.read("m", "m0")
        self.mass = foundation.M + m + m0
        self.added = 0.0

    def first(self, t, h, w):
        R_h, I_h = self.structure.step(t, h, w.tolist())
        self.added = -self.structure.instance.derivative("R_h", "a_g") if self.solve_loop else 0.0
        return np.array([self.y[1], [R_h + self.added * w[1, 0], I_h]])

    def second(self, t, h, y):
        foundation, M = self.foundation, self.foundation.M + self.added
        R_h, I_h = y.T
        foundation.step(h, R_h - M * self.ground(t, h), self.added)
        foundation.v += (I_h[1] - I_h[0]) / self.mass  # the law of impact keeps velocities relative to the foundation
        felt = (R_h[1] - foundation.k * foundation.x - foundation.c * foundation.v) / M
        return np.array([self.w[1], [felt]])


def draw(fmu: str, path: Path) -> None:
    """McManus's specimen under Pacoima Dam, on soil and on rigid ground, with four steps per sample."""
    time, a_g = pacoima_dam()
    foundation = SwayingMass(MASS, STIFFNESS, DAMPING)
    system = OnSoil(structure(fmu), foundation, linear(time, a_g))
    x, felt, uplift, a_t = simulate(system, gauss_seidel, extrapolate, time, 4,
                                    lambda: [foundation.x, system.w[1, 0], *system.structure.read("uplift", "a_t")]).T
    rigid = structure(fmu)
    on_rock = [rigid.read("uplift", "a_t")]
    for t, (start, end) in zip(time, zip(a_g, a_g[1:])):
        rigid.step(t, time[1], [[start], [end]])
        on_rock.append(rigid.read("uplift", "a_t"))
    rigid_uplift, rigid_a_t = np.transpose(on_rock)
    histories(path, "On soil the structure rocks farther and is accelerated less", time,
              ["ground\nacceleration (g)", "displacement of\nthe foundation (mm)", "uplift (mm)", "total acceleration\nof the top mass (g)"],
              [(felt / G, ROCKING, "felt by the structure"), (a_g / G, QUIET, "far away")], [(1e3 * x, ROCKING, "")],
              [(1e3 * rigid_uplift, FIXED, "on rigid ground"), (1e3 * uplift, ROCKING, "on soil")],
              [(rigid_a_t / G, FIXED, "on rigid ground"), (a_t / G, ROCKING, "on soil")])
