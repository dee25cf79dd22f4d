"""OpenSees beside the model: corotational beams that rock about a pinned pivot."""

import math

import flexible_rocking as fr
import numpy as np
import pytest
from evidence.ground.opensees import solve_with
from frames import FRAMES, cantilever
from host import need_opensees
from scipy.linalg import eigh

need_opensees()
import openseespy.opensees as ops

FRAME = FRAMES["frame"]
M, H, B, G = FRAME.m, FRAME.h, FRAME.B, 9.81
SPEED, EA, STEP, END = 0.22, 1e15, 1e-5, 0.3
GRAVITY = np.cumsum(M[::-1])[::-1] * G / np.diff(H, prepend=0)  # weight above each storey over its height
K_G = np.diag(GRAVITY + np.append(GRAVITY[1:], 0)) - np.diag(GRAVITY[1:], 1) - np.diag(GRAVITY[1:], -1)


def beams(EI, times):
    """theta and u of the uppermost mass at `times`, of axially stiff beams about the right edge, under gravity and a_g = sin 5t."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.geomTransf("Corotational", 1)
    ops.node(1, 0.0, 0.0)
    ops.fix(1, 1, 1, 0)
    ops.timeSeries("Constant", 1)
    ops.pattern("Plain", 1, 1)
    for node, (y, m, stiffness) in enumerate(zip([0.0, *H], [FRAME.m0, *M], [1e6 * EI, *[EI] * 3], strict=True), start=2):
        ops.node(node, -B, float(y))
        ops.mass(node, m, m, FRAME.J0 if node == 2 else 0.0)
        ops.element("elasticBeamColumn", node, node - 1, node, 1.0, EA, stiffness / EA, 1)
        ops.load(node, 0.0, -m * G, 0.0)
    ops.timeSeries("Trig", 2, 0.0, 10.0, 2 * math.pi / 5)
    ops.pattern("UniformExcitation", 2, 1, "-accel", 2)
    for node in ops.getNodeTags():
        x, y = ops.nodeCoord(node)
        for dof, velocity in enumerate((SPEED * y, -SPEED * x, -SPEED), start=1):
            ops.setNodeVel(node, dof, velocity, "-commit")
    solve_with(ops, "Transient", "Newmark", 0.5, 0.25)
    ops.test("NormDispIncr", 1e-12, 20)
    rows = []
    for count in np.diff(np.rint(times / STEP).astype(int), prepend=0).tolist():
        assert ops.analyze(count, STEP) == 0
        place = {node: np.add(ops.nodeCoord(node), ops.nodeDisp(node)[:2]) for node in (2, 5)}
        theta = math.atan2(place[2][1], -place[2][0])
        rows.append((theta, math.cos(theta) * place[5][0] - math.sin(theta) * place[5][1] + B))
    return np.array(rows).T


@pytest.mark.parametrize("f_1, with_K, without_K_G", [  # the largest differences of theta and u over their peaks
    (2.17, (1.9e-3, 3.3e-2), (8.9e-4, 1.3e-2)),
    (4.33, (2.9e-4, 1.9e-2), (1.7e-4, 9.2e-3)),
    (8.66, (6.6e-5, 1.1e-2), (4.8e-5, 6.2e-3)),
])
def test_corotational_beams_rock_as_the_model_does_but_for_its_p_delta(f_1, with_K, without_K_G):
    """The difference vanishes with the flexibility, and gravity's geometric stiffness takes half of it away."""
    K = np.array(cantilever(H, 1.0))
    EI = (2 * math.pi * f_1) ** 2 / eigh(K, np.diag(M), eigvals_only=True)[0]
    times = np.linspace(0.001, END, 300)
    theta, u = beams(EI, times)
    waves = np.linspace(0, END, 3_001)
    record = fr.Record(waves, np.sin(5 * waves), unit="m/s2")
    for stiffness, limits in ((EI * K, with_K), (EI * K - K_G, without_K_G)):
        frame = fr.Structure.from_matrices(M, H, stiffness, zeta=0.0, m0=FRAME.m0, J0=FRAME.J0, B=B, r=FRAME.r)
        found = fr.simulate(frame, record, theta_0=1e-12, theta_dot_0=SPEED, duration=END).at(times)
        for ours, theirs, limit in ((found["theta"], theta, limits[0]), (found["u[3]"], u, limits[1])):
            difference = np.abs(theirs - ours).max() / np.abs(ours).max()
            assert 0.5 * limit < difference < 1.1 * limit


def test_the_page_of_opensees_prints_what_it_shows(check_page):
    check_page("docs/examples/opensees.md")
