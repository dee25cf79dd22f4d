"""Ground that slips and yields: closed forms, OpenSees, and whether friction and capacity matter."""

import math
from pathlib import Path

import flexible_rocking as fr
import numpy as np
import pandas as pd

from .. import ROOT
from ..figures import COLOURS, save, subplots
from ..ground.opensees import shaken
from ..ground.page import F_V, MCMANUS, bed, record, signed
from ..page import table
from ..scenes import RECORDS, G, horizontal_records
from ..study import scientific

FRICTION = [0.3, 0.5, 0.8]
LONGEST = 15.0  # duration of a run of the population at most, s
STIFF = 10  # f_v over f_fc at least
LIGHT = 0.01  # rotation at which the first edge leaves the ground, as a part of tan α_cg, at most
CHANGED = 0.05  # relative difference from which a peak has changed
RESERVES = [2, 3, 5, None]  # fs
PIER = fr.Structure(m=450e3, m0=150e3, H=9, B=3, J0=5e5, f_fc=1.5, zeta_fc=0.03)
SOIL = {"f_v": 9.3, "zeta_v": 0.25, "n_points": 11}
LIMITS = {"rotation": "theta >= 2 %", "settlement that stays": "settlement_res >= 2 cm", "tilt that stays": "theta_res >= 0.2 %"}


def newmark() -> dict:
    """Errors of the way of a flat block beside Newmark's, under a rectangular pulse and half a sine."""
    A, t_0, mu_c = 6.0, 0.2, 0.3
    block = fr.Structure(m=1e3, m0=1e3, H=1e-3, B=1, J0=1e3, f_fc=200, zeta_fc=0.05, ground=fr.Ground(f_v=100, zeta_v=1, mu_c=mu_c))
    phi, slows = math.asin(mu_c * G / A), mu_c * G
    rest = t_0 * (1 - phi / math.pi)
    v_0 = A * t_0 / math.pi * (1 + math.cos(phi)) - slows * rest
    half = A * t_0 / math.pi * (rest * math.cos(phi) + t_0 / math.pi * math.sin(phi)) - slows * rest**2 / 2 + v_0**2 / (2 * slows)
    time = np.arange(10_001) * 1e-4
    pulses = {"rectangle": ([0, t_0, t_0 + 1e-9, 1], [A, A, 0, 0], A * t_0**2 / 2 * (A / slows - 1)),
              "sine": (time, np.where(time < t_0, A * np.sin(np.pi * time / t_0), 0), half)}
    found = {}
    for name, (times, a_g, way) in pulses.items():
        run = fr.simulate(block, fr.Record(times, a_g, unit="m/s2"), duration=1, tolerance=1e-12)
        found |= {f"{name}_way": f"{1e3 * way:.2f}", f"{name}_error": scientific(abs(-run.residuals["x_end"] / way - 1))}
    return found


def first_motion() -> str:
    """How a stiff block moves first while a_g rises by 0.4 m/s² a second, beside tan α_cg."""
    lines, rise = [], fr.Record([0, 12], [0, 4.8], unit="m/s2")
    for mu_c in (0.28, 0.30, 0.32, 0.34, 0.36):
        ground = fr.Ground(f_v=30, zeta_v=0.5, mu_c=mu_c)
        block = fr.Structure(m=999, m0=51, H=0.8, B=0.25, J0=234.167, f_fc=400, zeta_fc=0.05, ground=ground)
        first = fr.simulate(block, rise, duration=9).transitions[0]
        lines.append([f"{mu_c:.2f}", "slides" if first.kind.startswith("slip") else "lifts an edge", f"{0.4 * first.time / G:.4f}"])
    return table(["μ_c", "first the block", "at a_g (g)"], lines, (0, 1))


def capacity() -> str:
    """Largest static moments over W B beside the closed forms: points filled from the edge inwards, and the uniform bed."""
    lines = []
    for n in (2, 11):
        xi = np.linspace(1, -1, n)
        inner = 2 / 3 / (n - 2 - (xi[1:-1] ** 2).sum()) if n > 2 else 0.0  # K_r is K_z B²/3
        share = np.array([(1 - (n - 2) * inner) / 2, *[inner] * (n - 2), (1 - (n - 2) * inner) / 2])
        for fs in (1.5, 2, 3, 5):
            left = 1 - np.concatenate([[0], np.cumsum(fs * share)])[:-1]
            exact = float(xi @ np.clip(left, 0, fs * share))
            soil = fr.Ground(f_v=50, n_points=n, fs=fs)
            s = fr.Structure(m=1e3, m0=100, H=8, B=1, J0=500, f_fc=50, zeta_fc=0.02, ground=soil)
            along = s.pushover(400)
            theta, u = along["theta"], along["u"]
            moment = along["M"] + s.m * s.g * (s.H * np.sin(theta) + u * np.cos(theta))
            found = float((moment / np.cos(theta)).max() / ((s.m + s.m0) * s.g * s.B))
            lines.append([n, fs, f"{found:.4f}", f"{exact:.4f}", f"{1 - 1 / fs:.4f}" if n > 2 else "–"])
    return table(["points", "fs", "pushover", "points filled", "1 − 1/fs"], lines, ())


def opensees() -> dict:
    """Errors of OpenSees on two springs that yield, by steps."""
    soil = fr.Ground(**bed(2, 0.0), fs=3)
    run = fr.simulate(MCMANUS.replace(ground=soil), record(0.7), duration=8, tolerance=1e-12)
    exact = np.array([run.peaks["theta"].value, run.peaks["a_t"].value])
    errors = {step: shaken(MCMANUS, soil, record(0.7), 8.0, step) / exact - 1 for step in (1e-2, 2e-3, 1e-3, 5e-4, 1e-4)}
    lines = [[f"{1e3 * step:g} ms", round(8 / step), *map(signed, error)] for step, error in errors.items()]
    return dict(opensees=table(["step", "steps", "θ_max", "a_t,max"], lines), theta=f"{1e3 * exact[0]:.4f}", steps=run.steps, f_v=f"{F_V:g}")


def population() -> list[tuple[fr.Structure, fr.Record]]:
    """The structures of `validity.csv` on stiff springs, each with the ground motion that it has there."""
    root = 1.5
    for _ in range(60):
        root = (1 + root) ** 0.1
    names = ("*ELC180*", "*CLS000*", "*SYL360*", "*PUL164*")
    records = [fr.Record.read(next(RECORDS.glob(f"*/{name}.AT2"))) for name in names]
    rows = pd.read_csv(ROOT / "docs/explain/validity.csv")
    found = []
    for k, of in rows[rows["scene"].isna()].reset_index(drop=True).iterrows():
        s = fr.Structure(**{name: of[name] for name in ("m", "m0", "H", "B", "J0", "f_fc", "zeta_fc")})
        tangent = math.tan(s.alpha_cg)
        strength, which = ((0.5 + k * root ** -(i + 1)) % 1 for i in (7, 8))
        motion = records[int(4 * which)]
        f_v = max(STIFF * s.f_fc, math.sqrt(G / (LIGHT * tangent * s.B)) / (2 * math.pi))
        s = s.replace(J0=max(s.J0, s.m0 * s.B**2 / 3), ground=fr.Ground(f_v=f_v, zeta_v=0.2))
        found.append((s, motion.scaled(4**strength * G * tangent / motion.pga)))
    return found


def friction() -> dict:
    """How the peak of θ changes with friction, beside a base that is held, and what the held base predicts."""
    rows = []
    for number, (s, motion) in enumerate(population()):
        slipping = {f"{mu_c:g}": s.replace(ground=fr.Ground(**s.parameters["ground"], mu_c=mu_c)) for mu_c in FRICTION}
        with_motion = {"records": {"r": motion}, "scale": [1.0], "duration": min(LONGEST, motion.duration)}
        held = fr.sweep({"held": s}, **with_motion, validity=True)
        row = {"number": number, "tangent": math.tan(s.alpha_cg), "f_v": s.parameters["ground"]["f_v"], "needed": held["mu_required"][0]}
        for name, run in [("held", held.loc[0]), *fr.sweep(slipping, **with_motion).set_index("structures").iterrows()]:
            row |= {f"theta {name}": run["peak_theta[rad]"], f"x {name}": run.get("peak_x[m]", 0.0), f"ending {name}": run["ending"]}
        rows.append(row)
    all_rows = pd.DataFrame(rows)
    lines, told = [], {}
    for mu_c in FRICTION:
        endings = all_rows[["ending held", f"ending {mu_c:g}"]]
        of = all_rows[~endings.isin(["overturned", "failed"]).any(axis=1)]
        change = of[f"theta {mu_c:g}"] / of["theta held"] - 1
        moves, slender = change.abs() > CHANGED, of["tangent"] > mu_c
        needs = of["needed"] > mu_c
        lines.append([f"{mu_c:g}", len(of), (of[f"x {mu_c:g}"].abs() > 0.01).sum(), moves.sum(), (change < -CHANGED).sum(), needs.sum(), (moves & needs).sum(),
                      slender.sum(), (moves & slender).sum(), *(endings == "overturned").sum()])
        told |= {f"moved_{10 * mu_c:g}": moves.sum(), f"stand_{10 * mu_c:g}": len(of), f"fall_{10 * mu_c:g}": (change < -CHANGED).sum()}
    headings = ["μ_c", "stand", "slide by 1 cm", "θ_max moves", "and falls", "mu_required > μ_c", "of these move", "tan α_cg > μ_c", "of these move",
                "overturn held", "overturn"]
    return told | dict(friction=table(headings, lines), structures=len(all_rows),
                       ratio=f"{all_rows['f_v'].median():.0f}")


def yielding(figures: Path) -> dict:
    """Fragility of one pier by its static reserve."""
    records = {path.stem: fr.Record.read(path) for path in horizontal_records().values()}
    piers = {f"fs = {fs}" if fs else "elastic": PIER.replace(ground=fr.Ground(**SOIL, **({"fs": fs} if fs else {}))) for fs in RESERVES}
    at_1 = {name: of.scaled(1 / of.pgv) for name, of in records.items()}
    runs = fr.sweep(piers, at_1, scale=np.geomspace(0.15, 3, 14), intensity="PGV")
    figure, axes = subplots(1, 3, 3.2, sharey=True)
    lines, intensities = [], np.linspace(0.05, 3, 200)
    for axis, (name, limit) in zip(axes, LIMITS.items()):
        named = [of for of in piers if of != "elastic" or limit.startswith("theta ")]
        curves = fr.fragility(runs[runs["structures"].isin(named)], limit, by="structures")
        for of, color in zip(piers, COLOURS):
            if of in curves:
                axis.plot(intensities, curves[of].probability(intensities), color=color, label=of)
        axis.set(xlabel="PGV (m/s)", title=f"{name}\n{limit.partition(' ')[2].replace('>=', '≥')}")
        lines.append([f"`{limit}`", *(f"{curves[of].median:.2f} ({curves[of].dispersion:.2f})" if of in curves else "–" for of in piers)])
    axes[0].set_ylabel("probability")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    save(figure, figures / "fragility.svg", "Fragility by static reserve", "Probabilities of rotation, settlement and tilt over PGV")
    fallen = runs[runs["ending"] == "overturned"].groupby("structures").size()
    return dict(fragility=table(["limit", *piers], lines), fallen=", ".join(f"{of}: {fallen.get(of, 0)}" for of in piers), runs=len(runs) // len(piers))


def values(figures: Path) -> dict:
    return newmark() | opensees() | friction() | yielding(figures) | dict(first=first_motion(), capacity=capacity())
