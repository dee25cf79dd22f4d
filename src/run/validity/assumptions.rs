//! The assumptions of the model: one type each, with the value that tells of it, and a row of the table.

use crate::numbers::Number;
use crate::run::reaction_series::Extent;
use crate::series::terms::Terms;
use crate::structure::quantity::{Refused, ensure};
use crate::{Friction, Impulse, Phase, Reactions};
use std::fmt;

/// The limits: a value beyond one gives a warning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Of `tension_max` and `tension_impact`, parts of the weight and of the impulse.
    pub tension: f64,
    /// Of `R_v_min`, part of the weight.
    pub edge_load: f64,
    /// Of `mu_required` and `mu_impact`.
    pub friction: f64,
    /// Of `energy_gain_max`.
    pub energy_gain: f64,
}

impl Default for Limits {
    /// Friction: 0.5, of concrete on concrete cast against smooth formwork (EN 1992-1-1:2004, 6.2.5(2), "very smooth").
    /// Tension: 0.05, since any uplift at u_cr takes g/(H ω_fc²) or so, and damping adds to it. Edge load and gain: 0.
    fn default() -> Limits {
        Limits { tension: 0.05, edge_load: 0.0, friction: 0.5, energy_gain: 0.0 }
    }
}

impl Limits {
    /// Whether each of them is a limit.
    ///
    /// # Errors
    ///
    /// A limit that is not a finite number of at least 0.
    pub fn check(&self) -> Result<(), Refused> {
        let &Limits { tension, edge_load, friction, energy_gain } = self;
        let named =
            [("friction", friction), ("tension", tension), ("edge_load", edge_load), ("energy_gain", energy_gain)];
        named.into_iter().try_for_each(|(name, value)| {
            ensure(value >= 0.0 && value.is_finite(), || {
                format!("{name} = {value} is out of range: a finite number of at least 0 is needed")
            })
        })
    }
}

/// Values that pass a limit: those on this side of the limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Passing {
    /// Larger values; the worst value is the largest.
    Above,
    /// Smaller values; the worst value is the least.
    Below,
    /// The limit itself and smaller values; the worst value is the least.
    AtOrBelow,
}

impl Passing {
    /// Whether `value` is worse than another value `than`.
    pub(super) fn is_worse(self, value: f64, than: f64) -> bool {
        if self == Passing::Above { value > than } else { value < than }
    }

    /// Whether `value` passes `limit`.
    pub(super) fn passes(self, value: f64, limit: f64) -> bool {
        self.is_worse(value, limit) || self == Passing::AtOrBelow && value == limit
    }
}

impl fmt::Display for Passing {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        out.write_str(match self {
            Passing::Above => "above",
            Passing::Below => "below",
            Passing::AtOrBelow => "at or below",
        })
    }
}

/// A row of the table: one of the assumptions of the model.
#[derive(Debug)]
pub struct Assumption {
    /// Name of the value that tells of the assumption.
    pub name: &'static str,
    /// Name of the instant of the value.
    pub time_name: &'static str,
    /// Description of the value.
    pub description: &'static str,
    /// Description of the instant.
    pub time_description: &'static str,
    /// Meaning of a value beyond the limit.
    pub meaning: &'static str,
    /// Whether the assumption is about impacts only.
    pub is_of_impacts: bool,
    /// Values that pass the limit.
    pub passing: Passing,
    /// The limit among others.
    pub limit: fn(&Limits) -> f64,
    /// The value before anything has been seen: no value is better.
    pub start: f64,
}

/// Declares [`ASSUMPTIONS`] and the place of each by its rows: place, name, description, meaning, values that pass, limit, start, and
/// whether it is about impacts only.
macro_rules! assumptions {
    ($($place:ident $name:literal $description:literal, $meaning:literal,
        $passing:ident $limit:expr, $start:expr, $impacts:expr;)*) => {
        #[allow(non_camel_case_types, clippy::upper_case_acronyms)] // as the places
        enum Places {
            $($place),*
        }

        $(
            #[doc = concat!("Place of `", $name, "` in [`ASSUMPTIONS`].")]
            pub const $place: usize = Places::$place as usize;
        )*

        /// All assumptions, in the order of [`Findings::worst`](super::Findings::worst).
        pub const ASSUMPTIONS: [Assumption; [$($name),*].len()] = [$(Assumption {
            name: $name,
            time_name: concat!("t_", $name),
            description: $description,
            time_description: concat!("first instant of ", $name),
            meaning: $meaning,
            is_of_impacts: $impacts,
            passing: Passing::$passing,
            limit: $limit,
            start: $start,
        }),*];
    };
}

assumptions! {
    TENSION "tension_max" "largest (|R_m|/B - R_v)/W in full contact, W = (m + m0) g; above 0 the model needs tension at the base; -inf before full contact",
        "the model holds the base down by tension; a real base lifts off before |u| = u_cr",
        Above |limits| limits.tension, f64::NEG_INFINITY, false;
    EDGE_LOAD "R_v_min" "smallest R_v/W; below 0 the model needs tension at the edge in contact",
        "the model holds the edge in contact down by tension; a real edge jumps",
        Below |limits| limits.edge_load, f64::INFINITY, false;
    FRICTION "mu_required" "largest |R_h|/R_v, the coefficient of friction that the base needs; infinite once R_v is 0 or less",
        "the base needs that coefficient of friction; a real base may slide",
        Above |limits| limits.friction, 0.0, false;
    IMPACT_FRICTION "mu_impact" "largest |I_h|/I_v of an impact, the coefficient of friction that it needs; infinite if I_v is 0 or less",
        "the base needs that coefficient of friction at an impact; a real base may slide",
        Above |limits| limits.friction, 0.0, true;
    IMPACT_TENSION "tension_impact" "largest (|I_m|/B - I_v)/I_v of an impact; above 0 the model needs tension at an edge",
        "an impact needs tension at an edge; a real impact has a larger r, or the other edge lifts off",
        Above |limits| limits.tension, -1.0, true;
    ENERGY "energy_gain_max" "largest energy gain at an impact, as a fraction of the kinetic energy before it; 0 without a gain",
        "an impact raises the energy, which no real impact does",
        Above |limits| limits.energy_gain, 0.0, true;
    WEIGHT "weight_min" "smallest (g + a_v)/g; at 0 or below no weight holds the base down; 1 without vertical motion",
        "no weight holds the base down; a real base flies",
        AtOrBelow |_| 0.0, f64::INFINITY, false;
}

/// Weight W = (m + m0) g (N) and half the width B (m) of the structure.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    pub W: f64,
    pub B: f64,
}

/// h R_h + v R_v + m R_m + n for [h, v, m, n].
#[derive(Clone, Copy, Debug)]
pub(super) struct Combination(pub [f64; 4]);

impl Combination {
    /// The three weights other than 0, each with its reaction.
    fn weighed<'a, T>(&self, reactions: &'a Reactions<T>) -> impl Iterator<Item = (f64, &'a T)> + use<'a, T> {
        let (Reactions { R_h, R_v, R_m }, [h, v, m, _]) = (reactions, self.0);
        [(h, R_h), (v, R_v), (m, R_m)].into_iter().filter(|(weight, _)| *weight != 0.0)
    }

    /// The combination as a power series.
    pub fn series(&self, reactions: &Reactions<Terms>) -> Terms {
        self.weighed(reactions).fold(Terms::constant(self.0[3]), |sum, (weight, terms)| sum + *terms * weight)
    }

    /// Bounds of the combination.
    pub fn extent(&self, reactions: &Reactions<Extent>) -> Extent {
        let n = Extent { middle: self.0[3], half: 0.0 };
        self.weighed(reactions).fold(n, |sum, (weight, of)| Extent {
            middle: sum.middle + weight * of.middle,
            half: sum.half + weight.abs() * of.half,
        })
    }
}

/// An assumption about the reactions.
pub(super) struct OfReactions {
    /// Place in [`ASSUMPTIONS`].
    pub place: usize,
    /// Whether a phase rests on the assumption.
    pub holds_in: fn(Phase) -> bool,
    /// The value that tells of the assumption.
    pub value: fn(Scale, &Reactions) -> f64,
    /// The combinations of which one is positive if the value is worse than another.
    pub worse: fn(Scale, f64) -> [Option<Combination>; 2],
}

/// The base stays down in full contact without tension.
const NO_TENSION: OfReactions = OfReactions {
    place: TENSION,
    holds_in: |phase| phase.properties().is_down,
    value: |Scale { W, B }, Reactions { R_v, R_m, .. }| (R_m.abs() / B - R_v) / W,
    worse: |Scale { W, B }, than| [1.0, -1.0].map(|s| Some(Combination([0.0, -1.0, s * (1.0 / B), -than * W]))),
};

/// The edge of the base presses on the ground. Ground that gives cannot pull.
pub(super) const PRESSED_EDGE: OfReactions = OfReactions {
    place: EDGE_LOAD,
    holds_in: |phase| phase.properties().pivot != 0.0,
    value: |Scale { W, .. }, Reactions { R_v, .. }| R_v / W,
    worse: |Scale { W, .. }, than| [Some(Combination([0.0, -1.0, 0.0, than * W])), None],
};

/// The base does not slide. In flight nothing rubs, and a base that slides needs the friction that it has.
pub(super) const NO_SLIDING: OfReactions = OfReactions {
    place: FRICTION,
    holds_in: |phase| !phase.properties().is_free && phase.contact().friction == Friction::Sticks,
    value: |_, &Reactions { R_h, R_v, .. }| if R_v > 0.0 { R_h.abs() / R_v } else { f64::INFINITY },
    worse: |_, than| [1.0, -1.0].map(|s| Some(Combination([s, -than, 0.0, 0.0]))),
};

/// The assumptions about the reactions.
pub(super) const OF_REACTIONS: [OfReactions; 3] = [NO_TENSION, PRESSED_EDGE, NO_SLIDING];

/// The values that tell of the assumptions about impacts, each with its place in [`ASSUMPTIONS`], of an impact with this `impulse` that
/// gains this part of the kinetic energy before it; `B` is half the width of the base.
pub(super) fn of_impact(&Impulse { I_h, I_v, I_m }: &Impulse, gain: f64, B: f64) -> [(usize, f64); 3] {
    let per_impulse = |force: f64| if I_v > 0.0 { force / I_v } else { f64::INFINITY };
    [(IMPACT_FRICTION, per_impulse(I_h.abs())), (IMPACT_TENSION, per_impulse(I_m.abs() / B - I_v)), (ENERGY, gain)]
}
