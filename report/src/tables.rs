//! The tables of a run: the response and its transitions.
use crate::run::{Event, Line, Named, Run};
use rocking::mechanics::restraint::{Dissipators, Restraints};
use rocking::run::Runs;
use rocking::{Impulse, Output, Reactions, Sample};
use serde::Serialize;

/// Names and units of the columns after the outputs: reactions, impulses, vertical ground acceleration, ties and dissipators.
const AFTER: [(&str, &str); 14] = [
    ("R_h", "N"),
    ("R_v", "N"),
    ("R_m", "N.m"),
    ("I_h", "N.s"),
    ("I_v", "N.s"),
    ("I_m", "N.m.s"),
    ("a_v", "m/s2"),
    (Output::P_t.symbol(), "N"),
    (Output::F_d1.symbol(), "N"),
    (Output::F_d2.symbol(), "N"),
    ("e_p1", "m"),
    ("e_p2", "m"),
    ("E_viscous", "J"),
    ("E_hysteretic", "J"),
];

/// A line of the response, in the order of [`Run::headings`], with these values of the `outputs`.
pub(crate) fn line<Q: Runs>(sample: &Sample<Q>, outputs: Vec<f64>) -> Line {
    let Sample { motion, load, .. } = sample;
    let Reactions { R_h, R_v, R_m } = sample.reactions();
    let Impulse { I_h, I_v, I_m } = motion.impulse;
    let Restraints { P_t, F_d1, F_d2 } = sample.restraints();
    let Dissipators { plastic: [e_p1, e_p2], viscous, hysteretic, .. } = motion.dissipators;
    let after = [R_h, R_v, R_m, I_h, I_v, I_m, load.a_v, P_t, F_d1, F_d2, e_p1, e_p2, viscous, hysteretic];
    Line(
        [&[motion.time, load.a_g], &outputs[..], &after].concat(),
        motion.phase.shown(motion.state.theta).name(),
        motion.transitions,
    )
}

impl Run {
    /// Names and units of the numbers of a line of the response: ground acceleration, outputs, reactions and restraints.
    pub fn columns(&self) -> Vec<Named> {
        let named = |(name, unit): (&str, &'static str)| (name.to_owned(), unit);
        let before = [("time", "s"), ("a_g", "m/s2")].map(named);
        before.into_iter().chain(self.outputs()).chain(AFTER.map(named)).collect()
    }

    /// Headings of the response; phase and number of transitions are last.
    pub fn headings(&self) -> Vec<String> {
        let numbers = self.columns().into_iter().map(|(name, unit)| format!("{name}[{unit}]"));
        numbers.chain(["phase", "transitions"].map(str::to_owned)).collect()
    }

    /// Headings of the transitions: instant, kind, and the state before and after.
    pub fn event_headings(&self) -> Vec<String> {
        let components = self.components();
        let state = |when| components.iter().map(move |(name, unit)| format!("{name}_{when}[{unit}]"));
        ["time[s]", "kind"].map(str::to_owned).into_iter().chain(state("before")).chain(state("after")).collect()
    }
}

/// A line of the transitions.
pub fn event_line(event: &Event) -> impl Serialize {
    (event.time, event.kind.name(), &event.states)
}
