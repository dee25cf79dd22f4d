"""Section 2: frequency while rocking, impacts and overturning of flexible structures."""

from collections.abc import Callable

import flexible_rocking as fr
import numpy as np
from first_run import G
from scipy.linalg import eigvals, logm
from validation.report import table
from validation.specimens import EVISON, MCMANUS

from .block import boundary, homogeneous, lowest, p
from .ensemble import STRUCTURES as FOUR
from .ensemble import records
from .slender_block import HALF_SINE, half_sine_boundary

STRUCTURES = FOUR | {"massless base": EVISON.replace(m0=0)}
STATE = ["u", "u_dot", "theta", "theta_dot"]


def identified(of: fr.Structure) -> np.ndarray:
    """Eigenvalues (1/s) of the map from sample to sample of the states while it rocks, level linear, undamped."""
    step, tangent = 0.7 / (2 * np.pi * of.f_u), np.tan(of.alpha_cg)
    times = np.arange(round(1.2 / of.p_l / step) + 1) * step
    response = fr.simulate(of.replace(zeta_fc=0), duration=times[-1], detail="linear", tolerance=1e-12,
                           theta_0=0.9 * tangent, u_0=0.5 * of.u_cr).at(times)
    states = np.array([response[name] for name in STATE])
    scale = np.max(np.abs(states), axis=1, keepdims=True)
    affine = np.vstack([states[:, :-1] / scale, np.ones(states.shape[1] - 1)])
    matrix = np.linalg.lstsq(affine.T, (states[:, 1:] / scale).T)[0].T[:, :4]
    return eigvals(logm(matrix)) / step


def frequencies() -> str:
    """The table of frequencies while rocking."""
    lines = []
    for name, of in STRUCTURES.items():
        # Eqs 7 and 8 without damping: mass matrix [1 H; H J_P/m], stiffness [omega^2 -g; -g -g H]
        mass = np.array([[1, of.H], [of.H, of.J_P / of.m]])
        stiffness = np.array([[of.omega_fc**2, -G], [-G, -G * of.H]])
        squares = np.sort(np.real(eigvals(-stiffness, mass)))
        exact = np.sqrt(-squares[0]) / (2 * np.pi), np.sqrt(squares[1])
        eigenvalues = identified(of)
        found = np.max(np.imag(eigenvalues)) / (2 * np.pi), np.max(np.real(eigenvalues))
        lines.append([name, f"{of.f_fc:g}", f"{of.f_fc * np.hypot(1, of.H / of.B):.4f}",
                      f"{of.f_u:.4f}", f"{exact[0]:.6f}", f"{found[0]:.6f}",
                      f"{of.p_l:.5f}", f"{exact[1]:.6f}", f"{found[1]:.6f}"])
    return table(["structure", "f_fc (Hz)", "f_fc √(1+(H/B)²)", "f_fc/√(1−χ), Eq 18",
                  "vibration by Eqs 7, 8 (Hz)", "model", "p_l (rad/s)", "rocking by Eqs 7, 8 (rad/s)", "model"], lines)


def impacts() -> str:
    """The table of impacts: restitution that keeps the rigid body's angular momentum, and the energy that goes."""
    blocks = {f"homogeneous, α = {alpha:g}": homogeneous(np.tan(alpha), 1.0) for alpha in (0.1, 0.35)}
    lines = []
    for name, of in (blocks | {name: STRUCTURES[name] for name in ("McManus", "Evison", "massless base")}).items():
        kept = 1 - 2 * (of.m + of.m0) * of.B**2 / of.J_P
        housner = 1 - 1.5 * np.sin(of.alpha_cg) ** 2
        chosen = ["", ""] if name in blocks else [f"{of.r:g}", f"{100 * (1 - of.r**2):.1f}"]
        lines.append([name, f"{housner:.6f}", f"{kept:.6f}", chosen[0], f"{100 * (1 - kept**2):.1f}", chosen[1]])
    return table(["structure", "1 − 3/2 sin²α", "1 − 2 (m + m0) B²/J_P", "r of the model", "energy lost by momentum (%)",
                  "by r (%)"], lines)


FREQUENCIES = [200, 50, 20, 10, 5, 2, 1]  # f_fc, Hz
OMEGAS = [2, 4, 8]  # of the half sine, over p
PARTS = np.arange(0.4, 1.6, 0.02)  # of the amplitude that overturns the rigid limit


def flexibility(advance: Callable[[], None]) -> str:
    """The table of the lowest half sine that overturns McManus's structure, over that of its rigid limit."""
    limits = {omega: boundary(MCMANUS, HALF_SINE, omega, half_sine_boundary(omega)) for omega in OMEGAS}
    ratios = []
    for f_fc in FREQUENCIES:
        block = MCMANUS.replace(f_fc=f_fc)
        ratios.append([lowest(block, HALF_SINE, omega, PARTS * limit, "auto") / limit for omega, limit in limits.items()])
        advance()
    lines = [[f"{f_fc:g}", f"{2 * np.pi * f_fc / p(MCMANUS):.0f}", *(f"{ratio:.5f}" for ratio in row)]
             for f_fc, row in zip(FREQUENCIES, ratios)]
    return table(["f_fc (Hz)", "ω_fc/p", *(f"ω/p = {omega}" for omega in OMEGAS)], lines)


TOWER = fr.Structure(m=1000, m0=200, H=5, B=1, J0=0, f_fc=1, zeta_fc=0.05, r=0.95)
SLENDERNESS = [3, 5, 8]  # H/B
PERIODS = [0.1, 0.2, 0.4, 0.8, 1.5, 2.5]  # 1/f_fc, s
PGAS = [0.4, 0.8]  # g


def base_shear() -> str:
    """The table of base shear with uplift over that without: medians over records and intensities."""
    towers = [TOWER.replace(H=slenderness * TOWER.B, f_fc=1 / period) for slenderness in SLENDERNESS for period in PERIODS]
    with_uplift, without = (fr.sweep(towers, records(), scale=PGAS, detail=detail) for detail in ("auto", "fixed_base"))
    ratio = with_uplift["peak_V_t[N]"] / without["peak_V_t[N]"]
    median = ratio.groupby([with_uplift["H[m]"], with_uplift["f_fc[Hz]"]]).median()
    lines = [[f"{slenderness:g}", *(f"{median[slenderness * TOWER.B, 1 / period]:.2f}" for period in PERIODS)]
             for slenderness in SLENDERNESS]
    return table(["H/B", *(f"T_fc = {period:g} s" for period in PERIODS)], lines)
