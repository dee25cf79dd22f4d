//! Displacement-controlled pushover (Fig 1): a horizontal force P on the floors, slow enough for equilibrium.
//!
//! Floor i takes the part w_i = m_i h_i/Σ m h of P (EN 1998-1, Eq 4.11), and one mass takes all of it. In full contact
//! P = u_w/C up to uplift at P h_w = hold ([`uplift`](crate::levels::uplift)), which is u_cr of one mass. Beyond it, the
//! equations without inertia, damping and ground motion, P in the direction of each coordinate on the other side, are
//!
//! ```text
//! k u = P f cos θ + g Γ sin θ     of each mode, f = Σ w φ                                               (5)
//! P [(sB − Σ f u) sin θ + h_w cos θ] = g [(s m_t B − Σ Γ u) cos θ − S_1 sin θ] + T,   h_w = Σ w h          (6)
//! ```
//!
//! with T = Σ F l cos(θ/2) of the ties ([`restraint`](crate::mechanics::restraint)). Without u, for s = +1, they leave a quadratic
//! in P, whose smaller root is the equilibrium:
//!
//! ```text
//! C sin θ cos θ P² − [B sin θ + h_w cos θ + g A cos 2θ] P + g (m_t B − g G sin θ) cos θ − g S_1 sin θ + T = 0
//! C = Σ f²/k,   A = Σ f Γ/k,   G = Σ Γ²/k
//! ```
//!
//! On ground that gives the base turns about its middle: B is 0 in these equations, T is Σ ξ N cos θ of the points, whose pressed ones and y
//! follow from the vertical balance ([`Foundation`](crate::Foundation)), and the first points of elastic ground leave it at sin θ = y_s/ξ.
//!
//! As the base lifts off, the force drops because uplift leaves out the moment of the displaced weights: of one mass by
//! 1/(1 + g/(ω_fc² H)) (2e-3 for Evison, 5e-3 for McManus).

use crate::mechanics::instant::MassPoint;
use crate::mechanics::restraint::{Angles, Dissipators, Restraint};
use crate::numbers::Angle;
use crate::run::fall::angle_of_no_return;
use crate::series::bisection::last_where;
use crate::structure::quantity::{Refused, ensure};
use crate::{Base, Foundation, Mode, Phase, Side, Structure};
use std::f64::consts::FRAC_PI_2;

/// The structure at rest under a horizontal force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equilibrium {
    /// Phase: full contact, or rocking about a side.
    pub phase: Phase,
    /// Rotation of the base, rad.
    pub theta: f64,
    /// Elastic displacement of the top floor, m.
    pub u: f64,
    /// Lateral displacement of the top floor, m (Eq 26).
    pub delta_t: f64,
    /// Horizontal force P, N.
    pub force: f64,
    /// The moment of P about the base, the restoring moment, N·m.
    pub moment: f64,
}

/// Most points on each branch of a curve.
pub const MOST_POINTS: u32 = 1_000_000;

/// The refusal of a structure that gives way before it overturns.
pub fn too_soft() -> Refused {
    let remedy = "raise f_fc or its stiffnesses, or lower m0";
    Refused::by(format!("the structure is too soft to be held all the way to overturning: {remedy}"))
}

/// Refuses dissipators on ground that gives, whose plastic elongation follows from the way there.
pub fn check_ties(structure: &Structure) -> Result<(), Refused> {
    ensure(structure.foundation().is_none() || structure.base().ties.k_d == 0.0, || {
        "k_d: on ground that gives the static moment of dissipators depends on the way there: leave k_d and F_y out, or simulate a slow force"
            .into()
    })
}

/// A structure under a horizontal force on its floors.
#[derive(Clone, Debug)]
pub struct Pushover {
    structure: Structure,
    /// Heights of the force h_w and of the top floor, m.
    height: f64,
    top: f64,
    /// C (m/N), A (s²) and G (kg·s²).
    C: f64,
    A: f64,
    G: f64,
    /// Displacement of the top floor under P = 1 N (m/N), and under the weights if they act sideways and g is 1 (s²).
    of_top: [f64; 2],
}

impl Pushover {
    /// The pushover of `structure`, which must have floors, and on ground that gives no dissipators.
    pub fn new(structure: &Structure) -> Result<Pushover, Refused> {
        check_ties(structure)?;
        let floors = structure.floors();
        let none = || Refused::by("the structure has no floors that take the force: give masses, heights and shapes");
        let top = floors.last().ok_or_else(none)?;
        let whole: f64 = floors.iter().map(|floor| floor.mass * floor.height).sum();
        let mean = |of: &dyn Fn(usize) -> f64| {
            let parts = floors.iter().enumerate().map(|(i, floor)| floor.mass * floor.height / whole * of(i));
            parts.sum::<f64>()
        };
        let force = |j: usize| mean(&|i| floors[i].shape.numbers()[j]);
        let weight = |j: usize| structure.modes()[j].gamma;
        let under = |a: &dyn Fn(usize) -> f64, b: &dyn Fn(usize) -> f64| {
            let each = |(j, mode): (usize, &Mode)| a(j) * b(j) / mode.stiffness;
            structure.modes().iter().enumerate().map(each).sum::<f64>()
        };
        let at_top = |j: usize| top.shape.numbers()[j];
        Ok(Pushover {
            structure: structure.clone(),
            height: mean(&|i| floors[i].height),
            top: top.height,
            C: under(&force, &force),
            A: under(&force, &weight),
            G: under(&weight, &weight),
            of_top: [under(&at_top, &force), under(&at_top, &weight)],
        })
    }

    /// The curve from rest to overturning, to the right: `points` evenly over the displacements in full contact, then as many
    /// while rocking, or from the first point that leaves the ground.
    pub fn curve(&self, points: u32) -> Result<Vec<Equilibrium>, Refused> {
        ensure((2..=MOST_POINTS).contains(&points), || {
            format!("points = {points} is out of range: 2 to {MOST_POINTS} on each branch are possible")
        })?;
        let end = self.at_overturning().ok_or_else(too_soft)?.delta_t;
        let lifts = self.at_uplift().delta_t;
        let evenly = |from: f64, to: f64| {
            let part = move |i| f64::from(i) / f64::from(points - 1);
            (0..points).map(move |i| if i == points - 1 { to } else { from + (to - from) * part(i) })
        };
        let displacements = evenly(0.0, lifts).chain(evenly(lifts.next_up(), end));
        displacements.map(|delta_t| self.at_displacement(delta_t).ok_or_else(too_soft)).collect()
    }

    /// Full contact, about to lift off to the right.
    pub fn at_uplift(&self) -> Equilibrium {
        let release = |of: &Foundation| self.at_rotation(of.first_release(self.structure.base()));
        if let Some(release) = self.structure.foundation().and_then(release) {
            return release;
        }
        self.in_full_contact(self.structure.base().hold_at_rest() / self.height * self.of_top[0])
    }

    /// Full contact with the top floor displaced by `u` (m).
    fn in_full_contact(&self, u: f64) -> Equilibrium {
        let force = u / self.of_top[0];
        Equilibrium { phase: Phase::FullContact, theta: 0.0, u, delta_t: u, force, moment: force * self.height }
    }

    /// Rocking at the rotation `theta` (rad), |θ| ≤ π/2; 0 is the start of rocking to the right. `None` for a structure too
    /// soft to be held there. The dissipators have been moved there from rest.
    pub fn at_rotation(&self, theta: f64) -> Option<Equilibrium> {
        let &Pushover { ref structure, height, top, C, A, G, of_top } = self;
        let (&Base { m_t, g, .. }, first, side) = (structure.base(), structure.body().S_1, Side::of(theta));
        let s = side.sign();
        let (sin, cos) = libm::sincos(theta.abs());
        let (B, held, phase) = self.held(theta, [sin, cos]);
        let (quadratic, linear) = (C * sin * cos, B * sin + height * cos + g * A * (cos * cos - sin * sin));
        let constant = g * ((m_t * B - g * G * sin) * cos - first * sin) + held;
        let discriminant = linear * linear - 4.0 * quadratic * constant;
        if discriminant < 0.0 {
            return None;
        }
        let force = 2.0 * constant / (linear + discriminant.sqrt());
        let [u, of_force] = [of_top, [C, A]].map(|[push, weight]| force * cos * push + g * sin * weight);
        let moment = force * (height * cos + (B - of_force) * sin);
        let delta_t = MassPoint { share: 1.0, height: top, u: s * u }.right(s * B, &theta.turn());
        Some(Equilibrium { phase, theta, u: s * u, delta_t, force: s * force, moment: s * moment })
    }

    /// The half-width of the base about whose edge it turns, 0 if it turns about its middle; the moment of ties and of ground that gives, to
    /// the right; and the phase, of the base turned to `theta` (rad).
    fn held(&self, theta: f64, [sin, cos]: [f64; 2]) -> (f64, f64, Phase) {
        let (base, side) = (self.structure.base(), Side::of(theta));
        let Some(foundation) = self.structure.foundation() else {
            let dissipators = Dissipators::NEW.moved(base, side, theta);
            let held = side.sign() * Restraint::about(base, side, &dissipators).moment(&Angles::Any.chord(theta, 0.0));
            return (base.B, held, Phase::Rocking(side));
        };
        let is_full = theta.abs() <= foundation.first_release(base);
        (0.0, foundation.restoring(base, [sin, cos]), if is_full { Phase::FullContact } else { Phase::Rocking(side) })
    }

    /// The structure with its top floor displaced by `delta_t` (m): full contact up to uplift, rocking beyond. `None` where rocking
    /// does not reach, B and the height of the floor at most.
    pub fn at_displacement(&self, delta_t: f64) -> Option<Equilibrium> {
        if delta_t.abs() <= self.at_uplift().u && self.structure.foundation().is_none() {
            return Some(self.in_full_contact(delta_t));
        }
        if delta_t == 0.0 {
            return self.at_rotation(0.0);
        }
        let reaches = |theta| self.at_rotation(theta).is_some_and(|there| there.delta_t >= delta_t.abs());
        if !reaches(FRAC_PI_2) {
            return None;
        }
        let theta = last_where(0.0, FRAC_PI_2, |theta| !reaches(theta));
        self.at_rotation(theta.copysign(delta_t))
    }

    /// The unstable equilibrium without a force, beyond which the structure overturns (to the right); at π/2 of one that its
    /// tendon turns back from everywhere. `None` for a structure too soft to be held on the way there.
    pub fn at_overturning(&self) -> Option<Equilibrium> {
        let of_base = angle_of_no_return(self.structure.base()).filter(|_| self.structure.foundation().is_none());
        let farthest = of_base.unwrap_or(FRAC_PI_2); // an elastic structure overturns before
        let restores = |theta| self.at_rotation(theta).is_some_and(|there| there.force >= 0.0);
        self.at_rotation(last_where(0.0, farthest, restores))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::levels::nonlinear::accelerations;
    use crate::mechanics::load::Load;
    use crate::structure::description::{Damping, Storey};
    use crate::structure::ground::ContactPoint;
    use crate::structure::natural_quantities::Numbers;
    use crate::{Ground, OneMass, Parameters, State};
    use approx::assert_relative_eq;
    use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
    use proptest::prelude::*;

    fn specimens() -> [OneMass; 2] {
        [Parameters::EVISON, Parameters::MCMANUS].map(|parameters| OneMass::new(parameters).unwrap())
    }

    fn of(structure: &OneMass) -> Pushover {
        Pushover::new(&(*structure).into()).unwrap()
    }

    proptest! {
        /// The force cancels the accelerations of Eqs 5 and 6.
        #[test]
        fn the_force_balances_equations_5_and_6(theta in -1.4..1.4f64, preset in 0..3usize) {
            let tied = Parameters { P_0: 300.0, k_t: 2e4, k_d: 1e5, F_y: 200.0, ..Parameters::MCMANUS };
            let [evison, mcmanus] = specimens();
            let structure = [evison, mcmanus, OneMass::new(tied).unwrap()][preset];
            let &Parameters { m, m0, H, B, J0, .. } = structure.parameters();
            let Equilibrium { u, force, .. } = of(&structure).at_rotation(theta).unwrap();
            let side = Side::of(theta);
            let lever = side.sign() * B - u;
            let state = State { u, theta, ..State::default() };
            let moved = Dissipators::NEW.moved(structure.base(), side, theta);
            let released = accelerations(&structure, side, &state, Load::default(), &moved).unwrap();
            let mass = Matrix2::new(m, m * H, m * H, J0 + m * H * H + m * lever * lever + m0 * B * B);
            let direction = Vector2::new(theta.cos(), H * theta.cos() + lever * theta.sin());
            let unbalanced = mass * released + force * direction;
            let size = structure.k * u.abs().max(0.1 * structure.u_cr) * H;
            prop_assert!(unbalanced.norm() < 1e-13 * size, "{unbalanced}");
        }

        #[test]
        fn a_displacement_is_met_to_rounding(delta_t in -1.3..1.3f64, preset in 0..2usize) {
            let structure = specimens()[preset];
            let there = of(&structure).at_displacement(delta_t).unwrap();
            prop_assert!((there.delta_t - delta_t).abs() < 1e-15, "{there:?}");
        }
    }

    #[test]
    fn uplift_follows_full_contact_with_the_drop_that_u_cr_leaves_out() {
        for structure in specimens() {
            let &Parameters { H, g, .. } = structure.parameters();
            let left_out = 1.0 + g / (structure.omega_fc * structure.omega_fc * H);
            let rocking = of(&structure).at_rotation(0.0).unwrap();
            assert_relative_eq!(rocking.u, structure.u_cr / left_out, max_relative = 1e-14);
            let contact = of(&structure).at_uplift();
            assert_eq!(contact.phase, Phase::FullContact);
            assert_relative_eq!(contact.u, structure.u_cr, max_relative = 1e-14);
            assert_relative_eq!(contact.force, left_out * rocking.force, max_relative = 1e-14);
            let weight_moment = structure.gamma * structure.parameters().m * g * structure.parameters().B;
            assert_relative_eq!(contact.moment, weight_moment, max_relative = 1e-14);
            let lifted = of(&structure).at_displacement(-contact.u.next_up()).unwrap();
            assert_eq!(lifted.phase, Phase::Rocking(Side::Left));
        }
    }

    /// While rocking the force falls all the way to overturning, where the moment is 0 with it.
    #[test]
    fn the_stiffness_is_negative_until_overturning() {
        for structure in specimens() {
            let end = of(&structure).at_overturning().unwrap();
            let weight = structure.gamma * structure.parameters().m * structure.parameters().g;
            assert!(end.force >= 0.0 && end.force < 1e-13 * weight);
            assert_relative_eq!(end.theta, libm::atan(structure.base().tan_alpha_cg), max_relative = 6e-3);
            assert!(end.theta < libm::atan(structure.base().tan_alpha_cg));
            let forces: Vec<_> = (0..=50)
                .map(|i| of(&structure).at_rotation(f64::from(i) / 50.0 * end.theta).unwrap())
                .map(|there| (there.force, there.moment))
                .collect();
            assert!(forces.windows(2).all(|pair| pair[1].0 < pair[0].0 && pair[1].1 < pair[0].1));
        }
    }

    #[test]
    fn too_soft_a_strut_and_too_far_a_displacement_have_no_equilibrium() {
        let soft = OneMass::new(Parameters { f_fc: 0.05, m0: 5e4, ..Parameters::EVISON }).unwrap();
        assert_eq!(of(&soft).at_rotation(0.5), None);
        assert_eq!(of(&specimens()[0]).at_displacement(1.4), None);
    }

    /// Three storeys, balanced mass by mass with their stiffness matrix; a file of modes has no floors that take the force.
    #[test]
    fn three_storeys_are_in_balance() {
        let (m, h) = (Vector3::new(4e4, 4e4, 3e4), Vector3::new(3.5, 7.0, 10.5));
        let [B, m0, P_0, k_t] = [1.5, 2e4, 3e4, 2e5];
        let base = Numbers::of(&[("m0", m0), ("J0", 3e4), ("B", B), ("P_0", P_0), ("k_t", k_t)]).unwrap();
        let [a, b, c] = [6e6, 5e6, 4e6];
        let storeys: Vec<_> = [a, b, c].iter().zip(m.iter().zip(&h)).map(|(&k, (&m, &h))| Storey { m, h, k }).collect();
        let structure = Structure::from_storeys(&base, &Damping::All(0.02), &storeys).unwrap();
        let stiffness = Matrix3::new(a + b, -b, 0.0, -b, b + c, -c, 0.0, -c, c);
        let (pushed, g, w) = (Pushover::new(&structure).unwrap(), 9.81, m.component_mul(&h) / m.dot(&h));
        let weight = (m.sum() + m0) * g;
        for theta in [0.0, 0.02, 0.1, 0.3] {
            let Equilibrium { u, delta_t, force, moment, .. } = pushed.at_rotation(theta).unwrap();
            let (sin, cos) = theta.sin_cos();
            let displaced = stiffness.try_inverse().unwrap() * (w * force * cos + m * g * sin);
            assert_relative_eq!(u, displaced[2], max_relative = 1e-10);
            assert_relative_eq!(delta_t, B * (1.0 - cos) + u * cos + h[2] * sin, max_relative = 1e-12);
            let tendon = (P_0 + k_t * 2.0 * B * (theta / 2.0).sin()) * B * (theta / 2.0).cos();
            let restoring = (weight * B - m.dot(&displaced) * g) * cos - m.dot(&h) * g * sin + tendon;
            assert_relative_eq!(moment, restoring, max_relative = 1e-10);
            let about = (0..3).map(|i| w[i] * ((B - displaced[i]) * sin + h[i] * cos)).sum::<f64>();
            assert_relative_eq!(moment, force * about, max_relative = 1e-10);
        }
        let N = |of: &ContactPoint, sin: f64, y: f64| (of.k * (of.xi * sin - y)).clamp(0.0, of.q);
        for fs in [None, Some(1.5), Some(3.0)] {
            let ground = Ground { f_v: Some(6.0), n_points: Some(5.0), fs, ..Ground::default() };
            let bedded = structure
                .with(Parameters { k_t: 0.0, P_0: 0.0, ..structure.parameters() })
                .unwrap()
                .on(&ground)
                .unwrap();
            let (points, on_bed) = (&bedded.foundation().unwrap().points, Pushover::new(&bedded).unwrap());
            for theta in [1e-5, 2e-3, 0.02, 0.2] {
                let (Equilibrium { u, force, moment, .. }, (sin, cos)) =
                    (on_bed.at_rotation(theta).unwrap(), theta.sin_cos());
                let displaced = stiffness.try_inverse().unwrap() * (w * force * cos + m * g * sin);
                assert_relative_eq!(u, displaced[2], max_relative = 1e-10);
                let carried = |y: f64| points.iter().map(|of| N(of, sin, y)).sum::<f64>() > weight;
                let y = last_where(-1.0, 1.0, carried);
                let held: f64 = points.iter().map(|of| N(of, sin, y) * of.xi * cos).sum();
                let restoring = held - m.dot(&displaced) * g * cos - m.dot(&h) * g * sin;
                assert_relative_eq!(moment, restoring, max_relative = 1e-8);
                let about = (0..3).map(|i| w[i] * (h[i] * cos - displaced[i] * sin)).sum::<f64>();
                assert_relative_eq!(moment, force * about, max_relative = 1e-9);
            }
            let sin = on_bed.at_uplift().theta.sin(); // the left edge touches the ground without force
            let carried = |y: f64| points.iter().map(|of| N(of, sin, y)).sum::<f64>() > weight;
            assert_relative_eq!(points[0].xi * sin, last_where(-1.0, 1.0, carried), max_relative = 1e-12);
        }
        let lifts = pushed.at_uplift();
        assert_relative_eq!(lifts.force * w.dot(&h), (weight + P_0) * B, max_relative = 1e-12);
        assert_relative_eq!(lifts.u, (stiffness.try_inverse().unwrap() * w * lifts.force)[2], max_relative = 1e-10);
        let bare = Structure::of_body(*structure.body(), structure.modes(), &[]).unwrap();
        assert!(Pushover::new(&bare).unwrap_err().to_string().starts_with("the structure has no floors"));
    }
}
