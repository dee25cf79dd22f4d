"""Coupled structures integrated as one system: what co-simulation is held against.

Two systems, over the equations and transitions of reference.py: a bridge, piers that carry one deck through elastic
bearings, and a structure on a foundation mass that sways on soil. The state is (x, x_dot) of the deck or foundation, then (u, u_dot, theta, theta_dot) of every
structure. DOP853 restarts at every sample of the ground motion and at every transition of any structure.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import reference
from reference import ATOL, FULL_CONTACT, RTOL, Load, Structure, Transition
from reference import accelerations, impact, lifts, reactions, top
from scipy.integrate import DOP853


@dataclass(frozen=True)
class Bridge:
    """Piers under one deck of mass M (kg), on every pier a bearing of stiffness k (N/m) and damping c (N s/m)."""

    structures: tuple[Structure, ...]
    M: float
    k: float
    c: float

    def bearing_forces(self, phases, y) -> list[float]:
        """What each bearing exerts on its pier."""
        tops = [top(p, s, part) for p, s, part in zip(self.structures, phases, _parts(y))]
        return [self.k * (y[0] - delta) + self.c * (y[1] - v) for delta, v in tops]

    def rates(self, phases, y, a_g: float) -> list[float]:
        forces = self.bearing_forces(phases, y)
        found = [y[1], -a_g - sum(forces) / self.M]
        for p, s, part, F_t in zip(self.structures, phases, _parts(y), forces):
            u_ddot, theta_ddot = accelerations(p, s, part, a_g, F_t)
            found += [part[1], u_ddot, part[3], theta_ddot]
        return found

    def recoil(self, jump: float) -> float:
        """The deck hangs on springs: a jump of a pier's momentum leaves its velocity alone."""
        return 0.0


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

    def recoil(self, jump: float) -> float:
        """The law of impact is one of velocities relative to the foundation; momentum is that of the whole."""
        (p,) = self.structures
        return -jump / (self.M + p.m + p.m0)


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


def integrate(system, knots, a_g, *, per_sample: int = 1, rtol: float = RTOL, atol: float = ATOL) -> Response:
    """The response from rest to the ground acceleration `a_g` (m/s2) at `knots` (s), linear between them."""
    run = _Run(system, float(knots[1] - knots[0]), rtol, atol)
    rows = [(run.t, run.y, tuple(run.phases))]
    for t0, t1, a0, a1 in zip(knots[:-1].tolist(), knots[1:].tolist(), a_g[:-1].tolist(), a_g[1:].tolist()):
        for part in range(1, per_sample + 1):
            end = t0 + (t1 - t0) * part / per_sample if part < per_sample else t1
            while run.t < end:
                run.advance(end, lambda t: a0 + (a1 - a0) / (t1 - t0) * (t - t0))
            rows.append((run.t, run.y, tuple(run.phases)))
    t, y, phases = zip(*rows)
    return Response(np.array(t), np.array(y), np.array(phases), run.transitions)


class _Run:
    """The hybrid system at one instant, and how it gets on from there."""

    def __init__(self, system, h: float, rtol: float, atol: float):
        self.system, self.t, self.h, self.rtol, self.atol = system, 0.0, h, rtol, atol
        number = len(system.structures)
        self.y = np.zeros(2 + 4 * number)
        self.phases = [FULL_CONTACT] * number
        self.zeros_at_start = [0] * number
        self.transitions: list[list[Transition]] = [[] for _ in range(number)]

    def advance(self, end: float, a_g):
        """Gets on to `end` or to the first transition before it, whichever comes first."""
        phases = tuple(self.phases)
        solver = DOP853(lambda t, y: self.system.rates(phases, y.tolist(), a_g(t)), self.t, self.y, end,
                        rtol=self.rtol, atol=self.atol, first_step=min(self.h, end - self.t))
        while solver.status == "running":
            message = solver.step()
            if solver.status == "failed":
                raise RuntimeError(f"DOP853 stopped at {solver.t} s: {message}")
            self.h = max(self.h, solver.h_abs) if solver.status == "finished" else solver.h_abs
            if self.transition(reference._Step(solver)):
                return
            self.t, self.y, self.zeros_at_start = solver.t, solver.y, [0] * len(phases)
            if self.test_uplifts():
                return

    def transition(self, step: reference._Step) -> bool:
        """Makes the first transition of any structure within `step`, if there is one."""
        found = [(*first, i) for i in range(len(self.phases)) if (first := self.first_of(i, step))]
        if not found:
            return False
        x, s, (normal, constant), i = min(found, key=lambda candidate: candidate[0])
        at, p = slice(2 + 4 * i, 6 + 4 * i), self.system.structures[i]
        if constant == -math.pi / 2:
            raise RuntimeError(f"structure {i} overturns near {step.t0 + x * step.h} s")
        of_all = np.zeros(len(self.y))
        of_all[at] = normal
        self.t, self.y = step.refine(x, (of_all, constant), self.rtol, self.atol)
        self.zeros_at_start = [0] * len(self.phases)
        if self.phases[i] == FULL_CONTACT:
            self.enter(i, "uplift", s, s, self.y)
            return True
        kind, phase, after = impact(p, s, self.y[at])
        y = self.y.copy()
        y[at] = after
        y[1] += self.system.recoil(p.m * (top(p, phase, after)[1] - top(p, s, self.y[at])[1]))
        self.enter(i, kind, s, phase, y)
        self.test_uplifts()
        return True

    def first_of(self, i: int, step: reference._Step):
        """The first transition of structure i within `step`: x in [0, 1], the side, the guard."""
        at, p, s = slice(2 + 4 * i, 6 + 4 * i), self.system.structures[i], self.phases[i]
        part = object.__new__(reference._Step)
        part.powers, part.solver = step.powers[:, at], SimpleNamespace(y=step.solver.y[at])
        if s == FULL_CONTACT:
            return reference._first_uplift(p, part)
        touch = reference._first_touch(s, part, self.zeros_at_start[i])
        return touch and (touch[0], s, touch[1])

    def test_uplifts(self) -> bool:
        """Lifts every structure off for which the condition of uplift holds as the state stands."""
        lifted = False
        for i, p in enumerate(self.system.structures):
            u, u_dot = self.y[2 + 4 * i:4 + 4 * i]
            s = 1 if u >= 0 else -1
            if self.phases[i] == FULL_CONTACT and lifts(p, s, u, u_dot):
                self.enter(i, "uplift", s, s, self.y)
                lifted = True
        return lifted

    def enter(self, i: int, kind: str, side: int, phase: int, y: np.ndarray):
        self.transitions[i].append(Transition(self.t, kind, side, tuple(self.y.tolist()), tuple(y.tolist())))
        self.phases[i], self.y = phase, y
        self.zeros_at_start[i] = {"uplift": 2, "impact": 1}.get(kind, 0)
