//! Energy gained at impact.
//!
//! At θ = 0 the energy of a structure that rocks about side s is, but for what does not change there,
//!
//! ```text
//! E = ½ m (u̇ + Hθ̇)² + ½ [m (sB−u)² + J0 + m0 B²] θ̇²
//! ```
//!
//! Rocking goes on by s ← −s, θ̇ ← r θ̇ with u and u̇ kept, so that (sB−u)² becomes (sB+u)² and
//!
//! ```text
//! ΔE = −(1−r) m H u̇ θ̇ − ½ (1−r²) (J_P + m u²) θ̇² + (1+r²) m s B u θ̇²                                   (a)
//! ```
//!
//! The first term is positive where u̇ and θ̇ differ in sign. How much they may differ is bounded, because rocking goes
//! on only if L θ̇ > 0, L = m H (u̇ + Hθ̇) − [m (B²−u²) + m0 B² − J0] θ̇:
//!
//! ```text
//! m H u̇/θ̇ > (m + m0) B² − J0 − m u² − m H²                                                            (b)
//! ```
//!
//! ΔE/θ̇² falls as u̇/θ̇ rises; its supremum is at the bound (b). With A = m H² + J0 + m u² and F = (m + m0) B²
//! (J_P + m u² = A + F):
//!
//! ```text
//! sup ΔE/θ̇² = ½ (1−r) [(1−r) A − (3+r) F] + (1+r²) m s B u                                              (c)
//! ```
//!
//! At u = 0 this is positive if and only if
//!
//! ```text
//! r < 1 − 4 (m + m0) B²/J_P                                                                            (d)
//! ```
//!
//! A landing (u̇ ← u̇ + Hθ̇, θ̇ ← 0) always loses: ΔE = −½ [m (sB−u)² + J0 + m0 B²] θ̇².

use super::history::{History, at_rest, every, exact};
use super::{Exhibit, RIGHT, WRONG};
use crate::chart::{Axis, Entry, Figure, Marker, Panel, Style, colour};
use crate::scene::structure;
use anyhow::{Context, Result};
use rocking::energy::energy;
use rocking::impact::gaining_restitution;
use rocking::{Detail, Motion, Parameters, Phase, Side, State, Structure, Transition, TransitionKind};

/// Equation (a): change of energy, J, at an impact that ends rocking about `side` in the state `before` and is followed
/// by rocking about the other pivot.
pub fn change_when_rocking_goes_on(structure: &Structure, side: Side, before: &State) -> f64 {
    let &Parameters { m, H, B, r, .. } = structure.parameters();
    let &State { u, u_dot, theta_dot, .. } = before;
    let square = theta_dot * theta_dot;
    -(1.0 - r) * m * H * u_dot * theta_dot - 0.5 * (1.0 - r * r) * (structure.J_P + m * u * u) * square
        + (1.0 + r * r) * m * side.sign() * B * u * square
}

/// Change of energy, J, at an impact in the state `before` that ends rocking about `side` in full contact.
pub fn change_when_landing(structure: &Structure, side: Side, before: &State) -> f64 {
    let &Parameters { m, m0, B, J0, .. } = structure.parameters();
    let lever = side.sign() * B - before.u;
    -0.5 * (m * lever * lever + J0 + m0 * B * B) * before.theta_dot * before.theta_dot
}

/// Equation (c): supremum of ΔE/θ̇², kg·m², over all impacts at the displacement `u` (m) towards the pivot rocked about
/// (s u, so negative away from it) after which rocking goes on.
pub fn greatest_gain(structure: &Structure, u: f64) -> f64 {
    let &Parameters { m, m0, H, B, J0, r, .. } = structure.parameters();
    let (a, f) = (m * H * H + J0 + m * u * u, (m + m0) * B * B);
    0.5 * (1.0 - r) * ((1.0 - r) * a - (3.0 + r) * f) + (1.0 + r * r) * m * B * u
}

/// Whether any impact with u = 0 after which rocking goes on raises the energy, found by trying states through the
/// library's own reset and energy.
pub fn some_impact_raises(structure: &Structure) -> bool {
    const TRIES: i32 = 4000;
    let H = structure.parameters().H;
    (0..TRIES).any(|k| {
        // u̇ from −2 H |θ̇| to 2 H |θ̇|
        let u_dot = 4.0 * (f64::from(k) / f64::from(TRIES) - 0.5) * H;
        let before = State { u_dot, theta_dot: -1.0, ..State::default() };
        let (phase, after) = rocking::impact::resolve(structure, Side::Right, &before);
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

/// Slenderness in which (d) is one curve: √((m H² + J0)/((m + m0) B²)), which is H/(B √γ) for J0 = 0.
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
                map = map.area((left, left + width), (low, low + height), RAISES);
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
            let change = change_when_rocking_goes_on(&gainer_structure, side, &transition.before);
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
    let limit = |parameters| gaining_restitution(&structure(parameters));
    Ok(Exhibit {
        key: "energy-gain",
        title: "Energy gained at impact",
        cause: format!(
            "The reset θ̇ ← r θ̇ with u̇ kept takes momentum from the base and not from the top mass; where u̇ and θ̇ have \
             opposite signs that can raise the energy. It can if and only if r < 1 − 4 (m + m0) B²/J_P (at u = 0): r < {:.3} \
             for Evison's geometry, r < {:.3} for McManus's.",
            limit(Parameters::EVISON),
            limit(Parameters::MCMANUS)
        ),
        remedy:
            "The measured coefficients of restitution of both specimens are far above their limits. Below it the rule \
                 itself is at fault and no solver can help: do not choose r below 1 − 4 (m + m0) B²/J_P. The FMU \
                 warns of it at the start."
                .into(),
        caption:
            "Left: grey where trying states through the engine's own reset finds a gain; the line is the closed form. \
                  Right: McManus's geometry with f_fc = 2 Hz and r = 0.5, released at θ = 0.02 rad."
                .into(),
        figure: Figure {
            title: "Energy gained at impact".into(),
            panel: (600, 420),
            columns: 2,
            panels: vec![map, example],
            legend_columns: 3,
            legend: vec![
                Entry::new("r = 1 − 4 (m + m0) B²/J_P", RIGHT),
                Entry::new("the specimens", specimen),
                Entry::new("the example and its energy", WRONG),
            ],
        },
    })
}

/// Colour of the region where states that gain are found.
const RAISES: plotters::style::RGBColor = colour::PALE;
