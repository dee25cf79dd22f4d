//! Grazes that decide differently under a change of 1e-12.

use super::history::{History, at_rest, every, exact};
use super::{Exhibit, RIGHT, WRONG};
use crate::chart::{Axis, Entry, Marker, Panel, Style, colour, scientific};
use anyhow::{Context, Result};
use minijinja::context;
use rocking::{Detail, Parameters, State, Transition};

/// How long the structure is followed, s.
const DURATION: f64 = 1.0;

/// McManus's specimen shortly before an impact; what is varied is how fast it vibrates.
fn released(theta_dot: f64, u_dot: f64) -> Result<History> {
    let initial = State { theta: 0.002, theta_dot, u_dot, ..State::default() };
    Ok(exact(&at_rest(Parameters::MCMANUS, initial, DURATION), Detail::Nonlinear, every(1e-3))?)
}

/// A family of releases: θ̇ at the start, rad/s, and what is examined, u̇ in m/s.
pub struct Family {
    name: &'static str,
    theta_dot: f64,
    bracket: (f64, f64), // between these the first transition becomes another
    towards: f64,        // +1 or −1: to which side u̇ is changed
    style: Style,
}

/// L passes through 0 at an impact.
pub const MOMENTUM: Family = Family {
    name: "L passes through 0 at an impact",
    theta_dot: -0.2,
    bracket: (0.38, 0.40),
    towards: 1.0,
    style: Style::marked(colour::VERMILLION, 2, Marker::Circle),
};

/// θ touches 0 and turns.
pub const TOUCH: Family = Family {
    name: "θ touches 0 and turns",
    theta_dot: -0.1,
    bracket: (0.24, 0.26),
    towards: -1.0,
    style: Style::marked(colour::BLUE, 2, Marker::Square),
};

/// Neither.
pub const CLEAR: Family = Family {
    name: "neither",
    theta_dot: -0.1,
    bracket: (0.1, 0.1),
    towards: 1.0,
    style: Style::marked(colour::GREEN, 2, Marker::Triangle),
};

impl Family {
    fn first(&self, u_dot: f64) -> Result<Transition> {
        released(self.theta_dot, u_dot)?.transitions.first().copied().context("every release leads to an impact")
    }

    /// The last u̇ at which the first transition is still that of the bracket's lower end.
    fn critical(&self) -> Result<f64> {
        let (mut low, mut high) = self.bracket;
        let first = self.first(low)?;
        let is_same = |other: Transition| other.kind == first.kind && (other.time - first.time).abs() < 0.01;
        loop {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                return Ok(low);
            }
            *(if is_same(self.first(middle)?) { &mut low } else { &mut high }) = middle;
        }
    }

    /// How far the answer moves, relative to its largest value, when u̇ is changed by the fractions `changes`.
    pub fn sensitivity(&self, changes: &[f64]) -> Result<Vec<(f64, f64)>> {
        let critical = self.critical()?;
        let base = released(self.theta_dot, critical)?.theta();
        let largest = base.iter().map(|(_, theta)| theta.abs()).fold(0.0, f64::max);
        let moved = |change: &f64| {
            let moved = released(self.theta_dot, critical * (1.0 + self.towards * change))?.theta();
            let differences = base.iter().zip(moved).map(|((_, a), (_, b))| (a - b).abs());
            Ok((*change, differences.fold(0.0, f64::max) / largest))
        };
        changes.iter().map(moved).collect()
    }
}

/// Two responses one part in 10¹² apart, and how the distance of two responses depends on that of their starts.
pub fn show() -> Result<Exhibit> {
    const CHANGE: f64 = 1e-12;
    let critical = MOMENTUM.critical()?;
    let (lower, upper) =
        (released(MOMENTUM.theta_dot, critical)?, released(MOMENTUM.theta_dot, critical * (1.0 + CHANGE))?);
    let impact = lower.transitions[0];
    let mrad = |history: &History| history.theta().iter().map(|(t, theta)| (*t, 1e3 * theta)).collect::<Vec<_>>();
    let two = Panel::new(
        "two releases one part in 10¹² apart",
        Axis::linear("time, s", 0.0, 0.4),
        Axis::linear("θ, mrad", -1.5, 2.5),
    )
    .with("lower", mrad(&lower), RIGHT)
    .with("upper", mrad(&upper), WRONG);
    let changes: Vec<f64> = (3..=26).map(|k| 10f64.powf(-0.5 * f64::from(k))).collect();
    let mut distance = Panel::new(
        "how far a change carries",
        Axis::logarithmic("relative change of the start", 1e-13, 0.1),
        Axis::logarithmic("max|Δθ| / max|θ|", 1e-14, 1.0),
    );
    let mut legend = vec![Entry::new("u̇₀", RIGHT), Entry::new("u̇₀ (1 + 10⁻¹²)", WRONG)];
    let mut at_change = Vec::new();
    for family in [MOMENTUM, TOUCH, CLEAR] {
        let points = family.sensitivity(&changes)?;
        at_change.push(family.sensitivity(&[CHANGE])?[0].1);
        distance = distance.with(family.name, points, family.style);
        legend.push(Entry::new(family.name, family.style));
    }
    let [jump, touch, clear] = at_change[..] else { unreachable!("there are three families") };
    Ok(Exhibit {
        key: "grazing",
        title: "Grazes that decide differently under a change of 10⁻¹²",
        values: context! {
            impact => format!("{:.2}", 1e3 * impact.time),
            jump => format!("{:.0}", 100.0 * jump),
            touch => scientific(touch),
            clear => scientific(clear),
        },
        panels: vec![two, distance],
        legend_columns: 3,
        legend,
    })
}
