//! Levels of detail: the equations by which a structure moves, and what they make of it. The same code finds and applies transitions
//! at all levels, with the same condition of uplift. A fixed base has no uplift.
//!
//! | level | equations | solved by |
//! |---|---|---|
//! | `auto` | 1, 5, 6 | exact flow in full contact, series while rocking |
//! | `nonlinear` | 1, 5, 6 | series throughout, each to the tolerance |
//! | `linear` | 1, 7, 8 | exact flow, series on steps that may hold a transition |
//! | `modal` | 1, 11, 18 | likewise |
//! | `rigid` | 6 with u = 0 | series |
//! | `fixed_base` | 1, no uplift | exact flow |
//!
//! If a structure is restrained or shaken vertically, the equations of rocking have more terms. They are then solved by series
//! alone, `linear` by those of a base with one mode, and there is no level `modal`.

pub mod detail;
pub mod full_contact;
pub(crate) mod level;
mod linear;
pub(crate) mod modes;
pub mod nonlinear;
pub(crate) mod on_ground;
pub(crate) mod oscillator;
pub(crate) mod sliding;
pub(crate) mod start;
pub mod uplift;

use crate::levels::full_contact::ExactContact;
use crate::levels::level::{ElasticRocking, Level, LevelSubject, most_of_swings};
use crate::levels::linear::LinearRocking;
use crate::levels::modes::ManyModes;
use crate::levels::nonlinear::NonlinearRocking;
use crate::levels::on_ground::OnGround;
use crate::levels::oscillator::Oscillator;
use crate::levels::start::Start;
use crate::levels::uplift::Liftable;
use crate::mechanics::arc::Arc;
use crate::mechanics::restraint::Angles;
use crate::structure::quantity::{Refused, ensure};
use crate::{Detail, Modes, OneMass, Phase, State, Structure};
use std::cell::RefCell;
use wide::f64x4;

impl Detail {
    /// The level of a `structure` of one mass, in steps of this `local_error`; `is_vertical` if the ground may move vertically.
    pub(crate) fn level_of_one(
        self,
        structure: Structure,
        local_error: f64,
        is_vertical: bool,
    ) -> Result<Box<dyn Level>, Refused> {
        let one = *structure.of_mode()?;
        let is_tied = structure.base().is_restrained() || is_vertical;
        let subject = LevelSubject { structure, local_error, is_tied, detail: self, first: RefCell::default() };
        let contact = ExactContact::new(Oscillator::new(one.omega_fc, one.parameters().zeta_fc));
        Ok(match self {
            Detail::Auto | Detail::Nonlinear | Detail::FixedBase => {
                let contact = (self != Detail::Nonlinear).then_some(contact);
                let rocking = NonlinearRocking::new(one, is_tied);
                Box::new(Elastic { subject, one, contact, rocking })
            }
            Detail::Linear if is_tied => Box::new(ManyModes::<f64>::new(subject)),
            Detail::Modal if is_tied => {
                return Err(Refused::by(
                    "detail = modal has no modes of a structure that is restrained or shaken vertically, whose equations change with \
                     time and with what yields: choose linear, or set a_v and the numbers of tendon and dissipators to 0",
                ));
            }
            Detail::Linear | Detail::Modal => {
                let rocking =
                    if self == Detail::Linear { LinearRocking::new(&one) } else { LinearRocking::modal(&one) };
                Box::new(Elastic { subject, one, contact: Some(contact), rocking })
            }
            Detail::Rigid => {
                let structure = subject.structure.shown_rigid();
                Box::new(ManyModes::<f64>::new(LevelSubject { structure, ..subject }))
            }
        })
    }

    /// The level of any `structure`, which moves in a coordinate for each of its modes.
    pub(crate) fn level_of_modes(
        self,
        structure: Structure,
        local_error: f64,
        is_vertical: bool,
    ) -> Result<Box<dyn Level<Modes>>, Refused> {
        ensure(structure.foundation().is_none() || !matches!(self, Detail::Modal | Detail::Linear), || {
            let name = self.name();
            format!(
                "detail = {name} has no ground that gives: choose auto, nonlinear, rigid or fixed_base, or leave [ground] out"
            )
        })?;
        ensure(self != Detail::Modal, || {
            let name = self.name();
            format!(
                "detail = {name} moves structures of one mass alone: choose auto, nonlinear, linear, rigid or fixed_base"
            )
        })?;
        let structure = structure.moved_at(self);
        let is_tied = structure.base().is_restrained() || is_vertical;
        let subject = LevelSubject { structure, local_error, is_tied, detail: self, first: RefCell::default() };
        match self {
            _ if subject.structure.foundation().is_none() => Ok(Box::new(ManyModes::<Modes>::new(subject))),
            _ if subject.structure.modes().len() <= 1 => Ok(Box::new(OnGround::<f64>::new(subject))),
            _ => Ok(Box::new(OnGround::<f64x4>::new(subject))),
        }
    }
}

/// A level with an elastic strut: by exact flow in full contact where there is one, otherwise by series.
#[derive(Clone, Debug)]
pub(crate) struct Elastic<Rocking> {
    subject: LevelSubject,
    pub one: OneMass,
    pub contact: Option<ExactContact>,
    pub rocking: Rocking,
}

impl<Rocking: ElasticRocking + Clone + Send + 'static> Level for Elastic<Rocking> {
    fn subject(&self) -> &LevelSubject {
        &self.subject
    }

    fn boxed(&self) -> Box<dyn Level> {
        Box::new(self.clone())
    }

    fn leap(&self, phase: Phase, start: &Start) -> Option<State> {
        match phase {
            Phase::FullContact => {
                let (contact, one) = (self.contact()?, &self.one);
                let hold = match self.liftable() {
                    None => f64::INFINITY,
                    Some(_) if !self.subject.is_tied => one.u_cr, // every leap asks
                    Some(liftable) => liftable.least_hold(start) / (one.parameters().H * one.k),
                };
                full_contact::leap(contact, start, hold, |_| 1.0)
            }
            Phase::Rocking(side) => self.rocking.leap(side, start),
            _ => None,
        }
    }

    #[inline(always)]
    fn contact(&self) -> Option<&[ExactContact]> {
        self.contact.as_ref().map(std::slice::from_ref)
    }

    fn most(&self, phase: Phase, start: &Start, end: &State) -> State {
        match self.swings(phase, start) {
            Some(swings) => most_of_swings(&self.subject.structure, start, end, &swings),
            None => self.rocking.most(&self.subject.structure, phase.side(), start, end),
        }
    }

    #[inline(always)]
    fn series(&self, phase: Phase, start: &Start, arc: &mut Arc) {
        match phase {
            Phase::Rocking(side) => self.rocking.series(side, start, arc),
            Phase::FullContact | Phase::Overturned(_) | Phase::OnGround(_) => {
                full_contact::series(&self.one, start, arc)
            }
        }
    }

    fn is_singular(&self, phase: Phase, state: &State) -> bool {
        matches!(phase, Phase::Rocking(side) if self.rocking.is_singular(side, state))
    }

    #[inline(always)]
    fn liftable(&self) -> Option<Liftable<'_>> {
        let detail = self.subject.detail;
        detail.has_uplift().then(|| Liftable::of_one(&self.one, self.rocking.lean(), detail.angles() == Angles::Small))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Parameters, Ramp, Side};
    use proptest::prelude::*;

    /// Steep loads, white noise at 0.21 ms, leave an exact flow the digits that a series has: 1e-12 of the peaks of u̇ and
    /// θ̇ after a thousand leaps.
    #[test]
    fn exact_flows_keep_their_digits_under_steep_loads() {
        let parameters = Parameters { H: 30.3, B: 5.11, f_fc: 48.2, ..Parameters::MCMANUS };
        let structure = OneMass::new(parameters).unwrap();
        let rocking = State { u: 1e-5, u_dot: 0.01, theta: 0.1, theta_dot: 0.02 };
        let down = State { theta: 0.0, theta_dot: 0.0, ..rocking };
        for (detail, phase, mut state) in [
            (Detail::Modal, Phase::Rocking(Side::Right), rocking),
            (Detail::Linear, Phase::Rocking(Side::Right), rocking),
            (Detail::FixedBase, Phase::FullContact, down),
        ] {
            let level = detail.level_of_one(structure.into(), 1e-9, false).unwrap();
            let (mut expected, mut arc) = (state, Arc::default());
            let (mut u_dot, mut theta_dot) = (0.0_f64, 0.0_f64);
            let random = &mut fastrand::Rng::with_seed(1);
            let noise: Vec<_> = (0..1001).map(|_| 40.0 * random.f64() - 20.0).collect();
            for (k, pair) in noise.windows(2).enumerate() {
                let a_g = Ramp { value: pair[0], slope: (pair[1] - pair[0]) / 2.1e-4 };
                let start =
                    |state| Start { state, a_g, a_top: a_g, interval: 2.1e-4, local_error: 1e-17, ..Start::default() };
                state = level.leap(phase, &start(state)).unwrap_or_else(|| panic!("{detail:?} at {k}"));
                level.series(phase, &start(expected), &mut arc);
                expected = arc.end();
                (u_dot, theta_dot) = (u_dot.max(expected.u_dot.abs()), theta_dot.max(expected.theta_dot.abs()));
            }
            let off = (state.u_dot - expected.u_dot).abs() / u_dot;
            assert!(off < 1e-12, "{detail:?}: u_dot is off by {off:e}");
            let off = (state.theta_dot - expected.theta_dot).abs();
            assert!(off <= 1e-12 * theta_dot, "{detail:?}: theta_dot is off by {off:e} of {theta_dot:e}");
        }
    }

    proptest! {
        /// A leap while rocking ends where the series does, and is refused wherever the series comes back to the ground.
        #[test]
        fn a_leap_agrees_with_the_series_and_never_passes_an_impact(
            detail in prop_oneof![Just(Detail::Linear), Just(Detail::Modal)], s in prop_oneof![Just(1.0), Just(-1.0)],
            u in -4e-3..4e-3f64, u_dot in -0.4..0.4f64, theta in 1e-4..0.05f64, theta_dot in -1.0..1.0f64,
            value in -5.0..5.0f64, slope in -300.0..300.0f64, interval in 1e-4..0.02f64, zeta_fc in 0.0..0.2f64,
        ) {
            let structure = OneMass::new(Parameters { zeta_fc, ..Parameters::MCMANUS }).unwrap();
            let (level, phase) = (detail.level_of_one(structure.into(), 1e-15, false).unwrap(), Phase::Rocking(Side::of(s)));
            let a_g = Ramp { value, slope };
            let state = State { u, u_dot, theta: s * theta, theta_dot };
            let start = Start { state, a_g, a_top: a_g, interval, local_error: 1e-15, ..Start::default() };
            let mut arc = Arc::default();
            level.series(phase, &start, &mut arc);
            prop_assert_eq!(arc.reach, 1.0);
            let lowest = (0..=1000).map(|i| s * arc.at(f64::from(i) / 1000.0).theta).fold(1.0, f64::min);
            if let Some(end) = level.leap(phase, &start) {
                prop_assert!(lowest > 0.0);
                let most = level.most(phase, &start, &end);
                for i in 0..=20 {
                    let state = arc.at(f64::from(i) / 20.0);
                    let is_within = state.components().iter().zip(most.components()).all(|(value, most)| value.abs() <= most * (1.0 + 1e-9));
                    prop_assert!(is_within, "{state:?} {most:?}");
                }
                let expected = arc.end();
                prop_assert!((end.theta - expected.theta).abs() < 1e-14);
                prop_assert!((end.theta_dot - expected.theta_dot).abs() < 1e-12);
                prop_assert!((end.u - expected.u).abs() < 1e-14);
                prop_assert!((end.u_dot - expected.u_dot).abs() < 1e-12);
            } else {
                prop_assert!(lowest < 0.03);
            }
        }
    }
}
