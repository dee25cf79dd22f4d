"""OSP's libcosim, over Pacoima Dam: a fixed step, with the record inside and with a_g held over each."""

import numpy as np
import pytest
from libcosimpy.CosimEnums import CosimExecutionState
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimManipulator import CosimManipulator
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave
from pacoima import A_G, OUTPUTS, STEP, STEPS, distance, held, instants

log_output_level(CosimLogLevel.FATAL)


class Pier:
    """The FMU alone in an execution."""

    def __init__(self, fmu, step: float):
        self.execution = CosimExecution.from_step_size(step_size=round(step * 1e9))
        self.slave = CosimLocalSlave(fmu_path=fmu.path, instance_name="pier")
        self.index = self.execution.add_local_slave(self.slave)
        self.values = CosimObserver.create_last_value()
        self.execution.add_observer(self.values)
        self.override = CosimManipulator.create_override()
        self.execution.add_manipulator(self.override)
        self.references = {name: variable.valueReference for name, variable in fmu.variables.items()}

    def set(self, name: str, value: float):
        self.override.slave_real_values(self.index, [self.references[name]], [value])

    def get(self, names) -> list[float]:
        return self.values.last_real_values(self.index, [self.references[name] for name in names])


@pytest.mark.parametrize("step", STEPS)
def test_the_record_inside(shaken, exact, step):
    pier, samples = Pier(shaken["mcmanus"], step), []
    for _ in instants(step)[1:]:
        assert pier.execution.step()
        samples.append(pier.get(OUTPUTS))
    assert distance(np.array(samples), exact(step)[1:]) < 1e-9


def test_held(mcmanus):
    pier, samples = Pier(mcmanus, STEP), [[0.0] * len(OUTPUTS)]
    for a_g in A_G[:-1]:
        pier.set("a_g", a_g)
        assert pier.execution.step()
        samples.append(pier.get(OUTPUTS))
    assert distance(np.array(samples), held(mcmanus)) < 1e-10
    assert pier.values.last_integer_values(pier.index, [pier.references["transitions"]]) == [31]


def test_start_values_and_overturning(mcmanus):
    """It takes Discard for an error: the run stops at the communication point before."""
    pier = Pier(mcmanus, 0.01)
    pier.execution.real_initial_value(pier.index, pier.references["theta_0"], 0.3)
    steps = 0
    while pier.execution.step():
        steps += 1
    assert pier.execution.status().state == CosimExecutionState.ERROR.value
    with mcmanus.start(theta_0=0.3) as instance:
        instance.step(0.01 * steps)
        assert pier.get(["theta"]) == pytest.approx([instance.get("theta")], rel=1e-10)
        assert instance.get("theta") > 1.5


def test_enumerations_are_not_seen(mcmanus):
    pier = Pier(mcmanus, STEP)
    seen = {variable.name.decode() for variable in pier.execution.slave_variables(pier.index)}
    unseen = set(mcmanus.variables) - seen
    assert unseen == {name for name, variable in mcmanus.variables.items() if variable.type == "Enumeration"}
    assert "phase" in unseen
