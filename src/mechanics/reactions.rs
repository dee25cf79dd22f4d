//! What the structure exerts on the ground, from its momentum balance (d'Alembert).
//!
//! With x, y of the top mass and x₀, y₀ of the foundation in the ground's frame (`kinematics`), the forces
//! that are left for the ground are
//!
//! ```text
//! R_h = F_t − m (ẍ + a_g) − m0 (ẍ₀ + a_g)              to the right
//! R_v = (m + m0) g + m ÿ + m0 ÿ₀                       downwards
//! R_m = y [F_t − m (ẍ + a_g)] + x m (g + ÿ) − y₀ m0 (ẍ₀ + a_g) + x₀ m0 (g + ÿ₀) − J0 θ̈
//! ```
//!
//! R_m is about the place of the middle of the base in full contact, positive as θ. In full contact they are
//! R_h = c_fc u̇ + k u − m0 a_g, R_v = (m + m0) g and R_m = H (c_fc u̇ + k u) + m g u. While rocking the pivot is the
//! only contact: by Eqs 5 and 6 R_m = sB R_v; the levels with linear equations miss that by what they leave out.
//!
//! The edge that the model rocks about stays on the ground: R_v < 0 tells where it would jump in truth. A vertical ground
//! acceleration makes g + a_v of g. Restraints change none of this: the reactions are all that the ground feels, by the edges
//! and by the ties, which pull upwards.
//!
//! Impacts are not in them. Each leaves an impulse, the opposite of what it changes of the structure's momentum:
//!
//! ```text
//! P_h = m ẋ + m0 ẋ₀,   P_v = −m ẏ − m0 ẏ₀,   P_m = m (y ẋ − x ẏ) + m0 (y₀ ẋ₀ − x₀ ẏ₀) + J0 θ̇
//! ```

use crate::mechanics::kinematics::points;
use crate::mechanics::load::{LinearLoad, Load};
use crate::mechanics::restraint::{Angles, Tie};
use crate::{Phase, Side, State, Structure};
use nalgebra::Complex;
use serde::{Deserialize, Serialize};

/// Forces on the ground; from [`crate::Engine::rates`], their time derivatives in the same fields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reactions {
    /// Horizontal, N, positive to the right.
    pub R_h: f64,
    /// Vertical, N, positive downwards.
    pub R_v: f64,
    /// Moment about the middle of the base, N·m, positive as θ.
    pub R_m: f64,
}

/// Impulse of the impacts on the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Impulse {
    /// Horizontal, N·s, positive to the right.
    pub I_h: f64,
    /// Vertical, N·s, positive downwards.
    pub I_v: f64,
    /// About the middle of the base, N·m·s, positive as θ.
    pub I_m: f64,
}

/// y f_x − x f_y: the moment about the origin, positive as θ, of a force f at z.
fn moment(z: Complex<f64>, f: Complex<f64>) -> f64 {
    (z * f.conj()).im
}

impl Reactions {
    /// In `phase` and `state`, whose (ü, θ̈) under `load` are `accelerations`.
    pub(crate) fn of(
        structure: &Structure,
        phase: Phase,
        state: &State,
        accelerations: [f64; 2],
        load: Load,
    ) -> Reactions {
        let &crate::Parameters { m, m0, J0, g, .. } = structure.parameters();
        let points = points(structure, phase.side(), state, accelerations, [0.0; 2]);
        let mut reactions = Reactions { R_h: 0.0, R_v: 0.0, R_m: -J0 * accelerations[1] };
        for (point, mass, push) in [(points[0], m, load.F_t), (points[1], m0, 0.0)] {
            let force = -mass * (point.acceleration + Complex::new(load.a_g, g + load.a_v)) + push;
            reactions.R_h += force.re;
            reactions.R_v -= force.im;
            reactions.R_m += moment(point.position, force);
        }
        reactions
    }

    /// Time derivatives under `load`, given (ü, θ̈) and (u⃛, θ⃛); 0 once overturned.
    pub(crate) fn rates(
        structure: &Structure,
        phase: Phase,
        state: &State,
        [accelerations, jerks]: [[f64; 2]; 2],
        load: LinearLoad,
    ) -> Reactions {
        if let Phase::Overturned(_) = phase {
            return Reactions { R_h: 0.0, R_v: 0.0, R_m: 0.0 };
        }
        let &crate::Parameters { m, m0, J0, g, .. } = structure.parameters();
        let points = points(structure, phase.side(), state, accelerations, jerks);
        let LinearLoad { value, slope } = load;
        let mut rates = Reactions { R_h: 0.0, R_v: 0.0, R_m: -J0 * jerks[1] };
        for (point, mass, push, push_rate) in [(points[0], m, value.F_t, slope.F_t), (points[1], m0, 0.0, 0.0)] {
            let force = -mass * (point.acceleration + Complex::new(value.a_g, g + value.a_v)) + push;
            let rate = -mass * (point.jerk + Complex::new(slope.a_g, slope.a_v)) + push_rate;
            rates.R_h += rate.re;
            rates.R_v -= rate.im;
            rates.R_m += moment(point.velocity, force) + moment(point.position, rate);
        }
        rates
    }

    /// What the edges of the base carry of these: the `ties` pull upwards, and to the right where the base is turned, so that the
    /// edges press down by as much more. `angles` is how they elongate, and the moment is that of full contact.
    pub(crate) fn of_edges(
        self,
        structure: &Structure,
        side: Side,
        angles: Angles,
        state: &State,
        ties: &[Tie; 3],
    ) -> Self {
        let chord = angles.chord(state.theta, state.theta_dot);
        let (sin, cos) = if angles == Angles::Any { libm::sincos(state.theta / 2.0) } else { (0.0, 1.0) };
        let middle = side.sign() * structure.parameters().B;
        ties.iter().fold(self, |edges, tie| {
            let force = tie.force_at(chord);
            Reactions {
                R_h: edges.R_h - force * sin,
                R_v: edges.R_v + force * cos,
                R_m: edges.R_m + force * cos * (middle - tie.lever),
            }
        })
    }
}

impl Impulse {
    /// Of a transition that changes the motion from `before` to `after`.
    pub(crate) fn of(structure: &Structure, before: (Phase, &State), after: (Phase, &State)) -> Impulse {
        let [before, after] = [before, after].map(|(phase, state)| momentum(structure, phase, state));
        Impulse { I_h: before.I_h - after.I_h, I_v: before.I_v - after.I_v, I_m: before.I_m - after.I_m }
    }

    /// Both, one after the other.
    pub(crate) fn and(self, next: Impulse) -> Impulse {
        Impulse { I_h: self.I_h + next.I_h, I_v: self.I_v + next.I_v, I_m: self.I_m + next.I_m }
    }
}

/// Momentum of the structure relative to the ground: to the right, downwards and about the middle of the base.
fn momentum(structure: &Structure, phase: Phase, state: &State) -> Impulse {
    let &crate::Parameters { m, m0, J0, .. } = structure.parameters();
    let [top, base] = points(structure, phase.side(), state, [0.0; 2], [0.0; 2]);
    let total = m * top.velocity + m0 * base.velocity;
    Impulse {
        I_h: total.re,
        I_v: -total.im,
        I_m: m * moment(top.position, top.velocity) + m0 * moment(base.position, base.velocity) + J0 * state.theta_dot,
    }
}
