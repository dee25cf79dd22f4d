"""An independent integration of a frame of n masses on ground that gives, to compare the engine with.

The state is u, theta, y and their rates. Mass matrix and forces follow from the places of the masses by their Jacobians: no modes,
no elimination. DOP853 goes from sample to sample and from event to event; an event is a root of a polynomial over a step, refined by
fresh integrations.
"""

import numpy as np
import reference
from frames import Frame, Ties
from frames_reference import FIT, NODES
from numpy.polynomial import polynomial
from scipy.integrate import DOP853

NEAR = 1e-9  # a condition this small is on its root
AFTER = 1e-4  # of a step: a condition falls if it is negative so soon after a root
TOLERANCES = dict(rtol=1e-12, atol=1e-14)


class Motion:
    """The frame on `points`, rows of place, stiffness and damping, at rest at the time 0."""

    def __init__(self, frame: Frame, ties: Ties, points):
        self.frame, self.ties, self.n = frame, ties, len(frame.masses)
        self.xi, self.k, self.c = np.array(points, dtype=float).T
        self.rest = -(frame.m_t * frame.g + ties.P_0) / self.k.sum()
        self.s = np.zeros(2 * self.n + 4)
        self.s[self.n + 1] = self.rest
        self.pressed, self.taut = np.ones(len(self.xi), dtype=bool), True
        self.plastic, self.yields, self.events = np.zeros(2), np.zeros(2), []
        self.xi_d = np.array([ties.xi_d, -ties.xi_d])

    def heights(self, s, xi):
        """e and its rate at the places xi (F1)."""
        n, theta = self.n, s[self.n]
        return s[n + 1] - xi * np.sin(theta), s[2 * n + 3] - xi * np.cos(theta) * s[2 * n + 2]

    def pull(self, s):
        """Forces of the dissipators, and the elongations with their rates."""
        t, (height, rate) = self.ties, self.heights(s, self.xi_d)
        elastic = t.k_d * (height - self.rest - self.plastic)
        return np.where(self.yields != 0, self.yields * t.F_y, elastic) + t.c_d * rate, elastic, rate

    def rates(self, t, s):
        p, n = self.frame, self.n
        u, (theta, y), u_dot, (w, _) = s[:n], s[n:n + 2], s[n + 2:2 * n + 2], s[2 * n + 2:]
        sn, cs, column, one = np.sin(theta), np.cos(theta), np.zeros((n, 1)), np.eye(n)
        # Jacobians of x = u cos + h sin and z = y + h cos - u sin by u, theta, y; and what else is in the accelerations of the masses
        by_x = np.hstack([cs * one, (p.h * cs - u * sn)[:, None], column])
        by_z = np.hstack([-sn * one, -(p.h * sn + u * cs)[:, None], column + 1])
        a_g, a_v = (a + slope * (t - self.start) for a, slope in (self.a_g, self.a_v))
        x = -2 * sn * w * u_dot - (u * cs + p.h * sn) * w**2 + a_g
        z = -2 * cs * w * u_dot - (p.h * cs - u * sn) * w**2 + a_v + p.g
        e, rate = self.heights(s, self.xi)
        N, (F, *_) = np.where(self.pressed, -(self.k * e + self.c * rate), 0.0), self.pull(s)
        P = self.taut * (self.ties.P_0 + self.ties.k_t * (y - self.rest))
        mass = by_x.T * p.m @ by_x + by_z.T * p.m @ by_z + np.diag([0.0] * n + [p.J0, p.m0])
        force = -by_x.T @ (p.m * x) - by_z.T @ (p.m * z)
        force[:n] -= p.K @ u + p.C @ u_dot
        force[n] -= cs * (self.xi @ N - self.xi_d @ F)
        force[n + 1] += N.sum() - F.sum() - P - p.m0 * (p.g + a_v)
        return np.concatenate([s[n + 2:], np.linalg.solve(mass, force)])

    def conditions(self, s):
        """Numbers that are positive while nothing changes: of the points, the tendon, and both dissipators."""
        t, (e, rate), (_, elastic, stretch) = self.ties, self.heights(s, self.xi), self.pull(s)
        margin = np.minimum(-e, -(e + self.c / self.k * rate)) / -self.rest
        points = np.where(self.pressed, margin, -margin)
        slack = (t.P_0 + t.k_t * (s[self.n + 1] - self.rest)) * (1 if self.taut else -1) / (self.frame.m_t * self.frame.g)
        held = np.where(self.yields != 0, self.yields * stretch, 1 - np.abs(elastic) / t.F_y if t.F_y else 1.0)
        return np.concatenate([points, [slack if t.k_t else 1.0], held])

    def change(self, i, s, time):
        points = len(self.xi)
        if i < points:
            self.pressed[i] = not self.pressed[i]
            self.events.append((time, "touch" if self.pressed[i] else "release"))
        elif i == points:
            self.taut = not self.taut
        else:
            j, elastic = i - points - 1, self.pull(s)[1]
            if self.yields[j]:
                self.plastic[j] += (elastic[j] - self.yields[j] * self.ties.F_y) / self.ties.k_d
                self.yields[j] = 0.0
            else:
                self.yields[j] = np.sign(elastic[j])

    def to(self, end):
        """Goes on to `end` under the present acceleration."""
        while self.time < end:
            solver = DOP853(self.rates, self.time, self.s, end, max_step=self.longest, **TOLERANCES)
            while solver.status == "running":
                solver.step()
                assert solver.status != "failed", self.time
                step = reference._Step(solver)
                fits = FIT @ [self.conditions(step.at(x)) for x in NODES]
                falling = [(x, i) for i, c in enumerate(fits.T) for x in reference.unit_roots(c)
                           if polynomial.polyval(x + AFTER, c) < 0]  # what has just changed begins at 0 and rises
                if falling:
                    x, i = min(falling)
                    self.make(step, x, i, polynomial.polyval(x, polynomial.polyder(fits[:, i])))
                    break
                self.time, self.s = solver.t, solver.y

    def make(self, step, x, i, slope):
        """Makes the change of condition i near x, and what another condition is due for there."""
        for _ in range(3):
            self.time = step.t0 + x * step.h
            self.s = step.integrate_to(self.time, **TOLERANCES)
            x -= self.conditions(self.s)[i] / slope
        self.change(i, self.s, self.time)
        for i in np.flatnonzero(self.conditions(self.s) < -NEAR):
            self.change(i, self.s, self.time)

    def follow(self, dt, a_g, a_v):
        """Rows of theta, y, u and accelerations of the floors at the samples but the first."""
        p, n, rows = self.frame, self.n, []
        stiff = max(p.omega[-1] ** 2, self.k.sum() / p.m_t, self.k @ self.xi**2 / p.J0)
        self.longest, self.time = 0.5 / np.sqrt(stiff), 0.0
        for i in range(len(a_g) - 1):
            self.start = i * dt
            self.a_g, self.a_v = ((a[i], (a[i + 1] - a[i]) / dt) for a in (a_g, a_v))
            self.to((i + 1) * dt)
            u, theta, y = self.s[:n], *self.s[n:n + 2]
            rows.append([theta, y, *u, *(p.g * np.sin(theta) - p.elastic @ np.concatenate([u, self.s[n + 2:2 * n + 2]]))])
        return np.array(rows)
