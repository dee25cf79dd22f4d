"""An independent integration of a frame of n masses on ground that gives, to compare the engine with.

The state is u, theta, y, x and their rates, and the settlements s for good. Mass matrix and forces follow from the places of the masses
by their Jacobians: no modes, no elimination; a base that sticks has no row of x. DOP853 goes from sample to sample and from event to
event; an event is a root of a polynomial over a step, refined by fresh integrations.
"""

import math

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
    """The frame on `points`, rows of place, stiffness and damping, at rest at the time 0. The base slides if there is mu_c, and is held
    otherwise; the points yield at fs times their force at rest."""

    def __init__(self, frame: Frame, ties: Ties, points, mu_c=None, fs=math.inf):
        self.frame, self.ties, self.n, self.mu_c = frame, ties, len(frame.masses), mu_c
        self.xi, self.k, self.c = np.array(points, dtype=float).T
        self.rest = -(frame.m_t * frame.g + ties.P_0) / self.k.sum()
        self.q, self.d = -fs * self.k * self.rest, self.n + 3
        self.s = np.zeros(2 * self.d + len(self.xi))
        self.s[self.n + 1] = self.rest
        self.pressed, self.taut, self.settles = np.ones(len(self.xi), dtype=bool), True, np.zeros(len(self.xi), dtype=bool)
        self.plastic, self.yields, self.events = np.zeros(2), np.zeros(2), []
        self.friction, self.zeros = "stick", 0  # zeros of the rate of x at this instant
        self.xi_d = np.array([ties.xi_d, -ties.xi_d])

    def heights(self, s, xi):
        """e and its rate at the places xi (F1)."""
        n, theta, rates = self.n, s[self.n], s[self.d:]
        return s[n + 1] - xi * np.sin(theta), rates[n + 1] - xi * np.cos(theta) * rates[n]

    def pushes(self, s):
        """e above the settlements for good and its rate without theirs, f, and N (S5, S6)."""
        e, rate = self.heights(s, self.xi)
        f = -(self.k * (e + s[2 * self.d:]) + self.c * rate)
        return e + s[2 * self.d:], rate, f, np.where(self.pressed, np.where(self.settles, self.q, f), 0.0)

    def pull(self, s):
        """Forces of the dissipators, and the elongations with their rates."""
        t, (height, rate) = self.ties, self.heights(s, self.xi_d)
        elastic = t.k_d * (height - self.rest - self.plastic)
        return np.where(self.yields != 0, self.yields * t.F_y, elastic) + t.c_d * rate, elastic, rate

    def moved(self, t, s):
        """Accelerations of u, theta, y and x, and the friction that a base which sticks needs (S2)."""
        p, n, d = self.frame, self.n, self.d
        u, (theta, y), u_dot, w = s[:n], s[n:n + 2], s[d:d + n], s[d + n]
        sn, cs, column, one = np.sin(theta), np.cos(theta), np.zeros((n, 1)), np.eye(n)
        # Jacobians of x + u cos + h sin and y + h cos - u sin by u, theta, y, x; and what else is in the accelerations of the masses
        by_x = np.hstack([cs * one, (p.h * cs - u * sn)[:, None], column, column + 1])
        by_z = np.hstack([-sn * one, -(p.h * sn + u * cs)[:, None], column + 1, column])
        a_g, a_v = (a + slope * (t - self.start) for a, slope in (self.a_g, self.a_v))
        x = -2 * sn * w * u_dot - (u * cs + p.h * sn) * w**2 + a_g
        z = -2 * cs * w * u_dot - (p.h * cs - u * sn) * w**2 + a_v + p.g
        (*_, N), (F, *_) = self.pushes(s), self.pull(s)
        P = self.taut * (self.ties.P_0 + self.ties.k_t * (y - self.rest))
        mass = by_x.T * p.m @ by_x + by_z.T * p.m @ by_z + np.diag([0.0] * n + [p.J0, p.m0, p.m0])
        force = -by_x.T @ (p.m * x) - by_z.T @ (p.m * z)
        force[:n] -= p.K @ u + p.C @ u_dot
        force[n:] += [-cs * (self.xi @ N - self.xi_d @ F), N.sum() - F.sum() - P - p.m0 * (p.g + a_v), -p.m0 * a_g]
        if self.friction != "stick":
            force[-1] -= self.sign() * self.mu_c * N.sum()
            return np.linalg.solve(mass, force), 0.0
        held = np.append(np.linalg.solve(mass[:-1, :-1], force[:-1]), 0.0)
        return held, mass[-1] @ held - force[-1]

    def sign(self):
        return {"slip left": -1, "slip right": 1}.get(self.friction, 0)

    def rates(self, t, s):
        (_, rate, f, _), c = self.pushes(s), np.where(self.c > 0, self.c, 1.0)
        settling = self.settles * np.where(self.c > 0, (f - self.q) / c if self.settles.any() else 0.0, -rate)  # (S7)
        return np.concatenate([s[self.d:2 * self.d], self.moved(t, s)[0], settling])

    def conditions(self, t, s):
        """Numbers that are positive while nothing changes: of the points, their yielding, the tendon, both dissipators, and friction."""
        p, ties, (e, rate, f, N), (_, elastic, stretch) = self.frame, self.ties, self.pushes(s), self.pull(s)
        margin, weight = np.minimum(-e, f / self.k) / -self.rest, p.m_t * p.g
        points = np.where(self.pressed, margin, -margin)
        over = (f - self.q) / self.k / -self.rest if np.isfinite(self.q[0]) else -1.0
        yielding = np.where(self.settles, np.where(self.c > 0, over, -rate / math.sqrt(p.g * p.B)), np.where(self.pressed, -over, 1.0))
        slack = (ties.P_0 + ties.k_t * (s[self.n + 1] - self.rest)) * (1 if self.taut else -1) / weight
        held = np.where(self.yields != 0, self.yields * stretch, 1 - np.abs(elastic) / ties.F_y if ties.F_y else 1.0)
        rubs = np.ones(2)
        if self.mu_c is not None and self.friction == "stick":
            rubs = (self.mu_c * N.sum() + np.array([-1, 1]) * self.moved(t, s)[1]) / weight
        elif self.sign():
            rubs[0] = self.sign() * s[2 * self.d - 1] / math.sqrt(p.g * p.B)
        return np.concatenate([points, yielding, [slack if ties.k_t else 1.0], held, rubs])

    def change(self, i, s, time):
        """Makes the change of condition i, but for friction."""
        points, kind = len(self.xi), None
        if i < points:
            self.pressed[i] = not self.pressed[i]
            kind = "touch" if self.pressed[i] else "release"
        elif i < 2 * points:
            self.settles[i - points] = not self.settles[i - points]
            kind = "ground yields" if self.settles[i - points] else "ground holds"
        elif i == 2 * points:
            self.taut = not self.taut
        elif (j := i - 2 * points - 1) < 2:
            elastic = self.pull(s)[1]
            if self.yields[j]:
                self.plastic[j] += (elastic[j] - self.yields[j] * self.ties.F_y) / self.ties.k_d
                self.yields[j] = 0.0
            else:
                self.yields[j] = np.sign(elastic[j])
        self.events += [(time, kind)] if kind else []

    def rub(self, i):
        """Friction after all changes of an instant, of which condition i was the first."""
        before, due, rate = self.friction, i - 2 * len(self.xi) - 3, 2 * self.d - 1
        smooth = before == "stick" and due >= 0
        if self.sign() and due == 0:
            self.s[rate] = 0.0
        if not self.pressed.any():
            self.friction = "flight"
        elif smooth or self.s[rate]:
            self.friction = ("slip left", "slip right")[due if smooth else int(self.s[rate] > 0)]
        else:
            self.friction = "stick"
            needed, most = self.moved(self.time, self.s)[1], self.mu_c * self.pushes(self.s)[3].sum()
            if abs(needed) > most + NEAR * self.frame.m_t * self.frame.g:
                self.friction = "slip left" if needed > 0 else "slip right"
        self.zeros = 0 if self.s[rate] else 2 if smooth else 1
        self.events += [(self.time, self.friction)] if self.friction != before else []

    def to(self, end):
        """Goes on to `end` under the present acceleration."""
        while self.time < end:
            solver = DOP853(self.rates, self.time, self.s, end, max_step=self.longest, **TOLERANCES)
            while solver.status == "running":
                solver.step()
                assert solver.status != "failed", self.time
                step = reference._Step(solver)
                fits = FIT @ [self.conditions(step.t0 + x * step.h, step.at(x)) for x in NODES]
                zeros = [0] * (fits.shape[1] - 2) + [self.zeros if self.sign() else 0, 0]
                falling = [(x, i) for i, c in enumerate(fits.T) for x in reference.unit_roots(c[zeros[i]:])
                           if polynomial.polyval(x + AFTER, c[zeros[i]:]) < 0]  # what has just changed begins at 0 and rises
                if falling:
                    x, i = min(falling)
                    self.make(step, x, i, polynomial.polyval(x, polynomial.polyder(fits[:, i])))
                    break
                self.time, self.s, self.zeros = solver.t, solver.y, 0

    def make(self, step, x, i, slope):
        """Makes the change of condition i near x, and what another condition is due for there."""
        for _ in range(3):
            self.time = step.t0 + x * step.h
            self.s = step.integrate_to(self.time, **TOLERANCES)
            x -= self.conditions(self.time, self.s)[i] / slope
        self.change(i, self.s, self.time)
        for j in np.flatnonzero(self.conditions(self.time, self.s) < -NEAR):
            self.change(j, self.s, self.time)
        if self.mu_c is not None:
            self.rub(i)

    def follow(self, dt, a_g, a_v):
        """Rows of theta, y, x, s, u and accelerations of the floors at the samples but the first."""
        p, n, rows = self.frame, self.n, []
        stiff = max(p.omega[-1] ** 2, self.k.sum() / p.m_t, self.k @ self.xi**2 / p.J0)
        self.longest, self.time = 0.5 / np.sqrt(stiff), 0.0
        for i in range(len(a_g) - 1):
            self.start = i * dt
            self.a_g, self.a_v = ((a[i], (a[i + 1] - a[i]) / dt) for a in (a_g, a_v))
            self.to((i + 1) * dt)
            u, (theta, y, x), d = self.s[:n], self.s[n:n + 3], self.d
            rows.append([theta, y, x, *self.s[2 * d:], *u, *(p.g * np.sin(theta) - p.elastic @ np.concatenate([u, self.s[d:d + n]]))])
        return np.array(rows)
