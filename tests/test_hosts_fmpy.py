"""fmpy in all its ways, over Pacoima Dam."""

import subprocess
import sys
from ctypes import byref

import fmpy
import numpy as np
import pytest
from first_run import fmpy_input
from fmpy.fmi2 import defaultCallbacks, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.logging import addLoggerProxy
from host import simulate
from pacoima import A_G, OUTPUTS, STEP, TIME, distance, held, linear, rows, write_record

_SAID = []


@fmi2CallbackLoggerTYPE
def _listen(_environment, _name, _status, _category, text):
    _SAID.append(text.decode())


@pytest.mark.parametrize(("derivatives", "reference"), [(True, linear), (False, held)])
def test_simulate_fmu_follows_the_input_as_far_as_it_is_told(mcmanus, derivatives, reference):
    result, events = simulate(mcmanus, stop_time=TIME[-1], output_interval=STEP, input=fmpy_input(TIME, A_G),
                              set_input_derivatives=derivatives, output=OUTPUTS)
    assert len(events) == 31
    assert distance(rows(result), reference(mcmanus)) < 1e-10


def test_held_and_linear_inputs_differ(mcmanus):
    assert 1e-2 < distance(held(mcmanus), linear(mcmanus)) < 1


def test_command_line(mcmanus, tmp_path):
    write_record(tmp_path / "in.csv")
    command = [sys.executable, "-m", "fmpy", "simulate", mcmanus.path, "--input-file", "in.csv",
               "--output-file", "out.csv", "--stop-time", str(TIME[-1]), "--output-interval", str(STEP),
               "--output-variables", *OUTPUTS]
    subprocess.run(command, cwd=tmp_path, check=True)
    result = np.genfromtxt(tmp_path / "out.csv", delimiter=",", names=True)
    assert distance(rows(result), held(mcmanus)) < 1e-10


def test_every_step_can_be_taken_back(mcmanus):
    """Each step is taken twice with a wrong input and rolled back before it is taken as it should be."""
    with mcmanus.start() as instance:
        slave, samples = instance.slave, [instance.reals(OUTPUTS)]
        for start, until, a_g, next_a_g in zip(TIME, TIME[1:], A_G, A_G[1:]):
            state = slave.getFMUstate()
            for wrong in (-2 * a_g, 30.0):
                instance.load(wrong)
                instance.step(until)
                slave.setFMUstate(state)
                instance.time = start
            slave.freeFMUstate(state)
            instance.load(a_g, (next_a_g - a_g) / (until - start))
            instance.step(until)
            samples.append(instance.reals(OUTPUTS))
    assert np.array_equal(samples, linear(mcmanus))


def test_a_run_goes_on_from_bytes(mcmanus):
    """simulate_fmu with fmu_instance to the middle; from its serialized state to the end."""
    middle = len(TIME) // 2
    arguments = dict(output_interval=STEP, input=fmpy_input(TIME, A_G), set_input_derivatives=True, output=OUTPUTS,
                     terminate=False)
    with mcmanus.instance() as instance:
        first, _ = simulate(mcmanus, stop_time=TIME[middle], fmu_instance=instance.slave, set_stop_time=False,
                            **arguments)
        state = instance.slave.getFMUstate()
        middle_state = instance.slave.serializeFMUstate(state)
        instance.slave.freeFMUstate(state)
    second, _ = simulate(mcmanus, start_time=TIME[middle], stop_time=TIME[-1], fmu_state=middle_state, **arguments)
    assert distance(np.vstack([rows(first), rows(second)[1:]]), linear(mcmanus)) < 1e-10


def test_a_run_ends_where_the_structure_overturns(mcmanus):
    result, events = simulate(mcmanus, stop_time=5.0, output_interval=0.01, start_values={"theta_0": 0.3},
                              output=["theta", "overturned"])
    assert events[-1].kind == "overturning"
    assert result["time"][-1] == events[-1].time < 2.0
    assert result["theta"][-1] == pytest.approx(np.pi / 2, abs=1e-14)
    assert result["overturned"][-1] == 1


def test_fmpy_has_one_logger_per_process():
    """A run without a logger of its own logs into that of the run before, which may be gone by then: keep it alive.

    No FMU is needed to see it: the default callbacks call whatever logger was given to fmpy last.
    """
    callbacks = fmi2CallbackFunctions()
    callbacks.logger = _listen
    addLoggerProxy(byref(callbacks))
    _SAID.clear()
    defaultCallbacks.logger(None, b"", 0, b"", b"for someone else")
    assert _SAID == ["for someone else"]
