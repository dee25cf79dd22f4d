"""Section 1's published values: the accelerations that overturn the train at Point Reyes Station, 1906."""

from collections.abc import Callable

import numpy as np
from first_run import G
from scipy.optimize import bisect
from validation.report import table

from .block import homogeneous, lowest
from .slender_block import ONE_SINE, boundaries

PUBLISHED = {1.0: 0.35, 1.5: 0.5, 2.0: 1.05}  # Hz: g, as the abstract prints them
RESTITUTIONS = [0.85, 0.9, 0.95, 1.0]
BLOCKS = (1.85, 3.0)  # p between which the block is looked for, rad/s
PARTS = np.arange(0.6, 1.6, 0.02)  # of the slender block's amplitude
STEP = 0.02  # of the search for boundaries, g alpha


def least(frequency: float, p: float, r: float) -> float:
    """The least one sine that overturns the slender block, over g alpha; infinite where none does."""
    found = next(boundaries(ONE_SINE, 2 * np.pi * frequency / p, r, 10.0, STEP), None)
    return found.amplitude if found else np.inf


def rows(advance: Callable[[], None]) -> tuple[str, str]:
    """The table of the blocks that the first and the last value determine, with the value between; its range."""
    (first, a), (between, _), (last, c) = PUBLISHED.items()
    lines, predicted = [], []
    for r in RESTITUTIONS:
        p = bisect(lambda p, r=r: least(last, p, r) / least(first, p, r) - c / a, *BLOCKS, xtol=1e-6)
        alpha = a / least(first, p, r)
        block = homogeneous(np.tan(alpha), r)
        of_model = [np.tan(alpha) * lowest(block, ONE_SINE, 2 * np.pi * frequency / p, PARTS * least(frequency, p, r))
                    for frequency in PUBLISHED]
        predicted.append(alpha * least(between, p, r))
        numbers = [f"{r:g}", f"{p:.2f}", f"{alpha:.3f}", f"{0.75 * G / p**2:.2f}", f"{predicted[-1]:.3f}"]
        lines.append([*numbers, ", ".join(f"{amplitude:.3f}" for amplitude in of_model)])
        advance()
    return table(["r", "p (rad/s)", "α", "R = 3 g/(4 p²) (m)", f"slender, at {between:g} Hz (g)",
                  "model with that α, at " + ", ".join(f"{frequency:g}" for frequency in PUBLISHED) + " Hz (g)"],
                 lines), f"{min(predicted):.2f} to {max(predicted):.2f}"
