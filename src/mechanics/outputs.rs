//! What the structure shows at an instant: accelerations, forces, displacements (Eqs 2, 3, 23–27) and their rates.
//!
//! ```text
//! a_t = ü + H θ̈ + θ̇² (sB − u) + a_g cos θ          (full contact: ü + a_g)                       (27)
//! ```
//!
//! By (5) that is g sin θ − (c_u u̇ + k u)/m + (F_t/m) cos θ, and by (1) −(c_fc u̇ + k u)/m + F_t/m in full contact:
//! the outputs depend on the state and on F_t and are computed so; only their rates need the ground acceleration. The
//! levels with linear equations have the same outputs, by Eq 5 rather than by their own ü and θ̈. The rigid limit,
//! where u is 0 whatever the forces, is the exception: there (27) is taken as it stands, with the ground acceleration.

use crate::mechanics::load::LinearLoad;
use crate::{Phase, State, Structure};

/// The outputs at one instant; from [`crate::Engine::rates`], their time derivatives in the same fields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outputs {
    /// Rotation of the base θ, rad.
    pub theta: f64,
    /// Elastic displacement u, m.
    pub u: f64,
    /// Acceleration of the top mass in the direction of u, a_t, m/s² (Eq 27).
    pub a_t: f64,
    /// Base shear V_t = m a_t, N (Eqs 2, 23).
    pub V_t: f64,
    /// Overturning moment M_t = m H a_t, N·m (Eqs 3, 24).
    pub M_t: f64,
    /// Angular velocity θ̇, rad/s.
    pub theta_dot: f64,
    /// Elastic velocity u̇, m/s.
    pub u_dot: f64,
    /// Uplift of the free edge of the base δ_u = 2 B sin|θ|, m (Eq 25).
    pub uplift: f64,
    /// Lateral displacement of the top mass δ_t = sB (1 − cos θ) + u cos θ + H sin θ, m (Eq 26).
    pub delta_t: f64,
    /// Its rate, the lateral velocity of the top mass relative to the ground, m/s: u̇ cos θ + [(sB − u) sin θ + H cos
    /// θ] θ̇.
    pub v_t: f64,
}

/// The outputs whose peaks and histories are looked at; others follow from them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// θ, and with it the uplift (Eq 25).
    Theta,
    /// u.
    U,
    /// δ_t (Eq 26).
    DeltaT,
    /// a_t (Eq 27), and with it V_t and M_t.
    At,
}

impl Measure {
    /// All of them.
    pub const ALL: [Measure; 4] = [Measure::Theta, Measure::U, Measure::DeltaT, Measure::At];

    /// Its value among `outputs`.
    pub fn of(self, outputs: &Outputs) -> f64 {
        match self {
            Measure::Theta => outputs.theta,
            Measure::U => outputs.u,
            Measure::DeltaT => outputs.delta_t,
            Measure::At => outputs.a_t,
        }
    }
}

/// The damping in force: c_fc in full contact, c_u otherwise, N·s/m.
pub(crate) fn damping(structure: &Structure, phase: Phase) -> f64 {
    match phase {
        Phase::FullContact => structure.c_fc,
        Phase::Rocking(_) | Phase::Overturned(_) => structure.c_u,
    }
}

impl Outputs {
    /// The outputs of `structure` in `phase` and `state` with the force `F_t` (N) on the top mass.
    pub fn of(structure: &Structure, phase: Phase, state: &State, F_t: f64) -> Outputs {
        let &crate::Parameters { m, H, B, g, .. } = structure.parameters();
        let &State { u, u_dot, theta, theta_dot } = state;
        let (s, damping) = (phase.side().sign(), damping(structure, phase));
        let (sin, cos) = libm::sincos(theta);
        let a_t = g * sin + (F_t * cos - damping * u_dot - structure.k * u) / m;
        let one_minus_cos = sin * sin / (1.0 + cos); // without cancellation: cos θ ≥ 0
        Outputs {
            theta,
            u,
            a_t,
            V_t: m * a_t,
            M_t: m * H * a_t,
            theta_dot,
            u_dot,
            uplift: 2.0 * B * sin.abs(),
            delta_t: s * B * one_minus_cos + u * cos + H * sin,
            v_t: u_dot * cos + ((s * B - u) * sin + H * cos) * theta_dot,
        }
    }

    /// These outputs with another a_t (m/s²), or its rate, and with the forces that follow from it.
    pub(crate) fn with_a_t(self, structure: &Structure, a_t: f64) -> Outputs {
        let &crate::Parameters { m, H, .. } = structure.parameters();
        Outputs { a_t, V_t: m * a_t, M_t: m * H * a_t, ..self }
    }

    /// Time derivatives of the outputs, given `accelerations` (ü, θ̈) under `load`; 0 once overturned, where motion has
    /// ended.
    pub(crate) fn rates_by(
        structure: &Structure,
        phase: Phase,
        state: &State,
        accelerations: [f64; 2],
        load: LinearLoad,
    ) -> Outputs {
        let &crate::Parameters { m, H, B, g, .. } = structure.parameters();
        let moves = if let Phase::Overturned(_) = phase { 0.0 } else { 1.0 };
        let &State { u, .. } = state;
        let (u_dot, theta_dot) = (moves * state.u_dot, moves * state.theta_dot);
        let [u_ddot, theta_ddot] = accelerations;
        let (s, damping) = (phase.side().sign(), damping(structure, phase));
        let (sin, cos) = libm::sincos(state.theta);
        let force_rate = moves * (load.slope.F_t * cos - load.value.F_t * sin * theta_dot);
        let a_t = g * cos * theta_dot - (damping * u_ddot + structure.k * u_dot) / m + force_rate / m;
        let lever = s * B - u;
        let (height, height_rate) = (lever * sin + H * cos, (lever * cos - H * sin) * theta_dot - u_dot * sin);
        Outputs {
            theta: theta_dot,
            u: u_dot,
            a_t,
            V_t: m * a_t,
            M_t: m * H * a_t,
            theta_dot: theta_ddot,
            u_dot: u_ddot,
            uplift: 2.0 * B * s * cos * theta_dot,
            delta_t: u_dot * cos + height * theta_dot,
            v_t: u_ddot * cos - u_dot * sin * theta_dot + height_rate * theta_dot + height * theta_ddot,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::levels::detail::Detail;
    use crate::levels::full_contact;
    use crate::levels::nonlinear;
    use crate::mechanics::load::Load;
    use crate::mechanics::restraint::Dissipators;
    use crate::{Engine, Parameters, Reactions, Side};
    use approx::assert_relative_eq;

    /// Eq 27 with ü and θ̈ from Eqs 5 and 6 is what the state alone gives, and Eq 1 in full contact.
    #[test]
    fn the_acceleration_is_that_of_equation_27() {
        let structure = Structure::new(Parameters::MCMANUS).unwrap();
        let &Parameters { H, B, .. } = structure.parameters();
        let state = State { u: 3e-3, u_dot: -0.2, theta: -0.08, theta_dot: 0.6 };
        let load = Load { a_g: 7.0, F_t: 300.0, a_v: -3.0 };
        let accelerations = nonlinear::accelerations(&structure, Side::Left, &state, load, &Dissipators::NEW).unwrap();
        let expected = accelerations[0]
            + H * accelerations[1]
            + state.theta_dot.powi(2) * (-B - state.u)
            + load.a_g * libm::cos(state.theta)
            - load.a_v * libm::sin(state.theta);
        let outputs = Outputs::of(&structure, Phase::Rocking(Side::Left), &state, load.F_t);
        assert_relative_eq!(outputs.a_t, expected, max_relative = 1e-12);

        let down = State { theta: 0.0, theta_dot: 0.0, ..state };
        let outputs = Outputs::of(&structure, Phase::FullContact, &down, load.F_t);
        assert_relative_eq!(
            outputs.a_t,
            full_contact::acceleration(&structure, &down, load) + load.a_g,
            max_relative = 1e-12
        );
    }

    /// The rates are the slopes of the outputs along the motion, at every level.
    #[test]
    fn the_rates_are_the_slopes_of_the_outputs() {
        let structure = Structure::new(Parameters::EVISON).unwrap();
        let down = State { u: 2e-4, u_dot: 0.01, ..State::default() };
        let rocking = State { u: 1e-3, u_dot: -0.1, theta: 0.05, theta_dot: 0.4 };
        let rigid = State { u: 0.0, u_dot: 0.0, ..rocking };
        let scenes = [
            (Detail::Auto, down),
            (Detail::Auto, rocking),
            (Detail::Linear, rocking),
            (Detail::Modal, rocking),
            (Detail::Rigid, State::default()),
            (Detail::Rigid, rigid),
            (Detail::FixedBase, down),
        ];
        for (detail, initial) in scenes {
            let start = LinearLoad {
                value: Load { a_g: 1.2, F_t: 90.0, a_v: 0.0 },
                slope: Load { a_g: 40.0, F_t: -700.0, a_v: 0.0 },
            };
            let h = 1e-5;
            let mut engine = Engine::with_detail(structure, initial, 0.0, 1e-11, detail).unwrap();
            let mut show = |until: f64| {
                let here = |time: f64| LinearLoad { value: start.at(time), ..start };
                let now = engine.motion().time;
                engine.advance(until - now, here(now), &mut ()).unwrap();
                let load = here(until);
                ((engine.outputs(load.value), engine.reactions(load.value)), engine.rates(load))
            };
            let (before, _) = show(1e-3 - h);
            let (_, rates) = show(1e-3);
            let (after, _) = show(1e-3 + h);
            let slope = |get: fn(&Outputs) -> f64| (get(&after.0) - get(&before.0)) / (2.0 * h);
            for get in [
                |o: &Outputs| o.theta,
                |o: &Outputs| o.u,
                |o: &Outputs| o.a_t,
                |o: &Outputs| o.V_t,
                |o: &Outputs| o.M_t,
                |o: &Outputs| o.theta_dot,
                |o: &Outputs| o.u_dot,
                |o: &Outputs| o.uplift,
                |o: &Outputs| o.delta_t,
                |o: &Outputs| o.v_t,
            ] {
                assert_relative_eq!(get(&rates.0), slope(get), max_relative = 1e-4, epsilon = 1e-9);
            }
            for get in [|r: &Reactions| r.R_h, |r: &Reactions| r.R_v, |r: &Reactions| r.R_m] {
                let slope = (get(&after.1) - get(&before.1)) / (2.0 * h);
                assert_relative_eq!(get(&rates.1), slope, max_relative = 1e-4, epsilon = 1e-5);
            }
        }
    }
}
