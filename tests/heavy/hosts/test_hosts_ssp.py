"""A system of two specimens on the same ground, as an SSP archive, in three hosts: with the record inside the specimens,
and with a_g passed on.

libcosim and Ecos know no connection from the system's own input.
"""

import zipfile

import numpy as np
import pytest
from fmpy.ssp.simulation import simulate_ssp
from host import need_libtbb
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimObserver import CosimObserver
from pacoima import A_G, END, OUTPUTS, STEP, STEPS, TIME, distance, held, instants

SPECIMENS = ("mcmanus", "evison")
SSP = "http://ssp-standard.org/SSP1/SystemStructure"


def system_structure(names, connected: bool) -> str:
    """SystemStructure.ssd: an FMU for each of the names. If they are connected, the system's a_g goes to each."""
    def connectors(**kinds) -> str:
        listed = "".join(f'<ssd:Connector name="{name}" kind="{kind}"><ssc:Real/></ssd:Connector>' for name, kind in kinds.items())
        return f"<ssd:Connectors>{listed}</ssd:Connectors>" if kinds else ""

    inputs = {"a_g": "input"} if connected else {}
    components = "".join(f'<ssd:Component name="{name}" source="resources/{name}.fmu" type="application/x-fmu-sharedlibrary">'
                         f"{connectors(**inputs, **dict.fromkeys(OUTPUTS, 'output'))}</ssd:Component>" for name in names)
    ends = "".join(f'<ssd:Connection startConnector="a_g" endElement="{name}" endConnector="a_g"/>' for name in names)
    return (f'<ssd:SystemStructureDescription xmlns:ssd="{SSP}Description" xmlns:ssc="{SSP}Common" name="system" version="1.0">'
            f'<ssd:System name="system">{connectors(**inputs)}<ssd:Elements>{components}</ssd:Elements>'
            f"{f'<ssd:Connections>{ends}</ssd:Connections>' if connected else ''}</ssd:System></ssd:SystemStructureDescription>")


@pytest.fixture(scope="module")
def fmus(mcmanus, evison):
    return dict(zip(SPECIMENS, (mcmanus, evison)))


@pytest.fixture(scope="module")
def ssp(fmus, tmp_path_factory):
    """Writes the archive, in which a_g may be connected to every specimen's, and returns its path."""

    def write(connected: bool, fmus=fmus):
        path = tmp_path_factory.mktemp("ssp") / "shake_table.ssp"
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("SystemStructure.ssd", system_structure(fmus, connected))
            for name, fmu in fmus.items():
                archive.write(fmu.path, f"resources/{name}.fmu")
        return path

    return write


@pytest.mark.parametrize("step", STEPS)
def test_fmpy_with_the_record_inside(ssp, shaken, exact, step):
    result = simulate_ssp(str(ssp(False, shaken)), stop_time=END - step / 2, step_size=step)
    for name in SPECIMENS:
        found = np.column_stack([result[f"{name}.{output}"] for output in OUTPUTS])
        assert distance(found, exact(step, name)[1:]) < 1e-9


@pytest.mark.parametrize("step", STEPS)
def test_libcosim_with_the_record_inside(ssp, shaken, exact, tmp_path, step):
    with zipfile.ZipFile(ssp(False, shaken)) as archive:
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


@pytest.mark.parametrize("step", STEPS)
def test_ecos_with_the_record_inside(ssp, shaken, exact, step):
    need_libtbb()
    from ecospy import EcosSimulation

    with EcosSimulation(ssp_path=str(ssp(False, shaken)), step_size=step) as table:
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
    result = simulate_ssp(str(ssp(True)), stop_time=TIME[-1] - STEP / 2, step_size=STEP,
                          input={"a_g": lambda time: a_g[round(time / STEP)]})
    for name, fmu in fmus.items():
        found = np.column_stack([result[f"{name}.{output}"] for output in OUTPUTS])
        assert distance(found, held(fmu, delay=1)[1:]) < 1e-9
