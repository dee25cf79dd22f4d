//! The moment that turns a rocking base back, without a time history: what the weight, a tendon and dissipators restore while
//! the base is turned slowly.
//!
//! The moment is [`Restraint::restoring_moment`]: Eq 6 at rest with a strut that is not deformed. The forces of the elastoplastic
//! dissipators change sign on the way back, so that the loop is a flag of the height Σ_j 2 F_y |sB − ξ_j| cos(θ/2).

use crate::mechanics::restraint::{Dissipators, Restraint};
use crate::{Base, Side};
use serde::Serialize;

/// A point of the static loop.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FlagPoint {
    /// Rotation θ, rad.
    pub theta: f64,
    /// Moment that turns the base back, N·m.
    pub moment: f64,
}

/// The moments while the `base` is turned slowly from rest to the rotation `theta` (rad, 0 to π/2) and back to 0, in
/// this many equal `steps` each way.
pub fn flag(base: &Base, theta: f64, steps: u32) -> Vec<FlagPoint> {
    let there = (0..=steps).map(|i| theta * f64::from(i) / f64::from(steps));
    let mut dissipators = Dissipators::NEW;
    let at = |theta: f64| {
        dissipators = dissipators.moved(base, Side::Right, theta);
        FlagPoint { theta, moment: Restraint::about(base, Side::Right, &dissipators).restoring_moment(theta) }
    };
    there.clone().chain(there.rev().skip(1)).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::OneMass;
    use crate::Parameters;
    use crate::mechanics::restraint::centring_moments;

    const RESTRAINED: Parameters =
        Parameters { P_0: 500.0, k_t: 2e5, xi_d: 0.2, k_d: 1e6, F_y: 400.0, ..Parameters::MCMANUS };

    /// Both dissipators yield on the way there and on the way back: of a flag by hand every corner.
    #[test]
    fn the_flag_is_that_of_the_calculation_by_hand() {
        let structure = OneMass::new(RESTRAINED).unwrap();
        let Parameters { m, m0, H, B, g, P_0, k_t, xi_d, F_y, .. } = RESTRAINED;
        let points = flag(structure.base(), 0.05, 10);
        assert_eq!(points.len(), 21);
        let elastic = |theta: f64| {
            let by_weight = (m + m0) * g * B * theta.cos() - m * g * H * theta.sin();
            by_weight + P_0 * B * (theta / 2.0).cos() + k_t * B * B * theta.sin()
        };
        let yielding = |theta: f64| 2.0 * B * F_y * (theta / 2.0).cos(); // the levers B − ξ and B + ξ
        for FlagPoint { theta, moment } in points[1..=10].iter().copied() {
            let expected = elastic(theta) + yielding(theta);
            assert!((moment - expected).abs() <= 1e-12 * expected, "{theta}: {moment}, {expected}");
        }
        for FlagPoint { theta, moment } in &points[12..] {
            let expected = elastic(*theta) - yielding(*theta);
            assert!((moment - expected).abs() <= 1e-12 * expected.abs(), "{theta}: {moment}, {expected}");
        }
        assert_eq!(points[0].moment, elastic(0.0));
        // with the base down, the residual forces decide whether it stays down
        let [restoring, residual] = centring_moments(structure.base());
        assert!((points[20].moment - (restoring - residual)).abs() < 1e-9 * restoring);
        assert!((residual - F_y * ((B - xi_d) + (B + xi_d))).abs() < 1e-12 * residual);
    }
}
