"""The Pacoima Dam scene: what the engine gives by itself, and what hosts are compared with that pass a_g on."""

import functools
import subprocess

import numpy as np
from host import Fmu

from evidence.scenes import pacoima_dam

OUTPUTS = ("theta", "u", "a_t")
STEPS = (0.5e-3, 2e-3, 10e-3)  # s, communication steps of the hosts
END = 3.99  # s, a multiple of each of them


TIME, A_G = pacoima_dam()
STEP = TIME[1]


def write_record(path, time=TIME, a_g=A_G):
    """A CSV file of time and ground acceleration, to the last digit."""
    np.savetxt(path, np.column_stack([time, a_g]), "%.17g", delimiter=",", header="time,a_g", comments="")


def instants(step: float) -> np.ndarray:
    """The communication points of a host with this step."""
    return np.arange(round(END / step) + 1) * step


@functools.cache
def engine(exporter, preset: str, record) -> np.ndarray:
    """OUTPUTS at the shortest of STEPS from the command line, at a tolerance of 1e-12."""
    command = [exporter, "simulate", "--preset", preset, "--record", record, "--tolerance", "1e-12",
               "--interval", str(min(STEPS)), "--duration", str(END), "-o", "-"]
    printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    table = np.genfromtxt(printed.splitlines(), delimiter=",", names=True)
    return np.column_stack([table[name] for name in ("thetarad", "um", "a_tms2")])


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
            instance.input("a_g", a_g)
            instance.step(until)
            samples.append(instance.reals(OUTPUTS))
    return np.array(samples)


def rows(table: np.ndarray) -> np.ndarray:
    """OUTPUTS of a structured array as columns."""
    return np.column_stack([table[name] for name in OUTPUTS])


def distance(found: np.ndarray, expected: np.ndarray) -> float:
    """The largest error of the outputs, each relative to its peak."""
    assert found.shape == expected.shape
    return np.max(np.max(np.abs(found - expected), axis=0) / np.max(np.abs(expected), axis=0))
