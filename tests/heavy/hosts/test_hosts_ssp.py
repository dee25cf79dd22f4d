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
from pacoima import A_G, END, OUTPUTS, STEP, STEPS, TIME, distance, held, instants, stepped

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
def ssp(tmp_path_factory):
    """Writes the archive, in which a_g may be connected to every specimen's, and returns its path."""

    def write(fmus, connected: bool = False) -> str:
        path = tmp_path_factory.mktemp("ssp") / "shake_table.ssp"
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("SystemStructure.ssd", system_structure(fmus, connected))
            for name, fmu in fmus.items():
                archive.write(fmu.path, f"resources/{name}.fmu")
        return str(path)

    return write


def by_fmpy(path, fmus, step):
    result = simulate_ssp(path, stop_time=END - step / 2, step_size=step)
    return [[result[f"{name}.{output}"] for output in OUTPUTS] for name in fmus]


def by_libcosim(path, fmus, step):
    zipfile.ZipFile(path).extractall(f"{path}.unpacked")
    execution, values = CosimExecution.from_ssp_file(f"{path}.unpacked", step_size=round(step * 1e9)), CosimObserver.create_last_value()
    execution.add_observer(values)
    indices = {execution.slave_index_from_instance_name(name): fmu.references(OUTPUTS) for name, fmu in fmus.items()}
    read = lambda: [values.last_real_values(*of) for of in indices.items()]
    return stepped(read, lambda _: execution.step(), instants(step)[1:])[1:].transpose(1, 2, 0)


def by_ecos(path, fmus, step):
    need_libtbb()
    from ecospy import EcosSimulation

    with EcosSimulation(ssp_path=path, step_size=step) as table:
        assert table.init()
        read = lambda: [[table.get_real(f"{name}::{output}") for output in OUTPUTS] for name in fmus]
        found = stepped(read, lambda _: table.step(), instants(step)[1:])[1:]
        table.terminate()
    return found.transpose(1, 2, 0)


@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("host", [by_fmpy, by_libcosim, by_ecos])
def test_the_record_inside(ssp, shaken, exact, host, step):
    for name, found in zip(shaken, host(ssp(shaken), shaken, step), strict=True):
        assert distance(np.transpose(found), exact(step, name)[1:]) < 1e-9


def test_fmpy(ssp, mcmanus, evison):
    """It hands a connection's value on after the step, so that the input is a step late."""
    fmus, a_g = dict(mcmanus=mcmanus, evison=evison), dict(zip(np.round(TIME / STEP), A_G))
    result = simulate_ssp(ssp(fmus, True), stop_time=TIME[-1] - STEP / 2, step_size=STEP,
                          input={"a_g": lambda time: a_g[round(time / STEP)]})
    for name, fmu in fmus.items():
        found = np.column_stack([result[f"{name}.{output}"] for output in OUTPUTS])
        assert distance(found, held(fmu, delay=1)[1:]) < 1e-9
