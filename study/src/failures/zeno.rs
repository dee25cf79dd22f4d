//! Zeno at rest in the rigid limit.

use super::Exhibit;
use super::history::{at_rest, exact, is_impact};
use crate::chart::{Axis, Marker, Panel, Style, colour};
use crate::scene::structure;
use anyhow::Result;
use minijinja::context;
use rocking::{Detail, Parameters, State, Transition};

/// Evison's specimen with a coefficient of restitution low enough to come to rest soon.
pub const STRUCTURE: Parameters = Parameters { r: 0.9, ..Parameters::EVISON };

/// Natural frequencies, Hz, and how they are drawn.
const FREQUENCIES: [(f64, Style); 4] = [
    (11.0, Style::marked(colour::ORANGE, 0, Marker::Circle)),
    (50.0, Style::marked(colour::GREEN, 0, Marker::Square)),
    (200.0, Style::marked(colour::BLUE, 0, Marker::Triangle)),
    (1000.0, Style::marked(colour::PURPLE, 0, Marker::Diamond)),
];

/// Times (s) between successive impacts before the first landing, by number.
pub fn intervals(transitions: &[Transition]) -> Vec<(f64, f64)> {
    let impacts: Vec<_> = transitions.iter().take_while(|transition| is_impact(transition)).collect();
    impacts.windows(2).enumerate().map(|(k, pair)| ((k + 1) as f64, pair[1].time - pair[0].time)).collect()
}

/// A rigid block that comes to rest, and flexible structures ever stiffer.
pub fn show() -> Result<Exhibit> {
    let released = |parameters: Parameters, detail| {
        let initial = State { theta: 0.04, u: structure(parameters).u_cr, ..State::default() };
        Ok::<_, anyhow::Error>(exact(&at_rest(parameters, initial, 4.0), detail, [])?.transitions)
    };
    let rigid = released(STRUCTURE, Detail::Rigid)?;
    let impacts: Vec<_> = rigid.iter().filter(|transition| is_impact(transition)).collect();
    let (number, last) = (impacts.len(), impacts.last().map_or(0.0, |impact| impact.time));
    let x = Axis::linear("impact", 0.0, number as f64 + 10.0);
    let y = Axis::logarithmic("time to the next impact, s", 1e-12, 1.0);
    let mut panel = Panel::new("A stiffer structure makes more impacts before it lands", x, y);
    let mut counts = Vec::new();
    for (f_fc, style) in FREQUENCIES {
        let gaps = intervals(&released(Parameters { f_fc, ..STRUCTURE }, Detail::Nonlinear)?);
        counts.push(format!("{} at {f_fc} Hz", gaps.len() + 1));
        let last = gaps.last().copied();
        panel = panel.with(format!("{f_fc} Hz lands here"), last, style).named(last.unwrap_or_default());
    }
    let panel = panel.with("rigid: without end", intervals(&rigid), Style::line(colour::BLACK, 2)).named((150.0, 3e-7));
    Ok(Exhibit {
        key: "zeno",
        shows: "Time to the next impact over the number of impacts: it shrinks by r each time; flexible structures land.",
        values: context! { number, last => format!("{last:.3}"), counts => counts.join(", ") },
        panel,
    })
}
