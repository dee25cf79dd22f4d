"""The paper's specimens, how they move, and half cycles of a displacement between its zero crossings."""

from dataclasses import dataclass

import flexible_rocking as fr
import numpy as np

EVISON, MCMANUS = (fr.Structure(preset=preset) for preset in ("evison", "mcmanus"))
TOLERANCE = 1e-10


def free_vibration(structure: fr.Structure, duration: float, interval: float, **initial) -> fr.Response:
    """The response to a release, every `interval` (s)."""
    run = fr.simulate(structure, duration=duration, tolerance=TOLERANCE, **initial)
    return run.at(np.arange(round(duration / interval) + 1) * interval)


@dataclass(frozen=True)
class HalfCycles:
    """The half cycles between the zero crossings of a history."""

    first: np.ndarray  # index of the first instant after the crossing that begins it
    end: np.ndarray  # index of the first instant after the crossing that ends it
    amplitude: np.ndarray  # largest magnitude within
    frequency: np.ndarray  # inverse of twice the time between its crossings, Hz


def half_cycles(time: np.ndarray, displacement: np.ndarray) -> HalfCycles:
    """The complete half cycles, as Fig 7 of the paper counts them; what precedes the first crossing is left out."""
    before = np.flatnonzero(displacement[1:] * displacement[:-1] < 0)
    after = before + 1
    rate = (displacement[after] - displacement[before]) / (time[after] - time[before])
    crossing = time[before] - displacement[before] / rate
    amplitude = np.maximum.reduceat(np.abs(displacement), after)[:-1] if len(after) else np.array([])
    return HalfCycles(after[:-1], after[1:], amplitude, 1 / (2 * np.diff(crossing)))
