"""The Pacoima Dam scene through fmpy: what the other hosts are compared with."""

import functools

import numpy as np
from first_run import pacoima_dam
from host import Fmu

TIME, A_G = pacoima_dam()
STEP = TIME[1]
OUTPUTS = ("theta", "u", "a_t")


@functools.cache
def linear(fmu: Fmu) -> np.ndarray:
    """OUTPUTS at every sample under a ground acceleration that is linear between samples."""
    with fmu.start() as instance:
        return rows(instance.follow(TIME, A_G, OUTPUTS))


@functools.cache
def held(fmu: Fmu, delay: int = 0) -> np.ndarray:
    """OUTPUTS at every sample under a ground acceleration that is held over each, and comes `delay` samples late."""
    late = np.concatenate([np.zeros(delay), A_G[: len(A_G) - delay]])
    with fmu.start() as instance:
        samples = [instance.reals(OUTPUTS)]
        for until, a_g in zip(TIME[1:], late):
            instance.load(a_g)
            instance.step(until)
            samples.append(instance.reals(OUTPUTS))
    return np.array(samples)


def write_record(path, time=TIME, a_g=A_G):
    """A CSV file of time and ground acceleration, to the last digit."""
    np.savetxt(path, np.column_stack([time, a_g]), "%.17g", delimiter=",", header="time,a_g", comments="")


def rows(table: np.ndarray) -> np.ndarray:
    """OUTPUTS of a structured array as columns."""
    return np.column_stack([table[name] for name in OUTPUTS])


def distance(found: np.ndarray, expected: np.ndarray) -> float:
    """The largest error of the outputs, each relative to its peak."""
    assert found.shape == expected.shape
    return np.max(np.max(np.abs(found - expected), axis=0) / np.max(np.abs(expected), axis=0))
