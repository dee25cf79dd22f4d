"""The bridge as one system of equations: piers in model exchange, the deck's own equations, one solver for all of them.

There is no communication step and no master. SUNDIALS' CVODE integrates ten states, x and x_dot of the deck and u, u_dot,
theta, theta_dot of both piers, and finds the roots of their event indicators. At an event of one pier the forces on all of
them may jump: all handle it together, and the solver starts anew.
"""

import monolithic
import numpy as np

from ..model_exchange.hosts import Model, cvode, follow
from ..page import table
from ..scenes import PACOIMA_DAM, pacoima_dam
from . import convergence
from .bridge import deck
from .swaying_mass import SwayingMass

DECK, STATES, INDICATORS = 2, 4, 2  # states of the deck; of every pier states and event indicators
TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10)
SETTINGS = [*((tolerance, 0.0) for tolerance in TOLERANCES), (1e-10, 0.2e-3)]  # the latter the longest step, s; 0: any


class OneSystem:
    """Piers and deck as the equations that a solver asks for; the state is x, x_dot, then every pier's."""

    def __init__(self, piers: list[Model], deck: SwayingMass):
        self.piers, self.deck = piers, deck
        self.evaluations, self.steps = 0, 0

    def parts(self, y):
        """The piers' parts of the state, or of its rates."""
        return [y[i:i + STATES] for i in range(DECK, len(y), STATES)]

    def at(self, t: float, y) -> list[float]:
        """Brings every pier there; the bearings' forces."""
        for pier, part in zip(self.piers, self.parts(y)):
            pier.at(t, part)
        return self.push(y)

    def push(self, y) -> list[float]:
        """Gives every pier its bearing's force, where it stands."""
        forces = []
        for pier in self.piers:
            delta_t, v_t = pier.reals(("delta_t", "v_t"))
            forces.append((self.deck.k * (y[0] - delta_t) + self.deck.c * (y[1] - v_t)) / len(self.piers))
            pier.set(F_t=forces[-1])
        return forces

    def rates(self, t: float, y, rates) -> None:
        self.evaluations += 1
        forces = self.at(t, y)
        rates[:DECK] = y[1], -self.piers[0].get("a_ground") - sum(forces) / self.deck.M
        for pier, part, of_pier in zip(self.piers, self.parts(y), self.parts(rates)):
            pier.rates(t, part, of_pier)

    def roots(self, t: float, y, indicators) -> None:
        self.at(t, y)
        for pier, part, of_pier in zip(self.piers, self.parts(y), np.split(indicators, len(self.piers))):
            pier.roots(t, part, of_pier)

    def nominals(self) -> np.ndarray:
        """The magnitudes of the states; the deck's are like its piers'."""
        of_piers = np.array([pier.nominals() for pier in self.piers])
        return np.concatenate([of_piers[:, :DECK].max(axis=0), of_piers.ravel()])

    def completed(self, t: float, y) -> bool:
        """The solver's step to there is complete: whether a pier asks for event mode."""
        self.steps += 1
        self.at(t, y)
        return any([pier.complete()[0] for pier in self.piers])

    def enter_event_mode(self) -> None:
        for pier in self.piers:
            pier.enter_event_mode()

    def handle(self, y) -> tuple[np.ndarray, bool, float]:
        """Handles an event: the state after it, whether a pier has overturned, and when the next event is."""
        for pier in self.piers:
            pier.update()
        self.push(y)  # where a velocity has jumped, so has a dashpot's force
        states, have_ended, next_events = zip(*(pier.handle(y) for pier in self.piers))
        return np.concatenate([y[:DECK], *states]), any(have_ended), min(next_events)

    def transitions(self) -> int:
        return sum(pier.get("transitions") for pier in self.piers)


def response(fmus, of_deck, tolerance: float, time, longest_step: float = 0.0) -> tuple[np.ndarray, OneSystem]:
    """From rest, the deck's x, then theta and u of every pier at `time`; and the system, which has counted. 0 leaves the steps (s) to the solver.

    A pier takes its force to be a line over a step with a transition in it: an error of third order in the step.
    """
    system = OneSystem([Model(fmu, tolerance, PACOIMA_DAM) for fmu in fmus], of_deck)
    solver = cvode(system, tolerance, INDICATORS * len(fmus), longest_step)
    rows = np.array([y for _, y in follow(system, np.zeros(DECK + STATES * len(fmus)), *solver, time)])
    if len(rows) < len(time):
        raise RuntimeError("a pier overturned")
    return rows[:, [0, 4, 2, 8, 6]], system


def errors(fmus) -> str:
    time, a_g = pacoima_dam()
    expected = convergence.columns(monolithic.integrate(convergence.monolithic_bridge(deck()), time, a_g))
    rows = []
    for tolerance, longest_step in SETTINGS:
        found, system = response(fmus, deck(), tolerance, time, longest_step)
        limit = f", steps of at most {1e3 * longest_step:g} ms" if longest_step else ""
        rows.append([f"{tolerance:g}{limit}", f"{convergence.error(found, expected):.1e}", system.evaluations, system.steps])
    return table(["tolerance", "error", "evaluations of each pier", "steps of the solver"], rows)
