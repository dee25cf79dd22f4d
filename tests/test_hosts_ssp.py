"""A system of two specimens on the same ground, as an SSP archive, in three hosts: with the record inside the specimens,
and with a_g passed on.

libcosim and Ecos know no connection from the system's own input: for them the specimens' inputs are left open.
"""

import zipfile
from xml.etree import ElementTree

import numpy as np
import pytest
from coupling.bridge_ssp import SSC, SSD, component, connect, connectors
from fmpy.ssp.simulation import simulate_ssp
from host import need_libtbb
from libcosimpy._internal import get_last_error_message
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimManipulator import CosimManipulator
from libcosimpy.CosimObserver import CosimObserver
from pacoima import A_G, END, OUTPUTS, STEP, STEPS, TIME, distance, held, instants

SPECIMENS = ("mcmanus", "evison")
ElementTree.register_namespace("ssd", SSD)  # Ecos knows the elements by these prefixes
ElementTree.register_namespace("ssc", SSC)


def system_structure(a_g: str | None) -> bytes:
    """SystemStructure.ssd: every specimen's a_g is connected to that of the system, or open, or not there."""
    connected = a_g == "connected"
    root = ElementTree.Element(f"{{{SSD}}}SystemStructureDescription", name="shake table", version="1.0")
    system = ElementTree.SubElement(root, f"{{{SSD}}}System", name="table")
    if connected:
        connectors(system, {"a_g": "input"})
    elements = ElementTree.SubElement(system, f"{{{SSD}}}Elements")
    for name in SPECIMENS:
        component(elements, name, ({"a_g": "input"} if a_g else {}) | dict.fromkeys(OUTPUTS, "output"))
    if connected:
        connections = ElementTree.SubElement(system, f"{{{SSD}}}Connections")
        for name in SPECIMENS:
            connect(connections, (None, "a_g"), (name, "a_g"))
    return ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)


@pytest.fixture(scope="module")
def fmus(mcmanus, evison):
    return dict(zip(SPECIMENS, (mcmanus, evison)))


@pytest.fixture(scope="module")
def ssp(fmus, tmp_path_factory):
    """Writes the archive and returns its path."""

    def write(a_g: str | None, fmus=fmus):
        path = tmp_path_factory.mktemp("ssp") / "shake_table.ssp"
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("SystemStructure.ssd", system_structure(a_g))
            for name, fmu in fmus.items():
                archive.write(fmu.path, f"resources/{name}.fmu")
        return path

    return write


@pytest.mark.parametrize("step", STEPS)
def test_fmpy_with_the_record_inside(ssp, shaken, exact, step):
    result = simulate_ssp(str(ssp(None, shaken)), stop_time=END - step / 2, step_size=step)
    for name in SPECIMENS:
        found = np.column_stack([result[f"{name}.{output}"] for output in OUTPUTS])
        assert distance(found, exact(step, name)[1:]) < 1e-9


@pytest.mark.parametrize("step", STEPS)
def test_libcosim_with_the_record_inside(ssp, shaken, exact, tmp_path, step):
    with zipfile.ZipFile(ssp(None, shaken)) as archive:
        archive.extractall(tmp_path)
    execution = CosimExecution.from_ssp_file(str(tmp_path), step_size=round(step * 1e9))
    values = CosimObserver.create_last_value()
    execution.add_observer(values)
    samples = {name: [] for name in SPECIMENS}
    for _ in instants(step)[1:]:
        assert execution.step()
        for name, fmu in shaken.items():
            references = [fmu.variables[output].valueReference for output in OUTPUTS]
            index = execution.slave_index_from_instance_name(name)
            samples[name].append(values.last_real_values(index, references))
    for name in SPECIMENS:
        assert distance(np.array(samples[name]), exact(step, name)[1:]) < 1e-9


@pytest.mark.heavy
@pytest.mark.parametrize("step", STEPS)
def test_ecos_with_the_record_inside(ssp, shaken, exact, step):
    need_libtbb()
    from ecospy import EcosSimulation

    with EcosSimulation(ssp_path=str(ssp(None, shaken)), step_size=step) as table:
        assert table.init()
        samples = {name: [] for name in SPECIMENS}
        for _ in instants(step)[1:]:
            table.step()
            for name in SPECIMENS:
                samples[name].append([table.get_real(f"{name}::{output}") for output in OUTPUTS])
        table.terminate()
    for name in SPECIMENS:
        assert distance(np.array(samples[name]), exact(step, name)[1:]) < 1e-9


def test_fmpy(ssp, fmus):
    """It hands a connection's value on after the step, so that the input is a step late."""
    a_g = dict(zip(np.round(TIME / STEP), A_G))
    result = simulate_ssp(str(ssp("connected")), stop_time=TIME[-1] - STEP / 2, step_size=STEP,
                          input={"a_g": lambda time: a_g[round(time / STEP)]})
    for name, fmu in fmus.items():
        found = np.column_stack([result[f"{name}.{output}"] for output in OUTPUTS])
        assert distance(found, held(fmu, delay=1)[1:]) < 1e-9


def test_libcosim(ssp, fmus, tmp_path):
    """It wants the archive unpacked."""
    for a_g in ("connected", "open"):
        with zipfile.ZipFile(ssp(a_g)) as archive:
            archive.extractall(tmp_path / a_g)
    with pytest.raises(AssertionError, match="Unable to create execution"):
        CosimExecution.from_ssp_file(str(tmp_path / "connected"), step_size=round(STEP * 1e9))
    assert get_last_error_message() == "No such node (<xmlattr>.startElement)"
    execution = CosimExecution.from_ssp_file(str(tmp_path / "open"), step_size=round(STEP * 1e9))
    values, override = CosimObserver.create_last_value(), CosimManipulator.create_override()
    execution.add_observer(values)
    execution.add_manipulator(override)
    indices = {name: execution.slave_index_from_instance_name(name) for name in fmus}
    samples = {name: [[0.0] * len(OUTPUTS)] for name in fmus}
    for a_g in A_G[:-1]:
        for name, fmu in fmus.items():
            override.slave_real_values(indices[name], [fmu.variables["a_g"].valueReference], [a_g])
        assert execution.step()
        for name, fmu in fmus.items():
            references = [fmu.variables[output].valueReference for output in OUTPUTS]
            samples[name].append(values.last_real_values(indices[name], references))
    for name, fmu in fmus.items():
        assert distance(np.array(samples[name]), held(fmu)) < 1e-9


@pytest.mark.heavy
def test_ecos(ssp, fmus):
    need_libtbb()
    from ecospy import EcosSimulation

    with pytest.raises(Exception, match="No element named:"):
        EcosSimulation(ssp_path=str(ssp("connected")), step_size=STEP)
    with EcosSimulation(ssp_path=str(ssp("open")), step_size=STEP) as table:
        assert table.init()
        samples = {name: [[0.0] * len(OUTPUTS)] for name in fmus}
        for a_g in A_G[:-1]:
            for name in fmus:
                table.set_real(f"{name}::a_g", a_g)
            table.step()
            for name in fmus:
                samples[name].append([table.get_real(f"{name}::{output}") for output in OUTPUTS])
        table.terminate()
    for name, fmu in fmus.items():
        assert distance(np.array(samples[name]), held(fmu)) < 1e-9
