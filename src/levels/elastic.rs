//! The level of one mass on an elastic strut.

use crate::levels::first_uplift::Liftable;
use crate::levels::full_contact::{self, ExactContact};
#[cfg(feature = "lanes")]
use crate::levels::level::Leaping;
use crate::levels::level::{ElasticRocking, Level, Subject, most_of_swings};
use crate::levels::start::Start;
use crate::mechanics::arc::Arc;
use crate::mechanics::restraint::Angles;
#[cfg(feature = "lanes")]
use crate::mechanics::restraint::Dissipators;
use crate::mechanics::uplift::least_hold;
use crate::{OneMass, Phase, State};

/// A level with an elastic strut: by exact flow in full contact where there is one, otherwise by series.
#[derive(Clone, Debug)]
pub(crate) struct Elastic<Rocking> {
    pub subject: Subject,
    pub one: OneMass,
    pub contact: Option<ExactContact>,
    pub rocking: Rocking,
}

impl<Rocking: ElasticRocking> Elastic<Rocking> {
    /// The |u| (m) below which the base stays down over the interval of `start`, whatever pushes the top mass.
    #[inline(always)]
    fn least_displacement(&self, start: &Start) -> f64 {
        let one = &self.one;
        match self.subject.is_tied {
            _ if !Rocking::IS_POSSIBLE => f64::INFINITY,
            false => one.u_cr, // every leap asks
            true => {
                let hold = least_hold(one.base(), start.a_v, start.interval, start.dissipators);
                hold / (one.parameters().H * one.k)
            }
        }
    }
}

impl<Rocking: ElasticRocking + Clone + Send + 'static> Level for Elastic<Rocking> {
    fn subject(&self) -> &Subject {
        &self.subject
    }

    fn boxed(&self) -> Box<dyn Level> {
        Box::new(self.clone())
    }

    #[cfg(feature = "lanes")]
    fn as_any(&self) -> Option<&dyn std::any::Any> {
        Some(self)
    }

    fn leap(&self, phase: Phase, start: &Start) -> Option<State> {
        match phase {
            Phase::FullContact => self.contact.as_ref()?.leap(start, self.least_displacement(start)),
            Phase::Rocking(side) => self.rocking.leap(side, start),
            Phase::Overturned(_) | Phase::OnGround(_) => None,
        }
    }

    #[cfg(feature = "lanes")]
    fn leaping(&self, _dissipators: &Dissipators) -> Option<Leaping<'_>> {
        let modes = std::slice::from_ref(self.contact.as_ref()?);
        Some(Leaping { modes, moment: |_| 1.0, hold: self.one.u_cr })
    }

    fn swings(&self, phase: Phase, start: &Start) -> Option<[f64; 4]> {
        self.contact.as_ref().filter(|_| phase == Phase::FullContact).map(|contact| contact.swings(start))
    }

    fn most(&self, phase: Phase, start: &Start, end: &State) -> State {
        match (phase, &self.contact) {
            (Phase::FullContact, Some(contact)) => {
                most_of_swings(&self.subject.structure, start, end, &contact.swings(start))
            }
            _ => self.rocking.most(&self.subject.structure, phase.side(), start, end),
        }
    }

    #[inline(always)]
    fn series(&self, phase: Phase, start: &Start, arc: &mut Arc) {
        match phase {
            Phase::Rocking(side) => self.rocking.series(side, start, arc),
            _ => full_contact::series(&self.one, start, arc),
        }
    }

    fn is_singular(&self, phase: Phase, state: &State) -> bool {
        matches!(phase, Phase::Rocking(side) if self.rocking.is_singular(side, state))
    }

    #[inline(always)]
    fn liftable(&self) -> Option<Liftable<'_>> {
        let one = &self.one;
        Rocking::IS_POSSIBLE.then(|| Liftable {
            base: one.base(),
            modes: std::slice::from_ref(one.mode()),
            rigid: None,
            lean: self.rocking.lean(),
            has_constant_inertia: self.subject().angles == Angles::Small,
            turning_decides: one.u_cr == f64::NEG_INFINITY,
        })
    }
}
