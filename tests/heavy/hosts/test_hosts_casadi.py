"""CasADi, which differentiates and integrates FMI 3.0 that has no strings: in full contact, against closed forms."""

import casadi
import numpy as np
import pytest


@pytest.fixture
def opened(export):
    """The model of an FMU; `options` of the export."""
    return lambda *options: casadi.DaeBuilder("pier", str(export("mcmanus", None, *options, fmi=3).folder))


def test_strings_are_not_read(opened):
    with pytest.raises(RuntimeError, match="Cannot handle: Start"):
        opened()


def test_derivatives_and_a_free_vibration(opened):
    model = opened("--no-strings")
    assert (model.x(), model.u()) == (["theta", "u", "theta_dot", "u_dot"], ["a_g", "F_t", "a_v"])
    [f_fc], [zeta], [m] = (model.start(name) for name in ("f_fc", "zeta_fc", "m"))
    omega, u, u_dot, a_g = 2 * np.pi * f_fc, 1e-4, 0.02, 0.3
    x, inputs = casadi.MX.sym("x", 4), casadi.MX.sym("inputs", 3)
    rates = model.create("rates", ["x", "u"], ["ode"])(x, inputs)
    derivatives = casadi.Function("derivatives", [x, inputs], [rates, casadi.jacobian(rates, x), casadi.jacobian(rates, inputs)])
    rates_now, by_state, by_input = map(np.array, derivatives([0, u, 0, u_dot], [a_g, 0, 0]))
    assert rates_now[:, 0] == pytest.approx([0, u_dot, 0, -a_g - 2 * zeta * omega * u_dot - omega**2 * u], rel=1e-12)
    assert by_state[3] == pytest.approx([0, -(omega**2), 0, -2 * zeta * omega], rel=1e-12)
    assert by_input[3] == pytest.approx([-1, 1 / m, 0], rel=1e-12)

    end, ode, tolerances = 0.2, {"x": x, "u": inputs, "ode": rates}, {"abstol": 1e-12, "reltol": 1e-10}
    reached = casadi.integrator("vibration", "cvodes", ode, 0, end, tolerances)(x0=[0, u, 0, 0], u=[0, 0, 0])["xf"]
    damped = omega * np.sqrt(1 - zeta**2)
    vibration = np.cos(damped * end) + zeta * omega / damped * np.sin(damped * end)
    assert float(reached[1]) == pytest.approx(u * np.exp(-zeta * omega * end) * vibration, abs=1e-6 * u)
