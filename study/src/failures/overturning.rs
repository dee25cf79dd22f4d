//! Near-overturning: errors grow like e^{p t}.

use super::*;

const DURATION: f64 = 14.0; // s
const SAMPLE: f64 = 0.02; // time between results, s
const CHANGE: f64 = 1e-12; // relative distance of the two release angles from the one that balances

/// McManus's specimen released at rest, to where it overturns.
fn released(theta: f64) -> ReferenceHistory {
    let scene = at_rest(Parameters::MCMANUS, State { theta, ..State::default() }, DURATION);
    exact(&scene, Detail::Auto, every(SAMPLE)).expect("a release has an answer")
}

/// The rate at which a small error grows at the unstable equilibrium, 1/s: Eq 6 linearised at θ = α_cg.
pub fn growth() -> f64 {
    let structure = structure(Parameters::MCMANUS);
    structure.base().p_l / structure.base().tan_alpha_cg.atan().cos().sqrt()
}

/// Two releases on either side of the angle that balances.
pub fn show() -> Result<Exhibit> {
    let alpha_cg = structure(Parameters::MCMANUS).base().tan_alpha_cg.atan();
    let overturns = |one: &Transition| matches!(one.kind, TransitionKind::Overturning(_));
    let falls_back = |theta| !released(theta).transitions.iter().any(overturns);
    let balance = last_where(0.5 * alpha_cg, 1.5 * alpha_cg, falls_back);
    let [inside, outside] = [1.0 - CHANGE, 1.0 + CHANGE].map(|factor| released(balance * factor).theta());
    let difference: Vec<_> = inside.iter().zip(&outside).map(|((t, a), (_, b))| (*t, (a - b).abs())).collect();
    let rate = growth();
    let start = difference[(2.0 / SAMPLE) as usize];
    let theory: Vec<_> = difference.iter().map(|(t, _)| (*t, start.1 * (rate * (t - start.0)).exp())).collect();
    Ok(Exhibit {
        key: "near-overturning",
        values: values([("rate", &rate), ("doubling", &(1e3 * 2f64.ln() / rate))]),
        series: vec![series("e^(p t)", theory), series("two releases, 2·10⁻¹² apart", difference)],
    })
}
