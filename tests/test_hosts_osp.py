"""OSP's libcosim, over Pacoima Dam: a fixed step, with the record inside and with a_g held over each."""

import pytest
from libcosimpy.CosimEnums import CosimExecutionState
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimManipulator import CosimManipulator
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave
from pacoima import A_G, OUTPUTS, STEP, STEPS, distance, held, instants, stepped

log_output_level(CosimLogLevel.FATAL)


class Pier:
    """The FMU alone in an execution."""

    def __init__(self, fmu, step: float):
        self.fmu, self.execution = fmu, CosimExecution.from_step_size(step_size=round(step * 1e9))
        self.index = self.execution.add_local_slave(CosimLocalSlave(fmu_path=fmu.path, instance_name="pier"))
        self.values, self.override = CosimObserver.create_last_value(), CosimManipulator.create_override()
        self.execution.add_observer(self.values)
        self.execution.add_manipulator(self.override)

    def step(self, a_g):
        if a_g is not None:
            self.override.slave_real_values(self.index, self.fmu.references(["a_g"]), [a_g])
        assert self.execution.step()

    def read(self, names=OUTPUTS) -> list[float]:
        return self.values.last_real_values(self.index, self.fmu.references(names))


@pytest.mark.parametrize("step", STEPS)
def test_the_record_inside(shaken, exact, step):
    pier = Pier(shaken["mcmanus"], step)
    assert distance(stepped(pier.read, pier.step, [None] * (len(instants(step)) - 1))[1:], exact(step)[1:]) < 1e-9


def test_held(mcmanus):
    pier = Pier(mcmanus, STEP)
    assert distance(stepped(pier.read, pier.step, A_G[:-1])[1:], held(mcmanus)[1:]) < 1e-10
    assert pier.values.last_integer_values(pier.index, mcmanus.references(["transitions"])) == [31]


def test_start_values_and_overturning(mcmanus):
    """It takes Discard for an error: the run stops at the communication point before."""
    pier, steps = Pier(mcmanus, 0.01), 0
    pier.execution.real_initial_value(pier.index, *mcmanus.references(["theta_0"]), 0.3)
    while pier.execution.step():
        steps += 1
    assert pier.execution.status().state == CosimExecutionState.ERROR.value
    with mcmanus.start(theta_0=0.3) as instance:
        instance.step(0.01 * steps)
        assert pier.read(["theta"]) == pytest.approx([instance.get("theta")], rel=1e-10)
        assert instance.get("theta") > 1.5


def test_enumerations_are_not_seen(mcmanus):
    pier = Pier(mcmanus, STEP)
    seen = {variable.name.decode() for variable in pier.execution.slave_variables(pier.index)}
    unseen = {name for name, variable in mcmanus.variables.items() if variable.type == "Enumeration"}
    assert set(mcmanus.variables) - seen == unseen != set()
