//! Transitions: their kinds, and the change of the motion at each.

use crate::engine::motion::Motion;
use crate::levels::level::Level;
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::reactions::Impulse;
use crate::{Friction, Phase, Side, State};

/// The change at a transition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransitionKind {
    /// Full contact → rocking about this side.
    Uplift(Side),
    /// Rocking → rocking about the other pivot, which is the side given.
    Impact(Side),
    /// Rocking → full contact.
    Landing,
    /// Rocking → full contact, held to the end of a vibration period that saw too many transitions.
    Settling,
    /// |θ| reached π/2 on this side.
    Overturning(Side),
    /// This dissipator, the first (0) at +ξ_d, begins to yield.
    Yielding(usize),
    /// This dissipator ceases to yield.
    Unloading(usize),
    /// The ground touches this contact point, the leftmost (0) first.
    Touch(usize),
    /// The ground releases this contact point.
    Release(usize),
    /// This contact point begins to yield: the ground settles there.
    Settles(usize),
    /// This contact point ceases to yield.
    Holds(usize),
    /// The friction of a base that may slide: it sticks, slides or flies from now on.
    Friction(Friction),
    /// The tendon becomes taut.
    Taut,
    /// The tendon becomes slack.
    Slack,
}

impl TransitionKind {
    /// Whether the base comes down: an impact, a landing, or a touch of the ground.
    pub const fn is_impact(self) -> bool {
        use TransitionKind::{Impact, Landing, Settling, Touch};
        matches!(self, Impact(_) | Landing | Settling | Touch(_))
    }

    /// Name of the kind.
    pub const fn name(self) -> &'static str {
        match self {
            TransitionKind::Uplift(Side::Left) => "uplift left",
            TransitionKind::Uplift(Side::Right) => "uplift right",
            TransitionKind::Impact(Side::Left) => "impact left",
            TransitionKind::Impact(Side::Right) => "impact right",
            TransitionKind::Landing => "landing",
            TransitionKind::Settling => "settling",
            TransitionKind::Overturning(Side::Left) => "overturning left",
            TransitionKind::Overturning(Side::Right) => "overturning right",
            TransitionKind::Yielding(0) => "yielding of the first dissipator",
            TransitionKind::Yielding(_) => "yielding of the second dissipator",
            TransitionKind::Unloading(0) => "unloading of the first dissipator",
            TransitionKind::Unloading(_) => "unloading of the second dissipator",
            TransitionKind::Touch(_) => "touch",
            TransitionKind::Release(_) => "release",
            TransitionKind::Settles(_) => "ground yields",
            TransitionKind::Holds(_) => "ground holds",
            TransitionKind::Friction(Friction::Sticks) => "stick",
            TransitionKind::Friction(Friction::Slides(Side::Left)) => "slip left",
            TransitionKind::Friction(Friction::Slides(Side::Right)) => "slip right",
            TransitionKind::Friction(Friction::Free) => "flight",
            TransitionKind::Taut => "tendon taut",
            TransitionKind::Slack => "tendon slack",
        }
    }
}

/// One transition, as the engine reports it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transition<Q = f64> {
    /// Instant of the transition, s.
    pub time: f64,
    /// The change.
    pub kind: TransitionKind,
    /// State just before.
    pub before: State<Q>,
    /// State just after.
    pub after: State<Q>,
}

impl<Q> Transition<Q> {
    /// The coefficient of restitution of an impact after which rocking continues: given, or by momentum with the shape frozen (M19).
    pub fn restitution(&self) -> Option<f64> {
        matches!(self.kind, TransitionKind::Impact(_)).then(|| self.after.theta_dot / self.before.theta_dot)
    }
}

/// Takes `motion` into `phase` with the state `after`, and counts the transition.
pub(crate) fn enter<Q: Coordinates>(level: &dyn Level<Q>, motion: &mut Motion<Q>, phase: Phase, after: State<Q>) {
    let structure = level.structure();
    motion.chatter.count(structure);
    motion.impulse = motion.impulse.and(Impulse::of::<Q>(structure, (motion.phase, &motion.state), (phase, &after)));
    let rocking = if let Phase::Rocking(side) = phase { Some((side, after.theta_dot)) } else { None };
    motion.dissipators = motion.dissipators.after(structure.base(), rocking);
    (motion.phase, motion.state) = (phase, after);
}
