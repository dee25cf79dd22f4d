"""Directional derivatives, and the dependencies that the model description lists."""

import numpy as np
import pytest
from host import DISCARD, ERROR, refused, status
from reference import EVISON

OUTPUTS = ["a_t", "V_t", "M_t", "R_h", "R_v", "R_m"]


def test_they_are_linear_in_the_direction(wall):
    """For directions of any size, and along two at once, where every term counts."""
    one = wall.start(theta_0=0.3, theta_dot_0=-0.4, u_0=2e-3, u_dot_0=0.3, J0=2.0)
    one.set_reals(a_g=3.0, F_t=-50.0)
    by_ground, by_force = (np.array(one.derive(OUTPUTS, (name, 1.0))) for name in ("a_g", "F_t"))
    both = one.derive(OUTPUTS, ("a_g", -2.0), ("F_t", 10.0), ("F_t", 20.0))
    assert both == pytest.approx(-2 * by_ground + 30 * by_force, rel=1e-12, abs=1e-12) and by_force.all()
    for size in (1e-200, 1e100):
        assert np.array(one.derive(OUTPUTS, ("F_t", size))) / size == pytest.approx(by_force, rel=1e-13)
    assert one.derive(OUTPUTS, ("a_g", 0.0)) == one.derive(OUTPUTS) == [0.0] * 6
    assert one.derive(["theta", "u_dot", "v_t", "I_v"], ("a_g", 1.0), ("F_t", 1e3)) == [0.0] * 4, "of states and of events"
    stiff = wall.start(theta_0=0.3, u_0=5e-3, f_fc=1e3)
    assert stiff.derivative("a_t", "F_t") == pytest.approx(np.cos(0.3) / EVISON.m, rel=1e-12), "beside a large elastic force"
    for detail in (1, 3, 5):
        upwards = wall.start(theta_0=0.3, detail=detail).derive(["R_v", "der(theta_dot)"], ("a_v", 1.0))
        assert np.all(upwards), "of an input that has not been set"


def test_they_exist_from_initialization_to_overturning(wall):
    """During initialization and at the instant of overturning the outputs follow the inputs as they do in between."""
    one, knowns = wall.instance().enter(theta_0=0.3, u_0=2e-3), [("a_g", 1.0), ("F_t", 20.0)]
    before = one.derive(OUTPUTS, *knowns)
    assert before == one.exit().derive(OUTPUTS, *knowns)
    for detail in range(1, 6):
        one = wall.start(theta_0=1.2, detail=detail)
        assert status(one.step, 10.0) == DISCARD
        # along the strut, which lies down, nothing pushes u; the rigid structure is turned about its pivot
        expected = EVISON.H * EVISON.B / EVISON.J_P if detail == 5 else 0.0
        assert one.derivative("a_t", "F_t") == pytest.approx(expected, rel=1e-9, abs=1e-12)


def test_at_the_edge_of_a_range_they_are_one_sided(wall):
    """No parameter leaves its range: p_l² = m g H/J_P where m0 and J0 are 0."""
    one, J_P = wall.instance().enter(m0=0.0, J0=0.0), EVISON.m * (EVISON.H**2 + EVISON.B**2)
    for by, change in (("m0", EVISON.B**2), ("J0", 1.0)):
        assert one.derivative("p_l", by) == pytest.approx(-one.get("p_l") * change / (2 * J_P), rel=1e-9)
    assert one.get("m0", "J0") == [0.0, 0.0]


def test_where_the_equations_are_singular_neither_they_nor_the_reactions_exist(wall):
    """The top mass above the pivot of a foundation without inertia: nothing says how it turns."""
    one = wall.start(m0=0.0, J0=0.0, B=0.25, u_0=0.25, theta_0=0.01)
    with refused(one, "fmi2GetDirectionalDerivative: the derivative of R_h does not exist at t = 0 s"):
        one.derivative("R_h", "F_t")
    with refused(one, "fmi2GetReal: R_m does not exist at t = 0 s: the top mass is above the pivot of a foundation without inertia "
                      "(m0, J0 too small)"):
        one.reals(["theta", "R_m"])
    assert one.get("theta", "I_v") == [0.01, 0.0]
    assert status(one.slave.doStep, 0.0, 0.1) == ERROR and one.get("theta") == 0.01


def test_a_value_with_a_kink_has_no_derivative(wall):
    """At theta_0 = 0 the side about which the structure rocks changes."""
    one = wall.instance().enter(u_0=2e-4)
    for name in ("R_h", "R_m", "uplift"):
        with refused(one, f"fmi2GetDirectionalDerivative: the derivative of {name} does not exist at t = 0 s"):
            one.derive([name], ("theta_0", 1.0))
    assert one.derivative("delta_t", "theta_0") == pytest.approx(EVISON.H, rel=1e-9)


@pytest.mark.parametrize("theta_0", [0.0, 0.02])
def test_what_is_listed_has_a_derivative(interface, theta_0):
    """A variable that the model description lists as depending on a real number has a derivative by it."""
    new, force, starts = interface
    one, is_one_mass = new(), force == "F_t"
    description = one.fmu.description
    ties = dict(P_0=200.0, k_t=1e5, xi_d=0.2, c_d=50.0, k_d=1e6, F_y=1e3) if is_one_mass else {}
    one.enter(theta_0=theta_0, **starts, **ties)

    def derive(unknowns, is_known):
        listed = [(unknown.variable.name, known.name) for unknown in unknowns for known in unknown.dependencies
                  if {unknown.variable.type, known.type} <= {"Real", "Float64"} and is_known(known)]
        assert len([one.derivative(*of) for of in listed]) > 20

    if theta_0:  # one mode moves both floors of the building together
        derive(description.initialUnknowns, lambda known: is_one_mass or not known.name.startswith("u_"))
        assert one.derivative("theta", "theta_0") == pytest.approx(1.0, rel=1e-9)
    if is_one_mass:
        by_m = -np.cos(EVISON.alpha_cg) ** 2 * EVISON.B / EVISON.H * EVISON.m0 / EVISON.m**2
        assert one.derivative("alpha_cg", "m") == pytest.approx(by_m, rel=1e-9)
    one.exit()
    derive([*description.outputs, *description.derivatives], lambda known: known.causality != "parameter")
    assert [one.derivative("alpha_cg", by) for by in ("a_g", force)] == [0.0, 0.0]
    reactions = ["R_h", "R_v", "R_m"]  # which are affine in the inputs
    one.set(a_g=1.0)
    found, before = one.derive(reactions, (force, 1.0)), np.array(one.reals(reactions))
    one.set(**{force: 1e4})
    epsilon = 1e-12 * (1 + np.abs(before).max() / 1e4)
    assert found == pytest.approx((np.array(one.reals(reactions)) - before) / 1e4, rel=1e-12, abs=epsilon)


U_CR = 7.52467e-4
RESTRAINED = dict(theta_0=0.3, theta_dot_0=-0.4, P_0=300.0, k_t=2e4, xi_d=0.1, c_d=50.0, k_d=1e6)
BASES = [
    dict(theta_0=0.3, u_0=2e-3, record_scale=2.0, record_start=-0.25),
    dict(detail=5, theta_0=0.3, record_scale=2.0, record_start=-0.25),
    dict(detail=5, theta_0=0.3, theta_dot_0=-0.4, J0=2.0),
    dict(detail=5, record_scale=2.0, record_start=-0.25),
    dict(u_0=3e-4, u_dot_0=0.2),
    dict(theta_0=0.3, theta_dot_0=-0.4, u_0=2e-3, u_dot_0=0.3, c_ratio=0.7, J0=2.0),
    dict(u_0=U_CR * (1 - 1e-4), u_dot_0=0.01),
    dict(u_0=U_CR * (1 + 1e-4), u_dot_0=-0.01),
    dict(u_0=3e-4, u_dot_0=0.2, P_0=300.0),
    dict(F_y=2e5, u_0=2e-3, **RESTRAINED),
    dict(F_y=200.0, u_0=2e-3, **RESTRAINED),  # which yields
    dict(F_y=2e5, detail=5, **RESTRAINED),
    dict(F_y=200.0, detail=5, **RESTRAINED),
]


def test_the_stated_dependencies_are_the_true_ones(wall3):
    """A change of one parameter or initial value changes the initial value of exactly those variables that state it."""
    # in g; the ground follows them where the base says when, and either may be the longer one
    wall3.write("pulse.AT2", "-\n-\nACCELERATION IN UNITS OF G\n3, .5 NPTS, DT\n.1 .2 .4\n")
    wall3.write("up.AT2", "-\n-\nACCELERATION IN UNITS OF G\n4, .4 NPTS, DT\n.1 -.3 .2 .1\n")
    one, description = wall3.instance(), wall3.description
    parameters = {name: variable for name, variable in wall3.variables.items() if variable.causality == "parameter"}
    stated, of_indicators = ({(unknown.variable.name, known.name) for unknown in unknowns for known in unknown.dependencies}
                             for unknowns in (description.initialUnknowns, description.eventIndicators))
    indicators = {name for name, _ in of_indicators}
    stated = {(name, known) for name, known in stated if known in parameters and name not in indicators}
    computed = sorted({name for name, _ in stated} | indicators)

    def shown(values) -> np.ndarray:
        one.slave.reset()
        return np.array(one.enter(**values).reals(computed))

    found = set()
    for base in BASES:
        is_rigid = base.get("detail") == 5
        records = ["pulse.AT2", "up.AT2"] if "record_start" in base else ["", ""]
        base = base | dict(zip(("record", "record_v"), reversed(records) if is_rigid else records))
        before = shown(base)
        for name, variable in parameters.items():
            start = base.get(name, float(variable.start) if variable.type == "Float64" else None)
            # In full contact the base does not turn, and what is rigid is not deformed; of two numbers each needs the other.
            if (variable.type == "Boolean" or name == "detail" and not is_rigid or name == "theta_dot_0" and not base.get("theta_0")
                    or is_rigid and name.startswith("u_") or name in ("k_d", "F_y") and not start):
                continue
            changed = "" if variable.type == "String" else 1 if name == "detail" else start * (1 - 1e-3) if start else 1e-3
            differs = np.abs(shown(base | {name: changed}) - before) > 1e-9 * np.abs(before)
            found |= {(of, name) for of in np.array(computed)[differs].tolist()}
    starts = {"theta_0", "theta_dot_0", "u_0", "u_dot_0"}  # of the states, on which indicators depend while the simulation runs
    assert {of for of in found if of[0] in indicators and of[1] not in starts} <= of_indicators
    assert {of for of in found if of[0] not in indicators} == stated
