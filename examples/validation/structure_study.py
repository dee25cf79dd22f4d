"""Many structures under real records: peaks and frequencies from the FMU, demands and Eq 14 from the command line."""

import multiprocessing
import os
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from first_run import G
from scipy.stats import qmc

from .half_cycles import half_cycles
from .project import Project
from .records import Record, horizontal_records
from .rocking_frequency import effective_frequency
from .stepper import Stepper

SEED = 1971
RANGES = {  # of the Latin hypercube: lower, upper, whether evenly in the logarithm
    "B": (0.25, 5.0, True),  # m
    "H/B": (2.5, 8.0, False),
    "stiffness": (8.0, 60.0, True),  # omega_fc/sqrt(g/H); McManus 14, Evison 23
    "m0/m": (0.0, 1.0, False),
    "zeta_fc": (0.005, 0.05, False),
    "r": (0.85, 1.0, False),
    "release": (0.05, 0.85, False),  # theta_0/tan alpha_cg of the free vibration
}
TOLERANCE = 1e-8
STEPS_PER_VIBRATION = 8  # communication steps in a period 1/f_u
LARGE = 2.0  # amplitudes over u_cr from here on are compared with Eq 14


@dataclass(frozen=True)
class Structure:
    """One structure of the population."""

    parameters: dict[str, float]
    release: float  # theta_0/tan alpha_cg


@dataclass(frozen=True)
class Case:
    """One structure under one record."""

    structure: Structure
    record: str
    peak: float  # a_t, g
    ground: float  # first term of Eq 22, g
    step: float  # chi tan alpha_cg, g
    pga: float  # g
    one_minus_chi: float
    zeta_u: float
    transitions: int
    overturned: bool
    amplitude: float  # of the largest half cycle of delta_t, over H tan alpha_cg
    left_over: float  # part of a vibration that the half cycle before that of the peak leaves
    frequency_ratio: float  # of the largest half cycle over Eq 14; nan where it is too small or there is none

    @property
    def demand(self) -> float:
        """Eq 22 with C = 2, g."""
        return self.ground + 3 * self.step

    @property
    def amplification(self) -> float:
        """C with which Eq 22 would be the peak."""
        return (self.peak - self.ground) / self.step - 1


@dataclass(frozen=True)
class Results:
    """The whole study."""

    structures: int
    records: int
    cases: list[Case]  # that rocked and did not overturn
    overturned: int
    free_ratios: np.ndarray  # frequency after a release over Eq 14
    free_amplitudes: np.ndarray  # over H tan alpha_cg


def population(count: int) -> list[Structure]:
    """A Latin hypercube over RANGES, from a laboratory specimen to a tall pier; the mass itself scales out."""
    sample = qmc.LatinHypercube(len(RANGES), rng=SEED).random(count)
    structures = []
    for point in sample:
        value = {name: float(low * (high / low) ** x if logarithmic else low + (high - low) * x)
                 for (name, (low, high, logarithmic)), x in zip(RANGES.items(), point)}
        m, B = 1000.0, value["B"]
        m0, H = value["m0/m"] * m, value["H/B"] * B
        f_fc = value["stiffness"] * (G / H) ** 0.5 / (2 * np.pi)
        structures.append(Structure({"m": m, "m0": m0, "H": H, "B": B, "J0": m0 * B**2 / 3, "f_fc": f_fc,
                                     "zeta_fc": value["zeta_fc"], "r": value["r"]}, value["release"]))
    return structures


class Study:
    """What one process needs to run structures."""

    def __init__(self, project: Project, records: list[Record]):
        self.project = project
        self.records = records
        self.stepper = Stepper(project.fmu("mcmanus"), TOLERANCE)

    def run(self, number: int, structure: Structure) -> tuple[list[Case], float, float]:
        """The cases of one structure; its release's frequency over Eq 14 and amplitude."""
        file = self.project.folder / f"structure_{number}.toml"
        file.write_text("".join(f"{name} = {value!r}\n" for name, value in structure.parameters.items()))
        named = ("--parameters", file)
        derived = self.project.values("describe", *named)
        cases = [self._case(structure, named, derived, record) for record in self.records]
        return cases, *self._release(structure, named, derived)

    def _case(self, structure: Structure, named, derived: dict[str, float], record: Record) -> Case:
        per_sample = int(np.ceil(record.dt * derived["f_u"] * STEPS_PER_VIBRATION))
        steps = (len(record.a_g) - 1) * per_sample
        history = self.stepper.run(structure.parameters, record.dt / per_sample, steps, record.path)
        estimate = self.project.values("estimate", *named, "--record", record.path)
        reach = structure.parameters["H"] * np.tan(derived["alpha_cg"])
        amplitude, ratio, left_over = 0.0, np.nan, 0.0
        cycles = half_cycles(history.time, history.delta_t)
        if len(cycles.amplitude):
            largest = np.argmax(cycles.amplitude)
            amplitude = cycles.amplitude[largest] / reach
            if LARGE * derived["u_cr"] < cycles.amplitude[largest] < reach and not history.overturned:
                ratio = cycles.frequency[largest] / self._eq_14(named, amplitude)
            before_peak = np.searchsorted(cycles.first, history.peak_time / history.time[1], side="right") - 2
            if before_peak >= 0:
                damping = derived["zeta_u"] * 2 * np.pi * derived["f_u"]
                left_over = np.exp(-damping / (2 * cycles.frequency[before_peak]))
        return Case(structure, record.name, history.peak_acceleration / G, estimate["(1-chi) S_a"] / G,
                    estimate["chi g tan"] / G, estimate["PGA"] / G, 1 - derived["chi"], derived["zeta_u"],
                    history.transitions, history.overturned, amplitude, left_over, ratio)

    def _release(self, structure: Structure, named, derived: dict[str, float]) -> tuple[float, float]:
        """Of the first half cycle after a release at rest: frequency over Eq 14, amplitude over H tan alpha_cg."""
        tangent = np.tan(derived["alpha_cg"])
        quiet = derived["chi"] * derived["u_cr"]
        start = structure.parameters | {"theta_0": structure.release * tangent, "u_0": quiet}
        dt = min(1 / derived["f_u"] / STEPS_PER_VIBRATION, 1 / self._eq_14(named, structure.release) / 400)
        duration = 1.2 / self._eq_14(named, structure.release)
        history = self.stepper.run(start, dt, int(duration / dt) + 1)
        cycles = half_cycles(history.time, history.delta_t)
        amplitude = cycles.amplitude[0] / (structure.parameters["H"] * tangent)
        return cycles.frequency[0] / self._eq_14(named, amplitude), amplitude

    def _eq_14(self, named, amplitude: float) -> float:
        return effective_frequency(self.project, *named, amplitudes=np.array([amplitude]))[0]


_study: Study  # of a worker process


def _start(exporter: Path, folder: Path, records: list[Record]) -> None:
    global _study
    own = folder / str(os.getpid())
    own.mkdir()
    _study = Study(Project(exporter, own), records)


def _run(number: int, structure: Structure) -> tuple[list[Case], float, float]:
    return _study.run(number, structure)


def compute(project: Project, structures: list[Structure], advance: Callable[[], None]) -> Results:
    """Runs the study on all cores; `advance` is called after each structure."""
    records = horizontal_records()
    cases, ratios, amplitudes = [], [], []
    workers = len(os.sched_getaffinity(0))
    with ProcessPoolExecutor(workers, multiprocessing.get_context("spawn"), _start,
                             (project.exporter, project.folder, records)) as pool:
        for found, ratio, amplitude in pool.map(_run, range(len(structures)), structures):
            cases += found
            ratios.append(ratio)
            amplitudes.append(amplitude)
            advance()
    rocked = [case for case in cases if case.transitions and not case.overturned]
    return Results(len(structures), len(records), rocked, sum(case.overturned for case in cases), np.array(ratios),
                   np.array(amplitudes))
