"""The paper's specimens, and how they move."""

import flexible_rocking as fr
import numpy as np

EVISON, MCMANUS = (fr.Structure(preset=preset) for preset in ("evison", "mcmanus"))
TOLERANCE = 1e-10


def free_vibration(structure: fr.Structure, duration: float, interval: float, **initial) -> fr.Response:
    """The response to a release, every `interval` (s)."""
    run = fr.simulate(structure, duration=duration, tolerance=TOLERANCE, **initial)
    return run.at(np.arange(round(duration / interval) + 1) * interval)
