//! Energy gained at impact: [`impact::energy_gained`] tells how much, [`impact::lossless_restitution`] with which r none is.

use super::*;
use rocking::mechanics::energy::energy;
use rocking::mechanics::impact;

/// A structure that gains: McManus's specimen, softer, with little restitution.
const GAINER: Parameters = Parameters { r: 0.5, f_fc: 2.0, ..Parameters::MCMANUS };

const RELEASE: f64 = 0.02; // rotation from rest, rad
const DURATION: f64 = 0.5; // s

/// The energy of an example over time, on ground at rest.
pub fn show() -> Result<Exhibit> {
    let scene = at_rest(GAINER, State { theta: RELEASE, ..State::default() }, DURATION);
    let whole = scene.structure.into();
    let rest = energy(&whole, Phase::FullContact, &<State>::default());
    let history = exact(&scene, Detail::Auto, every(1e-3 * DURATION))?;
    let over_rest = |motion: &rocking::Motion| (motion.time, energy(&whole, motion.phase, &motion.state) - rest);
    let path: Vec<_> = history.motions.iter().map(over_rest).collect();
    let gained = |impact: &rocking::Transition| {
        let side = Side::of(-impact.before.theta_dot); // s θ falls to 0
        (impact.time, impact::energy_gained(&whole, side, &impact.before))
    };
    let mut gains = history.transitions.iter().filter(|transition| is_impact(transition)).map(gained);
    let (time, gain) = gains.find(|(_, gain)| *gain > 0.0).context("the example gains energy")?;
    let lossless = |parameters, part: f64| {
        let structure = structure(parameters);
        impact::lossless_restitution(&structure, part * structure.u_cr)
    };
    let range = |parameters| {
        lossless(parameters, 1.0).map_or("no r".into(), |[least, most]| format!("{least:.3} ≤ r ≤ {most:.4}"))
    };
    let limit = |parameters| lossless(parameters, 0.0).map_or(0.0, |[least, _]| least);
    Ok(Exhibit {
        key: "energy-gain",
        values: values([
            ("time", &time),
            ("gain", &gain),
            ("evison", &limit(Parameters::EVISON)),
            ("mcmanus", &limit(Parameters::MCMANUS)),
            ("evison_at_u_cr", &range(Parameters::EVISON)),
            ("mcmanus_at_u_cr", &range(Parameters::MCMANUS)),
        ]),
        series: vec![series("McManus's geometry, 2 Hz, r = 0.5", path)],
    })
}
