"""Ground that gives: OpenSees beside the engine, the paper's C on two springs, and when stiff springs are rigid ground."""

import math
from functools import cache
from pathlib import Path

import flexible_rocking as fr
import numpy as np

from ..figures import COLOURS, FIXED, QUIET, ROCKING, SMOOTH, save, subplots
from ..page import table
from ..scenes import RECORDS, G
from .opensees import shaken

J0 = {"evison": 1.1918415, "mcmanus": 10.7}  # m0 B²/3, which is assumed, and of the paper, kg·m²
EVISON, MCMANUS = (fr.Structure(preset=name).replace(J0=of) for name, of in J0.items())
F_V, SAMPLES = 40.0, 801
EL_CENTRO = next(RECORDS.glob("*/*ELC180*.AT2"))
STEPS = [1e-2, 2e-3, 1e-3, 1e-4]  # s
AXIAL = [1e3, 1e5]  # stiffness of an elastic column along its axis over the one across it
THETA_0, MEASURED = 0.04, 11.0  # release of Evison's wall, rad, and its first frequency, Hz
F_VS = [60, 80, 100, 120, 160, 200, 250, 320, 450, 640]
STIFF = [80, 160, 320, 640]  # f_v, Hz


def stiffness(s: fr.Structure, f_v: float) -> float:
    return (s.m + s.m0) * (2 * math.pi * f_v) ** 2


@cache
def record(scale: float) -> fr.Record:
    whole = fr.Record.read(EL_CENTRO, scale=scale)
    return fr.Record(whole.time[:SAMPLES], whole.a_g[:SAMPLES], unit="m/s2")


def signed(part: float) -> str:
    """A relative error in per cent, with its sign."""
    return "does not converge" if math.isnan(part) else f"{100 * part:+.2g} %".replace("-", "−")


def bed(n: int, zeta_v: float) -> fr.Ground:
    """A uniform bed of `n` points under McManus's pier, with half a point at each edge; of two points, springs at the edges."""
    k_v = stiffness(MCMANUS, F_V)
    k = k_v / (n - 1) * np.array([0.5, *[1.0] * (n - 2), 0.5])
    return fr.Ground(xi=list(MCMANUS.B * np.linspace(-1, 1, n)), k=list(k), c=list(2 * zeta_v / (2 * math.pi * F_V) * k))


def compared(figures: Path) -> dict:
    """Errors of OpenSees beside the engine, by steps."""
    scenes = {"springs": (2, 0.0, 0.7, None), "dashpots": (2, 0.2, 0.7, None), "bed": (11, 0.0, 0.35, None)}
    scenes |= {f"column {axial:g}": (2, 0.0, 0.7, axial) for axial in AXIAL}
    told = {name: ("θ_max",) if axial else ("θ_max", "a_t,max") for name, (*_, axial) in scenes.items()}
    errors, runs = {}, {}
    for name, (n, zeta_v, scale, axial) in scenes.items():
        ground = bed(n, zeta_v)
        runs[name] = run = fr.simulate(MCMANUS.replace(ground=ground), record(scale), duration=8, tolerance=1e-12)
        exact = np.array([run.peaks["theta"].value, run.peaks["a_t"].value])
        errors[name] = [shaken(MCMANUS, ground, record(scale), 8.0, step, axial) / exact - 1 for step in STEPS]
    lines = [[f"{1e3 * step:g} ms", round(8 / step), *(signed(part) for name, of in told.items() for part, _ in zip(errors[name][i], of))]
             for i, step in enumerate(STEPS)]
    figure, axis = subplots(1, 1, 3.6)
    for (name, of), color in zip(errors.items(), (ROCKING, COLOURS[2], COLOURS[5], SMOOTH, FIXED), strict=True):
        axis.loglog([8 / step for step in STEPS], [abs(error[0]) for error in of], "o-", color=color, label=f"OpenSees, {name}")
    axis.axvline(runs["springs"].steps, color=QUIET, label="steps of this engine on springs, to 1e-12")
    axis.set(xlabel="steps over 8 s", ylabel=r"relative error of $\theta_{max}$", title="OpenSees converges with the square of its step, to a wrong result with damped columns")
    figure.legend(loc="outside lower center", ncols=2)
    save(figure, figures / "opensees.svg", "Error of OpenSees by steps", "Errors of the peak of the rotation against the number of steps")
    at = {f"at_{1e3 * step:g}_{of}".replace(".", ""): signed(errors["springs"][i][j]) for i, step in enumerate(STEPS) for j, of in enumerate(("theta", "a_t"))}
    at |= {f"{name.replace(' ', '_')}_{of}": signed(errors[name][-1][j]) for name in scenes for j, of in enumerate(("theta", "a_t"))}
    run = runs["springs"]
    headings = ["step", "steps", *(f"{name}: {of}" for name, all_told in told.items() for of in all_told)]
    return dict(steps=run.steps, events=len(run.transitions), theta=f"{1e3 * run.peaks['theta'].value:.4f}", a_t=f"{run.peaks['a_t'].value / G:.4f}",
                bed_steps=runs["bed"].steps, bed_events=len(runs["bed"].transitions), opensees=table(headings, lines), **at)


def on_springs(s: fr.Structure, f_v: float, zeta_v: float) -> fr.Structure:
    """`s` on two springs, with f_fc so that its first frequency on them is the measured one."""
    square, inertia = (2 * math.pi * MEASURED) ** 2, s.J0 + s.m * s.H**2
    left = stiffness(s, f_v) * s.B**2 - s.m * s.g * s.H - square * inertia
    f_fc = math.sqrt(square + s.m * (s.H * square + s.g) ** 2 / left) / (2 * math.pi)
    return s.replace(f_fc=f_fc, ground=fr.Ground(f_v=f_v, zeta_v=zeta_v))


def released(s: fr.Structure, theta_0: float, alpha: float, detail: str = "auto", u_0: float = 0.0) -> tuple[float, float]:
    """The largest |a_t| (m/s²) of the half cycle after the first return of θ, which lasts at least 0.1 s, and the ratio r_eq of its peak to the
    release at `theta_0`."""
    time = np.arange(12_001) * 5e-5
    initial = {"u_0": u_0} if u_0 else {}
    response = fr.simulate(s, duration=time[-1], tolerance=1e-10, theta_0=theta_0, detail=detail, **initial).at(time)
    theta = response["theta"]
    first = np.flatnonzero(theta < 0)[0]
    back = np.flatnonzero((theta > 0) & (time > time[first] + 0.1))
    cycle = slice(first, back[0] if len(back) else None)
    energy = [1 - (1 - size / alpha) ** 2 for size in (np.abs(theta[cycle]).max(), theta_0)]
    return np.abs(response["a_t"][cycle]).max(), math.sqrt(energy[0] / energy[1])


def wall() -> dict:
    """The paper's C of Evison's wall on two springs."""
    rigid = fr.Structure(preset="evison")
    tangent = math.tan(rigid.alpha_cg)
    step = rigid.chi * G * tangent

    def of(s: fr.Structure) -> tuple[float, float]:
        a_t, r_eq = released(s, THETA_0, tangent, u_0=rigid.u_cr)
        return a_t / step - 1, r_eq

    found = [of(on_springs(EVISON, f_v, 0.2)) for f_v in F_VS]
    C, r_eq = of(rigid)
    middle = dict(zip(F_VS, found, strict=True))
    band = [middle[f_v] for f_v in (160, 200, 250)]
    return dict(rigid_C=f"{C:.2f}", rigid_r=f"{r_eq:.3f}", stiff_C=f"{min(C for C, _ in band):.2f} to {max(C for C, _ in band):.2f}",
                stiff_r=f"{np.mean([r for _, r in band]):.3f}",
                amplification=table(["f_v (Hz)", *map(str, F_VS)], [["C", *(f"{C:.2f}" for C, _ in found)],
                                                                   ["r_eq", *(f"{r:.3f}" for _, r in found)]]))


def block(slenderness: float, f_v: float = 800.0) -> str:
    """Restitution of a rigid block on springs with ζ_v = 1, beside Housner's 1 − 2 m_t B²/J_P."""
    m, m0, B, H = 1e3, 5e2, 0.3, 0.3 * slenderness
    s = fr.Structure(m=m, m0=m0, H=H, B=B, J0=m0 * B**2, f_fc=50, zeta_fc=0.02, ground=fr.Ground(f_v=f_v, zeta_v=1))
    alpha = (m + m0) * B / (m * H)
    _, r_eq = released(s, 0.1 * alpha, alpha, "rigid")
    return f"{r_eq:.3f} (Housner {1 - 2 * (m + m0) * B**2 / (m * (B**2 + H**2) + 2 * m0 * B**2):.3f})"


def limits() -> dict:
    """McManus's pier on ever stiffer springs, beside rigid ground."""
    lines, whole = [], fr.Record.read(EL_CENTRO)
    for name, s in (*((f"two springs, {f_v} Hz", MCMANUS.replace(ground=fr.Ground(f_v=f_v, zeta_v=1))) for f_v in STIFF),
                    (f"rigid ground, r = {MCMANUS.r:g}", MCMANUS)):
        run = fr.simulate(s, whole, duration=15)
        lines.append([name, f"{1e3 * run.peaks['theta'].value:.2f}", f"{run.peaks['a_t'].value / G:.3f}", run.steps])
    return dict(limits=table(["ground", "θ_max (mrad)", "a_t,max (g)", "steps"], lines), slender=block(4), stocky=block(2))


def values(figures: Path) -> dict:
    return compared(figures) | wall() | limits()
