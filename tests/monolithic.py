"""Coupled structures integrated as one system: what co-simulation is held against.

Two systems, over the equations and transitions of reference.py: a bridge, piers that carry one deck through elastic
bearings, and a structure on a foundation mass that sways on soil. The state is (x, x_dot) of the deck or foundation, then (u, u_dot, theta, theta_dot) of every
structure. DOP853 restarts at every sample of the ground motion and at every transition of any structure.
"""

from dataclasses import dataclass

import numpy as np
import reference
from reference import ATOL, RTOL, Load, Structure, Transition, accelerations, reactions, top


@dataclass(frozen=True)
class Bridge:
    """Piers under one deck of mass M (kg), on every pier a bearing of stiffness k (N/m) and damping c (N s/m)."""

    structures: tuple[Structure, ...]
    M: float
    k: float
    c: float

    def bearing_forces(self, phases, y) -> list[float]:
        tops = [top(p, s, part) for p, s, part in zip(self.structures, phases, _parts(y))]
        return [self.k * (y[0] - delta) + self.c * (y[1] - v) for delta, v in tops]

    def rates(self, phases, y, a_g: float) -> list[float]:
        forces = self.bearing_forces(phases, y)
        found = [y[1], -a_g - sum(forces) / self.M]
        for p, s, part, F_t in zip(self.structures, phases, _parts(y), forces):
            u_ddot, theta_ddot = accelerations(p, s, part, a_g, F_t)
            found += [part[1], u_ddot, part[3], theta_ddot]
        return found

    recoil = None  # the deck hangs on springs: a jump of a pier's momentum leaves its velocity alone


@dataclass(frozen=True)
class OnSoil:
    """One structure on a foundation mass M (kg) that sways on soil of stiffness k (N/m) and damping c (N s/m)."""

    structures: tuple[Structure]
    M: float
    k: float
    c: float

    def rates(self, phases, y, a_g: float) -> list[float]:
        (p,), (s,), (part,) = self.structures, phases, _parts(y)
        at_rest = reactions(p, s, part, Load(0.0, a_g=0.0))[0]
        carried = at_rest - reactions(p, s, part, Load(0.0, a_g=1.0))[0]  # the mass that follows the ground at once
        felt = (at_rest - self.k * y[0] - self.c * y[1]) / (self.M + carried)
        u_ddot, theta_ddot = accelerations(p, s, part, felt, 0.0)
        return [y[1], felt - a_g, part[1], u_ddot, part[3], theta_ddot]

    def recoil(self, p: Structure, before, after) -> float:
        """The law of impact is one of velocities relative to the foundation; momentum is that of the whole."""
        return -p.m * (top(p, *after)[1] - top(p, *before)[1]) / (self.M + p.m + p.m0)


def _parts(y):
    """The structures' parts of the state."""
    return [y[i:i + 4] for i in range(2, len(y), 4)]


@dataclass
class Response:
    """The state at the instants `t`, one row each, the phases, and every structure's transitions on the way."""

    t: np.ndarray
    y: np.ndarray
    phases: np.ndarray
    transitions: list[list[Transition]]


def integrate(system, knots, a_g) -> Response:
    """The response from rest to the ground acceleration `a_g` (m/s2) at `knots` (s), linear between them."""
    def rates(phases, load):
        return lambda t, y: system.rates(phases, y.tolist(), load.a_g + load.a_g_rate * (t - load.t0))

    start, h = np.zeros(2 + 4 * len(system.structures)), float(knots[1] - knots[0])
    run = reference.Run(system.structures, rates, start, 0.0, h, RTOL, ATOL, system.recoil)
    t, y, phases = np.split(reference.follow(run, knots, a_g, 0 * a_g), [1, 1 + len(start)], axis=1)
    if run.overturned:
        raise RuntimeError(f"a structure overturns at {run.t} s")
    return Response(t[:, 0], y, phases, run.transitions)
