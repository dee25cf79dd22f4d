//! The moment that turns a rocking base back, without a time history: what the weight, a tendon and dissipators restore while
//! the base is turned slowly.
//!
//! The moment is [`Restraint::restoring_moment`]: Eq 6 at rest with a strut that is not deformed. The forces of the elastoplastic
//! dissipators change sign on the way back, so that the loop is a flag of the height Σ_j 2 F_y |sB − ξ_j| cos(θ/2). On ground that gives
//! it is Σ ξ N cos θ − g S_1 sin θ about the middle of the base, the same there and back.

use crate::estimates::pushover::check_ties;
use crate::mechanics::restraint::{Dissipators, Restraint};
use crate::structure::quantity::{Refused, ensure};
use crate::{Side, Structure};
use serde::Serialize;

/// A point of the static loop.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FlagPoint {
    /// Rotation θ, rad.
    pub theta: f64,
    /// Moment that turns the base back, N·m.
    pub moment: f64,
}

/// The moments while the base of `structure` is turned slowly from rest to the rotation `theta` (rad, 0 to π/2) and back to 0, in
/// this many equal `steps` each way. Refuses dissipators on ground that gives, and ground that yields.
pub fn flag(structure: &Structure, theta: f64, steps: u32) -> Result<Vec<FlagPoint>, Refused> {
    check_ties(structure)?;
    ensure(structure.foundation().is_none_or(|of| !of.yields), || {
        "fs, q_u: on ground that yields the moment on the way back depends on the way there: use pushover, or simulate a slow force".into()
    })?;
    let base = structure.base();
    let there = (0..=steps).map(|i| theta * f64::from(i) / f64::from(steps));
    let mut dissipators = Dissipators::NEW;
    let at = |theta: f64| {
        if let Some(foundation) = structure.foundation() {
            let (sin, cos) = libm::sincos(theta);
            return FlagPoint {
                theta,
                moment: foundation.restoring(base, [sin, cos]) - base.g * structure.body().S_1 * sin,
            };
        }
        dissipators = dissipators.moved(base, Side::Right, theta);
        FlagPoint { theta, moment: Restraint::about(base, Side::Right, &dissipators).restoring_moment(theta) }
    };
    Ok(there.clone().chain(there.rev().skip(1)).map(at).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::restraint::centring_moments;
    use crate::run::Ending;
    use crate::run::fall::{FallPeaks, angle_of_no_return};
    use crate::run::record::Record;
    use crate::series::bisection::last_where;
    use crate::{Detail, OneMass, Parameters, Run, State};
    use std::f64::consts::FRAC_PI_2;

    const RESTRAINED: Parameters =
        Parameters { P_0: 500.0, k_t: 2e5, xi_d: 0.2, k_d: 1e6, F_y: 400.0, ..Parameters::MCMANUS };

    /// Both dissipators yield on the way there and on the way back: of a flag by hand every corner.
    #[test]
    fn the_flag_is_that_of_the_calculation_by_hand() {
        let structure = OneMass::new(RESTRAINED).unwrap();
        let Parameters { m, m0, H, B, g, P_0, k_t, xi_d, F_y, .. } = RESTRAINED;
        let points = flag(&structure.into(), 0.05, 10).unwrap();
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

    /// Beyond α_cg a tied structure comes back. Once it falls, its peak is the angle at which the static moment of weight, tendon
    /// and dissipators vanishes. A tendon of 4e4 N/m turns McManus back from everywhere: it falls where it overturns.
    #[test]
    fn a_tied_structure_falls_from_where_its_own_moment_vanishes() {
        let tied = Parameters { k_t: 2e4, xi_d: 0.2, k_d: 1e5, F_y: 300.0, ..Parameters::MCMANUS };
        let stiff = OneMass::new(Parameters { k_t: 4e4, ..tied }).unwrap();
        assert_eq!(angle_of_no_return(stiff.base()), None);
        let ground = Record::at_rest(60.0);
        let falls = |structure: OneMass, theta_dot: f64| {
            let mut watch = FallPeaks::since(0.0, &structure.into(), Detail::Auto).watch();
            let initial = State { theta: 1e-3, theta_dot, ..State::default() };
            let ending = Run { initial, ..Run::new(structure, &ground) }.follow(&mut watch).unwrap().ending;
            (ending == Ending::Overturned, watch.end())
        };
        for tied in [tied, Parameters { k_t: 1e4, P_0: 500.0, ..tied }] {
            let structure = OneMass::new(tied).unwrap();
            let no_return = angle_of_no_return(structure.base()).unwrap();
            let alpha_cg = structure.base().tan_alpha_cg.atan();
            assert!(no_return > 1.5 * alpha_cg, "{no_return}");
            let loop_there = flag(&structure.into(), no_return, 1000).unwrap();
            assert!(loop_there[1000].moment.abs() < 1e-9 * loop_there[0].moment);
            let least = last_where(0.0, 20.0, |theta_dot| !falls(structure, theta_dot).0);
            let (_, stands) = falls(structure, least);
            assert!(stands.peaks().theta().magnitude > alpha_cg && stands.fall().is_none());
            assert_eq!(stands.peaks(), stands.all());
            let (_, falls) = falls(structure, least * 1.001);
            assert!((falls.peaks().theta().magnitude - no_return).abs() < 1e-12);
        }
        let (overturns, falls) = falls(stiff, 20.0);
        assert!(overturns && falls.peaks() == falls.all());
        assert!((falls.peaks().theta().magnitude - FRAC_PI_2).abs() < 1e-12);
    }
}
