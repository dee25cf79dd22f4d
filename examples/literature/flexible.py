"""Section 2: frequency while rocking, impacts and overturning of flexible structures."""

from collections.abc import Callable

import fmpy
import numpy as np
from first_run import G
from scipy.linalg import eigvals, logm
from validation.project import Project
from validation.report import table
from validation.stepper import LINEAR, RIGID

from .block import Block, PulseRuns, homogeneous
from .ensemble import records
from .slender_block import HALF_SINE, half_sine_boundary

MCMANUS = Block({"m": 130.1, "m0": 65.4, "H": 1.84, "B": 0.285, "J0": 10.7, "f_fc": 5.0, "zeta_fc": 0.02, "r": 0.99})
EVISON = Block({"m": 125.8, "m0": 44.02, "H": 1.05, "B": 0.285, "J0": 0.0, "f_fc": 11.0, "zeta_fc": 0.015, "r": 0.96})
STRUCTURES = {"McManus": MCMANUS, "Evison": EVISON, "stiff": Block(MCMANUS.parameters | {"f_fc": 30.0}),
              "soft": Block(MCMANUS.parameters | {"f_fc": 1.5}),
              "massless base": Block(EVISON.parameters | {"m0": 0.0})}
STATE = ["u", "u_dot", "theta", "theta_dot"]


def identified(project: Project, of: Block) -> np.ndarray:
    """Eigenvalues (1/s) of the map from sample to sample of the FMU's states while it rocks, level linear, undamped."""
    step = 0.7 / (of.omega_fc / np.sqrt(of.one_minus_chi))
    duration = round(1.2 / of.p_l / step) * step
    start = of.parameters | {"zeta_fc": 0.0, "theta_0": 0.9 * of.tangent, "u_0": 0.5 * of.u_cr, "detail": LINEAR}
    result = fmpy.simulate_fmu(str(project.fmu("mcmanus")), stop_time=duration, output_interval=step, output=STATE,
                               start_values=start, relative_tolerance=1e-12, step_size=step, logger=lambda *_: None)
    states = np.array([result[name] for name in STATE])
    scale = np.max(np.abs(states), axis=1, keepdims=True)
    affine = np.vstack([states[:, :-1] / scale, np.ones(states.shape[1] - 1)])
    matrix = np.linalg.lstsq(affine.T, (states[:, 1:] / scale).T)[0].T[:, :4]
    return eigvals(logm(matrix)) / step


def frequencies(project: Project) -> str:
    """The table of frequencies while rocking."""
    lines = []
    for name, of in STRUCTURES.items():
        f_fc, H = of.parameters["f_fc"], of.parameters["H"]
        # Eqs 7 and 8 without damping: mass matrix [1 H; H J_P/m], stiffness [omega^2 -g; -g -g H]
        mass = np.array([[1, H], [H, of.J_P / of.parameters["m"]]])
        stiffness = np.array([[of.omega_fc**2, -G], [-G, -G * H]])
        squares = np.sort(np.real(eigvals(-stiffness, mass)))
        exact = np.sqrt(-squares[0]) / (2 * np.pi), np.sqrt(squares[1])
        eigenvalues = identified(project, of)
        found = np.max(np.imag(eigenvalues)) / (2 * np.pi), np.max(np.real(eigenvalues))
        lines.append([name, f"{f_fc:g}", f"{f_fc * np.hypot(1, H / of.parameters['B']):.4f}",
                      f"{f_fc / np.sqrt(of.one_minus_chi):.4f}", f"{exact[0]:.6f}", f"{found[0]:.6f}",
                      f"{of.p_l:.5f}", f"{exact[1]:.6f}", f"{found[1]:.6f}"])
    return table(["structure", "f_fc (Hz)", "f_fc √(1+(H/B)²)", "f_fc/√(1−χ), Eq 18",
                  "vibration by Eqs 7, 8 (Hz)", "FMU", "p_l (rad/s)", "rocking by Eqs 7, 8 (rad/s)", "FMU"], lines)


def impacts() -> str:
    """The table of impacts: restitution that keeps the rigid body's angular momentum, and the energy that goes."""
    blocks = {f"homogeneous, α = {alpha:g}": homogeneous(np.tan(alpha), 1.0) for alpha in (0.1, 0.35)}
    lines = []
    for name, of in (blocks | STRUCTURES).items():
        kept = 1 - 2 * (of.parameters["m"] + of.parameters["m0"]) * of.parameters["B"] ** 2 / of.J_P
        housner = 1 - 1.5 * np.sin(np.arctan(of.tangent)) ** 2
        r = of.parameters["r"]
        chosen = ["", ""] if name in blocks else [f"{r:g}", f"{100 * (1 - r**2):.1f}"]
        lines.append([name, f"{housner:.6f}", f"{kept:.6f}", chosen[0], f"{100 * (1 - kept**2):.1f}", chosen[1]])
    return table(["structure", "1 − 3/2 sin²α", "1 − 2 (m + m0) B²/J_P", "r of the model", "energy lost by momentum (%)",
                  "by r (%)"], lines)


FREQUENCIES = [200, 100, 50, 20, 10, 5, 3, 2, 1]  # f_fc, Hz
OMEGAS = [2, 4, 8]  # of the half sine, over p
PARTS = np.arange(0.4, 1.6, 0.02)  # of the amplitude that overturns the rigid limit


def flexibility(runs: PulseRuns, advance: Callable[[], None]) -> str:
    """The table of the lowest half sine that overturns McManus's structure, over that of its rigid limit."""
    rigid = PulseRuns(runs.folder, runs.records, RIGID)
    limits = {omega: rigid.boundary(MCMANUS, HALF_SINE, omega, half_sine_boundary(omega)) for omega in OMEGAS}
    ratios = []
    for f_fc in FREQUENCIES:
        block = Block(MCMANUS.parameters | {"f_fc": float(f_fc)})
        ratios.append([runs.lowest(block, HALF_SINE, omega, PARTS * limit) / limit for omega, limit in limits.items()])
        advance()
    lines = [[f"{f_fc:g}", f"{2 * np.pi * f_fc / MCMANUS.p:.0f}", *(f"{ratio:.5f}" for ratio in row)]
             for f_fc, row in zip(FREQUENCIES, ratios)]
    return table(["f_fc (Hz)", "ω_fc/p", *(f"ω/p = {omega}" for omega in OMEGAS)], lines)


TOWER = {"m": 1000.0, "m0": 200.0, "H": 5.0, "B": 1.0, "J0": 0.0, "f_fc": 1.0, "zeta_fc": 0.05, "r": 0.95}
SLENDERNESS = [3, 5, 8]  # H/B
PERIODS = [0.1, 0.2, 0.4, 0.8, 1.5, 2.5]  # 1/f_fc, s
PGAS = [0.4, 0.8]  # g


def base_shear(project: Project) -> str:
    """The table of base shear with uplift over that without: medians over records and intensities."""
    parameters = ", ".join(f"{name} = {value!r}" for name, value in TOWER.items())
    found = []
    for detail in ("auto", "fixed_base"):
        rows = project.sweep(f'records = [{records()}]\nscale = {PGAS}\ndetail = "{detail}"\n'
                             f'[[structures]]\nname = "tower"\nparameters = {{ {parameters} }}\n'
                             f"vary.slenderness = {SLENDERNESS}\n"
                             f"vary.f_fc = {[1 / period for period in PERIODS]}\n")
        found.append(rows.set_index(["record", "scale", "slenderness", "f_fc[Hz]"])["peak_V_t[N]"].sort_index())
    ratio = (found[0] / found[1]).groupby(["slenderness", "f_fc[Hz]"]).median()
    lines = [[f"{slenderness:g}", *(f"{ratio.loc[slenderness, 1 / period]:.2f}" for period in PERIODS)]
             for slenderness in SLENDERNESS]
    return table(["H/B", *(f"T_fc = {period:g} s" for period in PERIODS)], lines)
