"""The Pacoima Dam scene: what the engine gives by itself, and what hosts are compared with that pass a_g on."""

import functools

import numpy as np
from evidence.scenes import pacoima_dam
from host import Fmu, output

OUTPUTS = ("theta", "u", "a_t")
STEPS = (0.5e-3, 2e-3, 10e-3)  # s, communication steps of the hosts
END = 3.99  # s, a multiple of each of them
TIME, A_G = pacoima_dam()
STEP = TIME[1]


def instants(step: float) -> np.ndarray:
    """The communication points of a host with this step."""
    return np.arange(round(END / step) + 1) * step


@functools.cache
def engine(exporter, preset: str, record) -> np.ndarray:
    """OUTPUTS at the shortest of STEPS from the command line, at a tolerance of 1e-12."""
    printed = output(exporter, "--quiet", "simulate", "--preset", preset, "--record", record, "--tolerance", "1e-12",
                     "--interval", min(STEPS), "--duration", END, "-o", "-")
    table = np.genfromtxt(printed.splitlines(), delimiter=",", names=True)
    return np.column_stack([table[name] for name in ("thetarad", "um", "a_tms2")])


@functools.cache
def linear(fmu: Fmu) -> np.ndarray:
    """OUTPUTS at every sample under a ground acceleration that is linear between samples."""
    with fmu.start() as instance:
        return rows(instance.follow(TIME, A_G, OUTPUTS))


def stepped(read, step, inputs) -> np.ndarray:
    """What a host can `read` before the first step and after a `step` of each of `inputs`."""
    samples = [read()]
    for value in inputs:
        step(value)
        samples.append(read())
    return np.array(samples)


@functools.cache
def held(fmu: Fmu, delay: int = 0) -> np.ndarray:
    """OUTPUTS at every sample under a ground acceleration that is held over each, and comes `delay` samples late."""
    late = np.concatenate([np.zeros(delay), A_G])[:len(A_G) - 1]
    with fmu.start() as instance:

        def step(to):
            until, a_g = to
            instance.input("a_g", a_g)
            instance.step(until)

        return stepped(lambda: instance.reals(OUTPUTS), step, zip(TIME[1:], late))


def rows(table: np.ndarray) -> np.ndarray:
    """OUTPUTS of a structured array as columns."""
    return np.column_stack([table[name] for name in OUTPUTS])


def distance(found: np.ndarray, expected: np.ndarray) -> float:
    """The largest error of the outputs, each relative to its peak."""
    assert found.shape == expected.shape
    return np.max(np.max(np.abs(found - expected), axis=0) / np.max(np.abs(expected), axis=0))
