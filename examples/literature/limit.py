"""The limit of a vanishing slenderness: a quantity of blocks, each of half the tan alpha of the one before."""

from dataclasses import dataclass

import numpy as np

TANGENTS = [0.08, 0.04, 0.02, 0.01]  # tan alpha


@dataclass(frozen=True)
class Limit:
    """A quantity at TANGENTS beside its closed form at 0."""

    closed_form: float
    values: list[float]

    @property
    def differences(self) -> np.ndarray:
        """From the closed form, over it."""
        return np.array(self.values) / self.closed_form - 1

    @property
    def rate(self) -> float:
        """The power of tan alpha by which the difference vanishes: a straight line through the logarithms."""
        return np.polyfit(np.log(TANGENTS), np.log(np.abs(self.differences)), 1)[0]

    @property
    def extrapolated(self) -> float:
        """At tan alpha = 0 by Richardson, for a series in powers of tan^2 alpha."""
        column = list(self.values)
        for order in range(1, len(TANGENTS)):
            column = [(4**order * finer - coarser) / (4**order - 1) for coarser, finer in zip(column, column[1:])]
        return column[0]

    @property
    def error(self) -> float:
        """Of the extrapolated value, over the closed form."""
        return abs(self.extrapolated / self.closed_form - 1)
