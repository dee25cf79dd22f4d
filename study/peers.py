"""Peers in Python: heyoka (Taylor series with events) and scipy (DOP853 with events) on a scene of the study.

Reads the scene as JSON from standard input and prints a JSON list of runs, which `study precision` compares like its own. The
equations and rules are those of tests/reference.py, which shares no code with the engine. Each library finds the transitions
by its own events and restarts at every sample and transition. Python drives the steps, which is part of the time.
"""

import json
import math
import sys
import time
from pathlib import Path

import heyoka as hy
import numpy as np
from scipy.integrate import solve_ivp

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
import reference as model

ABSOLUTE = 1e-3  # absolute tolerance over relative tolerance, as in src/libraries.rs
MOST_TRANSITIONS = 1000  # in one interval
THROUGH_THE_FLOOR = 1e-3  # rad
TOLERANCES = [10.0**-k for k in range(2, 14)]
LEAST = 0.3  # runs are repeated until they have taken this many seconds, and the fastest counts
NUDGE = 1e-18  # rad: if rocking starts with θ = 0 exactly, events miss a return within the step, or find the start itself


class Failure(Exception):
    pass


def margins(p, y):
    """Whatever must be positive for uplift about the left and the right pivot."""
    for s in (1, -1):
        a, b, c = model.uplift_margin(p, s)
        yield s, s * y[0] - p.u_cr, a * y[0] + b * y[1] + c


class Scipy:
    """solve_ivp with DOP853 and terminal events."""

    def __init__(self, p, tolerance):
        self.p, self.tolerance, self.work = p, tolerance, 0

    def advance(self, s, y, tau, dt, a_g, slope):
        """The state where the phase or the interval ends, the instant, and the side about which the base lifts, if it does."""
        p = self.p
        load = model.Load(0.0, a_g, slope)
        if s == model.FULL_CONTACT:
            events = [lambda _, y, k=k: min(list(margins(p, y))[k][1:] / np.array([p.u_cr, p.g * p.m * p.B])) for k in (0, 1)]
        else:
            events = [lambda _, y: s * y[2], lambda _, y: s * y[2] - math.pi / 2]
        for event, direction in zip(events, (1, 1) if s == model.FULL_CONTACT else (-1, 1)):
            event.terminal, event.direction = True, direction
        found = solve_ivp(model.rocking(p, s, load), (tau, dt), y, "DOP853", events=events, rtol=self.tolerance,
                          atol=ABSOLUTE * self.tolerance)
        self.work += found.nfev
        if not found.success:
            raise Failure(found.message)
        hit = [k for k, times in enumerate(found.t_events) if len(times)]
        return found.y[:, -1], found.t[-1], hit[0] if hit else None


class Heyoka:
    """taylor_adaptive with terminal events: one integrator for each phase."""

    def __init__(self, p, tolerance):
        self.p, self.work = p, 0
        y = hy.make_vars("u", "u_dot", "theta", "theta_dot")
        a_g = hy.par[0] + hy.par[1] * hy.time
        rise, fall = hy.event_direction.positive, hy.event_direction.negative
        self.of_phase = {}
        for s in (model.FULL_CONTACT, 1, -1):
            guards = [(s * y[2], fall), (s * y[2] - math.pi / 2, rise)]
            if s == model.FULL_CONTACT:
                guards = [(guard, rise) for _, *pair in margins(p, y) for guard in pair]
            u_ddot, theta_ddot = model.accelerations(p, s, y, a_g, 0.0, hy)
            rates = [*zip(y, (y[1], u_ddot, y[3], hy.expression(theta_ddot)))]
            events = [hy.t_event(guard, direction=direction) for guard, direction in guards]
            self.of_phase[s] = hy.taylor_adaptive(rates, [0.0] * 4, pars=[0.0, 0.0], tol=tolerance, t_events=events)

    def advance(self, s, y, tau, dt, a_g, slope):
        solver = self.of_phase[s]
        solver.pars[:] = a_g, slope
        solver.time, solver.state[:] = tau, y
        solver.reset_cooldowns()
        while True:
            outcome, _, _, steps, *_ = solver.propagate_until(dt)
            self.work += steps * solver.order
            k = int(outcome)
            if outcome == hy.taylor_outcome.time_limit:
                return np.array(solver.state), dt, None
            if outcome == hy.taylor_outcome.err_nf_state:
                raise Failure("the state is not finite")
            stopped = -k - 1  # a terminal event that ends the propagation
            if s != model.FULL_CONTACT:
                return np.array(solver.state), solver.time, stopped
            # of the two conditions of uplift, the second to hold lifts the base
            pair = stopped // 2
            other = list(margins(self.p, solver.state))[pair][2 - stopped % 2]
            if other >= 0.0:
                return np.array(solver.state), solver.time, pair


def run(scene, p, solver):
    """The samples (theta, u, a_t) and the number of transitions; raises Failure."""
    dt, a_g = scene["dt"], scene["a_g"]
    u, theta = scene["u"], scene["theta"]
    y, s = np.array([u, 0.0, theta, 0.0]), int(math.copysign(1, theta)) if theta else model.FULL_CONTACT
    samples, transitions = [], 0
    for k in range(len(a_g) - 1):
        tau, most = 0.0, transitions + MOST_TRANSITIONS
        slope = (a_g[k + 1] - a_g[k]) / dt
        while tau < dt:
            if s != model.FULL_CONTACT and y[2] == 0.0:
                y[2] = s * NUDGE
            y, tau, event = solver.advance(s, y, tau, dt, a_g[k], slope)
            at = k * dt + tau
            if s != model.FULL_CONTACT and (event == 1 or s * y[2] < -THROUGH_THE_FLOOR):
                raise Failure(f"{'overturns' if event == 1 else 'falls through the ground'} at t = {at:.3f} s")
            if event is not None:
                if s == model.FULL_CONTACT:
                    s = (1, -1)[event]
                else:
                    _, s, y = model.impact(p, s, (y[0], y[1], 0.0, y[3]))
                transitions += 1
                if s == model.FULL_CONTACT:
                    due = [s for s in (1, -1) if model.lifts(p, s, y[0], y[1])]
                    s, transitions = (due[0], transitions + 1) if due else (s, transitions)
            if transitions > most:
                raise Failure(f"opens and shuts contact without end at t = {at:.3f} s")
        damping = p.c_fc if s == model.FULL_CONTACT else p.c_u
        samples.append((y[2], y[0], p.g * math.sin(y[2]) - (damping * y[1] + p.k * y[0]) / p.m))
    return samples, transitions


def measured(scene, p, make, name, tolerance):
    solver = make(p, tolerance)
    best, spent = math.inf, 0.0
    while spent < LEAST:
        solver.work, start = 0, time.process_time()
        samples, transitions, failure = [], 0, None
        try:
            samples, transitions = run(scene, p, solver)
        except Failure as why:
            failure = str(why)
        took = time.process_time() - start
        best, spent = min(best, took), spent + took
    return dict(method=name, tolerance=tolerance, seconds=best, evaluations=solver.work, transitions=transitions, failure=failure,
                samples=np.ravel(samples).tolist())


def main():
    scene = json.load(sys.stdin)
    p = model.Structure(**scene["structure"])
    runs = []
    for name, make in (("heyoka, its events", Heyoka), ("scipy DOP853, its events", Scipy)):
        for tolerance in TOLERANCES:
            runs.append(measured(scene, p, make, name, tolerance))
    json.dump(runs, sys.stdout)


if __name__ == "__main__":
    main()
