"""FlexibleRocking: structures that rock on their foundation under earthquake ground motion.

    import flexible_rocking as fr

    pier = fr.Structure(m=4e5, m0=1e5, H=9, B=1.5, J0=1e5, f_fc=2.5, zeta_fc=0.03, r=0.95)
    ground = fr.Record.read("RSN77.AT2", scale=1.45)          # or fr.Record(time, a_g), fr.Record(dt, a_g), fr.pulse(...)
    run = fr.simulate(pier, ground)
    run.peaks["theta"], run.overturned, run.transitions
    run.at([0.5, 1.0]).to_pandas()

A Structure is shaken by a Record, which is a ground motion; simulate returns a Run. advise recommends a level of detail. estimate
gives the demands that need no time history. sweep does many runs on all cores, fragility fits a curve to them, and
intensity_at finds how strong each record must be to reach a limit. design finds the value of a number at which limits hold in a
share of the runs, calibrate the numbers that fit measured histories. export writes an FMU; fmu is the path of one. help() of each
has units, shapes, equation numbers of the paper, and errors. docs/howto/python.md is the page of the module.

SI units and radians throughout. Invalid input raises ValueError with the name, the value and the limit, a missing file
FileNotFoundError. A path stands for the Record of its file. Structure.read and write share files with the command line. Tables need pandas,
pictures matplotlib, calibrate scipy, and notebooks IPython.
"""

from collections.abc import Iterable as _Iterable
from importlib.metadata import distribution as _distribution
from os import PathLike as _PathLike
from pathlib import Path as _Path

from . import _native
from ._calibrate import Calibration, calibrate
from ._design import Design, design
from ._ground import Ground
from ._native import Curve, Record, Run, Structure, __version__, advise, estimate, pulse, simulate
from ._results import Advice, Condition, Estimate, Peak, Profile, Response, Transition, Transitions, Worst
from ._sweep import Fragility, fragility, intensity_at, overturning_map, sweep

__all__ = ["Advice", "Calibration", "Condition", "Curve", "Design", "Estimate", "Fragility", "Ground", "Peak", "Profile", "Record", "Response", "Run",
           "Structure", "Transition", "Transitions", "Worst", "__version__", "advise", "calibrate", "design", "estimate", "export", "fmu",
           "fragility", "intensity_at", "overturning_map", "pulse", "simulate", "sweep"]


def fmu() -> _Path:
    """The FMU of McManus's bridge pier, for every platform, with a pulse as its ground motion until `record` names another."""
    files = _distribution("flexible-rocking").files or []
    return next(_Path(str(file.locate())).resolve() for file in files if file.name == "FlexibleRocking.fmu")


def export(
    target: str | _PathLike[str],
    structure: Structure,
    *,
    record: Record | str | _PathLike[str] | _Iterable[Record | str | _PathLike[str]] = (),
    name: str = "FlexibleRocking",
    fmi: int = 2,
    library: str | _PathLike[str] | None = None,
    strings: bool = True,
) -> _Path:
    """Writes the FMU of a structure to `target` and returns its path.

    record: a Record or a file, or several. The FMU follows the first and has the others inside, each Record under its title.
    name: the name of the model for hosts. fmi: the version of the standard, 2 (2.0) or 3 (3.0).
    strings: False leaves out the parameters `record` and `record_v`, because CasADi loads no FMI 3.0 with strings.
    library: an FMU or a shared library with the code; by default `fmu()`. A Python warning names an assumption about a file, or a likely fault. Raises
    ValueError with the reason.
    """
    is_one = isinstance(record, (Record, str)) or not isinstance(record, _Iterable)
    records = [record] if is_one else list(record)  # type: ignore[arg-type]
    _native.export(target, structure, records, name, fmi, fmu() if library is None else library, strings)
    return _Path(target).absolute()
