//! Energy gained at impact: [`impact::energy_gained`] tells how much, [`impact::greatest_gain`] how much at most.

use super::history::{History, at_rest, every, exact};
use super::{Exhibit, RIGHT, WRONG};
use crate::chart::{Axis, Entry, Marker, Panel, Style, colour};
use crate::scene::structure;
use anyhow::{Context, Result};
use minijinja::context;
use rocking::mechanics::energy::energy;
use rocking::mechanics::impact;
use rocking::{Detail, Motion, Parameters, Phase, Side, State, Structure, Transition, TransitionKind};

/// Whether any impact with u = 0 after which rocking goes on raises the energy, found by trying states through the
/// library's own reset and energy.
pub fn some_impact_raises(structure: &Structure) -> bool {
    const TRIES: i32 = 4000;
    let H = structure.parameters().H;
    (0..TRIES).any(|k| {
        // u̇ from −2 H |θ̇| to 2 H |θ̇|
        let u_dot = 4.0 * (f64::from(k) / f64::from(TRIES) - 0.5) * H;
        let before = State { u_dot, theta_dot: -1.0, ..State::default() };
        let (phase, after) = impact::resolve(structure, Side::Right, &before);
        let rise = energy(structure, phase, &after) - energy(structure, Phase::Rocking(Side::Right), &before);
        matches!(phase, Phase::Rocking(_)) && rise > 0.0
    })
}

/// A structure that gains: McManus's specimen, softer, with little restitution.
const GAINER: Parameters = Parameters { r: 0.5, f_fc: 2.0, ..Parameters::MCMANUS };

/// Where it is released, at rest.
const RELEASE: f64 = 0.02;

/// How long it is followed, s.
const DURATION: f64 = 0.5;

/// Time, s, and energy over that at rest, J.
type Instant = (f64, f64);

/// The energy of the example over time, on ground at rest, and its transitions.
fn energy_history() -> Result<(Vec<Instant>, Vec<Transition>)> {
    let scene = at_rest(GAINER, State { theta: RELEASE, ..State::default() }, DURATION);
    let rest = energy(&scene.structure, Phase::FullContact, &State::default());
    let History { motions, transitions } = exact(&scene, Detail::Auto, every(1e-3 * DURATION))?;
    let over_rest = |motion: &Motion| (motion.time, energy(&scene.structure, motion.phase, &motion.state) - rest);
    Ok((motions.iter().map(over_rest).collect(), transitions))
}

/// Slenderness in which r = 1 − 4 (m + m0) B²/J_P is one curve: √((m H² + J0)/((m + m0) B²)), which is H/(B √γ) for J0 = 0.
fn slenderness(structure: &Structure) -> f64 {
    let &Parameters { m, m0, H, B, J0, .. } = structure.parameters();
    ((m * H * H + J0) / ((m + m0) * B * B)).sqrt()
}

/// The region and an example.
pub fn show() -> Result<Exhibit> {
    const WIDEST: f64 = 8.0;
    const COLUMNS: usize = 56;
    const ROWS: usize = 40;
    let mut map = Panel::new(
        "where an impact can raise the energy (u = 0)",
        Axis::linear("√((m H² + J0)/((m + m0) B²)), or H/(B √γ) without J0", 1.0, WIDEST),
        Axis::linear("coefficient of restitution r", 0.0, 1.0),
    );
    let (width, height) = ((WIDEST - 1.0) / COLUMNS as f64, 1.0 / ROWS as f64);
    for i in 0..COLUMNS {
        for j in 0..ROWS {
            let (x, r) = (1.0 + (i as f64 + 0.5) * width, (j as f64 + 0.5) * height);
            // m0 = m, J0 = 0: γ = 2
            let m0 = Parameters::EVISON.m;
            let parameters = Parameters { H: x * 2f64.sqrt() * 0.285, B: 0.285, m0, r, ..Parameters::EVISON };
            if some_impact_raises(&structure(parameters)) {
                let (left, low) = (1.0 + i as f64 * width, j as f64 * height);
                map = map.area((left, left + width), (low, low + height), colour::PALE);
            }
        }
    }
    let boundary = (0..=100).map(|k| 1.0 + 0.01 * f64::from(k) * (WIDEST - 1.0));
    let boundary = boundary.map(|x| (x, 1.0 - 4.0 / (x * x + 1.0))).filter(|(_, r)| *r >= 0.0);
    map = map.with("r = 1 − 4 (m + m0) B²/J_P", boundary, RIGHT);
    let specimen = Style::marked(colour::BLUE, 0, Marker::Circle);
    let gainer = Style::marked(colour::VERMILLION, 0, Marker::Diamond);
    for (name, parameters, style) in [
        ("Evison", Parameters::EVISON, specimen),
        ("McManus", Parameters::MCMANUS, specimen),
        ("the example", GAINER, gainer),
    ] {
        let at = (slenderness(&structure(parameters)), parameters.r);
        map = map.with(name, [at], style).note((at.0 + 0.05, at.1 - 0.03), name, style.colour);
    }
    let (history, transitions) = energy_history()?;
    let gainer_structure = structure(GAINER);
    let mut side = Side::Right;
    let mut gain = None;
    for transition in &transitions {
        if let TransitionKind::Impact(next) = transition.kind {
            let change = impact::energy_gained(&gainer_structure, side, &transition.before);
            if change > 0.0 && gain.is_none() {
                gain = Some((transition.time, change));
            }
            side = next;
        }
    }
    let (time, change) = gain.context("the example gains energy")?;
    let highest = history.iter().map(|(_, energy)| *energy).fold(0.0, f64::max);
    let example = Panel::new(
        "the example, on ground at rest",
        Axis::linear("time, s", 0.0, DURATION),
        Axis::linear("energy over that at rest, J", 0.0, 1.25 * highest),
    )
    .with("energy", history, WRONG)
    .note((time, 0.42 * highest), format!("impact: +{change:.2} J"), colour::VERMILLION);
    let lossless = |parameters, part: f64| {
        let structure = structure(parameters);
        let range = impact::lossless_restitution(&structure, part * structure.u_cr);
        range.map_or("no r".into(), |[least, most]| format!("{least:.3} ≤ r ≤ {most:.4}"))
    };
    let limit = |parameters| impact::lossless_restitution(&structure(parameters), 0.0).map_or(0.0, |[least, _]| least);
    Ok(Exhibit {
        key: "energy-gain",
        title: "Energy gained at impact",
        values: context! {
            evison => format!("{:.3}", limit(Parameters::EVISON)),
            mcmanus => format!("{:.3}", limit(Parameters::MCMANUS)),
            evison_at_u_cr => lossless(Parameters::EVISON, 1.0),
            mcmanus_at_u_cr => lossless(Parameters::MCMANUS, 1.0),
        },
        panels: vec![map, example],
        legend_columns: 3,
        legend: vec![
            Entry::new("r = 1 − 4 (m + m0) B²/J_P", RIGHT),
            Entry::new("the specimens", specimen),
            Entry::new("the example and its energy", WRONG),
        ],
    })
}
