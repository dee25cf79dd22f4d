//! What `simulate` prints at the end of a run.
use crate::significant::significant;
use rocking::{Motion, Outputs, Phase, Side, Transition, TransitionKind, record::Segment};

/// Peaks and first transitions of a run.
pub struct Summary {
    g: f64,
    peaks: Vec<Peak>,
    first_uplift: Option<f64>,
    first_impact: Option<f64>,
}

/// The largest magnitude of a quantity so far, and its instant.
struct Peak {
    name: &'static str,
    unit: &'static str,
    magnitude: f64,
    time: f64,
}

impl Summary {
    /// Nothing seen yet; accelerations are shown in `g` (m/s²).
    pub fn new(g: f64) -> Summary {
        Summary { g, peaks: Vec::new(), first_uplift: None, first_impact: None }
    }

    /// Takes in a part of the ground motion: linear, so that its ends hold its peak.
    pub fn see_ground(&mut self, segment: &Segment) {
        for time in [segment.start, segment.end] {
            self.see("a_g", "g", segment.from(time).value / self.g, time);
        }
    }

    /// Takes in the outputs at `time` (s).
    pub fn see_outputs(&mut self, time: f64, outputs: &Outputs) {
        for (name, unit, value) in [
            ("theta", "rad", outputs.theta),
            ("u", "mm", 1e3 * outputs.u),
            ("a_t", "g", outputs.a_t / self.g),
            ("V_t", "N", outputs.V_t),
            ("M_t", "N.m", outputs.M_t),
            ("uplift", "mm", 1e3 * outputs.uplift),
        ] {
            self.see(name, unit, value, time);
        }
    }

    /// Takes in a transition.
    pub fn see_transition(&mut self, transition: &Transition) {
        let first = match transition.kind {
            TransitionKind::Uplift(_) => &mut self.first_uplift,
            TransitionKind::Impact(_) | TransitionKind::Landing | TransitionKind::Settling => &mut self.first_impact,
            TransitionKind::Overturning(_) => return,
        };
        first.get_or_insert(transition.time);
    }

    fn see(&mut self, name: &'static str, unit: &'static str, value: f64, time: f64) {
        let magnitude = value.abs();
        match self.peaks.iter_mut().find(|peak| peak.name == name) {
            Some(peak) if magnitude > peak.magnitude => (peak.magnitude, peak.time) = (magnitude, time),
            Some(_) => {}
            None => self.peaks.push(Peak { name, unit, magnitude, time }),
        }
    }

    /// Prints it all, with what `motion` counted and came to, on standard error.
    pub fn print(&self, motion: &Motion) {
        for Peak { name, unit, magnitude, time } in &self.peaks {
            let name = format!("peak |{name}|");
            eprintln!("{name:<14} {:>12} {unit:<4} at {} s", significant(*magnitude), significant(*time));
        }
        let instant = |time: Option<f64>| time.map_or("none".into(), |time| format!("at {} s", significant(time)));
        eprintln!("first uplift   {}", instant(self.first_uplift));
        eprintln!("first impact   {}", instant(self.first_impact));
        eprintln!("transitions    {}", motion.transitions);
        let overturned = match motion.phase {
            Phase::Overturned(Side::Left) => format!("to the left at {} s", significant(motion.time)),
            Phase::Overturned(Side::Right) => format!("to the right at {} s", significant(motion.time)),
            Phase::FullContact | Phase::Rocking(_) => "no".into(),
        };
        eprintln!("overturned     {overturned}");
        eprintln!("work           {} steps, {} evaluations", motion.work.steps, motion.work.evaluations);
    }
}
