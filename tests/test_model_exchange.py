"""The FMU under solvers of hosts: never below the floor, and the nearer to co-simulation the tighter they are.

docs/model_exchange.md has three records and all tolerances; these are a few quick ones."""

import ctypes
import subprocess

import fmpy
import numpy as np
import pytest
from first_run import PACOIMA_DAM
from fmpy import read_model_description, simulate_fmu
from fmpy.simulation import instantiate_fmu
from model_exchange.hosts import Scene, co_simulation, dop853, fmpy_cvode, fmpy_euler, sundae

BAND = 1e-9 * 0.23  # rad, of alpha_cg


@pytest.fixture(scope="module")
def scene(mcmanus):
    return Scene("Pacoima Dam", mcmanus.path, tuple(PACOIMA_DAM.items()), 1.99, 0.01)


@pytest.mark.parametrize("host", [fmpy_cvode, sundae])
def test_a_solver_follows_co_simulation_as_close_as_its_tolerance(scene, host):
    exact = co_simulation(scene)
    loose, tight = host(scene, 1e-4), host(scene, 1e-8)
    assert loose.depth <= BAND and tight.depth <= BAND
    assert exact.transitions > 15
    assert tight.transitions == exact.transitions
    assert tight.error(exact) < 1e-4 < loose.error(exact) < 0.3
    assert np.array_equal(tight.rows["phase"], exact.rows["phase"])


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8, 1e-10])
def test_a_solver_of_one_step_stays_within_its_tolerance_times_the_scenes_amplification(scene, tolerance):
    """The FMU and going over the host's steps add nothing to that."""
    exact, change = co_simulation(scene), 1e-12
    amplification = co_simulation(scene, change).error(exact) / change
    result = dop853(scene, tolerance)
    assert result.error(exact) <= tolerance * amplification
    assert result.depth <= BAND and np.array_equal(result.rows["transitions"], exact.rows["transitions"])


@pytest.mark.parametrize("step", [10e-3, 1e-3])
def test_eulers_method_never_falls_through_the_floor(scene, step):
    """At 10 ms it blows up in the vibration mode."""
    result = fmpy_euler(scene, step)
    assert result.depth <= BAND and result.transitions > 10
    assert np.abs(result.rows["theta"]).max() <= np.pi / 2 + 1e-9


def test_outputs_are_those_of_the_hosts_state(mcmanus):
    """Between events a_t follows from the states and F_t alone, and der(u_dot) obeys Eq 1 with the base down."""
    from fmpy import simulate_fmu

    names = ["u", "u_dot", "theta", "a_t", "der(u)", "der(u_dot)", "a_ground", "phase"]
    rows = simulate_fmu(mcmanus.path, fmi_type="ModelExchange", stop_time=0.5, output_interval=0.01, relative_tolerance=1e-6,
                        start_values=PACOIMA_DAM, output=names, record_events=False)
    omega, zeta = 2 * np.pi * 5, 0.02
    elastic = 2 * zeta * omega * rows["u_dot"] + omega**2 * rows["u"]
    assert np.all(rows["phase"] == 1) and np.abs(rows["u"]).max() > 1e-4
    np.testing.assert_allclose(rows["a_t"], -elastic, rtol=1e-12)
    np.testing.assert_allclose(rows["der(u_dot)"], -elastic - rows["a_ground"], rtol=1e-9, atol=1e-12)
    assert np.array_equal(rows["der(u)"], rows["u_dot"]) and not rows["theta"].any()


class RungeKutta:
    """The classic method of order 4, in either version of FMI, which heeds every event: it never steps over one."""

    def __init__(self, folder, start_time, tolerance, **start_values):
        description = read_model_description(folder)
        self.references = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.model = model = instantiate_fmu(folder, description, "ModelExchange")
        self.is_fmi2 = description.fmiVersion == "2.0"
        texts = [name for name, value in start_values.items() if isinstance(value, str)]
        model.setString([self.references[name] for name in texts], [start_values.pop(name) for name in texts])
        self.set_numbers = model.setReal if self.is_fmi2 else model.setFloat64
        self.set_numbers([self.references[name] for name in start_values], list(start_values.values()))
        if self.is_fmi2:
            model.setupExperiment(tolerance=tolerance, startTime=start_time)
            model.enterInitializationMode()
        else:
            model.enterInitializationMode(tolerance=tolerance, startTime=start_time)
        model.exitInitializationMode()
        self.time = start_time
        self.next_event = self.update()

    def update(self):
        """When the next event is; on to continuous-time mode."""
        *_, is_foreseen, time = self.model.newDiscreteStates() if self.is_fmi2 else self.model.updateDiscreteStates()
        self.model.enterContinuousTimeMode()
        return time if is_foreseen else np.inf

    def array(self, get):
        values = np.empty(4)
        get(values.ctypes.data_as(ctypes.POINTER(ctypes.c_double)), 4)
        return values

    def states(self):
        return self.array(self.model.getContinuousStates)

    def go_to(self, time, states):
        self.model.setTime(time)
        self.model.setContinuousStates(np.ascontiguousarray(states).ctypes.data_as(ctypes.POINTER(ctypes.c_double)), 4)

    def rates(self, time, states):
        self.go_to(time, states)
        return self.array(self.model.getDerivatives if self.is_fmi2 else self.model.getContinuousStateDerivatives)

    def step(self, until):
        start, h, x = self.time, until - self.time, self.states()
        a = self.rates(start, x)
        b = self.rates(start + h / 2, x + h / 2 * a)
        c = self.rates(start + h / 2, x + h / 2 * b)
        d = self.rates(until, x + h * c)
        self.go_to(until, x + h / 6 * (a + 2 * b + 2 * c + d))
        self.time = until
        if self.model.completedIntegratorStep()[0] or until == self.next_event:
            self.model.enterEventMode()
            self.next_event = self.update()

    def run(self, end, h):
        while self.time < end:
            until = min(self.next_event, end)
            for point in np.linspace(self.time, until, int(np.ceil((until - self.time) / h)) + 1)[1:]:
                self.step(point)
        return self.states()


@pytest.fixture(scope="module", params=[2, 3])
def folder(request, exporter, tmp_path_factory):
    """McManus's specimen, unpacked, in either version of FMI."""
    folder = tmp_path_factory.mktemp("jumps")
    command = [exporter, "export", "--preset", "mcmanus", "--fmi", str(request.param), "-o", folder / "mcmanus.fmu"]
    subprocess.run(command, check=True)
    return fmpy.extract(str(folder / "mcmanus.fmu"), unzipdir=str(folder / "mcmanus"))


def errors(folder, record, tolerance, steps, start_time=0.0, **starts):
    """Of the host's states after both jumps of a record, over their magnitudes, against the engine."""
    starts, end = {"record": str(record), "record_start": 0.03, **starts}, start_time + 0.11
    names = ["u", "u_dot", "theta", "theta_dot"]
    rows = simulate_fmu(folder, start_time=start_time, stop_time=end, output_interval=0.11, relative_tolerance=1e-13,
                        start_values=starts, output=names, fmi_type="CoSimulation")
    for step in steps:
        host = RungeKutta(folder, start_time, tolerance, **starts)
        found = host.run(end, step)
        host.model.freeInstance()
        yield np.max(np.abs(found - [rows[name][-1] for name in names]) / [1e-3, 0.03, 0.05, 0.1])


@pytest.mark.parametrize("tolerance, samples", [(1e-9, "0,4\n0.02,-1\n0.05,2.47\n"), (1e-6, "0,4\n0.05,2.47\n")])
@pytest.mark.parametrize("theta_0", [0.0, 0.05])
def test_a_record_that_jumps_leaves_the_host_its_order(folder, tmp_path, tolerance, samples, theta_0):
    """Down and rocking, by a record that begins at 4 and ends at 2.47 m/s2 within the run."""
    (tmp_path / "jumps.csv").write_text(samples)
    found = errors(folder, tmp_path / "jumps.csv", tolerance, [1e-3, 5e-4, 2.5e-4], theta_0=theta_0, u_0=1e-3)
    coarse, middle, fine = found
    assert np.log2(coarse / middle) > 3.7 and np.log2(middle / fine) > 3.7, (coarse, middle, fine)


def test_a_record_that_jumps_does_so_at_a_late_start_too(folder, tmp_path):
    """Where the last digit of the host's clock is 0.2 ns."""
    (tmp_path / "jumps.csv").write_text("0,4\n0.05,2.47\n")
    [error] = errors(folder, tmp_path / "jumps.csv", 1e-9, [2.5e-4], start_time=1.7e6, theta_0=0.05, u_0=1e-3)
    assert error < 1e-6
