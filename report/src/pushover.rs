//! The pushover: lateral force and moment against displacement (Fig 1).

use crate::quantities::in_readable_unit;
use rocking::Refused;
use rocking::digits::significant;
use rocking::estimates::pushover::{Equilibrium, Pushover, too_soft};
use serde::Serialize;

pub const HEADINGS: [&str; 6] = ["phase", "theta[rad]", "u[m]", "delta_t[m]", "P[N]", "M[N.m]"];

/// A corner of the curve, in SI units.
#[derive(Serialize)]
pub struct Corner {
    name: &'static str,
    delta_t: f64,
    theta: f64,
    P: f64,
    M: f64,
}

/// The corners of the curve, in its order; on ground that gives rocking starts where the first point leaves it. Refuses a structure that is
/// too soft.
pub fn corners(pushed: &Pushover) -> Result<Vec<Corner>, Refused> {
    let corner = |(name, corner)| {
        let Equilibrium { theta, delta_t, force: P, moment: M, .. } = corner;
        Corner { name, delta_t, theta, P, M }
    };
    let start = pushed.at_rotation(0.0).ok_or_else(too_soft)?;
    let start = Some(("start of rocking", start)).filter(|(_, start)| start.force > 0.0);
    let end = ("overturning", pushed.at_overturning().ok_or_else(too_soft)?);
    Ok([("uplift", pushed.at_uplift())].into_iter().chain(start).chain([end]).map(corner).collect())
}

impl Corner {
    pub fn line(&self) -> String {
        let &Corner { name, delta_t, theta, P, M } = self;
        let ([theta, delta_t], [force, moment]) = (
            [theta, 1e3 * delta_t].map(significant),
            [(P, "N"), (M, "N.m")].map(|(of, unit)| in_readable_unit(of, unit, significant)),
        );
        format!("{name:<16} delta_t {delta_t:>8} mm, theta {theta:>8} rad, P {force:>10}, M {moment:>12}\n")
    }
}

pub fn line(at: &Equilibrium) -> impl Serialize + use<> {
    let &Equilibrium { phase, theta, u, delta_t, force, moment } = at;
    (phase.name(), theta, u, delta_t, force, moment)
}
