//! Near-overturning: errors grow like e^{p t}.

use super::history::{History, at_rest, every, exact};
use super::{Exhibit, RIGHT, WRONG};
use crate::chart::{Axis, Entry, Panel, Style, colour};
use crate::scene::structure;
use anyhow::Result;
use minijinja::context;
use rocking::run::RunError;
use rocking::{Detail, Parameters, State, TransitionKind};

/// How long the structure is followed, s.
const DURATION: f64 = 14.0;

/// Time between results, s.
const SAMPLE: f64 = 0.02;

/// Relative distance of the two release angles from the one that balances.
const CHANGE: f64 = 1e-12;

/// McManus's specimen released at rest, to where it overturns.
fn released(theta: f64) -> Result<History, RunError> {
    exact(&at_rest(Parameters::MCMANUS, State { theta, ..State::default() }, DURATION), Detail::Auto, every(SAMPLE))
}

fn overturns(history: &History) -> bool {
    history.transitions.iter().any(|transition| matches!(transition.kind, TransitionKind::Overturning(_)))
}

/// The rate at which a small error grows at the unstable equilibrium, 1/s: Eq 6 linearised at θ = α_cg.
pub fn growth() -> f64 {
    let structure = structure(Parameters::MCMANUS);
    structure.p_l / structure.tan_alpha_cg.atan().cos().sqrt()
}

/// Two releases on either side of the angle that balances.
pub fn show() -> Result<Exhibit> {
    let structure = structure(Parameters::MCMANUS);
    let alpha_cg = structure.tan_alpha_cg.atan();
    let (mut low, mut high) = (0.5 * alpha_cg, 1.5 * alpha_cg);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        *(if overturns(&released(middle)?) { &mut high } else { &mut low }) = middle;
    }
    let inside = released(low * (1.0 - CHANGE))?.theta();
    let outside = released(low * (1.0 + CHANGE))?.theta();
    let difference: Vec<_> = inside.iter().zip(&outside).map(|((t, a), (_, b))| (*t, (a - b).abs())).collect();
    let rate = growth();
    let start = difference[(2.0 / SAMPLE) as usize];
    let theory: Vec<_> = [0.0, DURATION].map(|t| (t, start.1 * (rate * (t - start.0)).exp())).into();
    let balance = Style::dashed(colour::GREY, 1);
    let guide = Style::dashed(colour::BLUE, 2);
    let history = Panel::new(
        "released two parts in 10¹² apart",
        Axis::linear("time, s", 0.0, DURATION),
        Axis::linear("θ, rad", -0.5, 1.6),
    )
    .with("unstable equilibrium", [(0.0, alpha_cg), (DURATION, alpha_cg)], balance)
    .with("overturns", outside.iter().copied(), WRONG)
    .with("falls back", inside.iter().copied(), RIGHT)
    .note((0.0, alpha_cg + 0.09), "α_cg", colour::GREY);
    let growth = Panel::new(
        "their difference",
        Axis::linear("time, s", 0.0, DURATION),
        Axis::logarithmic("|Δθ|, rad", 1e-13, 10.0),
    )
    .with("theory", theory, guide)
    .with("difference", difference, RIGHT);
    let doubling = 1e3 * 2f64.ln() / rate;
    Ok(Exhibit {
        key: "near-overturning",
        title: "Near-overturning",
        values: context! { rate => format!("{rate:.3}"), doubling => format!("{doubling:.0}") },
        panels: vec![history, growth],
        legend_columns: 4,
        legend: vec![
            Entry::new("θ₀ (1 − 10⁻¹²): falls back", RIGHT),
            Entry::new("θ₀ (1 + 10⁻¹²): overturns", WRONG),
            Entry::new("e^(p t)", guide),
            Entry::new("unstable equilibrium", balance),
        ],
    })
}
