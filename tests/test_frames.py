"""The physical equations of many masses, against the engine's modes."""

from pathlib import Path

import frames_reference
import numpy as np
import pytest
from conftest import ROOT
from frames import SCENES, Frame, Ties, scene
from host import output


@pytest.fixture(scope="module")
def program(exporter):
    """The example that moves a frame by its modes, chosen with the packages of `make test`: no other features, no second build."""
    packages = ["--workspace", "--exclude", "flexible-rocking-python", "--exclude", "rocking-web"]
    output("cargo", "build", "--quiet", "--release", *packages, "--example", "frame_scene", cwd=ROOT)
    return exporter.parent / "examples/frame_scene"


def engine(program: Path, frame: Frame, dt: float, a_g, a_v, ties: Ties, detail: str, points=(), mu_c=-1, fs=-1):
    """Transitions, and rows of theta, y, x, s, u and a at the samples, of those that there are, by the modes of the frame (examples/frame_scene.rs)."""
    phi, M_phi = frame.phi, frame.m[:, None] * frame.phi
    zeta = np.diag(phi.T @ frame.C @ phi) / (2 * frame.omega)
    numbers = [detail == "auto", 1e-11, frame.m0, frame.J0, frame.m.sum(), frame.S_1, frame.I_2, frame.B, frame.r or -1, frame.g,
               len(vars(ties)), *vars(ties).values(), len(frame.omega), len(frame.m),
               *frame.omega, *zeta, *M_phi.sum(axis=0), *(frame.h @ M_phi), *np.column_stack([frame.m, frame.h, phi]).ravel(), len(points), *np.ravel(points, order="F"), mu_c, fs,
               dt, len(a_g), *np.column_stack([a_g, a_v]).ravel()]
    lines = [line.split() for line in output(program, input=" ".join(repr(float(x)) for x in numbers)).splitlines()]
    return ([(float(time), " ".join(kind)) for name, time, *kind in (line for line in lines if line[0] == "T")],
            np.array([line[1:] for line in lines if line[0] == "S"], dtype=float))


@pytest.mark.parametrize("name, motion, tied", SCENES[::2])
def test_modes_move_as_the_masses_do(name, motion, tied, program):
    """Every transition, and theta, u and a of every floor at every sample, to 1e-9 of the peak, at both levels."""
    frame, *rest = scene(name, motion, tied)
    n = len(frame.masses)
    exact = frames_reference.simulate(frame, *rest)
    times, kinds = zip(*((transition.time, transition.kind.split()[0]) for transition in exact.transitions))
    for detail in ("auto", "nonlinear"):
        transitions, rows = engine(program, frame, *rest, detail)
        assert [kind.split()[0] for _, kind in transitions] == list(kinds)
        np.testing.assert_allclose([time for time, _ in transitions], times, rtol=0, atol=1e-9)
        for found, expected in zip(np.split(rows, [1, n + 1], axis=1), (exact.theta[1:, None], exact.u[1:], exact.a[1:])):
            np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * np.abs(expected).max())
