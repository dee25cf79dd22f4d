//! A level of detail as the engine uses it: equations, uplift, and exact leaps where there are any.

use crate::levels::detail::Detail;
use crate::levels::full_contact::{self, ExactContact};
use crate::levels::start::{MIN_ORDER, Start};
use crate::levels::uplift::Liftable;
use crate::mechanics::arc::Arc;
use crate::mechanics::instant::{Instant, Second};
use crate::mechanics::lateral::{Coordinates, Lateral};
use crate::mechanics::load::{LinearLoad, Load};
use crate::mechanics::reactions::Reactions;
use crate::mechanics::restraint::{Dissipators, Kept, pulls};
use crate::numbers::{Angle, Real};
use crate::{Phase, Side, State, Structure};
use std::any::Any;
use std::cell::RefCell;
use std::fmt::{self, Debug};

/// The structure that a level moves, and how it is moved.
#[derive(Clone, Debug)]
pub(crate) struct LevelSubject<Q = f64> {
    pub structure: Structure,
    /// Truncation error that a step may have.
    pub local_error: f64,
    /// Whether the structure is restrained or shaken vertically: its equations of rocking then have more terms.
    pub is_tied: bool,
    /// The level of detail, with the angles at which the ties elongate.
    pub detail: Detail,
    /// Room for a series of which only the first terms count.
    pub first: RefCell<Box<Arc<Q>>>,
}

impl<Q: Coordinates> LevelSubject<Q> {
    /// The step of `interval` (s) from `state` under `load`.
    #[inline]
    pub(crate) fn start<'a>(
        &self,
        state: State<Q>,
        (dissipators, settled): Kept<'a>,
        load: LinearLoad<Q>,
        interval: f64,
    ) -> Start<'a, Q> {
        let (a_g, a_top, a_v) = (load.on_foundation(), load.on_top(&self.structure), load.upwards());
        Start { state, a_g, a_top, a_v, dissipators, settled, interval, local_error: self.local_error }
    }
}

/// The level of detail of a structure. The provided methods are those of an elastic strut. A level without a
/// [liftable](Level::liftable) structure has a fixed base.
#[allow(private_interfaces)] // the coordinates name the trait, and nobody else can use it
pub trait Level<Q: Coordinates = f64>: Send + Any {
    fn subject(&self) -> &LevelSubject<Q>;

    /// The same level again.
    fn boxed(&self) -> Box<dyn Level<Q>>;

    fn structure(&self) -> &Structure {
        &self.subject().structure
    }

    /// The state at the end of `start`, if it is known exactly and no transition can happen until then.
    fn leap(&self, _phase: Phase, _start: &Start<Q>) -> Option<State<Q>> {
        None
    }

    /// The longest step, s, of a level that never leaps.
    fn longest_step(&self) -> f64 {
        f64::INFINITY
    }

    /// The modes in full contact, if their exact flows are used.
    fn contact(&self) -> Option<&[ExactContact]> {
        None
    }

    /// Bounds of |u|, |u̇|, |ü| and |u⃛| of the vibration about the motion that follows the load, over a leap in full contact.
    fn swings(&self, phase: Phase, start: &Start<Q>) -> Option<[Q; 4]> {
        let modes = self.contact().filter(|_| phase.properties().is_down)?;
        Some(full_contact::swings(self.structure(), modes, start))
    }

    /// Bounds of the magnitudes of the state over a leap from `start` to `end`.
    fn most(&self, phase: Phase, start: &Start<Q>, end: &State<Q>) -> State<Q> {
        match self.swings(phase, start) {
            Some(swings) => most_of_swings(self.structure(), start, end, &swings),
            None => State::unbounded(self.structure()),
        }
    }

    /// Writes the motion from `start` in `phase` into `arc`.
    fn series(&self, phase: Phase, start: &Start<Q>, arc: &mut Arc<Q>);

    /// Whether the equations of rocking are about to have no solution.
    fn is_singular(&self, _phase: Phase, _state: &State<Q>) -> bool {
        false
    }

    /// The structure whose base can lift off; none if the base is fixed.
    fn liftable(&self) -> Option<Liftable<'_>> {
        None
    }

    /// Distance of a structure in full contact from uplift, and its side, as in [`Liftable::margin`].
    fn uplift_margin(&self, state: &State<Q>, load: Load<Q>, dissipators: &Dissipators) -> (f64, Side) {
        let a_top = load.on_modes(self.structure());
        self.liftable().map_or((1.0, Side::Right), |of| of.margin(state, [load.a_g, load.a_v], &a_top, dissipators))
    }

    /// Whether a structure in full contact in `state` stays there while nothing acts on it.
    fn stays_down(&self, state: &State<Q>, (dissipators, _): Kept) -> bool {
        self.liftable().is_none_or(|liftable| liftable.stays_down(state, dissipators))
    }

    /// `state`, with 0 for all that cannot move in `phase`.
    fn admissible(&self, phase: Phase, state: State<Q>) -> State<Q> {
        if phase.properties().is_down { State { theta: 0.0, theta_dot: 0.0, ..state } } else { state }
    }

    /// ü and θ̈ in `phase`, m/s² and rad/s²; not finite where the equations have no solution.
    fn accelerations(&self, phase: Phase, (state, load): (&State<Q>, Load<Q>), kept: Kept) -> Second<f64, Q> {
        let [second] = derivatives(self, phase, (state, kept, load.into()), &mut self.subject().first.borrow_mut());
        second
    }
}

impl<Q: Coordinates> Debug for dyn Level<Q> + '_ {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        self.subject().fmt(out)
    }
}

/// The part of `reactions` that the edges of the base carry at the instant `x`: all of it, unless the structure is restrained.
pub(crate) fn edges<N: Angle, Q: Lateral<N>>(
    x: &Instant<N, Q>,
    &LevelSubject { is_tied, detail, .. }: &LevelSubject<Q::Of>,
    dissipators: &Dissipators,
    reactions: Reactions<N>,
) -> Reactions<N> {
    if !is_tied {
        return reactions;
    }
    let [up, right, moment] = pulls(x, detail.angles(), dissipators);
    Reactions { R_h: reactions.R_h - right, R_v: reactions.R_v + up, R_m: reactions.R_m + moment }
}

/// How far a motion leaves its chord. A vibration about a line leaves it by at most twice the `vibration`. A motion whose second
/// derivative is at most M leaves it by at most M h²/8 over the time h: `bend` is M and h²/8.
#[inline(always)]
pub(crate) fn off_chord<N: Real>(vibration: N, bend: [N; 2]) -> N {
    (vibration.like(2.0) * vibration).min(bend[0] * bend[1])
}

/// Bound of the magnitude of a motion from `first` to `last`, as [`off_chord`] says.
#[inline(always)]
pub(crate) fn most_of_swing<N: Real>([first, last]: [N; 2], vibration: N, bend: [N; 2]) -> N {
    first.abs().max(last.abs()) + off_chord(vibration, bend)
}

/// Bounds of the magnitudes of the state over a leap in full contact from `start` to `end`, given bounds of the vibration.
#[inline]
pub(crate) fn most_of_swings<Q: Coordinates>(
    structure: &Structure,
    start: &Start<Q>,
    end: &State<Q>,
    [u, u_dot, u_ddot, jerk]: &[Q; 4],
) -> State<Q> {
    let per_bend = start.interval * start.interval / 8.0;
    let most = |first: &Q, last: &Q, vibration: &Q, bend: &Q| {
        Q::each(structure, |j, _| most_of_swing([first.of(j), last.of(j)], vibration.of(j), [bend.of(j), per_bend]))
    };
    State {
        u: most(&start.state.u, &end.u, u, u_ddot),
        u_dot: most(&start.state.u_dot, &end.u_dot, u_dot, jerk),
        theta: 0.0,
        theta_dot: 0.0,
    }
}

/// (ü, θ̈) in `phase` and, if two are asked for, (u⃛, θ⃛) from the first terms of the series of `level`, which it writes into `arc`.
pub(crate) fn derivatives<Q: Coordinates, const K: usize>(
    level: &(impl Level<Q> + ?Sized),
    phase: Phase,
    (state, kept, load): (&State<Q>, Kept, LinearLoad<Q>),
    arc: &mut Arc<Q>,
) -> [Second<f64, Q>; K] {
    let start = level.subject().start(*state, kept, load, 1.0);
    arc.spared = MIN_ORDER - K;
    level.series(phase, &Start { local_error: 1e100, ..start }, arc);
    std::array::from_fn(|i| {
        let (k, factorial) = (i + 1, [1.0, 2.0][i]);
        let derivative = |c: f64| factorial * c / arc.span.powi(k as i32);
        let u_ddot = Q::each(level.structure(), |j, _| derivative(arc.u_dot[k].of(j)));
        Second { u_ddot, theta_ddot: derivative(arc.theta_dot[k]) }
    })
}

/// Equations of rocking with an elastic strut.
pub(crate) trait ElasticRocking {
    fn leap(&self, _side: Side, _start: &Start) -> Option<State> {
        None
    }

    /// Bounds of the magnitudes of the state over such a leap to `end`.
    fn most(&self, structure: &Structure, _side: Side, _start: &Start, _end: &State) -> State {
        State::unbounded(structure)
    }

    fn series(&self, side: Side, start: &Start, arc: &mut Arc);

    fn is_singular(&self, _side: Side, _state: &State) -> bool {
        false
    }

    /// Factor of the moment that the displaced weight adds at the start of rocking.
    fn lean(&self) -> f64 {
        1.0
    }
}
