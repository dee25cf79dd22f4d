"""Hosts that integrate the FMU by solvers of their own, good and bad, and what they make of a scene."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from host import PHASES, Instance, simulate
from scipy.integrate import DOP853
from sksundae.cvode import CVODE

from ..coupling.structure import unpacked

OUTPUTS = ["theta", "u", "phase", "transitions"]
SAMPLES_ARE_EVENTS = 1e-8  # tolerance up to which the FMU foresees the samples of a record as events
SAME_TIME = 1e-12  # s, closer than solvers tell apart


@dataclass(frozen=True)
class Scene:
    """A structure's FMU under a record."""

    name: str
    fmu: str
    record: tuple[tuple[str, str | float], ...]  # start values: which record, and how it is scaled
    end: float  # s
    interval: float  # s, between the instants that are compared

    @property
    def start_values(self) -> dict:
        return dict(self.record)


@dataclass(frozen=True)
class Result:
    rows: np.ndarray  # OUTPUTS over time
    hidden: int  # events of which the host's own step showed nothing

    @property
    def transitions(self) -> int:
        return int(self.rows["transitions"][-1])

    @property
    def depth(self) -> float:
        """How far below the ground it was, rad: theta of the wrong sign while rocking."""
        theta, phase = self.rows["theta"], self.rows["phase"]
        return max(np.max(np.where(phase == PHASES["rocking right"], -theta, 0)), np.max(np.where(phase == PHASES["rocking left"], theta, 0)))

    def error(self, exact: Result) -> float:
        """The largest error of theta and u up to where it ends, each relative to its peak; with the base down of u alone."""
        n, moving = len(self.rows), [name for name in ("theta", "u") if exact.rows[name].any()]
        return max(np.max(np.abs(self.rows[name] - exact.rows[name][:n])) / np.max(np.abs(exact.rows[name])) for name in moving)


def _simulate(scene: Scene, interval: float | None = None, **arguments) -> Result:
    """By fmpy's own loop."""
    interval = interval or scene.interval
    rows, messages = simulate(scene.fmu, stop_time=scene.end, output_interval=interval, output=OUTPUTS, record_events=False, **arguments)
    return Result(rows[:: round(scene.interval / interval)], sum("shows nothing of" in message.text for message in messages))


@cache
def co_simulation(scene: Scene, change: float = 0.0) -> Result:
    """The FMU by itself, the record multiplied by 1 + `change`."""
    scaled = scene.start_values | {"record_scale": scene.start_values.get("record_scale", 1.0) * (1 + change)}
    return _simulate(scene, fmi_type="CoSimulation", relative_tolerance=1e-12, start_values=scaled)


def fmpy_cvode(scene: Scene, tolerance: float) -> Result:
    """CVode as fmpy uses it: BDF, roots of the indicators, the step that is complete is the one between outputs."""
    return _simulate(scene, fmi_type="ModelExchange", solver="CVode", relative_tolerance=tolerance, start_values=scene.start_values)


def fmpy_euler(scene: Scene, step: float) -> Result:
    """Euler's method by fixed steps, which looks at the indicators after the step."""
    return _simulate(scene, step, fmi_type="ModelExchange", solver="Euler", step_size=step, start_values=scene.start_values)


class Model(Instance):
    """An instance as the equations that a solver asks for."""

    def __init__(self, fmu: str, tolerance: float, start_values: dict[str, str | float]):
        super().__init__(unpacked(fmu), "ModelExchange", logs=False)
        self.enter(tolerance, **start_values).slave.exitInitializationMode()

    def rates(self, time: float, states: np.ndarray, rates: np.ndarray) -> None:
        self.at(time, states)
        rates[:] = self.derivatives()

    def roots(self, time: float, states: np.ndarray, indicators: np.ndarray) -> None:
        self.at(time, states)
        indicators[:] = self.indicators()

    def nominals(self) -> np.ndarray:
        return np.array(self.vector("getNominalsOfContinuousStates", 4))

    def completed(self, time: float, states: np.ndarray) -> bool:
        """The solver's step to there is complete: whether the FMU asks for event mode."""
        self.at(time, states)
        return self.complete()[0]

    def enter_event_mode(self) -> None:
        self.slave.enterEventMode()

    def handle(self, _states) -> tuple[np.ndarray, bool, float]:
        """Handles an event: the states after it, whether the structure has overturned, and when the next event is."""
        has_ended, _, next_event = self.update()
        self.leave_event()
        return np.array(self.states()), has_ended, np.inf if next_event is None else next_event


@cache
def sundae(scene: Scene, tolerance: float, told: float | None = None) -> Result:
    """SUNDIALS' CVODE of scikit-sundae: Adams, roots of the indicators, and every step of the solver is completed. The FMU may be told of
    another tolerance."""
    model = Model(scene.fmu, told or tolerance, scene.start_values)
    return _result(scene, model, *cvode(model, tolerance, 2))


def cvode(system, tolerance: float, indicators: int, longest_step: float = 0.0) -> tuple:
    """SUNDIALS' CVODE (Adams) over the equations of a system, as `start` and `step` of `follow`; 0 leaves the steps (s) to it."""
    solver = CVODE(system.rates, method="Adams", rtol=tolerance, atol=tolerance * system.nominals(), max_step=longest_step,
                   eventsfn=lambda t, y, z: system.roots(t, y, z), num_events=indicators)

    def step(stop):
        found = solver.step(stop, method="onestep", tstop=stop)
        if not found.success:
            raise RuntimeError(f"CVODE towards t = {stop} s: {found.message}")
        return float(found.t), found.y.copy(), found.status == 2

    return solver.init_step, step


def dop853(scene: Scene, tolerance: float) -> Result:
    """scipy's DOP853, a Runge-Kutta method. A restart costs it nothing, so every sample is an event. The roots are left to
    the FMU, which goes over the step."""
    model = Model(scene.fmu, min(tolerance, SAMPLES_ARE_EVENTS), scene.start_values)
    atol = tolerance * model.nominals()
    solver, at, length = None, (0.0, np.array(model.states())), scene.interval

    def rates(t, x):
        found = np.empty_like(x)
        model.rates(t, x, found)
        return found

    def start(t, x):
        nonlocal solver, at
        solver, at = None, (t, x)

    def step(stop):
        nonlocal solver, at, length
        solver = solver or DOP853(rates, *at, stop, rtol=tolerance, atol=atol, first_step=min(length, stop - at[0]))
        message = solver.step()
        if solver.status == "failed":
            raise RuntimeError(f"DOP853 at t = {solver.t} s: {message}")
        at, is_cut = (solver.t, solver.y), solver.status == "finished"
        length = max(length, solver.h_abs) if is_cut else solver.h_abs
        solver = None if is_cut else solver
        return *at, False

    return _result(scene, model, start, step)


def follow(system, states, start, step, points):
    """Yields time and states at `points`, up to where the system ends. The solver goes on from where it is to `start`, one `step`
    up to where it is told to stop: time, states, and whether it found a root. `system.hidden` counts other events."""
    system.hidden, time = 0, float(points[0])
    states, has_ended, next_event = system.handle(states)
    start(time, states)
    yield time, states
    for point in points[1:]:
        while time < point - SAME_TIME and not has_ended:
            time, states, has_root = step(next_event if next_event < point - SAME_TIME else point)
            has_event = system.completed(time, states)
            if has_event or has_root or time > next_event - SAME_TIME:
                system.hidden += has_event and not has_root
                system.enter_event_mode()
                states, has_ended, next_event = system.handle(states)
                start(time, states)
        if time > point - SAME_TIME:
            yield time, states


def _result(scene: Scene, model: Model, start, step) -> Result:
    points = scene.interval * np.arange(round(scene.end / scene.interval) + 1)
    rows = [(time, *model.get(*OUTPUTS)) for time, _ in follow(model, None, start, step, points)]
    return Result(np.array(rows, dtype=[(name, float) for name in ("time", *OUTPUTS)]), model.hidden)
