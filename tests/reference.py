"""An independent integration of the flexible rocking model, to hold the FMU against.

Every line is written from the model's equations (numbers in brackets are the paper's); nothing is shared with the
FMU. Each phase is integrated by scipy's DOP853 at a relative tolerance of 1e-13. Integration restarts at every
sample of the ground motion, so that no step crosses a kink of the load, and at every transition.

A transition is found on the polynomial of degree 7 that DOP853 gives over a step: all its roots are looked at, so two
crossings within one step are both seen. Where the phase starts with theta exactly 0 the zero at the start is divided
out of the polynomial first (once after an impact, twice after an uplift, which starts with theta_dot = 0 too), so that
a return to 0 is found however soon it comes and the start is never taken for it. The instant is then refined by Newton
iteration on fresh integrations from the start of the step, because the polynomial is less accurate than the steps.
"""

from __future__ import annotations

import copy
import math
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import DOP853

FULL_CONTACT = 0  # otherwise the phase is the side s: +1 about the right pivot, -1 about the left one
RTOL = 1e-13
ATOL = 1e-16
TRANSITIONS_PER_SAMPLE = 1000


@dataclass(frozen=True)
class Structure:
    """Parameters (SI) and what follows from them."""

    m: float
    m0: float
    H: float
    B: float
    J0: float
    f_fc: float
    zeta_fc: float
    r: float
    c_ratio: float = 1.0
    g: float = 9.81

    def __post_init__(self):
        omega_fc = 2 * math.pi * self.f_fc
        k = self.m * omega_fc**2
        c_fc = 2 * self.zeta_fc * math.sqrt(k * self.m)
        J_P = self.J0 + self.m * (self.H**2 + self.B**2) + self.m0 * self.B**2
        tan_alpha_cg = (self.m + self.m0) / self.m * self.B / self.H
        p_l = math.sqrt(self.m * self.g * self.H / J_P)
        chi = self.H * p_l**2 / self.g
        vars(self).update(omega_fc=omega_fc, k=k, c_fc=c_fc, c_u=self.c_ratio * c_fc, J_P=J_P, tan_alpha_cg=tan_alpha_cg,
                          alpha_cg=math.atan(tan_alpha_cg), p_l=p_l, chi=chi, u_cr=self.g * tan_alpha_cg / omega_fc**2,
                          f_u=self.f_fc / math.sqrt(1 - chi))


EVISON = Structure(m=125.8, m0=44.02, H=1.05, B=0.285, J0=0.0, f_fc=11.0, zeta_fc=0.015, r=0.96)
MCMANUS = Structure(m=130.1, m0=65.4, H=1.84, B=0.285, J0=10.7, f_fc=5.0, zeta_fc=0.02, r=0.99)


@dataclass(frozen=True)
class Transition:
    """One change of phase; `before` and `after` are (u, u_dot, theta, theta_dot)."""

    time: float
    kind: str  # "uplift", "impact", "landing" or "overturned"
    side: int  # the side rocked about: after an uplift, before the others
    before: tuple
    after: tuple


@dataclass
class Response:
    """The response at the instants `t`, and every transition on the way."""

    structure: Structure
    t: np.ndarray
    u: np.ndarray
    u_dot: np.ndarray
    theta: np.ndarray
    theta_dot: np.ndarray
    phase: np.ndarray
    transitions: list[Transition] = field(default_factory=list)

    @property
    def a_t(self) -> np.ndarray:
        """Acceleration of the top mass by (5), in full contact by (1), m/s2, where no force acts on it."""
        p = self.structure
        damping = np.where(self.phase == FULL_CONTACT, p.c_fc, p.c_u)
        return p.g * np.sin(self.theta) - (damping * self.u_dot + p.k * self.u) / p.m

    @property
    def v_t(self) -> np.ndarray:
        """Lateral velocity of the top mass, m/s."""
        return self._tops()[:, 1]

    @property
    def uplift(self) -> np.ndarray:
        """Uplift of the free edge (25), m."""
        return 2 * self.structure.B * np.sin(np.abs(self.theta))

    @property
    def delta_t(self) -> np.ndarray:
        """Lateral displacement of the top mass (26), m."""
        return self._tops()[:, 0]

    def _tops(self) -> np.ndarray:
        states = zip(self.u, self.u_dot, self.theta, self.theta_dot)
        return np.array([top(self.structure, s, y) for s, y in zip(self.phase, states)])


@dataclass(frozen=True)
class Load:
    """Ground acceleration (m/s2) and force on the top mass (N) at t0, and their rates."""

    t0: float
    a_g: float
    a_g_rate: float = 0.0
    F_t: float = 0.0
    F_t_rate: float = 0.0


def accelerations(p: Structure, s: int, y, a_g: float, F_t: float, numbers=math) -> tuple[float, float]:
    """u_ddot and theta_ddot by (1), or by (5, 6) about side s, with a force F_t on the top mass. `numbers` has sin and cos of theta."""
    u, u_dot, theta, theta_dot = y
    if s == FULL_CONTACT:
        return F_t / p.m - a_g - 2 * p.zeta_fc * p.omega_fc * u_dot - p.omega_fc**2 * u, 0.0
    m, H, B, g, M = p.m, p.H, p.B, p.g, p.m + p.m0
    sn, cs, arm = numbers.sin(theta), numbers.cos(theta), s * B - u
    force = -p.c_u * u_dot - p.k * u - m * theta_dot**2 * arm - m * a_g * cs + m * g * sn + F_t * cs
    moment = (2 * m * arm * u_dot * theta_dot + m * g * H * sn + m * g * u * cs - s * M * g * B * cs
              - a_g * (m * H * cs + (s * M * B - m * u) * sn) + F_t * (H * cs + arm * sn))
    # (6) - H (5) leaves theta_ddot alone, with the inertia that does not turn with the strut's height
    theta_ddot = (moment - H * force) / (p.J0 + m * arm**2 + p.m0 * B**2)
    return force / m - H * theta_ddot, theta_ddot


def _rates(p: Structure, s: int, load: Load):
    """Right-hand side of (1), or of (5, 6) about side s, under a load linear in time."""
    def rates(t, y):
        y = y.tolist()
        a_g = load.a_g + load.a_g_rate * (t - load.t0)
        F_t = load.F_t + load.F_t_rate * (t - load.t0)
        u_ddot, theta_ddot = accelerations(p, s, y, a_g, F_t)
        return [y[1], u_ddot, y[3], theta_ddot]

    return rates


def rocking(p: Structure, s: int, load: Load):
    """Right-hand side of (5, 6) about side s under a load linear in time."""
    return _rates(p, s, load)


def top(p: Structure, s: int, y) -> tuple[float, float]:
    """Displacement and velocity of the top mass relative to the ground (26)."""
    u, u_dot, theta, theta_dot = y
    sn, cs = math.sin(theta), math.cos(theta)
    return (s * p.B * (1 - cs) + u * cs + p.H * sn,
            u_dot * cs + ((s * p.B - u) * sn + p.H * cs) * theta_dot)


def uplift_margin(p: Structure, s: int) -> tuple[float, float, float]:
    """(a, b, c) such that a u + b u_dot + c has the sign of s theta_ddot by (5, 6) at theta = theta_dot = 0."""
    return s * (p.H * p.k + p.m * p.g), s * p.H * p.c_u, -(p.m + p.m0) * p.g * p.B


def lifts(p: Structure, s: int, u: float, u_dot: float) -> bool:
    """Whether the base lifts off about side s from full contact: s u >= u_cr and s theta_ddot > 0."""
    a, b, c = uplift_margin(p, s)
    return s * u >= p.u_cr and a * u + b * u_dot + c > 0


def impact(p: Structure, s: int, y) -> tuple[str, int, np.ndarray]:
    """The transition at theta = 0 from side s: its kind, the phase after it, the state after it."""
    u, u_dot, _, theta_dot = y
    L = p.m * p.H * (u_dot + p.H * theta_dot) - (p.m * (p.B**2 - u**2) + p.m0 * p.B**2 - p.J0) * theta_dot
    if L * theta_dot > 0:
        return "impact", -s, np.array([u, u_dot, 0.0, p.r * theta_dot])
    return "landing", FULL_CONTACT, np.array([u, u_dot + p.H * theta_dot, 0.0, 0.0])


def _dense_to_powers() -> np.ndarray:
    """Powers of x in x F0 + x(1-x) F1 + x²(1-x) F2 + x²(1-x)² F3 + ..., DOP853's dense output less its start."""
    P = np.polynomial.Polynomial
    columns, factor = [], P([1.0])
    for i in range(7):
        factor *= P([0.0, 1.0]) if i % 2 == 0 else P([1.0, -1.0])
        columns.append(np.pad(factor.coef, (0, 8 - len(factor.coef))))
    return np.array(columns).T


_POWERS = _dense_to_powers()
_BERNSTEIN = {n: np.array([[math.comb(i, j) / math.comb(n, j) if j <= i else 0.0 for j in range(n + 1)]
                           for i in range(n + 1)]) for n in (4, 5, 6, 7)}


def unit_roots(c: np.ndarray) -> list[float]:
    """Roots in [0, 1] of the polynomial with coefficients c, by rising power."""
    control = _BERNSTEIN[len(c) - 1] @ c  # the polynomial lies between the least and the largest of these
    if control.min() > 0 or control.max() < 0:
        return []
    found = np.roots(c[::-1])
    found = np.sort(found.real[np.abs(found.imag) <= 1e-14 * np.abs(found)])
    return [x for x in found.tolist() if 0 <= x <= 1]


class _Step:
    """The step that `solver` has just taken: its two ends and, over x in [0, 1] between them, its polynomial."""

    def __init__(self, solver: DOP853):
        self.solver, self.t0, self.h = solver, solver.t_old, solver.t - solver.t_old
        dense = solver.dense_output()
        self.y0, self.y1 = dense.y_old, solver.y
        self.powers = _POWERS @ dense.F
        self.powers[0] += self.y0

    def part(self, at: slice) -> _Step:
        """The same of a part of the state."""
        part = copy.copy(self)
        part.powers, part.y1 = self.powers[:, at], self.y1[at]
        return part

    def at(self, x: float) -> np.ndarray:
        """The state at x, by the polynomial."""
        return x ** np.arange(8) @ self.powers

    def roots(self, guard, zeros_at_start: int = 0) -> list[float]:
        """Where guard, a normal and a constant, has normal @ y + constant = 0; that many zeros at 0 divided out."""
        normal, constant = guard
        c = self.powers @ normal
        c[0] += constant
        return unit_roots(c[zeros_at_start:])

    def integrate_to(self, t: float, rtol: float, atol: float) -> np.ndarray:
        """The state at t, by steps of its own from the start of this one."""
        if t <= self.t0:
            return self.y0
        solver = DOP853(self.solver.fun, self.t0, self.y0, t, rtol=rtol, atol=atol, first_step=t - self.t0)
        while solver.status == "running":
            solver.step()
        return solver.y

    def refine(self, x: float, guard, rtol: float, atol: float) -> tuple[float, np.ndarray]:
        """The instant near x at which guard is 0, and the state there."""
        normal, constant = guard
        t, end = self.t0 + x * self.h, self.t0 + self.h
        for _ in range(6):
            y = self.integrate_to(t, rtol, atol)
            rate = normal @ np.array(self.solver.fun(t, y))
            correction = -(normal @ y + constant) / rate if rate != 0 else 0.0
            if abs(correction) > 1e-3 * self.h:  # a grazing touch: nothing better than the polynomial's root
                break
            refined = min(max(t + correction, self.t0), end)
            if abs(refined - t) <= np.spacing(t):
                break
            t = refined
        return t, y


def _first_uplift(p: Structure, step: _Step) -> tuple[float, int, tuple] | None:
    """The first x in [0, 1] after which the base lifts off, the side, and the guard met there."""
    candidates = []
    for s in (1, -1):
        a, b, c = uplift_margin(p, s)
        for guard in ((np.array([s, 0.0, 0.0, 0.0]), -p.u_cr), (np.array([a, b, 0.0, 0.0]), c)):
            candidates += [(x, s, guard) for x in step.roots(guard)]
    candidates.sort(key=lambda candidate: candidate[0])
    for i, (x, s, guard) in enumerate(candidates):
        following = candidates[i + 1][0] if i + 1 < len(candidates) else 1.0
        u, u_dot = step.at((x + following) / 2)[:2]
        if lifts(p, s, u, u_dot):
            return x, s, guard
    return None


def _first_touch(s: int, step: _Step, zeros_at_start: int) -> tuple[float, int, tuple] | None:
    """The first x in (0, 1] at which s theta is 0 again or pi/2, s, and that guard."""
    returned, flat = (np.array([0.0, 0.0, s, 0.0]), 0.0), (np.array([0.0, 0.0, s, 0.0]), -math.pi / 2)
    touches = [(x, s, returned) for x in step.roots(returned, zeros_at_start) if x > 0]
    touches += [(x, s, flat) for x in step.roots(flat)]
    if s * step.y1[2] <= 0:  # also when rounding hides the root at the very end of the step
        touches.append((1.0, s, returned))
    return min(touches, key=lambda touch: touch[0], default=None)


def integrate(p: Structure, knots, a_g, initial=(0.0, 0.0, 0.0, 0.0), *, F_t=None) -> Response:
    """The response to the ground acceleration `a_g` (m/s2) and the force `F_t` (N) on the top mass at `knots` (s), both
    linear between them.

    `initial` is (u, u_dot, theta, theta_dot). The response is given at the knots. It ends early, at that instant, when the
    structure overturns.
    """
    def rates(phases, load):
        return (_rates if phases[0] == FULL_CONTACT else rocking)(p, phases[0], load)

    run = Run([p], rates, np.array(initial, dtype=float), float(knots[0]), float(knots[1] - knots[0]), RTOL, ATOL)
    run.test_uplifts()
    t, u, u_dot, theta, theta_dot, phase = follow(run, knots, a_g, np.zeros(len(knots)) if F_t is None else F_t).T
    return Response(p, t, u, u_dot, theta, theta_dot, phase.astype(int), run.transitions[0])


def follow(run: Run, knots, a_g, F_t) -> np.ndarray:
    """Rows of the run at the knots, and where a structure overturns, under loads that are linear between the knots."""
    rows = [run.row()]
    for t0, t1, a0, a1, F0, F1 in zip(knots[:-1], knots[1:], a_g[:-1], a_g[1:], F_t[:-1], F_t[1:]):
        load = Load(*map(float, (t0, a0, (a1 - a0) / (t1 - t0), F0, (F1 - F0) / (t1 - t0))))
        budget = len(run.transitions[0]) + TRANSITIONS_PER_SAMPLE
        while run.t < t1 and not run.overturned:
            run.advance(float(t1), load)
            if len(run.transitions[0]) > budget:
                raise RuntimeError(f"more than {TRANSITIONS_PER_SAMPLE} transitions in the sample from {t0} s")
        rows.append(run.row())
        if run.overturned:
            break
    return np.array(rows)


class Run:
    """The hybrid system of one structure, or of several with a state that goes before theirs, at one instant, and how it
    gets on from there."""

    def __init__(self, structures, rates, y: np.ndarray, t: float, h: float, rtol: float, atol: float, recoil=None):
        """`rates` gives the right-hand side for the phases and a load; `recoil` what a transition that takes a structure from
        one (s, state) to another adds to the second number of the state."""
        self.structures, self.rates, self.recoil = structures, rates, recoil
        self.y, self.t, self.h, self.rtol, self.atol = y, t, h, rtol, atol
        before = len(y) - 4 * len(structures)
        self.parts = [slice(before + 4 * i, before + 4 * i + 4) for i in range(len(structures))]
        self.phases = [int(np.sign(y[at][2])) for at in self.parts]
        self.zeros_at_start = [0] * len(structures)  # of theta(t), at the start of a phase, while there
        self.overturned = False
        self.transitions: list[list[Transition]] = [[] for _ in structures]

    def row(self) -> tuple:
        return (self.t, *self.y.tolist(), *self.phases)

    def enter(self, i: int, kind: str, side: int, phase: int, y: np.ndarray):
        before, after = (tuple(state[self.parts[i]].tolist()) for state in (self.y, y))
        self.transitions[i].append(Transition(self.t, kind, side, before, after))
        self.phases[i], self.y = phase, y
        self.zeros_at_start[i] = {"uplift": 2, "impact": 1}.get(kind, 0)

    def test_uplifts(self) -> bool:
        """Lifts every structure off for which the condition of uplift holds as the state stands."""
        lifted = False
        for i, p in enumerate(self.structures):
            u, u_dot = self.y[self.parts[i]][:2]
            s = 1 if u >= 0 else -1
            if self.phases[i] == FULL_CONTACT and lifts(p, s, u, u_dot):
                self.enter(i, "uplift", s, s, self.y)
                lifted = True
        return lifted

    def advance(self, end: float, load):
        """Gets on to `end` or to the first transition before it, whichever comes first."""
        solver = DOP853(self.rates(tuple(self.phases), load), self.t, self.y, end, rtol=self.rtol, atol=self.atol,
                        first_step=min(self.h, end - self.t))
        while solver.status == "running":
            message = solver.step()
            if solver.status == "failed":
                raise RuntimeError(f"DOP853 stopped at {solver.t} s: {message}")
            self.h = max(self.h, solver.h_abs) if solver.status == "finished" else solver.h_abs
            if self.transition(_Step(solver)):
                return
            self.t, self.y, self.zeros_at_start = solver.t, solver.y, [0] * len(self.phases)
            if self.test_uplifts():
                return

    def transition(self, step: _Step) -> bool:
        """Makes the first transition of any structure within `step`, if there is one."""
        found = []
        for i, (p, s, at) in enumerate(zip(self.structures, self.phases, self.parts)):
            part = step.part(at)
            first = _first_uplift(p, part) if s == FULL_CONTACT else _first_touch(s, part, self.zeros_at_start[i])
            found += [(*first, i)] if first else []
        if not found:
            return False
        x, s, (normal, constant), i = min(found, key=lambda candidate: candidate[0])
        p, at, of_all = self.structures[i], self.parts[i], np.zeros(len(self.y))
        of_all[at] = normal
        self.t, self.y = step.refine(x, (of_all, constant), self.rtol, self.atol)
        self.zeros_at_start = [0] * len(self.phases)
        if self.phases[i] == FULL_CONTACT:
            self.enter(i, "uplift", s, s, self.y)
        elif constant != 0:
            self.overturned = True
            self.enter(i, "overturned", s, s, self.y)
        else:
            y = self.y.copy()
            kind, phase, y[at] = impact(p, s, self.y[at])
            if self.recoil:
                y[1] += self.recoil(p, (s, self.y[at]), (phase, y[at]))
            self.enter(i, kind, s, phase, y)
            self.test_uplifts()
        return True


def reactions(p: Structure, s: int, y, load: Load) -> tuple[float, float, float]:
    """(R_h, R_v, R_m) on the ground at load.t0, body by body: the strut pulls the foundation as it pulls the top mass."""
    u, u_dot, theta, theta_dot = y
    if s == FULL_CONTACT:
        shear = p.c_fc * u_dot + p.k * u
        return shear - p.m0 * load.a_g, (p.m + p.m0) * p.g, p.H * shear + p.m * p.g * u
    sn, cs = math.sin(theta), math.cos(theta)
    _, theta_ddot = accelerations(p, s, y, load.a_g, load.F_t)
    shear = p.c_u * u_dot + p.k * u
    away = (s * p.B - u) * theta_ddot - p.H * theta_dot**2 - 2 * theta_dot * u_dot  # of the top mass along the strut
    thrust = p.m * (away + load.a_g * sn + p.g * cs) - load.F_t * sn
    x_ddot = s * p.B * (sn * theta_ddot + cs * theta_dot**2)
    y_ddot = s * p.B * (cs * theta_ddot - sn * theta_dot**2)
    R_v = shear * sn + thrust * cs + p.m0 * (p.g + y_ddot)
    return shear * cs - thrust * sn - p.m0 * (x_ddot + load.a_g), R_v, s * p.B * R_v


def impulses(p: Structure, transition: Transition) -> tuple[float, float, float]:
    """(I_h, I_v, I_m) on the ground: the momentum that the masses lose at theta = 0, where the foundation lies at 0."""

    def momentum(s, y):
        u, u_dot, _, theta_dot = y
        right, down = p.m * (u_dot + p.H * theta_dot), -(p.m * (s * p.B - u) + p.m0 * s * p.B) * theta_dot
        about_middle = p.H * right - p.m * u * (s * p.B - u) * theta_dot + p.J0 * theta_dot
        return np.array([right, down, about_middle])

    after = {"impact": -transition.side}.get(transition.kind, transition.side)
    return tuple(momentum(transition.side, transition.before) - momentum(after, transition.after))
