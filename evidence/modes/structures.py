"""The structures of docs/evidence/modes.md: masses on a base, and their modes in full contact."""

from dataclasses import dataclass
from functools import cached_property

import flexible_rocking as fr
import numpy as np
from scipy.linalg import eigh


@dataclass(frozen=True)
class Building:
    """Masses m (kg) at heights h (m) with the stiffness matrix K (N/m), on a base (SI)."""

    m: np.ndarray
    h: np.ndarray
    K: np.ndarray
    zeta: float
    base: dict[str, float]

    @cached_property
    def modes(self) -> tuple[np.ndarray, np.ndarray]:
        """Circular frequencies, and shapes of modal mass 1 (a column for each mode)."""
        squares, phi = eigh(self.K, np.diag(self.m))
        return np.sqrt(squares), phi

    @cached_property
    def structure(self) -> fr.Structure:
        return fr.Structure.from_matrices(self.m, self.h, self.K, zeta=self.zeta, **self.base)


def shear(m: list[float], h: list[float], k: list[float], **base: float) -> Building:
    """A building whose storeys have these stiffnesses."""
    K = np.diag(np.array(k) + np.append(k[1:], 0)) - np.diag(k[1:], 1) - np.diag(k[1:], -1)
    return Building(np.array(m), np.array(h), K, 0.03, base)


def cantilever(m: list[float], h: list[float], EI: float, **base: float) -> Building:
    """A wall or a column that bends."""
    low, high = np.minimum.outer(h, h), np.maximum.outer(h, h)
    return Building(np.array(m), np.array(h), np.linalg.inv(low**2 * (3 * high - low) / (6 * EI)), 0.03, base)


BUILDINGS = {
    "stiff: a wall of 4 storeys": cantilever([90e3] * 4, [3.0, 6.0, 9.0, 12.0], 2.5e10, m0=60e3, J0=2e5, B=2.0),
    "slender: a pier of 24 m": cantilever([50e3] * 5 + [6e5], [4.0, 8.0, 12.0, 16.0, 20.0, 24.0], 1.2e11, m0=3e5, J0=2e6, B=3.0),
    "tall: a frame of 12 storeys": shear([60e3] * 12, [3.2 * i for i in range(1, 13)], [1.2e8 * (1.05 - 0.05 * i) for i in range(1, 13)],
                                         m0=1.5e5, J0=2e6, B=3.5),
}
