"""A structure on soil by every master: what the foundation mass does to the exchange of R_h and a_g."""

import functools

import monolithic
import numpy as np
import reference
from validation.records import pacoima_dam

from .bridge import linear, simulate
from .building_on_soil import DAMPING, STIFFNESS, OnSoil, structure
from .convergence import error
from .masters import extrapolate, gauss_seidel
from .stability import BLOWN_UP, ITERATED
from .swaying_mass import SwayingMass
from .tables import markdown

MASSES = (20.0, 50.0, 100.0, 200.0, 400.0)  # kg, of the foundation
SAMPLES = 700  # of the record
PER_SAMPLE = 4


@functools.cache
def integrated_as_one(M: float) -> np.ndarray:
    """The foundation's x, theta and u."""
    time, a_g = (values[:SAMPLES] for values in pacoima_dam())
    system = monolithic.OnSoil((reference.MCMANUS,), M, STIFFNESS, DAMPING)
    return monolithic.integrate(system, time, a_g).y[:, [0, 4, 2]]


def run(fmu: str, M: float, step, solve_loop: bool) -> float | None:
    """The largest error over its peak, None if the master blows up."""
    time, a_g = (values[:SAMPLES] for values in pacoima_dam())
    foundation = SwayingMass(M, STIFFNESS, DAMPING)
    system = OnSoil(structure(fmu), foundation, linear(time, a_g), solve_loop)
    try:
        found = simulate(system, step, extrapolate, time, PER_SAMPLE,
                         lambda: [foundation.x, *system.structure.read("theta", "u")])
    except BLOWN_UP:
        return None
    return error(found, integrated_as_one(M))


def table(fmu: str) -> str:
    """Masters by foundation masses."""
    rows = []
    for solve_loop, name in ((False, "R_h passed as it is"), (True, "loop solved")):
        errors = [run(fmu, M, gauss_seidel, solve_loop) for M in MASSES]
        rows.append([f"{name}: Gauss-Seidel, error", *map(percent, errors)])
        for master, make in ITERATED.items():
            rows.append([f"{name}: {master}, sweeps", *(sweeps(fmu, M, make(), solve_loop) for M in MASSES)])
    return markdown(["foundation mass, kg", *(f"{M:g}" for M in MASSES)], rows)


def sweeps(fmu: str, M: float, step, solve_loop: bool) -> str:
    """Of an iterated master, per step."""
    if run(fmu, M, step, solve_loop) is None:
        return "diverges"
    return f"{step.sweeps / (SAMPLES - 1) / PER_SAMPLE:.1f}"


def percent(value: float | None) -> str:
    return "blows up" if value is None else f"{value:.2%}".replace("%", " %")
