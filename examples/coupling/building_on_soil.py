"""A structure on soil: McManus's specimen on a foundation mass that sways, under Pacoima Dam 1971.

The foundation mass stands on soil (spring and dashpot). It feels the structure's horizontal reaction R_h and gives
back its own acceleration as the structure's a_g: an algebraic loop, since R_h holds -m0 a_g. Passed around as it is,
the pair blows up at any step if the foundation mass is less than m0. So the part of R_h that follows a_g at once, which
the directional derivative of the FMU tells, is taken over to the foundation as mass: solved exactly, without iteration.
One sweep per step is then stable, and needs no rollback. Draws the response beside that on rigid ground.

    PYTHONPATH=examples python -m coupling.building_on_soil
"""

import argparse
import contextlib
from pathlib import Path

import numpy as np
from first_run import G
from validation.figures import FIXED, QUIET, ROCKING, save, subplots
from validation.records import pacoima_dam

from .bridge import linear, simulate
from .masters import extrapolate, gauss_seidel
from .structure import Structure
from .swaying_mass import SwayingMass

MASS, STIFFNESS, DAMPING = 50.0, 2e5, 3e3  # of the foundation mass on its soil: kg, N/m, N s/m


def structure(fmu: str, **start_values: float) -> Structure:
    return Structure(fmu, ["a_g"], ["R_h", "I_h"], **start_values)


class OnSoil:
    """The first side is the structure: a_g in, R_h and I_h out. The second side is the foundation."""

    def __init__(self, structure: Structure, foundation: SwayingMass, ground, solve_loop: bool = True):
        """`ground` gives the acceleration of the ground far away at the start and the end of a step."""
        self.structure, self.foundation, self.ground, self.solve_loop = structure, foundation, ground, solve_loop
        m, m0 = structure.read("m", "m0")
        self.mass = foundation.M + m + m0
        self.added = 0.0
        self.w, self.y = np.zeros((2, 1)), np.zeros((2, 2))

    def first(self, t, h, w):
        R_h, I_h = self.structure.step(t, h, w.tolist())
        self.added = -self.structure.derivative("R_h", "a_g") if self.solve_loop else 0.0
        return np.array([self.y[1], [R_h + self.added * w[1, 0], I_h]])

    def second(self, t, h, y):
        foundation, M = self.foundation, self.foundation.M + self.added
        R_h, I_h = y.T
        foundation.step(h, R_h - M * self.ground(t, h), self.added)
        foundation.v += (I_h[1] - I_h[0]) / self.mass  # the law of impact keeps velocities relative to the foundation
        felt = (R_h[1] - foundation.k * foundation.x - foundation.c * foundation.v) / M
        return np.array([self.w[1], [felt]])

    def transitions(self):
        return self.structure.transitions()

    @contextlib.contextmanager
    def checkpoint(self):
        with self.structure.checkpoint() as of_structure:
            yield of_structure, (self.foundation.x, self.foundation.v), self.w, self.y

    def restore(self, state):
        of_structure, (self.foundation.x, self.foundation.v), self.w, self.y = state
        self.structure.restore(of_structure)


def plot(path: Path, time, a_g, x, felt, on_soil, on_rock) -> None:
    figure, axes = subplots(4, 1, 7.0, sharex=True)
    axes[0].plot(time, felt / G, color=ROCKING, label="felt by the structure")
    axes[0].plot(time, a_g / G, color=QUIET, label="far away")
    axes[1].plot(time, 1e3 * x, color=ROCKING)
    for rows, color, label in ((on_rock, FIXED, "on rigid ground"), (on_soil, ROCKING, "on soil")):
        axes[2].plot(time, 1e3 * rows[:, 0], color=color, label=label)
        axes[3].plot(time, rows[:, 1] / G, color=color, label=label)
    labels = ("ground\nacceleration (g)", "displacement of\nthe foundation (mm)", "uplift (mm)",
              "total acceleration\nof the top mass (g)")
    for axis, label in zip(axes, labels):
        axis.set_ylabel(label)
    for axis in axes[[0, 2, 3]]:
        axis.legend(loc="upper right", ncols=2)
    axes[-1].set(xlabel="time (s)", xlim=(0, time[-1]))
    figure.suptitle("On soil the structure rocks farther and is accelerated less")
    figure.align_ylabels()
    save(figure, path)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0],
                                     formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("fmu", nargs="?", default="out/mcmanus.fmu", help="of the structure")
    parser.add_argument("--mass", type=float, default=MASS, help="of the foundation (kg)")
    parser.add_argument("--steps", type=int, default=4, help="communication steps per sample of the record (2 ms)")
    parser.add_argument("--figure", type=Path, default=Path("docs/evidence/coupling/building_on_soil.png"),
                        help="where to save it")
    arguments = parser.parse_args()

    time, a_g = pacoima_dam()
    foundation = SwayingMass(arguments.mass, STIFFNESS, DAMPING)
    system = OnSoil(structure(arguments.fmu), foundation, linear(time, a_g))
    rows = simulate(system, gauss_seidel, extrapolate, time, arguments.steps,
                    lambda: [foundation.x, system.w[1, 0], *system.structure.read("uplift", "a_t")])
    rigid = structure(arguments.fmu)
    on_rock = [rigid.read("uplift", "a_t")]
    for t, (start, end) in zip(time, zip(a_g, a_g[1:])):
        rigid.step(t, time[1], [[start], [end]])
        on_rock.append(rigid.read("uplift", "a_t"))
    on_rock = np.array(on_rock)
    for label, (uplift, a_t) in (("on soil", rows[:, 2:].T), ("on rigid ground", on_rock.T)):
        print(f"{label}: uplift {1e3 * np.max(uplift):.2f} mm, total acceleration {np.max(np.abs(a_t)) / G:.4f} g")
    plot(arguments.figure, time, a_g, rows[:, 0], rows[:, 1], rows[:, 2:], on_rock)
    print(f"figure: {arguments.figure}")


if __name__ == "__main__":
    main()
