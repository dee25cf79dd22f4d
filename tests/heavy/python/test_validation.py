"""The parts of the page on the paper. `make evidence` compares the page."""

import numpy as np
import pytest
from evidence.paper import modal_components
from evidence.paper.specimens import half_cycles


def test_half_cycles_of_a_decaying_cosine():
    time = np.linspace(0, 2, 4001)
    cycles = half_cycles(time, np.exp(-time) * np.cos(2 * np.pi * 5 * time))
    assert cycles.frequency == pytest.approx(np.full(19, 5.0), rel=1e-6)
    peaks = np.arange(1, 20) / 10 - np.arctan(1 / (10 * np.pi)) / (10 * np.pi)
    assert cycles.amplitude == pytest.approx(np.exp(-peaks) * np.cos(np.arctan(1 / (10 * np.pi))), rel=1e-5)


def test_decomposition_of_a_known_signal():
    time = np.linspace(0, 1, 1001)
    smooth, oscillation = 20 * np.sin(np.pi * time), 0.5 * np.sin(2 * np.pi * 30 * time)
    found_smooth, found_oscillation = modal_components.decompose(time, smooth + oscillation)
    inside = slice(200, 800)
    assert np.max(np.abs(found_smooth - smooth)[inside]) < 0.03
    assert np.max(np.abs(found_oscillation - oscillation)[inside]) < 0.03
    assert modal_components.dominant_frequency(time, found_oscillation) == pytest.approx(30, rel=2e-3)
