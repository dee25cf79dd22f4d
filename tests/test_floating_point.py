"""Hosts with a floating point control of their own: one that rounds up and traps what has no result, and one that looks for that."""

import ctypes
import platform
import sys

import numpy as np
import pytest

if sys.platform != "linux" or platform.machine() != "x86_64" or platform.libc_ver()[0] != "glibc":
    pytest.skip("these numbers are those of glibc on x86-64", allow_module_level=True)

LIBM = ctypes.CDLL("libm.so.6")
WRONG = 1 | 4 | 8  # invalid operation, division by zero, overflow
UPWARD = 0x800


class Strict:
    """A function of the FMU for a host that rounds up and traps operations without a result, as it still does after the call."""

    def __init__(self, function):
        self.function, self.restype = function, function.restype

    def __call__(self, *arguments):
        LIBM.feenableexcept(WRONG)
        LIBM.fesetround(UPWARD)
        result = self.function(*arguments)
        rounding, trapped = LIBM.fegetround(), LIBM.fedisableexcept(WRONG)
        LIBM.fesetround(0)
        assert (rounding, trapped & WRONG) == (UPWARD, WRONG)
        return result


class Watchful(Strict):
    """The same for a host that looks for operations without a result."""

    def __call__(self, *arguments):
        LIBM.feclearexcept(WRONG)
        result = self.function(*arguments)
        assert LIBM.fetestexcept(WRONG) == 0, self.function.__name__
        return result


def run(one, force, detail, starts) -> bytes:
    """All real numbers along a run; where the host integrates, it does by Euler's method."""
    reals = [name for name, variable in one.fmu.variables.items() if variable.type in ("Real", "Float64")]
    switches = dict.fromkeys(("a_g_late", "F_t_extrapolated", "peaks", "validity"), True)
    one.enter(theta_0=0.0 if detail == 6 else 0.02, detail=detail, **switches, **starts)
    rows = [one.reals(reals)]
    one.exit()
    for step in range(40):
        time, length = step / 64, 1 / 64  # exact, as is the end of the step
        one.set(**{"a_g": np.sin(9 * time), force: np.sin(9 * time)})
        if one.is_model:
            one.go_to(time + length, np.array(one.states()) + length * np.array(one.derivatives()))
        else:
            one.slave.doStep(time, length)
        rows.append(one.reals(reals))
        for by in ("a_g", "theta"):
            one.derivative("R_m", by)
    return np.array(rows).tobytes()


@pytest.mark.parametrize("detail", range(1, 7))
def test_no_operation_is_invalid_and_the_hosts_control_is_its_own(interface, detail):
    """No valid scene needs an operation that has no result, and how the host rounds changes no bit."""
    new, force, starts = interface
    if detail == 4 and force != "F_t":
        pytest.skip("`modal` is of one mass")
    found = []
    for host in (Watchful, Strict):
        one = new()
        functions = one.slave._functions
        functions.update({name: host(function) for name, function in functions.items()})
        found.append(run(one, force, detail, starts))
    assert found[0] == found[1]
