"""An independent integration of a frame of n masses that rocks on its base, to compare the engine's modes with.

The equations are the physical ones, with M, C and K: no modes, no matrix exponential. The numbers (M1), (M7) … count the
equations of many masses. DOP853 integrates each phase at a relative tolerance of 1e-13, from sample to sample and from
transition to transition. A transition is a root of a polynomial over the step, refined by fresh integrations.
"""

import math
from functools import partial
from types import SimpleNamespace

import numpy as np
import reference
from frames import Frame, Ties
from numpy.polynomial import polynomial
from reference import FULL_CONTACT, Transition
from scipy.integrate import DOP853

MAX_TRANSITIONS = 1000  # within one period of the lowest vibration mode while rocking; then contact is held to its end
TIE = 1e-12  # an angle this small, relative to that at yield, is 0
NODES = (1 - np.cos(np.pi * np.arange(8) / 7)) / 2
FIT = np.linalg.inv(np.vander(NODES, increasing=True))  # from values at NODES to the polynomial of degree 7


class Motion:
    """The frame at one instant, and how its motion continues. The state is u, u_dot, theta, theta_dot in one row."""

    def __init__(self, frame: Frame, ties: Ties):
        self.frame, self.ties, self.n, self.y = frame, ties, len(frame.masses), np.zeros(2 * len(frame.masses) + 2)
        self.tolerances, self.t, self.h, self.s = dict(rtol=1e-13, atol=1e-16), 0.0, 1e-4, FULL_CONTACT
        self.zeros, self.plastic, self.yields, self.released = 0, [0.0, 0.0], [0, 0], [0, 0]  # zeros of theta(t) at this instant
        self.transitions = []
        self.viscous, self.hysteretic = 0.0, 0.0  # energies that the dissipators took
        self.burst, self.count, self.held_until, self.overturned = -math.inf, 0, -math.inf, False

    def row(self):
        ties, (theta, theta_dot) = self.ties, self.y[-2:]
        a = self.frame.g * math.sin(theta) - self.frame.elastic @ self.y[:-2]
        forces, levers = self.forces(theta, self.s or 1)
        F_d = [F + ties.c_d * lever * math.cos(theta / 2) * theta_dot for F, lever in zip(forces, levers)]
        P_t = ties.P_0 + 2 * ties.k_t * self.frame.B * math.sin(abs(theta) / 2)
        return [self.t, *self.y[: self.n], *a, theta, *self.y[self.n : -2], theta_dot, P_t, *F_d, *self.plastic, self.viscous,
                self.hysteretic]

    def gravity(self, t):
        return self.frame.g + self.a_v[0] + self.a_v[1] * (t - self.start)

    def forces(self, theta, s):
        """F_j of the elastoplastic dissipators, and their levers sB - xi_j."""
        levers = self.ties.levers(self.frame, s)
        return [way * self.ties.F_y if way else self.ties.k_d * (2 * lever * math.sin(theta / 2) - plastic)
                for lever, way, plastic in zip(levers, self.yields, self.plastic)], levers

    def rates(self, t, y):
        p, s, n = self.frame, self.s, self.n
        u, u_dot, theta, theta_dot = y[:n], y[n:-2], y[-2], y[-1]
        a_g, f = self.a_g[0] + self.a_g[1] * (t - self.start), p.elastic @ y[:-2]  # f = M^-1 (K u + C u_dot)
        if s == FULL_CONTACT:
            return np.concatenate([u_dot, -f - a_g, [0.0, 0.0]])  # (M1)
        sn, cs, g, d = math.sin(theta), math.cos(theta), self.gravity(t), s * p.B - u
        tied = self.ties.moment(p, s, theta, theta_dot, self.forces(theta, s)[0])
        moment = (p.m * p.h @ f + theta_dot**2 * (s * p.B * p.S_1 - p.m * p.h @ u) + 2 * theta_dot * (p.m * d @ u_dot)
                  - (s * p.m_t * p.B - p.m @ u) * (g * cs + a_g * sn) + tied)
        theta_ddot = moment / (p.J0 + p.m0 * p.B**2 + p.m @ d**2)  # (M7)
        u_ddot = -f - p.h * theta_ddot - theta_dot**2 * d + (g * sn - a_g * cs)  # (M7), its second line
        return np.concatenate([u_dot, u_ddot, [theta_dot, theta_ddot]])

    def margins(self, s, t, y):
        """The excess of the base's moment about side s over what holds the base down: by (M3), and by (M2), s D theta_ddot."""
        p, n = self.frame, self.n
        held = (p.m_t * self.gravity(t) + self.ties.P_0) * p.B + s * np.dot(*self.forces(0.0, s))
        by_rule = s * (y[..., :n] @ (p.K @ p.h)) - held
        return by_rule, by_rule + s * (y[..., n:-2] @ (p.C @ p.h) + (y[..., :n] @ p.m) * self.gravity(t))

    def lift_off(self):
        """Lifts the base off where uplift is due as the state stands; while g + a_v > 0, that is about one side at most."""
        for s in (1, -1) if self.s == FULL_CONTACT and self.t >= self.held_until else ():
            if min(self.margins(s, self.t, self.y)) > 0:
                self.enter("uplift", s, zeros=2)
                return True
        return False

    def enter(self, kind, phase, y=None, zeros=0):
        """Goes into a phase, with the state y if it jumps; theta(t) has so many zeros there."""
        y = self.y if y is None else y
        self.transitions.append(Transition(self.t, kind, self.s or phase, tuple(self.y), tuple(y)))
        if self.t - self.burst >= self.frame.period:
            self.burst, self.count = self.t, 0
        goes_on = [way * lever * y[-1] > 0 for way, lever in zip(self.yields, self.ties.levers(self.frame, phase))]
        self.yields = [way if kind == "impact" and on else 0 for way, on in zip(self.yields, goes_on)]  # beyond the edge alone
        self.count, self.s, self.y, self.zeros = self.count + 1, phase, y, zeros
        self.overturned = kind == "overturning"

    def impact(self):
        self.y[-2] = 0.0
        p, s, u, u_dot, theta_dot = self.frame, self.s, self.y[: self.n], self.y[self.n : -2], self.y[-1]
        rest = p.m @ (p.B**2 - u**2) + p.m0 * p.B**2 - p.J0
        L = p.m * p.h @ (u_dot + p.h * theta_dot) - rest * theta_dot  # (M14)
        after = p.J0 + p.m0 * p.B**2 + p.I_2 + p.m @ (p.B + s * u) ** 2
        r = (p.I_2 - rest) / after if p.r is None else p.r  # (M19)
        too_many = self.count >= MAX_TRANSITIONS and self.t - self.burst < p.period
        if L * theta_dot > 0 and r > 0 and not too_many:
            return self.enter("impact", -s, np.concatenate([u, u_dot, [0.0, r * theta_dot]]), 1)  # (M15)
        if too_many:
            self.held_until = self.burst + p.period
        self.enter("settling" if too_many else "landing", FULL_CONTACT, np.concatenate([u, u_dot + p.h * theta_dot, [0.0, 0.0]]))

    def advance(self, end: float):
        """Moves on to `end`, or to the first transition before it."""
        self.lift_off()
        if self.s == FULL_CONTACT and self.t < self.held_until:
            end = min(end, self.held_until)
        solver = DOP853(self.rates, self.t, self.y, end, first_step=min(self.h, end - self.t), **self.tolerances)
        while solver.status == "running":
            solver.step()
            assert solver.status != "failed", self.t
            self.h = max(self.h, solver.h_abs) if solver.status == "finished" else solver.h_abs
            step = reference._Step(solver)
            found = self.uplifts(step) if self.s == FULL_CONTACT else self.ends_of_rocking(step)
            if found:
                return self.make(step, *min(found, key=lambda one: one[0]))
            self.see(step, 1.0)
            self.move(solver.t, solver.y)
            if self.lift_off():  # if rounding hides the root at the end of the step
                return None

    def uplifts(self, step):
        """(x, guard, transition) where both guards about a side hold up to the next root of either side's."""
        found, states = [], np.vander(NODES, 8, increasing=True) @ step.powers
        for s in (1, -1) if self.t >= self.held_until else ():
            fits = FIT @ np.column_stack(self.margins(s, step.t0 + NODES * step.h, states))
            for i in (0, 1):
                guard = lambda t, y, s=s, i=i: self.margins(s, t, y)[i]
                transition = partial(self.enter, "uplift", s, zeros=2 + i)  # theta_ddot starts at 0 if (M2) is met last
                found += [(x, guard, transition, fits) for x in reference.unit_roots(fits[:, i])]
        found.sort(key=lambda one: one[0])
        following = [*(one[0] for one in found[1:]), 1.0]
        return [one[:3] for one, x in zip(found, following)
                if np.min(polynomial.polyval((one[0] + x) / 2, one[3])) > 0]

    def ends_of_rocking(self, step):
        """(x, guard, transition) of impact, overturning, yielding and its end."""
        s, ties, found = self.s, self.ties, []
        guards = [(-2, 0.0, self.zeros, self.impact), (-2, s * math.pi / 2, 0, partial(self.enter, "overturning", s))]
        for j, (lever, way) in enumerate(zip(ties.levers(self.frame, s), self.yields) if ties.k_d else ()):
            if way:
                guards.append((-1, 0.0, 0, partial(self.change_yielding, j, 0)))
            for to in () if way else (1, -1):  # |F_j| = F_y at this angle; if that is 0, the impact comes first
                sine = (self.plastic[j] + to * ties.F_y / ties.k_d) / (2 * lever)
                if TIE * ties.F_y / ties.k_d / abs(lever) < s * sine < 1:
                    zeros = 2 * (self.released[j] == to)
                    guards.append((-2, 2 * math.asin(sine), zeros, partial(self.change_yielding, j, to)))
        for column, value, zeros, transition in guards:
            c = step.powers[:, column].copy()
            c[0] -= value
            roots = [x for x in reference.unit_roots(c[zeros:]) if x > 0]
            if transition == self.impact and s * step.y1[-2] <= 0:
                roots.append(1.0)  # also if rounding hides the root at the end of the step
            found += [(x, lambda t, y, at=column, value=value: y[at] - value, transition) for x in roots]
        return found

    def change_yielding(self, which, to):
        for j, (F, lever, way) in enumerate(zip(*self.forces(self.y[-2], self.s), self.yields)):
            outward = F * lever * self.y[-1] > 0  # elongations turn round together, and may yield again together
            if j == which or (not way and outward and abs(F) >= (1 - TIE) * self.ties.F_y if to else way):
                self.released[j], self.yields[j] = way, int(math.copysign(to, F))
                kind = "yielding" if to else "unloading"
                self.transitions.append(Transition(self.t, kind, self.s, tuple(self.y), tuple(self.y)))

    def make(self, step, x, guard, transition):
        """Makes the transition near x: Newton's iteration on fresh integrations, unless the touch grazes."""
        state = lambda x: step.integrate_to(step.t0 + x * step.h, **self.tolerances)
        slope = np.diff([guard(step.t0 + near * step.h, step.at(near)) for near in (x - 1e-4, x + 1e-4)])[0] / 2e-4
        for _ in range(3):
            change = guard(step.t0 + x * step.h, state(x)) / slope if slope else 0.0
            x = min(max(x - change, 0.0), 1.0) if abs(change) < 1e-3 else x
        self.see(step, x)
        self.move(step.t0 + x * step.h, state(x))
        transition()

    def move(self, t, y):
        self.t, self.y, self.zeros, self.released = float(t), y.copy(), 0, [0, 0]
        for j, (lever, way) in enumerate(zip(self.ties.levers(self.frame, self.s), self.yields)):
            if way:
                before, self.plastic[j] = self.plastic[j], 2 * lever * math.sin(y[-2] / 2) - way * self.ties.F_y / self.ties.k_d
                self.hysteretic += way * self.ties.F_y * (self.plastic[j] - before)

    def see(self, step, end):
        """Adds what the viscous dissipators take over the step up to x = end."""
        y = np.vander(end * NODES, 8, increasing=True) @ step.powers
        power = self.ties.power(self.frame, y[:, -2], y[:, -1])
        self.viscous += step.h * end * np.sum(FIT @ power / np.arange(1, 9))


def simulate(frame: Frame, dt: float, a_g, a_v, ties: Ties):
    """The response from rest to accelerations (m/s2) linear between samples every dt (s), at the samples: motion, forces, energies.
    `transitions` have the states before and after."""
    n, time = len(frame.masses), dt * np.arange(len(a_g))
    motion = Motion(frame, ties)
    rows = [motion.row()]
    for i, end in enumerate(time[1:].tolist()):
        motion.start = float(time[i])
        motion.a_g, motion.a_v = ((float(values[i]), float(values[i + 1] - values[i]) / dt) for values in (a_g, a_v))
        while motion.t < end and not motion.overturned:
            motion.advance(end)
        rows += [] if motion.overturned else [motion.row()]
    names = dict(time=0, u=slice(1, n + 1), a=slice(n + 1, 2 * n + 1), theta=2 * n + 1, u_dot=slice(2 * n + 2, -8), theta_dot=-8,
                 P_t=-7, F_d1=-6, F_d2=-5, e_p1=-4, e_p2=-3, E_viscous=-2, E_hysteretic=-1)
    columns = {name: np.array(rows)[:, at] for name, at in names.items()}
    return SimpleNamespace(**columns, transitions=motion.transitions)
