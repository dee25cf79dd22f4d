//! The paper's equations, without a solver: state, loads, outputs, reactions, energy, impact.

pub(crate) mod arc;
pub mod contact;
pub mod energy;
mod gauge;
pub mod impact;
pub(crate) mod instant;
pub(crate) mod lateral;
pub mod load;
pub mod outputs;
pub(crate) mod reach;
pub mod reactions;
pub mod restraint;
pub mod shown;
pub mod state;

#[cfg(test)]
mod tests {
    use super::energy::energy;
    use super::impact::{angular_momentum, energy_gained, land, resolve, restitution};
    use super::instant::{Instant, Second};
    use super::lateral::{Coordinates, Lateral};
    use crate::structure::description::Storey;
    use crate::structure::description::tests::{STOREYS, three_storeys};
    use crate::{Base, Body, Impulse, Load, Modes, Phase, Reactions, Side, State, Structure};
    use approx::assert_relative_eq;
    use nalgebra::{Matrix3, Vector3};

    /// Coordinates of the modes from displacements of the masses.
    fn modal(frame: &Structure, u: &Vector3<f64>) -> Modes {
        let weighed =
            |j| frame.floors().iter().zip(u).map(|(floor, u)| floor.mass * floor.shape.of(j) * u).sum::<f64>();
        Modes::each(frame, |j, mode| weighed(j) / mode.mass)
    }

    /// From the accelerations of the masses, whatever brings these about.
    #[test]
    fn the_reactions_are_those_of_the_masses() {
        let frame = three_storeys();
        let &Base { m0, B, m_t, g, .. } = frame.base();
        let [u, u_dot, u_ddot] = [[0.02, -0.05, 0.11], [0.4, 0.7, -0.3], [3.0, -7.0, 11.0]].map(Vector3::from);
        let load = Load { a_g: 3.0, F_t: Modes::each(&frame, |_, _| 0.0), a_v: -1.5 };
        for side in [Side::Right, Side::Left] {
            let (s, theta, theta_dot, theta_ddot) = (side.sign(), side.sign() * 0.2, 0.6, -1.7);
            let (sin, cos) = f64::sin_cos(theta);
            let state = State { u: modal(&frame, &u), u_dot: modal(&frame, &u_dot), theta, theta_dot };
            let x = Instant::of(&frame, Phase::Rocking(side), &state, load);
            let found = Reactions::at(&x, &Second { u_ddot: modal(&frame, &u_ddot), theta_ddot });
            // m (a along, a across) of all masses in the axes of the base, whose foundation is at u = 0, h = 0
            let [mut along, mut across] = [0.0, m0 * s * B * theta_ddot];
            along += m0 * s * B * theta_dot * theta_dot;
            for (i, &Storey { m, h, .. }) in STOREYS.iter().enumerate() {
                let arm = s * B - u[i];
                along += m * (u_ddot[i] + h * theta_ddot + arm * theta_dot * theta_dot);
                across += m * (arm * theta_ddot - 2.0 * u_dot[i] * theta_dot - h * theta_dot * theta_dot);
            }
            let R_h = -(m_t * load.a_g + along * cos + across * sin);
            assert_relative_eq!(found.R_h, R_h, max_relative = 1e-12);
            assert_relative_eq!(found.R_v, m_t * (g + load.a_v) - along * sin + across * cos, max_relative = 1e-12);
        }
    }

    /// Energy and angular momentum of the masses themselves, and the gains of energy at an impact and at a landing.
    #[test]
    fn energy_and_impact_are_those_of_the_masses() {
        let frame = three_storeys();
        let (m, h) = (STOREYS.map(|of| of.m), STOREYS.map(|of| of.h));
        let stiffness = Matrix3::new(110e6, -50e6, 0.0, -50e6, 90e6, -40e6, 0.0, -40e6, 40e6);
        let &Base { m0, B, J0, r, g, m_t, .. } = frame.base();
        let [u, u_dot] = [Vector3::new(0.02, -0.05, 0.11), Vector3::new(0.4, 0.7, -0.3)];
        for side in [Side::Right, Side::Left] {
            let (s, theta, theta_dot) = (side.sign(), side.sign() * 0.1, -0.3 * side.sign());
            let state = State { u: modal(&frame, &u), u_dot: modal(&frame, &u_dot), theta, theta_dot };
            let (sin, cos) = theta.sin_cos();
            let mut expected = 0.5 * u.dot(&(stiffness * u)) + m0 * g * s * B * sin;
            expected += 0.5 * (J0 + m0 * B * B) * theta_dot * theta_dot;
            let mut momentum = -(m0 * B * B - J0) * theta_dot;
            for i in 0..3 {
                let (m, h) = (m[i], h[i]);
                let (along, across) = (u_dot[i] + h * theta_dot, (s * B - u[i]) * theta_dot);
                expected += 0.5 * m * (along * along + across * across) + m * g * ((s * B - u[i]) * sin + h * cos);
                momentum += m * h * along - m * (B * B - u[i] * u[i]) * theta_dot;
            }
            assert_relative_eq!(energy(&frame, Phase::Rocking(side), &state), expected, max_relative = 1e-13);

            let before = State { theta: 0.0, ..state };
            assert_relative_eq!(angular_momentum(&frame, &before), momentum, max_relative = 1e-13);
            let of = |phase, state: &State<Modes>| energy(&frame, phase, state);
            let energy_before = of(Phase::Rocking(side), &before);
            // (M17): a landing loses ½ D θ̇²
            let landed = land(&frame, &before);
            let D = J0 + m0 * B * B + (0..3).map(|i| m[i] * (s * B - u[i]).powi(2)).sum::<f64>();
            let lost = energy_before - of(Phase::FullContact, &landed);
            assert_relative_eq!(lost, 0.5 * D * theta_dot * theta_dot, max_relative = 1e-9);
            // each mass keeps its horizontal momentum
            let Impulse { I_h, I_v, .. } =
                Impulse::of(&frame, (Phase::Rocking(side), &before), (Phase::FullContact, &landed));
            let mu = Vector3::from(m).dot(&u);
            assert_relative_eq!(I_h, 0.0, epsilon = 1e-9);
            assert_relative_eq!(I_v, -(s * m_t * B - mu) * theta_dot, max_relative = 1e-12);
            // (M19)
            let momentum = Structure::of_body(Body { r: None, ..*frame.body() }, frame.modes(), &[]).unwrap();
            let of_masses = |with: &dyn Fn(usize) -> f64| (0..3).map(|i| m[i] * with(i)).sum::<f64>();
            let rest = of_masses(&|i| B * B - u[i] * u[i]) + m0 * B * B - J0;
            let height = of_masses(&|i| h[i] * h[i]);
            let after = J0 + m0 * B * B + height + of_masses(&|i| (B + s * u[i]).powi(2));
            assert_relative_eq!(restitution(&momentum, side, &before), (height - rest) / after, max_relative = 1e-12);
            // (M16)
            let going = State { u_dot: modal(&frame, &(-s * u_dot)), ..before };
            let (phase, after) = resolve(&frame, 0.0, side, &going);
            assert_eq!((phase, after.theta_dot), (Phase::Rocking(side.opposite()), r.unwrap() * theta_dot));
            let gained = of(phase, &after) - of(Phase::Rocking(side), &going);
            assert_relative_eq!(energy_gained(&frame, side, &going), gained, max_relative = 1e-9);
        }
    }
}
