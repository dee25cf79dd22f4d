"""McManus's pier on springs in OpenSees: the same equations, by average acceleration."""

import math

import flexible_rocking as fr
import numpy as np

STIFF, ROD = 1e13, 1e12  # of arms (N, N·m²) and of the rod that guides the mass (N/m)
TOLERANCE = 1e-8  # of an iteration: the end of the rod moves 1000 times as far as θ
ARM = 1000.0  # length of that rod, m, which bends the path of the mass by u²/2000
GAP = 1e5  # stiffness of a gap before a dashpot over the stiffness of its spring


def solve_with(ops, kind: str, *integrator) -> None:
    """Newton's method at every step of an analysis of this kind."""
    ops.constraints("Plain")
    ops.numberer("RCM")
    ops.system("UmfPack")
    ops.test("NormDispIncr", TOLERANCE, 50)
    ops.algorithm("Newton")
    ops.integrator(*integrator)
    ops.analysis(kind)


def pier(s: fr.Structure, ground: fr.Ground, axial: float | None) -> None:
    """The pier at rest on the points of `ground` (xi, k, c), whose base node 1 is held horizontally. A point with a dashpot has a gap above spring and
    dashpot; a point that yields has none. The mass, node 5, is guided along an axis that turns with the base. With `axial` it stands on an elastic column instead, so many
    times as stiff along its axis as across it, with damping of its initial stiffness."""
    import openseespy.opensees as ops

    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.geomTransf("Corotational", 1)
    places = {1: (0, 0), 5: (0, s.H)} | ({} if axial else {4: (0, s.H), 6: (-1, s.H), 7: (0, s.H - ARM)})
    for node, (x, y) in places.items():
        ops.node(node, float(x), float(y))
    ops.fix(1, 1, 0, 0)
    ops.mass(1, s.m0, s.m0, s.J0)
    ops.mass(5, s.m, s.m, 0.0)

    def arm(element: int, start: int, end: int) -> None:
        ops.element("elasticBeamColumn", element, start, end, 1.0, STIFF, 1.0, 1)

    for i, (xi, k, c) in enumerate(zip(ground["xi"], ground["k"], ground["c"], strict=True)):
        foot, end, soil = (20 + 3 * i + j for j in range(3))  # which also number materials and elements
        for node in (foot, soil):
            ops.node(node, xi, 0.0)
        if xi:
            arm(foot, 1, foot)
        else:
            ops.equalDOF(1, foot, 1, 2, 3)
        ops.fix(soil, 1, 1, 1)
        if fs := ground.get("fs"):
            q = fs * (s.m + s.m0) * s.g * k / sum(ground["k"])
            ops.uniaxialMaterial("ElasticPPGap", foot, k, -q, 0.0, 0.0, "damage")
        else:
            ops.uniaxialMaterial("ENT", foot, GAP * k if c else k)
        if c:
            ops.node(end, xi, 0.0)
            ops.fix(end, 1, 0, 1)
            ops.uniaxialMaterial("Elastic", end, k)
            ops.uniaxialMaterial("Viscous", soil, c, 1.0)
            ops.element("zeroLength", end, soil, end, "-mat", end, soil, "-dir", 2, 2)
        ops.element("zeroLength", soil, end if c else soil, foot, "-mat", foot, "-dir", 2)
    if not axial:
        arm(4, 1, 4)
        arm(6, 4, 6)
        ops.uniaxialMaterial("Elastic", 2, s.k)  # the rod to the left is 1 m long
        ops.uniaxialMaterial("Elastic", 3, ROD * ARM)
        arm(7, 1, 7)
        ops.fix(5, 0, 0, 1)
        ops.element("corotTruss", 10, 6, 5, 1.0, 2, "-doRayleigh", 1)
        ops.element("corotTruss", 11, 7, 5, 1.0, 3)
    else:
        EA, EI = axial * s.k * s.H, s.k * s.H**3 / 3
        ops.element("elasticBeamColumn", 10, 1, 5, 1.0, EA, EI / EA, 1)
    of_current, of_initial = (0, 1) if axial else (1, 0)
    factor = 2 * s.zeta_fc / s.omega_fc
    ops.region(1, "-ele", 10, "-rayleigh", 0.0, factor * of_current, factor * of_initial, 0.0)
    ops.timeSeries("Constant", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(1, 0.0, -s.m0 * s.g, 0.0)
    ops.load(5, 0.0, -s.m * s.g, 0.0)
    solve_with(ops, "Static", "LoadControl", 1.0)
    assert ops.analyze(1) == 0
    ops.wipeAnalysis()


def shaken(s: fr.Structure, ground: fr.Ground, record: fr.Record, duration: float, step: float, axial: float | None = None) -> np.ndarray:
    """Largest |θ| (rad) and |a_t| (m/s²) over `duration` (s) under `record` with steps of `step` (s); not numbers if the iteration does not converge."""
    import openseespy.opensees as ops

    pier(s, ground, axial)
    ops.timeSeries("Path", 2, "-time", *record.time.tolist(), "-values", *record.a_g.tolist())
    ops.pattern("UniformExcitation", 2, 1, "-accel", 2)
    ops.setTime(0.0)
    solve_with(ops, "Transient", "Newmark", 0.5, 0.25)
    theta, a_t = 0.0, 0.0
    for i in range(1, round(duration / step) + 1):
        if ops.analyze(1, step) != 0:
            return np.array([math.nan, math.nan])
        turn, a_g = -ops.nodeDisp(1, 3), np.interp(i * step, record.time, record.a_g)
        along = (ops.nodeAccel(5, 1) + a_g) * math.cos(turn) - ops.nodeAccel(5, 2) * math.sin(turn)
        theta, a_t = max(theta, abs(turn)), max(a_t, abs(along))
    return np.array([theta, a_t])
