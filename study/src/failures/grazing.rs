//! Grazes that decide differently under a change of 1e-12.

use super::*;

const DURATION: f64 = 1.0; // s

/// McManus's specimen shortly before an impact; what is varied is how fast it vibrates.
fn released(theta_dot: f64, u_dot: f64) -> ReferenceHistory {
    let initial = State { theta: 0.002, theta_dot, u_dot, ..State::default() };
    let scene = at_rest(Parameters::MCMANUS, initial, DURATION);
    exact(&scene, Detail::Nonlinear, every(1e-3)).expect("a release has an answer")
}

/// A family of releases: θ̇ at the start, rad/s, and what is examined, u̇ in m/s.
pub struct Family {
    name: &'static str,
    theta_dot: f64,
    bracket: (f64, f64), // between these the first transition becomes another
    towards: f64,        // +1 or −1: to which side u̇ is changed
}

/// L passes through 0 at an impact; θ touches 0 and turns; neither.
pub const FAMILIES: [Family; 3] = [
    Family { name: "L passes through 0 at an impact", theta_dot: -0.2, bracket: (0.38, 0.40), towards: 1.0 },
    Family { name: "θ touches 0 and turns", theta_dot: -0.1, bracket: (0.24, 0.26), towards: -1.0 },
    Family { name: "neither", theta_dot: -0.1, bracket: (0.1, 0.1), towards: 1.0 },
];

impl Family {
    /// The last u̇ at which the first transition is still that of the bracket's lower end.
    fn critical(&self) -> f64 {
        let first = |u_dot| released(self.theta_dot, u_dot).transitions[0];
        let (low, high) = self.bracket;
        let expected = first(low);
        last_where(low, high, |u_dot| {
            let found = first(u_dot);
            found.kind == expected.kind && (found.time - expected.time).abs() < 0.01
        })
    }

    /// How far the answer moves, relative to its largest value, when u̇ is changed by the fractions `changes`.
    pub fn sensitivity(&self, changes: &[f64]) -> Vec<(f64, f64)> {
        let critical = self.critical();
        let base = released(self.theta_dot, critical).theta();
        let largest = base.iter().map(|(_, theta)| theta.abs()).fold(0.0, f64::max);
        let moved = |change: &f64| {
            let moved = released(self.theta_dot, critical * (1.0 + self.towards * change)).theta();
            let differences = base.iter().zip(moved).map(|((_, a), (_, b))| (a - b).abs());
            (*change, differences.fold(0.0, f64::max) / largest)
        };
        changes.iter().map(moved).collect()
    }
}

/// How the distance of two responses depends on that of their starts.
pub fn show() -> Result<Exhibit> {
    let changes: Vec<f64> = (3..=26).map(|k| 10f64.powf(-0.5 * f64::from(k))).collect();
    let curves = FAMILIES.map(|family| series(family.name, family.sensitivity(&changes)));
    let [jump, touch, clear] = FAMILIES.map(|family| family.sensitivity(&[1e-12])[0].1);
    let [momentum, ..] = FAMILIES;
    let impact = released(momentum.theta_dot, momentum.critical()).transitions[0];
    Ok(Exhibit {
        key: "grazing",
        values: values([
            ("impact", &(1e3 * impact.time)),
            ("jump", &(100.0 * jump)),
            ("touch", &touch),
            ("clear", &clear),
        ]),
        series: curves.into(),
    })
}
