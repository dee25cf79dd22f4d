"""Frames that rock, and ground motions that shake them: the scenes of the comparison with frames_reference.py."""

import math
from dataclasses import dataclass

import numpy as np
from host import G, ground_motion
from scipy.linalg import eigh


@dataclass(frozen=True)
class Ties:
    """A tendon and a pair of dissipators (SI)."""

    P_0: float = 0.0
    k_t: float = 0.0
    xi_d: float = 0.0
    c_d: float = 0.0
    k_d: float = 0.0
    F_y: float = 0.0

    def levers(self, p, s: int) -> tuple[float, float]:
        return s * p.B - self.xi_d, s * p.B + self.xi_d

    def moment(self, p, s: int, theta: float, theta_dot: float, forces) -> float:
        """About the pivot of side s of `p`, with these forces of the elastoplastic dissipators."""
        half = math.cos(theta / 2)
        return (-s * self.P_0 * p.B * half - self.k_t * p.B**2 * math.sin(theta) - half * np.dot(forces, self.levers(p, s))
                - self.c_d * (2 * p.B**2 + 2 * self.xi_d**2) * half**2 * theta_dot)

    def power(self, p, theta, theta_dot):
        """Of the viscous dissipators."""
        return self.c_d * (2 * p.B**2 + 2 * self.xi_d**2) * (np.cos(theta / 2) * theta_dot) ** 2


@dataclass(frozen=True)
class Frame:
    """Masses on a rigid base (SI). `stiffness` lists the storeys of a shear frame, or is K. `zeta` is the damping ratio of every
    mode, or one for each; instead, `rayleigh` is (a, b) of C = a M + b K. Without r, the impact follows from momentum."""

    masses: tuple
    heights: tuple
    stiffness: tuple
    m0: float
    J0: float
    B: float
    r: float | None = None
    zeta: float | tuple = 0.0
    rayleigh: tuple | None = None
    g: float = 9.81

    def __post_init__(self):
        m, h, K = (np.array(values, dtype=float) for values in (self.masses, self.heights, self.stiffness))
        if K.ndim == 1:
            K = np.diag(K + np.append(K[1:], 0)) - np.diag(K[1:], 1) - np.diag(K[1:], -1)
        squares, phi = eigh(K, np.diag(m))
        omega, M_phi = np.sqrt(squares), m[:, None] * phi
        C = M_phi * (2 * np.array(self.zeta) * omega) @ M_phi.T
        if self.rayleigh:
            C = self.rayleigh[0] * np.diag(m) + self.rayleigh[1] * K
        m_t, S_1, I_2 = m.sum() + self.m0, m @ h, m @ h**2
        J_P = self.J0 + m_t * self.B**2 + I_2
        omega_r = np.sqrt(eigh(K, np.diag(m) - np.outer(m * h, m * h) / J_P, eigvals_only=True))  # (M13)
        vars(self).update(m=m, h=h, K=K, C=C, phi=phi, omega=omega, omega_r=omega_r, m_t=m_t, S_1=S_1, I_2=I_2, J_P=J_P,
                          elastic=np.hstack([K, C]) / m[:, None], period=2 * math.pi / omega_r[0])


def of_one_mass(p) -> Frame:
    """The structure `p` of reference.py as a frame."""
    return Frame((p.m,), (p.H,), (p.k,), m0=p.m0, J0=p.J0, B=p.B, r=p.r, zeta=p.zeta_fc, g=p.g)


def toml(frame: Frame, ties: Ties = Ties(), ground: str = "") -> str:
    """The file of a shear frame, of what ties it down, and of the ground if it gives, for the command line."""
    base = {"m0": frame.m0, "J0": frame.J0, "B": frame.B, "r": frame.r, "g": frame.g, **vars(ties)}
    storeys = zip(frame.masses, frame.heights, frame.stiffness, strict=True)
    return (f"zeta = {frame.zeta}\n[base]\n" + "".join(f"{name} = {value}\n" for name, value in base.items())
            + "".join(f"[[storeys]]\nm = {m}\nh = {h}\nk = {k}\n" for m, h, k in storeys)
            + (f"[ground]\n{ground}\n" if ground else ""))


def cantilever(heights, EI: float) -> tuple:
    """K of a cantilever that bends."""
    h = np.array(heights)
    low, high = np.minimum.outer(h, h), np.maximum.outer(h, h)
    return tuple(map(tuple, np.linalg.inv(low**2 * (3 * high - low) / (6 * EI))))


FRAMES = {
    "frame": Frame((40e3, 40e3, 30e3), (3.5, 7.0, 10.5), (60e6, 50e6, 40e6), m0=20e3, J0=3e4, B=1.5, r=0.93, zeta=0.02),
    "tower": Frame((25e3,) * 8, tuple(3.2 * i for i in range(1, 9)), tuple(5e6 * (43 - 3 * i) for i in range(1, 9)),
                   m0=60e3, J0=2e5, B=3.0, rayleigh=(0.5, 1.5e-3)),  # 2.4 to 25 Hz
    "wall": Frame((12e3, 10e3, 8e3), (2.5, 5.0, 7.5), cantilever((2.5, 5.0, 7.5), 0.8e9), m0=10e3, J0=2e4, B=1.0, r=0.9,
                  zeta=(0.05, 0.03, 0.01)),  # 3.6, 21.6 and 55.6 Hz
}
MOTIONS = {  # event, component, first sample, scale of the free and of the tied frame
    "El Centro": ("imperialValley_elCentro_1940", "elc180", 150, (1.6, 1.6)),
    "Pacoima Dam": ("sanFernando_pacoidaDam_1971", "pul164", 200, (0.8, 1.0)),
}
#: Every other one has each motion, and each frame free or tied; the rest are in tests/heavy.
SCENES = [(frame, motion, tied) for motion in (*MOTIONS, "pulse") for tied in (False, True) for frame in FRAMES]


def ties_of(frame: Frame, prestress: float) -> Ties:
    """All ties, of sizes that fit the frame; `prestress` is that of the tendon as a part of the weight."""
    weight, B = frame.m_t * frame.g, frame.B
    return Ties(P_0=prestress * weight, k_t=20 * weight / B, xi_d=0.8 * B, c_d=0.02 * weight / B, k_d=50 * weight / B, F_y=0.1 * weight)


def scene(name: str, motion: str, tied: bool) -> tuple:
    """The frame, the time step, a_g, a_v and what ties the base down; a record's vertical component acts on tied frames alone."""
    frame, samples = FRAMES[name], 150 if name == "wall" else 250
    if motion == "pulse":
        time = 0.01 * np.arange(samples)
        a_g, a_v = (0.4 if tied else 0.3) * G * np.where(time < 0.8, np.sin(2 * np.pi * time / 0.8), 0.0), np.zeros(samples)
    else:
        event, component, first, scales = MOTIONS[motion]
        along, up = (ground_motion(event, which, first + samples, scale=scales[tied]) for which in (component, "up"))
        time, a_g, a_v = along[0], along[1][first:], up[1][first:]
    return (frame, time[1], a_g, a_v, ties_of(frame, 0.3)) if tied else (frame, time[1], a_g, np.zeros(samples), Ties())
