//! The numbers by which the outputs of a structure follow from its motion, and by which they are bounded.

use crate::structure::base::Body;
use crate::structure::mode::{Floor, Mode, Modes};

/// Parts of the largest weight that rounding may leave between two gauges that measure the same.
const ROUNDING: f64 = 1e-14;

/// A weighed sum of the accelerations of masses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gauge {
    /// Sum of the weights.
    pub(crate) weight: f64,
    /// Σ φ of each mode, and Σ φ k/μ, Σ φ c/μ, Σ φ/μ.
    pub(crate) shape: Modes,
    pub(crate) stiffness: Modes,
    pub(crate) damping: Modes,
    pub(crate) push: Modes,
    /// The rest beside the modes of the sum of the heights, and of the sum of the weights: the moment and the force on mass that no mode carries,
    /// of a unit of force on a floor whose acceleration this gauge reads.
    pub(crate) left: [f64; 2],
}

impl Gauge {
    /// The gauge of masses with this sum of weights, these sums of shapes and this sum of weighed heights, on a base with `modes`,
    /// whose sums are off by this `rounding`.
    fn new(modes: &[Mode], weight: f64, shape: Modes, height: f64, rounding: f64) -> Gauge {
        let of = |part: fn(&Mode) -> f64| modes.iter().enumerate().map(|(j, mode)| shape.of[j] * part(mode)).sum();
        let left = [rest(height, of(|mode| mode.height), rounding), rest(weight, of(|mode| mode.share), rounding)];
        let per_mass = |part: fn(&Mode) -> f64| {
            Modes::new(&Vec::from_iter(modes.iter().enumerate().map(|(j, mode)| shape.of[j] * part(mode) / mode.mass)))
        };
        let [stiffness, damping, push] =
            [|of: &Mode| of.stiffness, |of: &Mode| of.damping, |_: &Mode| 1.0].map(per_mass);
        Gauge { weight, shape, stiffness, damping, push, left }
    }

    /// Whether the value depends on the ground acceleration directly.
    #[inline]
    pub fn has_feedthrough(&self) -> bool {
        self.left != [0.0; 2]
    }

    /// The value as a multiple of the value of `other`, if all weights are in this proportion.
    pub(crate) fn over(&self, other: &Gauge) -> Option<f64> {
        let ratio = self.weight / other.weight;
        let are_same = |own: &[f64], other: &[f64]| {
            let most = own.iter().fold(0.0, |most: f64, own| most.max(own.abs()));
            own.iter().zip(other).all(|(own, other)| (own - ratio * other).abs() <= ROUNDING * most)
        };
        let is_multiple = are_same(self.shape.numbers(), other.shape.numbers())
            && (0..2).all(|i| are_same(&self.left[i..=i], &other.left[i..=i]));
        is_multiple.then_some(ratio)
    }
}

/// The constants by which the outputs of a structure follow from its modes.
#[derive(Clone, Debug, PartialEq)]
pub struct Gauges {
    /// Shape of the drift of each storey in the modes.
    pub(crate) drift: Vec<Modes>,
    /// Acceleration of each floor along the turning e_x a_i, m/s².
    pub a: Vec<Gauge>,
    /// Shear of the storey below each floor V_k, from the given floors, N.
    pub V: Vec<Gauge>,
    /// Overturning moment at the foot of each storey M_k, from the given floors, N·m.
    pub M: Vec<Gauge>,
    /// Base shear V_t, N.
    pub V_t: Gauge,
    /// Overturning moment M_t, N·m.
    pub M_t: Gauge,
    /// Whether a value depends on the ground acceleration directly.
    pub has_feedthrough: bool,
}

impl Gauges {
    pub(crate) fn new(&Body { m_s, S_1, I_2, .. }: &Body, modes: &[Mode], floors: &[Floor], rounding: f64) -> Gauges {
        let shape = |of: fn(&Mode) -> f64| Modes::new(&Vec::from_iter(modes.iter().map(of)));
        let sum = |floors: &[Floor], part: &dyn Fn(&Floor) -> f64| {
            let (mut weight, mut height, mut sum) = (0.0, 0.0, shape(|_| 0.0));
            for floor in floors {
                let part = part(floor);
                (weight, height) = (weight + part, height + part * floor.height);
                sum = sum.with(&floor.shape, |sum, of| sum + of * part);
            }
            Gauge::new(modes, weight, sum, height, rounding)
        };
        let moment = |k: usize| {
            let foot = if k == 0 { 0.0 } else { floors[k - 1].height };
            sum(&floors[k..], &|floor| floor.mass * (floor.height - foot))
        };
        let a = Vec::from_iter(floors.iter().map(|floor| Gauge::new(modes, 1.0, floor.shape, floor.height, rounding)));
        let V = Vec::from_iter((0..floors.len()).map(|k| sum(&floors[k..], &|floor| floor.mass)));
        let M = Vec::from_iter((0..floors.len()).map(moment));
        let V_t = Gauge::new(modes, m_s, shape(|mode| mode.gamma), S_1, rounding);
        let M_t = Gauge::new(modes, S_1, shape(|mode| mode.mass * mode.height), I_2, rounding);
        let has_feedthrough = [&V_t, &M_t].into_iter().chain(&a).chain(&V).chain(&M).any(Gauge::has_feedthrough);
        let below = |i: usize| i.checked_sub(1).map_or(Modes::default(), |below| floors[below].shape);
        let drift =
            floors.iter().enumerate().map(|(i, floor)| floor.shape.with(&below(i), |own, below| own - below)).collect();
        Gauges { drift, a, V, M, V_t, M_t, has_feedthrough }
    }
}

/// How far an output reaches: the weights of the magnitudes of the motion in the bound of its magnitude.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reach {
    /// Whether the output is not linear in these, so that the weights are none.
    pub(crate) is_curved: bool,
    /// Of |sin θ| and of 1 − cos θ.
    pub(crate) turn: [f64; 2],
    /// Of |a_g| in full contact, if the output depends on the ground acceleration directly.
    pub(crate) a_g: Option<f64>,
    /// Of each |u|, of each |u̇| times the part of the damping, and of each |F_t|.
    pub(crate) u: Modes,
    pub(crate) u_dot: Modes,
    pub(crate) push: Modes,
    /// Of each u, and of each u̇ times the part of the damping, in the output itself while the base is flat.
    #[cfg(feature = "lanes")]
    pub(crate) signed: [Modes; 2],
}

/// The rest of the `whole` beside a sum over the modes, if more than this part `rounding` of the whole.
pub(crate) fn rest(whole: f64, of_modes: f64, rounding: f64) -> f64 {
    let rest = whole - of_modes;
    if rest.abs() <= rounding * whole.abs() { 0.0 } else { rest }
}
