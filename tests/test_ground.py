"""Ground that gives: the engine against an independent integration of the masses."""

import json
from dataclasses import replace

import numpy as np
import pytest
from frames import FRAMES, Frame, Ties, ties_of, toml
from ground_reference import Motion
from host import ground_motion, output, refusal, write
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


@pytest.mark.parametrize("command", [["pushover"], ["describe", "--restoring", "0.03"]])
def test_what_needs_rigid_ground_says_so(command, exporter, tmp_path):
    file = tmp_path / "pier.toml"
    file.write_text("m = 130.1\nm0 = 65.4\nH = 1.84\nB = 0.285\nJ0 = 10.7\nf_fc = 5\nzeta_fc = 0.02\nxi_d = 0.2\nk_d = 1e5\nF_y = 300\n[ground]\nf_v = 40\n")
    told = "k_d: on ground that gives the static moment of dissipators depends on the way there"
    assert told in refusal(exporter, *command, f"--parameters={file}")


FOOTING = Frame((4e5,), (9.0,), (4e5 * (2 * np.pi * 2.5) ** 2,), m0=1e5, J0=1e5, B=1.5, r=0.9, zeta=0.03)


@pytest.fixture(scope="module")
def simulate(exporter, tmp_path_factory):
    """The results of the command line for a frame on this ground under El Centro and `options`."""
    folder = tmp_path_factory.mktemp("ground")
    record = write(folder / "record.csv", "m/s2", *ground_motion("imperialValley_elCentro_1940", "elc180"))

    def run(frame: Frame, ground: dict, *options, run=output):
        file = folder / "frame.toml"
        file.write_text(toml(frame, Ties(), "\n".join(f"{name} = {value}" for name, value in ground.items())))
        return run(exporter, "--quiet", "simulate", f"--parameters={file}", f"--record={record}", "--duration=8", "--format=json", *options)

    return run


@pytest.mark.parametrize("frame, ground, scale, expected", [  # transitions, and peaks of theta and x
    (MCMANUS, dict(f_v=40, zeta_v=0, mu_c=0.6), 0.7, (45, 0.0415155875, 2.453096787e-6)),
    (MCMANUS, dict(f_v=40, zeta_v=0, mu_c=0.3), 0.7, (71, 0.0414190156, 0.1389907852e-3)),
    (MCMANUS, dict(f_v=40, zeta_v=0.2, mu_c=0.2), 0.7, (55, 0.0459441247, 2.018318693e-3)),
    (MCMANUS, dict(f_v=40, zeta_v=0, fs=3), 0.7, (63, 0.0415303434, 0.0)),
    (MCMANUS, dict(f_v=40, zeta_v=0.2, fs=3, n_points=11), 0.35, (410, 0.0124307670, 0.0)),
    (FOOTING, dict(f_v=10, zeta_v=0.25, fs=3, n_points=11), 0.6, (101, 0.0091893736, 0.0)),
    (FRAMES["frame"], dict(f_v=12, zeta_v=0.1, mu_c=0.3), 2, (60, 0.0945604184, 11.56895254e-3)),
    (FRAMES["frame"], dict(f_v=12, zeta_v=0.1, mu_c=0.3, fs=3), 2, (37, 0.0951521734, 4.131635439e-3)),
])
def test_three_other_integrators_have_these_numbers(frame, ground, scale, expected, simulate):
    found = json.loads(simulate(frame, ground, f"--scale={scale}"))
    peaks = {of["name"]: of["peak"] for of in found["peaks"]}
    assert (found["transitions"], peaks["theta"], peaks.get("x", 0.0)) == pytest.approx(expected, rel=3e-8)


HARD = dict(f_v=40, zeta_v=0.0, mu_c=0.2, fs=1 + 1e-9, n_points=11)
WEIGHT = float(MCMANUS.m_t) * 9.81


@pytest.mark.parametrize("ground, options", [
    (dict(mu_c=0), ()), (dict(mu_c=1e-6), ()), (dict(mu_c=2, fs=100), ()), (dict(zeta_v=5, fs=1.5), ()), (dict(fs=3), ("--theta-0=1.5",)),
    (dict(), ("--theta-0=-0.25",)), (dict(fs=1.01), ("--theta-0=0.2",)), (dict(fs=3), ("--scale=100",)), (dict(), ("--scale=100",)),
    (dict(n_points=21), ()), (dict(n_points=21), ("--detail=rigid",)), (dict(), ("--detail=fixed_base",)), (dict(f_v=1000, fs=3), ()),
])
def test_hard_numbers_have_an_end(ground, options, simulate):
    found = json.loads(simulate(MCMANUS, HARD | ground, *options))
    assert all(np.isfinite(of["peak"]) for of in found["peaks"]) and (found["ending"] == "overturned" or found["end"] == 8)


@pytest.mark.parametrize("ground, options, told", [
    (dict(mu_c=100), (), "mu_c = 100 is out of range: it must lie between 0 and 2"),
    (dict(fs=1), (), "fs: it sinks at rest: the point can carry"),
    (dict(zeta_v=0.01), (), "zeta_v = 0.01 is too small for points that yield: give 0, or 0.02 or more"),
    (dict(q_u=[WEIGHT] * 11), (), "fs and q_u are both given: leave one of them out"),
    (dict(fs="", q_u=[WEIGHT]), (), "q_u has 1 numbers, and there are 11 points"),
    (dict(fs="", n_points=2, q_u=[WEIGHT, 1.1 * WEIGHT]), (), "q_u[1] and q_u[2] differ"),
    (dict(f_v=0), (), "f_v = 0 Hz is rigid ground: give f_v or k_v"),
    (dict(), ("--detail=linear",), "detail = linear has no ground that gives"),
    (dict(m0=0), (), "mu_c is given, and all mass is in the modes"),
])
def test_what_no_ground_can_be_is_refused_by_name(ground, options, told, simulate):
    given = {name: value for name, value in (HARD | ground).items() if value != ""}
    frame = replace(MCMANUS, m0=given.pop("m0", MCMANUS.m0))
    assert told in simulate(frame, given, *options, run=refusal)
