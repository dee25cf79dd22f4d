//! A line of the response.
use rocking::mechanics::restraint::{Dissipators, Restraints};
use rocking::run::Runs;
use rocking::{Impulse, Output, Phase, Reactions, Sample};
use serde::{Serialize, Serializer};

/// A line of the response: the numbers in the order of [`RunSetup::columns`](crate::run::Run::columns), the phase, and the number of
/// transitions so far.
#[derive(Serialize)]
pub struct Line(pub Vec<f64>, #[serde(serialize_with = "by_name")] pub Phase, pub u64);

fn by_name<S: Serializer>(phase: &Phase, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(phase.name())
}

/// Names and units of the columns after the outputs: reactions, impulses, vertical ground acceleration, ties and dissipators.
pub(crate) const AFTER: [(&str, &str); 14] = [
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

/// A line of the response, with these values of the `outputs`.
pub(crate) fn line<Q: Runs>(sample: &Sample<Q>, outputs: Vec<f64>) -> Line {
    let Sample { motion, load, .. } = sample;
    let Reactions { R_h, R_v, R_m } = sample.reactions();
    let Impulse { I_h, I_v, I_m } = motion.impulse;
    let Restraints { P_t, F_d1, F_d2 } = sample.restraints();
    let Dissipators { plastic: [e_p1, e_p2], viscous, hysteretic, .. } = motion.dissipators;
    let after = [R_h, R_v, R_m, I_h, I_v, I_m, load.a_v, P_t, F_d1, F_d2, e_p1, e_p2, viscous, hysteretic];
    let numbers = [&[motion.time, load.a_g], &outputs[..], &after].concat();
    Line(numbers, motion.phase.shown(motion.state.theta), motion.transitions)
}
