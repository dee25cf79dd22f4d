//! Zeno at rest in the rigid limit.

use super::Exhibit;
use super::history::{at_rest, every, exact, is_impact};
use crate::chart::{Axis, Entry, Marker, Panel, Style, colour};
use crate::scene::structure;
use anyhow::Result;
use minijinja::context;
use rocking::{Detail, Parameters, State, Transition};

/// Evison's specimen with a coefficient of restitution low enough to come to rest soon.
pub const STRUCTURE: Parameters = Parameters { r: 0.9, ..Parameters::EVISON };

/// Natural frequencies, Hz.
const FREQUENCIES: [f64; 4] = [11.0, 50.0, 200.0, 1000.0];

const STYLES: [Style; 4] = [
    Style::marked(colour::ORANGE, 0, Marker::Circle),
    Style::marked(colour::GREEN, 0, Marker::Square),
    Style::marked(colour::BLUE, 0, Marker::Triangle),
    Style::marked(colour::PURPLE, 0, Marker::Diamond),
];

const RIGID: Style = Style::line(colour::BLACK, 2);

/// Times (s) between successive impacts before the first landing, by number.
pub fn intervals(transitions: &[Transition]) -> Vec<(f64, f64)> {
    let impacts: Vec<_> = transitions.iter().take_while(|transition| is_impact(transition)).collect();
    impacts.windows(2).enumerate().map(|(k, pair)| ((k + 1) as f64, pair[1].time - pair[0].time)).collect()
}

/// A rigid block that comes to rest, and flexible structures ever stiffer.
pub fn show() -> Result<Exhibit> {
    let released = |parameters: Parameters| {
        at_rest(parameters, State { theta: 0.04, u: structure(parameters).u_cr, ..State::default() }, 4.0)
    };
    let rigid = exact(&released(STRUCTURE), Detail::Rigid, every(2e-3))?;
    let last = rigid.transitions.iter().rfind(|transition| is_impact(transition)).map_or(0.0, |impact| impact.time);
    let number = rigid.transitions.iter().filter(|transition| is_impact(transition)).count();
    let theta: Vec<_> = rigid.theta().iter().map(|(t, theta)| (*t, 1e3 * theta)).collect();
    let history = Panel::new(
        "a rigid block comes to rest",
        Axis::linear("time, s", 0.0, 4.0),
        Axis::linear("θ, mrad", -40.0, 40.0),
    )
    .with("rigid", theta, RIGID)
    .note((last, 25.0), format!("last impact: {last:.3} s"), colour::BLACK);
    let mut times = Panel::new(
        "time between impacts",
        Axis::linear("impact", 0.0, number as f64 + 10.0),
        Axis::logarithmic("time to the next, s", 1e-12, 1.0),
    );
    let mut legend = vec![Entry::new("rigid", RIGID)];
    let mut counts = Vec::new();
    times = times.with("rigid", intervals(&rigid.transitions), RIGID);
    for (f_fc, style) in FREQUENCIES.into_iter().zip(STYLES) {
        let flexible = exact(&released(Parameters { f_fc, ..STRUCTURE }), Detail::Nonlinear, [])?;
        let gaps = intervals(&flexible.transitions);
        counts.push(format!("{} at {f_fc} Hz", gaps.len() + 1));
        times = times.with(format!("{f_fc} Hz"), gaps.last().copied(), style);
        legend.push(Entry::new(format!("{f_fc} Hz: lands here"), style));
    }
    Ok(Exhibit {
        key: "zeno",
        title: "Zeno at rest in the rigid limit",
        values: context! { number, last => format!("{last:.3}"), counts => counts.join(", ") },
        panels: vec![history, times],
        legend_columns: 5,
        legend,
    })
}
