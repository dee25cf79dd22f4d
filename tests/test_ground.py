"""Ground that gives: the engine against an independent integration of the masses."""

import numpy as np
import pytest
from frames import FRAMES, Frame, Ties, ties_of
from ground_reference import Motion
from host import ground_motion, refusal
from test_frames import engine

pytest_plugins = ["test_frames"]  # for its fixture

MCMANUS = Frame((130.1,), (1.84,), (130.1 * (2 * np.pi * 5) ** 2,), m0=65.4, J0=10.7, B=0.285, r=0.99, zeta=0.02)
STOREYS = Frame((40e3,) * 5, tuple(3.2 * i for i in range(1, 6)), tuple(5e6 * (25 - 3 * i) for i in range(1, 6)),
                m0=60e3, J0=2e5, B=2.5, zeta=0.02)


def bed(frame: Frame, f_v: float, zeta_v: float, n: int) -> np.ndarray:
    """Rows of place, stiffness and damping of a uniform bed, or of two springs."""
    K = frame.m_t * (2 * np.pi * f_v) ** 2
    xi = np.linspace(-frame.B, frame.B, n)
    ratio = 1 if n == 2 else 1 / 3
    inner = K * frame.B**2 * (1 - ratio) / ((n - 2) * frame.B**2 - (xi[1:-1] ** 2).sum()) if n > 2 else 0.0
    k = np.full(n, inner)
    k[[0, -1]] = (K - (n - 2) * inner) / 2
    return np.column_stack([xi, k, 2 * zeta_v / np.sqrt(K / frame.m_t) * k])


def record(event: str, first: int, samples: int, scale: float):
    along, up = (ground_motion(event, which, first + samples, scale=scale) for which in ("elc180", "up"))
    return along[0][1], along[1][first:], up[1][first:]


SCENES = {  # frame, f_v, zeta_v, points, scale, whether tied and shaken upwards, mu_c, fs
    "one mass on two springs": (MCMANUS, 40.0, 0.2, 2, 0.7, False, None, None),
    "one mass on a bed of 11": (MCMANUS, 40.0, 0.1, 11, 0.35, False, None, None),
    "five storeys": (STOREYS, 8.0, 0.1, 3, 1.6, False, None, None),
    "three storeys, tied, with a_v": (FRAMES["frame"], 12.0, 0.1, 2, 1.6, True, None, None),
    "one mass that slides on two springs": (MCMANUS, 40.0, 0.0, 2, 0.9, False, 0.15, None),
    "one mass on a bed of 11 that yields": (MCMANUS, 40.0, 0.2, 11, 0.5, False, None, 2.0),
    "five storeys that slide on points that yield": (STOREYS, 8.0, 0.1, 3, 2.5, False, 0.15, 1.5),
    "three storeys, tied, with a_v, that slide, yield and fly": (FRAMES["frame"], 20.0, 0.1, 2, 6.0, True, 0.4, 3.0),
}
POINTS, GROUND, FRICTION = ("touch", "release"), ("ground yields", "ground holds"), ("slip left", "slip right", "stick", "flight")


@pytest.mark.parametrize("name", SCENES)
def test_the_engine_moves_as_the_masses_do(name, program):
    """Every event of the base, and theta, y, x, s, u and a of every floor at every sample, to 1e-9 of the peak and 100 times conditioning."""
    frame, f_v, zeta_v, n, scale, is_tied, mu_c, fs = SCENES[name]
    dt, a_g, a_v = record("imperialValley_elCentro_1940", 150, 150, scale)
    ties, a_v = (ties_of(frame, 0.1), a_v) if is_tied else (Ties(), 0 * a_v)
    points = bed(frame, f_v, zeta_v, n)
    exact = Motion(frame, ties, points, mu_c, fs or np.inf)
    expected = exact.follow(dt, a_g, a_v)
    slides, settles = ([-1 if of is None else of] for of in (mu_c, fs))
    given = ("auto", points, *slides, *settles)
    transitions, rows = engine(program, frame, dt, a_g, a_v, ties, *given)
    found, events = zip(*(of for of in transitions if of[1] in (*POINTS, *GROUND, *FRICTION))), zip(*exact.events)
    (times, kinds), (exact_times, exact_kinds) = found, events
    assert kinds == exact_kinds and all(kinds.count(of) > 1 for of in POINTS + GROUND * bool(fs) + FRICTION[:3] * bool(mu_c))
    assert ("flight" in kinds) == name.endswith("fly")
    np.testing.assert_allclose(times, exact_times, rtol=0, atol=1e-8)
    changed = engine(program, frame, dt, a_g * (1 + 1e-12), a_v, ties, *given)[1]
    m = len(frame.masses)
    expected = np.delete(expected, [*([] if mu_c else [2]), *([] if fs else range(3, 3 + n))], axis=1)
    ends = np.cumsum([1, 1, bool(mu_c), n * bool(fs), m, m])
    for of in map(slice, [0, *ends], ends):
        peak, off = (np.abs(of).max(initial=0.0) for of in (expected[:, of], changed[:, of] - rows[:, of]))
        np.testing.assert_allclose(rows[:, of], expected[:, of], rtol=0, atol=max(1e-9 * peak, 100 * off))


@pytest.mark.parametrize("command, ground, told", [
    (["pushover"], "f_v = 40\n", "k_d: on ground that gives the static moment of dissipators depends on the way there"),
    (["describe", "--restoring", "0.03"], "f_v = 40\n", "k_d: on ground that gives the static moment of dissipators depends on the way there"),
])
def test_what_needs_rigid_ground_says_so(command, ground, told, exporter, tmp_path):
    file = tmp_path / "pier.toml"
    file.write_text(f"m = 130.1\nm0 = 65.4\nH = 1.84\nB = 0.285\nJ0 = 10.7\nf_fc = 5\nzeta_fc = 0.02\nxi_d = 0.2\nk_d = 1e5\nF_y = 300\n[ground]\n{ground}")
    assert told in refusal(exporter, *command, f"--parameters={file}")
