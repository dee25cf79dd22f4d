"""Ecos, over Pacoima Dam: a fixed step, with the record inside, in both versions of FMI, and with a_g held over each."""

import numpy as np
import pytest
from host import need_libtbb
from pacoima import A_G, OUTPUTS, STEP, STEPS, distance, held, instants

need_libtbb()
from ecospy import EcosLib, EcosSimulation, EcosSimulationStructure

EcosLib.set_log_level("off")


def simulation(path: str, step: float, **start_values) -> EcosSimulation:
    """The FMU alone in a simulation, initialized."""
    structure = EcosSimulationStructure()
    structure.add_model("pier", path)
    structure.add_parameter_set("start", {f"pier::{name}": value for name, value in start_values.items()})
    simulation = EcosSimulation(structure=structure, step_size=step)
    assert simulation.init(parameter_set="start")
    return simulation


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("step", STEPS)
def test_the_record_inside(export, pacoima_record, exact, step, version):
    with simulation(str(export("mcmanus", pacoima_record, fmi=version)), step) as pier:
        get = lambda: [pier.get_real(f"pier::{name}") for name in OUTPUTS]
        samples = [get()]
        for _ in instants(step)[1:]:
            pier.step()
            samples.append(get())
        pier.terminate()
    assert distance(np.array(samples), exact(step)) < 1e-9


def test_held(mcmanus):
    with simulation(mcmanus.path, STEP) as pier:
        get = lambda: [pier.get_real(f"pier::{name}") for name in OUTPUTS]
        samples = [get()]
        for a_g in A_G[:-1]:
            pier.set_real("pier::a_g", a_g)
            pier.step()
            samples.append(get())
        assert pier.get_integer("pier::transitions") == 31
        pier.terminate()
    assert distance(np.array(samples), held(mcmanus)) < 1e-10


def test_start_values_and_overturning(mcmanus):
    """It takes no notice of Discard: time goes on, the structure lies where it fell."""
    with simulation(mcmanus.path, 0.01, theta_0=0.3) as pier:
        assert pier.get_real("pier::theta") == 0.3
        pier.step(300)
        assert pier.get_time() == pytest.approx(3.0)
        assert pier.get_real("pier::theta") == pytest.approx(np.pi / 2, abs=1e-14)
        assert pier.get_bool("pier::overturned")


def test_enumerations_are_not_seen(mcmanus):
    with simulation(mcmanus.path, STEP) as pier:
        for name in ("phase", "detail"):
            with pytest.raises(Exception, match=f"No int property pier::{name} found"):
                pier.get_integer(f"pier::{name}")
