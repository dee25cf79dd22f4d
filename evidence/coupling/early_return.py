"""The bridge of piers in FMI 3.0: a step ends at a transition by itself, where FMI 2.0 leaves a master to halve it.

A pier comes back from a step early, at the instant of its transition, and applies it when it is told to. How long a step
is thus depends on the forces in it, as the forces do: both are found by the same iteration.
"""

import weakref

import numpy as np

from .bridge import Bridge
from .masters import MOST_SWEEPS, TOLERANCE, Diverged
from .structure import Structure, unpacked

SLIVER = 1e-12  # s; what is left of a step that is not worth another


class Pier(Structure):
    """A structure in FMI 3.0 that hands its transitions over."""

    def __init__(self, fmu: str):
        self.line_end, self.time, self.is_transition_due = [0.0, 0.0], 0.0, False
        owner = weakref.proxy(self)  # the instance must not keep its owner

        def at_the_end_of_the_step(_environment, _time, *_):
            owner.set(owner.line_end)

        inputs = ["a_g", "F_t"]
        super().__init__(fmu, inputs, ["delta_t", "v_t"], eventModeUsed=True, earlyReturnAllowed=True,
                         intermediateUpdate=at_the_end_of_the_step, requiredIntermediateVariables=unpacked(fmu).references(inputs))

    def set(self, values) -> None:
        self.instance.set_reals(**dict(zip(self.inputs, values)))

    def step(self, t: float, h: float, line) -> tuple[float, ...]:
        """The outputs at the end of the step under `line`, the inputs at its start and at its end, or where it came to a
        transition, just before it."""
        start, self.line_end = line
        self.set(start)
        self.is_transition_due, _, _, self.time = self.instance.slave.doStep(t, h)
        return self.read(*self.outputs)

    def transit(self) -> None:
        """Applies the transition that is due."""
        self.instance.event()
        self.is_transition_due = False


class EventBridge(Bridge):
    """The bridge of such piers."""

    def first_until_transition(self, t, h, reach, w, start):
        """Advances the piers over at most `h` under forces that are linear from t to t + `reach` and beyond. If another pier comes
        to a transition before, a pier starts again from `start`. Their lines, and how long the step became."""
        a_g, ends = self.ground(t, h), w[0] + (w[1] - w[0]) * (h / reach)
        tops = [pier.step(t, h, list(zip(a_g, forces))) for pier, forces in zip(self.piers, np.transpose([w[0], ends]))]
        reached = min(min(pier.time for pier in self.piers) - t, h)
        for i, (pier, state) in enumerate(zip(self.piers, start[0])):
            if pier.time - t > reached and reached > 0:
                part = w[0, i] + (w[1, i] - w[0, i]) * (reached / reach)
                pier.restore(state)
                tops[i] = pier.step(t, reached, list(zip(self.ground(t, reached), (w[0, i], part))))
            elif reached == 0 and not pier.is_transition_due:
                pier.restore(state)
        return np.array([self.y[1], np.ravel(tops)]), reached

    def transit(self):
        for pier in self.piers:
            if pier.is_transition_due:
                pier.transit()
        tops = [pier.read("delta_t", "v_t") for pier in self.piers]
        self.y = np.array([self.y[0], np.ravel(tops)])


class EndedAtTransitions:
    """Steps that end at transitions, where an iteration finds the forces and the step's length at once."""

    def __init__(self):
        self.largest, self.steps = 1.0, 0

    def __call__(self, system, t, h, guess):
        end = t + h
        while h > SLIVER:
            with system.checkpoint() as start:
                taken = self.part(system, t, h, guess(system.w), start)
            if any(pier.is_transition_due for pier in system.piers):
                system.transit()
            t, h = t + taken, end - t - taken

    def part(self, system, t, h, w, start):
        """A step over at most `h`; how long it became."""
        reach = h
        self.steps += 1
        for _ in range(MOST_SWEEPS):
            y, reached = system.first_until_transition(t, h, reach, w, start)
            if reached == 0:
                return 0.0
            value = system.second(t, reached, y)
            residual, self.largest = np.max(np.abs(value - w)), max(self.largest, np.max(np.abs(value)))
            if abs(reached - reach) <= TOLERANCE * h and residual <= TOLERANCE * self.largest:
                system.y, system.w = y, value
                return reached
            w, reach = value, reached
            system.restore(start)
        raise Diverged(f"{MOST_SWEEPS} sweeps over the step of {h} s from {t} s leave a residual of {residual:.1e}")
