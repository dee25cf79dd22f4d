"""An independent integration of a rocking structure with a tendon and dissipators under horizontal and vertical ground motion,
to hold the FMU against.

Written from the equations alone; phases, impacts and the steps of DOP853 are those of reference.py. A phase here is the side
and what yields: where a dissipator reaches its yield force or turns round, integration starts anew. The state has two numbers
more: the energy that the viscous dissipators take, and the vertical ground acceleration, so that every guard is a function of
the state alone. Guards are looked at on the polynomial of a step and refined on fresh integrations.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import reference
from reference import FULL_CONTACT, Load, Structure
from scipy.integrate import DOP853
from scipy.optimize import brentq

GRID = np.linspace(0, 1, 33)  # where guards are looked at within a step


@dataclass(frozen=True)
class Ties:
    """A tendon and a pair of dissipators (SI)."""

    P_0: float = 0.0
    k_t: float = 0.0
    xi_d: float = 0.0
    c_d: float = 0.0
    k_d: float = 0.0
    F_y: float = 0.0

    def levers(self, p: Structure, s: int) -> tuple[float, float]:
        return s * p.B - self.xi_d, s * p.B + self.xi_d


@dataclass
class Response:
    """(t, u, u_dot, theta, theta_dot, E_viscous, P_t, F_d1, F_d2, e_p1, e_p2, E_hysteretic) at the knots; transitions as (time,
    kind)."""

    rows: list = field(default_factory=list)
    transitions: list = field(default_factory=list)

    def column(self, i: int) -> np.ndarray:
        return np.array([row[i] for row in self.rows])


class Motion:
    """The structure at one instant, and how it gets on from there."""

    def __init__(self, p: Structure, ties: Ties, t: float, rtol: float, atol: float):
        self.p, self.ties, self.t, self.rtol, self.atol = p, ties, t, rtol, atol
        self.y = np.zeros(6)  # u, u_dot, theta, theta_dot, energy of the viscous ones, a_v
        self.s, self.yields, self.plastic, self.hysteretic = FULL_CONTACT, [0, 0], [0.0, 0.0], 0.0
        self.zeros_at_start, self.h, self.overturned = 0, 1e-4, False
        self.transitions = []

    def elongations(self, theta: float, s: int) -> list[float]:
        return [2 * lever * math.sin(theta / 2) for lever in self.ties.levers(self.p, s)]

    def elastoplastic(self, theta: float, s: int) -> list[float]:
        """Forces of the elastoplastic dissipators."""
        k_d, F_y = self.ties.k_d, self.ties.F_y
        return [way * F_y if way else k_d * (e - e_p)
                for e, e_p, way in zip(self.elongations(theta, s), self.plastic, self.yields)]

    def accelerations(self, y, a_g: float, s: int) -> tuple[float, float]:
        p, ties = self.p, self.ties
        u_ddot, theta_ddot = reference.accelerations(p, s, y[:4], a_g, 0.0)
        if s == FULL_CONTACT:
            return u_ddot, theta_ddot
        u, _, theta, theta_dot, _, a_v = y
        sn, cs, half, M = math.sin(theta), math.cos(theta), math.cos(theta / 2), p.m + p.m0
        force = p.m * a_v * sn
        moment = p.m * a_v * (p.H * sn + u * cs) - s * M * a_v * p.B * cs
        moment -= s * ties.P_0 * p.B * half + ties.k_t * p.B**2 * sn
        moment -= ties.c_d * (2 * p.B**2 + 2 * ties.xi_d**2) * half**2 * theta_dot
        moment -= half * sum(F * lever for F, lever in zip(self.elastoplastic(theta, s), ties.levers(p, s)))
        more = (moment - p.H * force) / (p.J0 + p.m * (s * p.B - u) ** 2 + p.m0 * p.B**2)
        return u_ddot + force / p.m - p.H * more, theta_ddot + more

    def rates(self, load: Load, a_v_rate: float):

        def rates(t, y):
            y = y.tolist()
            u_ddot, theta_ddot = self.accelerations(y, load.a_g + load.a_g_rate * (t - load.t0), self.s)
            half = math.cos(y[2] / 2)
            power = self.ties.c_d * (2 * self.p.B**2 + 2 * self.ties.xi_d**2) * (half * y[3]) ** 2
            return [y[1], u_ddot, y[3], theta_ddot, power, a_v_rate]

        return rates

    def uplift(self, y, s: int) -> float:
        """Positive while the base stays down: what u lacks to u_cr about side s, or what the moment lacks that turns it."""
        p, ties, (u, u_dot, a_v) = self.p, self.ties, (y[0], y[1], y[5])
        residual = sum(-ties.k_d * e_p * lever * s for e_p, lever in zip(self.plastic, ties.levers(p, s)))
        held = ((p.m + p.m0) * (p.g + a_v) + ties.P_0) * p.B + residual
        displacement = held / (p.m * p.H * p.omega_fc**2)
        turning = s * (p.H * (p.k * u + p.c_u * u_dot) + p.m * (p.g + a_v) * u) - held
        lacks = displacement - s * u if displacement > 0 else -1.0
        return max(lacks / p.u_cr, -turning / (p.k * p.H * p.u_cr))

    def guards(self):
        """(what happens, function of the state that is positive until it does)."""
        if self.s == FULL_CONTACT:
            return [(("uplift", s), lambda y, s=s: self.uplift(y, s)) for s in (1, -1)]
        if self.ties.k_d == 0:
            return []
        s, F_y, found = self.s, self.ties.F_y, []
        for j, (lever, way) in enumerate(zip(self.ties.levers(self.p, s), self.yields)):
            if way:
                found.append((("unloading", j), lambda y, at=way * lever: at * y[3]))
            else:
                for way in (1, -1):
                    force = lambda y, j=j: self.ties.k_d * (self.elongations(y[2], s)[j] - self.plastic[j])
                    found.append((("yielding", j, way), lambda y, way=way, force=force: 1 - way * force(y) / F_y))
        return found

    def advance(self, end: float, load: Load, a_v_rate: float):
        """Gets on to `end`, or to the first transition before it."""
        solver = DOP853(self.rates(load, a_v_rate), self.t, self.y, end, rtol=self.rtol, atol=self.atol,
                        first_step=min(self.h, end - self.t))
        while solver.status == "running":
            assert solver.step() is None and solver.status != "failed", solver.t
            self.h = solver.h_abs
            step = reference._Step(solver)
            first = self.first(step)
            if first:
                return self.transit(*first)
            self.move(solver.t, solver.y)

    def first(self, step):
        """The first x in [0, 1], and what happens there; None if nothing does."""
        found = []
        for what, guard in self.guards():
            values = [guard(step.at(x)) for x in GRID]
            for x0, x1, v0, v1 in zip(GRID, GRID[1:], values, values[1:]):
                if v1 < -1e-15 and v0 >= 0 or x0 == 0 and v1 < 0 and v1 < v0 <= 1e-12:
                    x = brentq(lambda x: guard(step.at(x)), x0, x1, xtol=1e-15) if v0 > 0 else x0
                    found.append((x, what, self.refine(step, x, guard)))
                    break
        if self.s != FULL_CONTACT:
            touch = reference._first_touch(self.s, step.part(slice(0, 4)), self.zeros_at_start)
            if touch:
                x, _, (normal, constant) = touch
                # what has yielded at theta = 0 is at its yield force there again: the impact comes first
                found = [one for one in found if one[0] < x - 1e-9]
                guard = np.concatenate([normal, [0.0, 0.0]]), constant
                what = ("impact",) if constant == 0 else ("overturned",)
                found.append((x, what, step.refine(x, guard, self.rtol, self.atol)))
        return min(found, key=lambda one: one[0])[1:] if found else None

    def refine(self, step, x: float, guard):
        """The instant near x, where the guard is 0 on fresh integrations, and the state there."""
        state = lambda x: step.integrate_to(step.t0 + x * step.h, self.rtol, self.atol)
        if x > 0:
            d = 1e-3
            slope = (guard(step.at(min(1, x + d))) - guard(step.at(max(0, x - d)))) / (min(1, x + d) - max(0, x - d))
            for _ in range(3):
                x = min(max(x - guard(state(x)) / slope, 0.0), 1.0) if slope else x
        return step.t0 + x * step.h, state(x)

    def move(self, t: float, y: np.ndarray):
        self.t, self.y, self.zeros_at_start = t, y.copy(), 0
        if self.s == FULL_CONTACT:
            return
        for j, (e, way) in enumerate(zip(self.elongations(y[2], self.s), self.yields)):
            if way:
                plastic = e - way * self.ties.F_y / self.ties.k_d
                self.hysteretic += way * self.ties.F_y * (plastic - self.plastic[j])
                self.plastic[j] = plastic

    def transit(self, what, at):
        self.move(*at)
        kind = what[0]
        if kind == "uplift":
            self.s, self.zeros_at_start, self.yields = what[1], 2, [0, 0]
        elif kind == "yielding":
            self.yields[what[1]] = what[2]
        elif kind == "unloading":
            self.yields[what[1]] = 0
        elif kind == "overturned":
            self.overturned = True
        else:
            kind, phase, self.y[:4] = reference.impact(self.p, self.s, self.y[:4])
            self.s, self.zeros_at_start = phase, 1
            levers = self.ties.levers(self.p, phase)
            on = [phase != 0 and way * lever * self.y[3] > 0 for way, lever in zip(self.yields, levers)]
            self.yields = [way if goes_on else 0 for way, goes_on in zip(self.yields, on)]
        self.transitions.append((self.t, kind))
        self.lift_off()

    def lift_off(self):
        """Lifts the base off where that is due as the state stands."""
        if self.s == FULL_CONTACT:
            for s in (1, -1):
                if self.uplift(self.y, s) < 0:
                    self.transit(("uplift", s), (self.t, self.y))
                    return

    def row(self) -> tuple:
        s = self.s or 1
        theta, theta_dot = self.y[2:4]
        forces = self.elastoplastic(theta, s)
        rates = [lever * math.cos(theta / 2) * theta_dot for lever in self.ties.levers(self.p, s)]
        F_d = [F + self.ties.c_d * rate for F, rate in zip(forces, rates)]
        P_t = self.ties.P_0 + 2 * self.ties.k_t * self.p.B * math.sin(abs(theta) / 2)
        return (self.t, *self.y[:5], P_t, *F_d, *self.plastic, self.hysteretic)


def integrate(p: Structure, ties: Ties, knots, a_g, a_v, rtol: float = 1e-13, atol: float = 1e-16) -> Response:
    """The response from rest to the accelerations `a_g` and `a_v` (m/s2) at `knots` (s), linear between them."""
    motion = Motion(p, ties, float(knots[0]), rtol, atol)
    response = Response([motion.row()], motion.transitions)
    for t0, t1, a0, a1, v0, v1 in zip(knots, knots[1:], a_g, a_g[1:], a_v, a_v[1:]):
        load, a_v_rate = Load(float(t0), float(a0), float((a1 - a0) / (t1 - t0))), float((v1 - v0) / (t1 - t0))
        motion.y[5] = v0
        motion.lift_off()
        while motion.t < t1 and not motion.overturned:
            motion.advance(float(t1), load, a_v_rate)
        response.rows.append(motion.row())
        if motion.overturned:
            break
    return response
