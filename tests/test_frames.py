"""The physical equations of many masses, against the FMU of one mass and against the engine's modes."""

import os
import subprocess
from pathlib import Path

import frames_reference
import numpy as np
import pytest
from conftest import ROOT
from frames import SCENES, Frame, scene
from host import G, ground_motion
from reference import MCMANUS
from restrained_reference import Ties

WEIGHT = (MCMANUS.m + MCMANUS.m0) * G


@pytest.mark.parametrize("ties", [Ties(), Ties(0.3 * WEIGHT, 2e5, 0.2, 500.0, 1e6, 0.1 * WEIGHT)], ids=["free", "tied"])
def test_a_frame_of_one_mass_moves_as_one_mass(ties, mcmanus):
    """Every transition, and u, θ and a_t at every sample, to 1e-9 of the peak; with vertical motion if tied."""
    p, start = MCMANUS, {name: getattr(MCMANUS, name) for name in ("m", "m0", "H", "B", "J0", "f_fc", "zeta_fc", "r", "g")}
    time, a_g = ground_motion("imperialValley_elCentro_1940", "elc180", 800, time_scale=5, scale=1.75)
    a_v = ground_motion("imperialValley_elCentro_1940", "up", 800, time_scale=5, scale=1.75)[1] * (ties != Ties())
    frame = Frame((p.m,), (p.H,), (p.k,), m0=p.m0, J0=p.J0, B=p.B, r=p.r, zeta=p.zeta_fc, g=p.g)
    exact = frames_reference.simulate(frame, time[1], a_g, a_v, ties)
    with mcmanus.start(tolerance=1e-12, **start, **vars(ties)) as instance:
        rows, events = instance.follow(time, a_g, ("u", "theta", "a_t"), a_v=a_v), instance.events
    assert [event.kind for event in events] == [transition.kind for transition in exact.transitions]
    assert len(events) > 10
    for name, expected in (("u", exact.u[:, 0]), ("theta", exact.theta), ("a_t", exact.a[:, 0])):
        np.testing.assert_allclose(rows[name], expected, rtol=0, atol=1e-9 * np.abs(expected).max(), err_msg=name)


@pytest.fixture(scope="module")
def program():
    """The example that moves a frame by its modes."""
    command = ["cargo", "build", "--quiet", "--release", "--package", "rocking", "--example", "frame_scene"]
    subprocess.run(command, cwd=ROOT, check=True, env=os.environ)
    return ROOT / "target/release/examples/frame_scene"


def engine(program: Path, frame: Frame, dt: float, a_g, a_v, ties: Ties, detail: str):
    """Transitions, and rows of theta, u and a at the samples, by the modes of the frame (examples/frame_scene.rs)."""
    phi, M_phi = frame.phi, frame.m[:, None] * frame.phi
    zeta = np.diag(phi.T @ frame.C @ phi) / (2 * frame.omega)
    numbers = [detail == "auto", 1e-11, frame.m0, frame.J0, frame.m.sum(), frame.S_1, frame.I_2, frame.B, frame.r or -1, frame.g,
               ties.P_0, ties.k_t, ties.xi_d, ties.c_d, ties.k_d, ties.F_y, len(frame.omega), len(frame.m),
               *frame.omega, *zeta, *M_phi.sum(axis=0), *(frame.h @ M_phi), *np.column_stack([frame.m, frame.h, phi]).ravel(),
               dt, len(a_g), *np.column_stack([a_g, a_v]).ravel()]
    done = subprocess.run([program], check=True, capture_output=True, text=True, input=" ".join(repr(float(x)) for x in numbers))
    lines = [line.split() for line in done.stdout.splitlines()]
    return ([(float(time), kind) for name, time, kind, *_ in (line for line in lines if line[0] == "T")],
            np.array([line[1:] for line in lines if line[0] == "S"], dtype=float))


@pytest.mark.parametrize("name, motion, tied", SCENES)
def test_modes_move_as_the_masses_do(name, motion, tied, program):
    """Every transition, and theta, u and a of every floor at every sample, to 1e-9 of the peak, at both levels."""
    frame, *rest = scene(name, motion, tied)
    n = len(frame.masses)
    exact = frames_reference.simulate(frame, *rest)
    times, kinds = zip(*((transition.time, transition.kind.split()[0]) for transition in exact.transitions))
    for detail in ("auto", "nonlinear"):
        transitions, rows = engine(program, frame, *rest, detail)
        assert [kind for _, kind in transitions] == list(kinds)
        np.testing.assert_allclose([time for time, _ in transitions], times, rtol=0, atol=1e-9)
        for found, expected in zip(np.split(rows, [1, n + 1], axis=1), (exact.theta[1:, None], exact.u[1:], exact.a[1:])):
            np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * np.abs(expected).max())
