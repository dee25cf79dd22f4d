"""Ecos, over Pacoima Dam: a fixed step, with the record inside, in both versions of FMI, and with a_g held over each."""

import numpy as np
import pytest
from host import need_libtbb
from pacoima import A_G, OUTPUTS, STEP, STEPS, distance, held, instants, stepped

need_libtbb()
from ecospy import EcosLib, EcosSimulation, EcosSimulationStructure

EcosLib.set_log_level("off")


def simulation(fmu, step: float, **start_values) -> EcosSimulation:
    """The FMU alone in a simulation, initialized."""
    structure = EcosSimulationStructure()
    structure.add_model("pier", fmu.path)
    structure.add_parameter_set("start", {f"pier::{name}": value for name, value in start_values.items()})
    simulation = EcosSimulation(structure=structure, step_size=step)
    assert simulation.init(parameter_set="start")
    return simulation


def samples(pier, inputs) -> np.ndarray:
    def step(a_g):
        if a_g is not None:
            pier.set_real("pier::a_g", a_g)
        pier.step()

    return stepped(lambda: [pier.get_real(f"pier::{name}") for name in OUTPUTS], step, inputs)


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("step", STEPS)
def test_the_record_inside(export, pacoima_record, exact, step, version):
    with simulation(export("mcmanus", pacoima_record, fmi=version), step) as pier:
        found = samples(pier, [None] * (len(instants(step)) - 1))
        pier.terminate()
    assert distance(found, exact(step)) < 1e-9


def test_held(mcmanus):
    with simulation(mcmanus, STEP) as pier:
        found = samples(pier, A_G[:-1])
        assert pier.get_integer("pier::transitions") == 31
        pier.terminate()
    assert distance(found, held(mcmanus)) < 1e-10


def test_start_values_and_overturning(mcmanus):
    """It takes no notice of Discard: time goes on, the structure lies where it fell."""
    with simulation(mcmanus, 0.01, theta_0=0.3) as pier:
        assert pier.get_real("pier::theta") == 0.3
        pier.step(300)
        assert pier.get_time() == pytest.approx(3.0)
        assert pier.get_real("pier::theta") == pytest.approx(np.pi / 2, abs=1e-14)
        assert pier.get_bool("pier::overturned")


def test_enumerations_are_not_seen(mcmanus):
    with simulation(mcmanus, STEP) as pier:
        for name in ("phase", "detail"):
            with pytest.raises(Exception, match=f"No int property pier::{name} found"):
                pier.get_integer(f"pier::{name}")
