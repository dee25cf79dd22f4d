//! Loads: the accelerations of the ground and a force on the top mass.
//!
//! The force F_t does the work F_t δx on the top mass, x = sB (1 − cos θ) + u cos θ + H sin θ. On the right it adds to
//!
//! ```text
//! (1)  F_t/m        (5)  F_t cos θ        (6)  F_t [H cos θ + (sB − u) sin θ]        (7)  F_t/m        (8)  H F_t/m
//! ```
//!
//! The top mass therefore feels the ground acceleration a_g − F_t/m, and the foundation feels a_g alone. With F_t = 0 no result
//! changes in a bit. Uplift of one mass requires s u ≥ u_cr and s θ̈ > 0, and neither depends on a_g or F_t. Impacts are too short for
//! both. [`Structure::load`](crate::Structure::load) tells what forces on floors add to a structure of many masses.
//!
//! The vertical ground acceleration a_v replaces g by g + a_v in every weight.

use crate::mechanics::lateral::Coordinates;
use crate::structure::quantity::{OutOfRange, Quantity, Refused, ensure, quantity};
use crate::{Mode, Modes, Structure};
use serde::{Deserialize, Serialize};

/// An acceleration (m/s²) or a force (N) over one interval, positive to the right: `value + slope·(t − start of the interval)`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ramp<Q = f64> {
    /// Value at the start of the interval.
    pub value: Q,
    /// Rate per second.
    pub slope: Q,
}

impl Ramp {
    /// The ramp that changes from `from` to `to` within `duration` (s).
    #[inline(always)] // for each sample of a run
    pub fn between(from: f64, to: f64, duration: f64) -> Ramp {
        Ramp { value: from, slope: (to - from) / duration }
    }
}

impl<Q: Coordinates> Ramp<Q> {
    /// Value `tau` seconds after the start of the interval.
    pub fn at(self, tau: f64) -> Q {
        self.value.plus(self.slope, tau)
    }

    /// The same ramp with an interval that starts `tau` seconds later.
    pub fn from(self, tau: f64) -> Ramp<Q> {
        Ramp { value: self.at(tau), slope: self.slope }
    }
}

/// All loads, with units and ranges.
pub static LOADS: [Quantity<Load>; 3] = [
    quantity!(a_g["m/s2"] - 1e4, 1e4, "horizontal ground acceleration, positive to the right"),
    quantity!(F_t["N"] - 1e15, 1e15, "external horizontal force on the top mass, positive to the right"),
    quantity!(a_v["m/s2"] - 1e4, 1e4, "vertical ground acceleration, positive upwards"),
];

/// The place of a_v in [`LOADS`].
pub const VERTICAL: usize = 2;

/// The loads at one instant, or their rates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Load<Q = f64> {
    /// Ground acceleration, m/s², positive to the right.
    pub a_g: f64,
    /// External force on the top mass, N, horizontal in the ground's frame, positive to the right; of many masses, the force φᵀF on
    /// each mode, from [`Structure::load`](crate::Structure::load).
    pub F_t: Q,
    /// Vertical ground acceleration, m/s², positive upwards.
    pub a_v: f64,
}

impl Load {
    /// The ground acceleration `a_g` (m/s²) alone.
    pub fn ground(a_g: f64) -> Load {
        Load { a_g, ..Load::default() }
    }

    /// Whether all loads are finite numbers.
    pub fn is_finite(&self) -> bool {
        LOADS.iter().all(|quantity| (quantity.get)(self).is_finite())
    }

    /// Accepts loads within the ranges of [`LOADS`].
    #[inline]
    pub fn check(&self) -> Result<(), OutOfRange> {
        LOADS[0].check(self.a_g)?;
        LOADS[1].check(self.F_t)?;
        LOADS[2].check(self.a_v)
    }
}

impl<Q: Coordinates> Load<Q> {
    /// The load of ground at rest without any force.
    pub const NONE: Load<Q> = Load { a_g: 0.0, F_t: Q::ZERO, a_v: 0.0 };

    /// The ground acceleration that each mode feels, a_g Γ/μ − F_t/μ, m/s², beside the force on mass that no mode carries.
    #[inline(always)]
    pub(crate) fn on_modes(&self, structure: &Structure) -> Q {
        Q::each(structure, |j, mode| mode.part(self.a_g) - self.F_t.of(j) / mode.mass).beside(&self.F_t)
    }
}

impl Structure {
    /// The load of the ground accelerations `a_g` and `a_v` (m/s²) and of a horizontal force on each floor (N, to the right), or of
    /// none. On the right, the forces F add to
    ///
    /// ```text
    /// (M1, M8)  φᵀF cos θ       (M9)  Σ φᵀF w sin θ + F_res sB sin θ + N_res cos θ       (M2, M3)  N_res
    /// ```
    ///
    /// F_res = Σ F (1 − Σ φ Γ/μ) and N_res = Σ F (h − Σ φ κ/μ) act on mass that no mode carries. Both are 0 with all modes.
    pub fn load(&self, a_g: f64, a_v: f64, forces: &[f64]) -> Result<Load<Modes>, Refused> {
        let (given, floors) = (forces.len(), self.floors().len());
        ensure(given == 0 || given == floors, || {
            format!("{given} forces are given on {floors} floors: give one for each floor, or none")
        })?;
        Ok(Load { a_g, F_t: Modes::of_forces(self, forces.iter().copied()), a_v })
    }

    /// The sum of the horizontal forces of `load` (N), and the sum of their moments in full contact (N·m).
    pub(crate) fn pushes<Q: Coordinates>(&self, load: &Load<Q>) -> [f64; 2] {
        let [force, moment] = load.F_t.rest().unwrap_or_default();
        let on_modes = |part: fn(&Mode) -> f64| Q::sum(self, |j, mode| part(mode) * load.F_t.of(j));
        [force + on_modes(|mode| mode.share), moment + on_modes(|mode| mode.height)]
    }
}

/// The loads over one interval: `value + slope·(t − start of the interval)`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LinearLoad<Q = f64> {
    /// Loads at the start of the interval.
    pub value: Load<Q>,
    /// Rates of the loads, per second.
    pub slope: Load<Q>,
}

impl<Q: Coordinates> LinearLoad<Q> {
    /// Loads `tau` seconds after the start of the interval.
    #[inline]
    pub fn at(&self, tau: f64) -> Load<Q> {
        Load {
            a_g: self.value.a_g + self.slope.a_g * tau,
            F_t: self.value.F_t.plus(self.slope.F_t, tau),
            a_v: self.value.a_v + self.slope.a_v * tau,
        }
    }

    /// The same loads with an interval that starts `tau` seconds later.
    pub fn from(&self, tau: f64) -> LinearLoad<Q> {
        LinearLoad { value: self.at(tau), slope: self.slope }
    }

    /// Whether the sum of the loads at the end of an `interval` (s) is finite. Then every load is finite throughout.
    #[inline]
    pub(crate) fn is_finite_over(&self, interval: f64) -> bool {
        let Load { a_g, F_t, a_v } = self.at(interval);
        (a_g + F_t.total() + a_v).abs() <= f64::MAX
    }

    /// Whether the ground moves upwards or downwards.
    #[inline]
    pub(crate) fn is_vertical(&self) -> bool {
        self.value.a_v.abs() + self.slope.a_v.abs() > 0.0
    }

    /// The vertical ground acceleration.
    pub(crate) fn upwards(&self) -> Ramp {
        Ramp { value: self.value.a_v, slope: self.slope.a_v }
    }

    /// The horizontal ground acceleration.
    pub(crate) fn on_foundation(&self) -> Ramp {
        Ramp { value: self.value.a_g, slope: self.slope.a_g }
    }

    /// The ground acceleration that each mode feels; of one mass, the acceleration that the top mass feels.
    #[inline]
    pub(crate) fn on_top(&self, structure: &Structure) -> Ramp<Q> {
        if self.value.F_t.is_within(&Q::ZERO) && self.slope.F_t.is_within(&Q::ZERO) {
            let Ramp { value, slope } = self.on_foundation(); // the result of the divisions, at less cost
            return Ramp { value: Q::parts(structure, value), slope: Q::parts(structure, slope) };
        }
        self.on_pushed_top(structure)
    }

    /// [`LinearLoad::on_top`] with a force.
    #[cold]
    fn on_pushed_top(&self, structure: &Structure) -> Ramp<Q> {
        Ramp { value: self.value.on_modes(structure), slope: self.slope.on_modes(structure) }
    }

    /// These loads with the accelerations of `ground` added.
    pub fn on_ground(mut self, ground: LinearLoad) -> LinearLoad<Q> {
        for (own, ground) in [(&mut self.value, ground.value), (&mut self.slope, ground.slope)] {
            own.a_g += ground.a_g;
            own.a_v += ground.a_v;
        }
        self
    }
}

impl LinearLoad {
    /// These loads with the force `F_t` and the vertical ground acceleration `a_v`.
    #[cold]
    pub(crate) fn and(self, F_t: Ramp, a_v: Ramp) -> LinearLoad {
        let (value, slope) = (Load { F_t: F_t.value, a_v: a_v.value, ..self.value }, self.slope);
        LinearLoad { value, slope: Load { F_t: F_t.slope, a_v: a_v.slope, ..slope } }
    }
}

/// Constant loads.
impl<Q: Coordinates> From<Load<Q>> for LinearLoad<Q> {
    fn from(value: Load<Q>) -> LinearLoad<Q> {
        LinearLoad { value, slope: Load::NONE }
    }
}

/// Horizontal ground motion alone.
impl From<Ramp> for LinearLoad {
    fn from(a_g: Ramp) -> LinearLoad {
        LinearLoad { value: Load::ground(a_g.value), slope: Load::ground(a_g.slope) }
    }
}
