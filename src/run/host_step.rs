//! Steps of another integrator: the equations to integrate, event indicators for transitions, and a check that no transition
//! was passed over.
//!
//! Such an integrator knows ẋ = f(x, t) of the phase, and event indicators: they are positive while the phase lasts, and a
//! root of one of them ends it. Many find no root, or not all of them: after an uplift θ starts at 0 as t³, a return within
//! the step shows no change of sign, steps are fixed. So each complete step is gone over once more by the engine, which
//! passes nothing over. If the engine finds a transition on the way, or if the integrator ended beyond a guard without one,
//! the engine's own motion from the start of the step counts.

use crate::engine::piece::Watch;
use crate::engine::sample::Sample;
use crate::engine::step::{Closed, Step};
use crate::engine::{AdvanceError, first};
use crate::mechanics::arc::Arc;
use crate::mechanics::instant::Second;
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::load::{LinearLoad, Load};
use crate::run::ground_motion::Elapsed;
use crate::structure::ground::{Footing, NONE_SETTLED, Settlements};
use crate::{Engine, Friction, GroundMotion, Motion, Phase, PressedPoints, Side, State};
use serde::{Deserialize, Serialize};

/// How many event indicators there are.
pub const INDICATORS: usize = 2;

pub use crate::engine::guard::BAND;

/// The most transitions that are applied at one instant. Points, ties and uplift are fewer.
const MOST_AT_ONCE: usize = 100;

impl<Q: Coordinates> Sample<'_, Q> {
    /// (u̇, ü, θ̇, θ̈) by the equations of the level and the phase; not numbers where these have no solution.
    pub fn state_rates(&self) -> State<Q> {
        let State { u_dot, theta_dot, .. } = self.level.admissible(self.motion.phase, self.motion.state);
        let Second { u_ddot, theta_ddot } = self.second();
        if self.motion.phase.properties().is_over {
            let none = Q::each(self.level.structure(), |_, _| 0.0);
            return State { u: none, u_dot: none, theta: 0.0, theta_dot: 0.0 };
        }
        State { u: u_dot, u_dot: u_ddot, theta: theta_dot, theta_dot: theta_ddot }
    }

    /// The rates at which the contact points settle for good, m/s.
    pub fn settling(&self) -> Settlements {
        let Motion { phase, state, settled, .. } = &self.motion;
        let Some(ground) = Q::foundation(self.level.structure()) else { return NONE_SETTLED };
        let motion = [state.u, state.u_dot].map(|of| of.footing(ground));
        ground.settling(phase.contact(), motion, settled.as_ref())
    }
}

/// Result of the check of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checked<Q: Coordinates = f64> {
    /// The motion at its end.
    pub motion: Motion<Q>,
    /// Whether that is the engine's own and not where the integrator ended.
    pub is_corrected: bool,
    /// Whether the step's end shows nothing of the transitions on its way.
    pub was_hidden: bool,
}

/// The last known instant of a motion that another integrator continues: the start, the end of a complete step, an event.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Checkpoint<Q: Coordinates = f64> {
    /// The motion.
    pub motion: Motion<Q>,
    /// Time since the start, on ground that follows a record.
    pub elapsed: Elapsed,
    /// Load beside the record at this instant.
    pub load: Load<Q>,
}

impl<Q: Coordinates> Checkpoint<Q> {
    /// Checks the step from here to where `engine` is now, under `load`, which came about linearly, and on `ground`. The engine
    /// stays where it is; transitions on the way are shown to `watch`.
    pub fn check(
        &self,
        engine: &mut Engine<Q>,
        ground: Option<&GroundMotion>,
        elapsed: Elapsed,
        load: Load<Q>,
        watch: &mut dyn Watch<Q>,
    ) -> Result<Checked<Q>, AdvanceError> {
        if self.motion.phase.properties().is_over {
            return Ok(Checked { motion: self.motion, is_corrected: false, was_hidden: false });
        }
        let end = *engine.motion();
        let now: LinearLoad<Q> = load.into();
        let now = ground.map_or(now, |ground| now.on_ground(ground.since(self.elapsed, elapsed)));
        let is_beyond = !engine.event_indicators(now.value).iter().all(|indicator| *indicator > 0.0);
        engine.set_motion(self.motion);
        let own = self.go_on(engine, ground, end.time - self.motion.time, load, watch);
        let own = own.map(|()| *engine.motion());
        engine.set_motion(end);
        let own = own?;
        let has_changed = own.transitions != self.motion.transitions;
        let is_corrected = has_changed || is_beyond;
        let time = if own.phase.properties().is_over { own.time } else { end.time };
        let (phase, mut state) = if is_corrected { (own.phase, own.state) } else { (end.phase, end.state) };
        if let Some(ground) = Q::foundation(engine.structure()) {
            let taken = own.state.u.footing(ground).taken; // the host does not integrate what the ground takes
            state.u.set_footing(ground, Footing { taken, ..state.u.footing(ground) });
        }
        let settled = if is_corrected { own.settled } else { end.settled };
        Ok(Checked {
            motion: Motion { time, phase, state, settled, ..own },
            is_corrected,
            was_hidden: has_changed && !is_beyond,
        })
    }

    /// The engine's own motion from here over `interval` (s).
    fn go_on(
        &self,
        engine: &mut Engine<Q>,
        ground: Option<&GroundMotion>,
        interval: f64,
        load: Load<Q>,
        watch: &mut dyn Watch<Q>,
    ) -> Result<(), AdvanceError> {
        if interval == 0.0 {
            return Ok(());
        }
        let slope =
            |from: f64, to: f64| Some((to - from) / interval).filter(|slope| slope.is_finite()).unwrap_or_default();
        let slope = Load {
            a_g: slope(self.load.a_g, load.a_g),
            F_t: Q::each(engine.structure(), |j, _| slope(self.load.F_t.of(j), load.F_t.of(j)))
                .beside(&load.F_t.plus(self.load.F_t, -1.0).times(slope(0.0, 1.0))),
            a_v: slope(self.load.a_v, load.a_v),
        };
        let load = LinearLoad { value: self.load, slope };
        match ground {
            Some(ground) => ground.advance(engine, &mut self.elapsed.clone(), interval, load, &mut (&mut (), watch)),
            None => engine.advance(interval, load, &mut (&mut (), watch)),
        }
        .map(|_| ())
    }
}

impl<Q: Coordinates> Engine<Q> {
    /// Event indicators: continuous, of order one, positive while the phase lasts under `load`. The first is for uplift in full contact and
    /// for impact while rocking. The second is for overturning, for dissipators that begin or cease to yield, and for friction.
    pub fn event_indicators(&self, load: Load<Q>) -> [f64; INDICATORS] {
        let now = self.sample(load);
        let mut indicators = [f64::INFINITY; INDICATORS];
        for guard in self.watched().map_or(&[][..], |watched| watched.guards) {
            let (place, value) = guard.indicator(&now);
            if value < indicators[place] || value.is_nan() {
                indicators[place] = value;
            }
        }
        indicators.map(|value| if value == f64::INFINITY { 1.0 } else { value })
    }

    /// Takes `state` from another integrator; what does not move in the present phase stays at rest. A base that sticks slides if it has a
    /// velocity, beyond what rounding leaves.
    pub fn set_state(&mut self, state: State<Q>) {
        let Sample { mut motion, level, .. } = self.sample(Load::NONE);
        let (mut phase, structure) = (motion.phase, level.structure());
        let x_dot = Q::foundation(structure).and_then(|ground| state.u_dot.slide(ground)).unwrap_or(0.0);
        let least = BAND * (structure.base().g * structure.base().B).sqrt();
        if let (Phase::OnGround(contact @ PressedPoints { friction: Friction::Sticks, .. }), true) =
            (&mut phase, x_dot.abs() > least)
        {
            contact.friction = Friction::Slides(Side::of(x_dot));
        }
        let state = level.admissible(phase, state);
        if let Some(ground) = Q::foundation(structure) {
            ground.hold(phase.contact(), state.u.footing(ground), motion.settled.as_mut());
        }
        self.set_motion(Motion { state, phase, ..motion });
    }

    /// Applies what is due at once under `load`: after a landing, at the start, or when a load jumps.
    pub fn transit_at_once<W: Watch<Q>>(&mut self, load: Load<Q>, watch: &mut W) {
        for _ in 0..MOST_AT_ONCE {
            let Some(closed) = self.due_at_once(load) else { return };
            self.set_motion(Motion { due: Some(closed), ..*self.motion() });
            self.transit(watch);
        }
    }

    /// Whether a transition is due at once under `load`.
    pub fn is_due(&self, load: Load<Q>) -> bool {
        self.due_at_once(load).is_some()
    }

    /// The guard that is closed from the start under `load`. On ground that gives, the search of a step decides that: within rounding of
    /// its root a guard goes where its rate points, and has to open first once its transition has been applied.
    fn due_at_once(&self, load: Load<Q>) -> Option<Closed> {
        let (now, watched) = (self.sample(load), self.watched()?);
        let Sample { motion: motion @ Motion { phase, state, .. }, level, .. } = &now;
        if let Phase::OnGround(contact) = *phase {
            let start = level.subject().start(*state, motion.kept(), load.into(), level.longest_step());
            let mut arc = Arc::default();
            level.series(*phase, &start, &mut arc);
            let side = now.motion.side();
            return first(
                watched,
                &mut Step { level: *level, side, contact, start: &start, arc: &arc, reach: 0.0, is_cut: false },
            );
        }
        let mut guards = watched.guards.iter().enumerate();
        guards.find_map(|(guard, of)| Some(Closed { guard: guard as u8, branch: of.closed(&now)? }))
    }
}
