//! The pushover: lateral force and moment against displacement (Fig 1).

use crate::{quantities::in_readable_unit, significant::significant};
use anyhow::Context;
use rocking::estimates::pushover::{Equilibrium, at_displacement, at_overturning, at_rotation, in_full_contact};
use rocking::mechanics::restraint::{Dissipators, uplift_displacement};
use rocking::{Phase, Side, Structure};
use serde::Serialize;

/// Headings of the curve.
pub const HEADINGS: [&str; 6] = ["phase", "theta[rad]", "u[m]", "delta_t[m]", "P[N]", "M[N.m]"];

/// The displacement (m) at which the base lifts off, with what a tendon adds.
fn u_cr(structure: &Structure) -> f64 {
    uplift_displacement(structure, Side::Right, 0.0, &Dissipators::default())
}

/// A corner of the curve, in SI units.
#[derive(Serialize)]
pub struct Corner {
    name: &'static str,
    delta_t: f64,
    theta: f64,
    P: f64,
    M: f64,
}

/// The corners of the curve, in its order. Refuses a strut that is too soft.
pub fn corners(structure: &Structure) -> anyhow::Result<[Corner; 3]> {
    let corner = |(name, corner)| {
        let Equilibrium { theta, delta_t, force: P, moment: M, .. } = corner;
        Corner { name, delta_t, theta, P, M }
    };
    let corners = [
        ("uplift", in_full_contact(structure, u_cr(structure))),
        ("start of rocking", at_rotation(structure, 0.0).context(TOO_SOFT)?),
        ("overturning", at_overturning(structure).context(TOO_SOFT)?),
    ];
    Ok(corners.map(corner))
}

impl Corner {
    /// The corner in a line for people.
    pub fn line(&self) -> String {
        let &Corner { name, delta_t, theta, P, M } = self;
        let ([theta, delta_t], [force, moment]) = (
            [theta, 1e3 * delta_t].map(significant),
            [(P, "N"), (M, "N.m")].map(|(of, unit)| in_readable_unit(of, unit, significant)),
        );
        format!("{name:<16} delta_t {delta_t:>8} mm, theta {theta:>8} rad, P {force:>10}, M {moment:>12}\n")
    }
}

const TOO_SOFT: &str = "the strut is too soft to hold the structure all the way to overturning: raise f_fc or lower m0";

/// The pushover from 0 to overturning, to the right, at as many `points` on each branch: full contact, then rocking. Refuses a
/// strut that is too soft.
pub fn curve(structure: &Structure, points: u32) -> anyhow::Result<Vec<Equilibrium>> {
    let end = at_overturning(structure).context(TOO_SOFT)?;
    let at = |delta_t| at_displacement(structure, delta_t).context(TOO_SOFT);
    displacements(structure, end.delta_t, points).map(at).collect()
}

/// Displacements (m) evenly on each branch: 0 to u_cr, and from just beyond to `end`.
fn displacements(structure: &Structure, end: f64, points: u32) -> impl Iterator<Item = f64> {
    let evenly = move |from: f64, to: f64| {
        (0..points)
            .map(move |i| if i == points - 1 { to } else { from + (to - from) * f64::from(i) / f64::from(points - 1) })
    };
    let u_cr = u_cr(structure);
    evenly(0.0, u_cr).chain(evenly(u_cr.next_up(), end))
}

/// A line of the curve.
pub fn line(at: &Equilibrium) -> impl Serialize + use<> {
    let &Equilibrium { phase, theta, u, delta_t, force, moment } = at;
    let phase = if phase == Phase::FullContact { "full contact" } else { "rocking right" };
    (phase, theta, u, delta_t, force, moment)
}
