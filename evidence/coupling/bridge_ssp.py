"""The bridge as an SSP archive, run by fmpy: two piers and the deck, an FMU each, with the ground motion inside them.

fmpy passes every value on after the step. The piers (`F_t_extrapolated`) and the deck extrapolate their inputs with the slope of the last
two values. The master is therefore a Jacobi master of second order. The deck's FMU is built by pythonfmu.
"""

import tempfile
import zipfile
from pathlib import Path

import numpy as np
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import Parameter, ParameterSet
from pythonfmu.builder import FmuBuilder

from ..page import table
from ..scenes import exported, pacoima_dam
from .bridge import PIERS, Bridge, deck, iterated, linear, pier

SSP = "http://ssp-standard.org/SSP1/SystemStructure"
STEPS = (2e-3, 1e-3, 0.5e-3, 0.25e-3, 0.125e-3)  # s
DECK = "deck"


def write_archive(path: Path, piers: list, record: Path) -> None:
    """The SSP archive of the bridge. `piers` are the FMUs of the specimens of McManus and Evison with `record` inside."""
    here, mass = Path(__file__).parent, deck()
    with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, fmu in zip(PIERS, piers):
            archive.write(fmu, f"resources/{name}.fmu")
        built = FmuBuilder.build_FMU(here / "deck_fmu.py", dest=folder, project_files=[here / "swaying_mass.py", record],
                                     newargs=dict(M=mass.M, k=mass.k, c=mass.c))
        archive.write(built, f"resources/{DECK}.fmu")
        archive.writestr("SystemStructure.ssd", bridge())


def bridge() -> str:
    """The piers' tops to the deck, its bearings' forces to the piers."""
    reals, ends = {DECK: {"x": "output"}}, []
    for i, name in enumerate(PIERS):
        reals[name] = {"F_t": "input", "delta_t": "output", "v_t": "output"}
        reals[DECK] |= {f"delta_t_{i}": "input", f"v_t_{i}": "input", f"F_{i}": "output"}
        ends += [(name, "delta_t", DECK, f"delta_t_{i}"), (name, "v_t", DECK, f"v_t_{i}"), (DECK, f"F_{i}", name, "F_t")]
    return system_structure(reals, ends)


def system_structure(reals: dict, ends: list, inputs: dict | None = None) -> str:
    """SystemStructure.ssd: FMUs with the kinds of their reals by name, and connections from an element's connector to another's.
    The element "" is the system itself, with its `inputs`."""
    def listed(name: str, items) -> str:
        found = "".join(items)
        return f"<ssd:{name}>{found}</ssd:{name}>" if found else ""

    def connectors(of) -> str:
        return listed("Connectors", (f'<ssd:Connector name="{name}" kind="{kind}"><ssc:Real/></ssd:Connector>' for name, kind in of.items()))

    def connection(*ends) -> str:
        names = zip(("startElement", "startConnector", "endElement", "endConnector"), ends)
        return "<ssd:Connection " + " ".join(f'{key}="{name}"' for key, name in names if name) + "/>"

    components = (f'<ssd:Component name="{name}" source="resources/{name}.fmu" type="application/x-fmu-sharedlibrary">'
                  f"{connectors(of)}</ssd:Component>" for name, of in reals.items())
    return (f'<ssd:SystemStructureDescription xmlns:ssd="{SSP}Description" xmlns:ssc="{SSP}Common" name="system" version="1.0">'
            f'<ssd:System name="system">{connectors(inputs or {})}{listed("Elements", components)}'
            f'{listed("Connections", (connection(*of) for of in ends))}</ssd:System></ssd:SystemStructureDescription>')


def run(archive: Path, stop_time: float, h: float, extrapolated: bool = True) -> np.ndarray:
    """fmpy's result; its rows are the outputs at the ends of the steps."""
    parameters = ParameterSet()
    switches = [*(f"{name}.F_t_extrapolated" for name in PIERS), f"{DECK}.extrapolated"]
    parameters.parameters = [Parameter(name=name, value=extrapolated) for name in switches]
    return simulate_ssp(str(archive), stop_time=stop_time - h / 2, step_size=h, parameter_set=parameters)


def error(result: np.ndarray, h: float, time, reference) -> float:
    """The largest of the deck's displacement at the samples of the record, over the peak."""
    steps = round(time[1] / h)
    x = result["deck.x"][steps - 1::steps]
    return np.max(np.abs(x - reference[1:len(x) + 1])) / np.max(np.abs(reference))


def errors(fmus) -> str:
    """Errors of values held and extrapolated, by steps."""
    time, a_g = pacoima_dam()
    system = Bridge([pier(fmu) for fmu in fmus], deck(), linear(time, a_g))
    reference = iterated(system, time, lambda: system.deck.x)
    with tempfile.TemporaryDirectory() as folder:
        archive, record = Path(folder, "bridge.ssp"), Path(folder, "record.csv")
        np.savetxt(record, np.column_stack([time, a_g]), "%.17g", delimiter=",", header="time (s),a_g (m/s2)", comments="")
        write_archive(archive, [exported(name.lower(), record=record) for name in PIERS], record)
        rows = [[name, *(f"{error(run(archive, time[-1], h, extrapolated), h, time, reference):.1e}" for h in STEPS)]
                for name, extrapolated in (("held", False), ("extrapolated", True))]
    return table(["error of the deck's displacement, step", *(f"{1e3 * h:g} ms" for h in STEPS)], rows)
