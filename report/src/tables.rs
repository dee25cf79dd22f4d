//! The tables of a run: the response and its transitions.
use crate::shown::{Named, Shown};
use rocking::engine::piece::Sample;
use rocking::mechanics::restraint::{Dissipators, Restraints};
use rocking::{Impulse, Reactions, State, Transition};
use serde::Serialize;

/// The columns before the outputs.
const BEFORE: [&str; 2] = ["time[s]", "a_g[m/s2]"];

/// The columns after the outputs.
const AFTER: [&str; 16] = [
    "R_h[N]",
    "R_v[N]",
    "R_m[N.m]",
    "I_h[N.s]",
    "I_v[N.s]",
    "I_m[N.m.s]",
    "a_v[m/s2]",
    "P_t[N]",
    "F_d1[N]",
    "F_d2[N]",
    "e_p1[m]",
    "e_p2[m]",
    "E_viscous[J]",
    "E_hysteretic[J]",
    "phase",
    "transitions",
];

/// Headings of the response: the ground accelerations, the outputs of the structure, reactions and restraints.
pub fn response_headings<Q: Shown>(structure: &Q::Structure) -> Vec<String> {
    let outputs = Q::outputs(structure).into_iter().map(|(name, unit)| format!("{name}[{unit}]"));
    let [before, after] = [&BEFORE[..], &AFTER[..]].map(|names| names.iter().map(|name| name.to_string()));
    before.chain(outputs).chain(after).collect()
}

/// The numbers of a line of the response, in the order of [`response_headings`]; phase and transitions follow.
pub fn response_numbers<Q: Shown>(structure: &Q::Structure, sample: &Sample<Q>) -> Vec<f64> {
    let Sample { motion, load, .. } = sample;
    let Reactions { R_h, R_v, R_m } = sample.reactions();
    let Impulse { I_h, I_v, I_m } = motion.impulse;
    let Restraints { P_t, F_d1, F_d2 } = sample.restraints();
    let Dissipators { plastic: [e_p1, e_p2], viscous, hysteretic, .. } = motion.dissipators;
    let mut numbers = vec![motion.time, load.a_g];
    numbers.extend(Q::values(structure, sample));
    numbers.extend([R_h, R_v, R_m, I_h, I_v, I_m]);
    numbers.extend([load.a_v, P_t, F_d1, F_d2, e_p1, e_p2, viscous, hysteretic]);
    numbers
}

/// A line of the response.
pub fn response_line<Q: Shown>(structure: &Q::Structure, sample: &Sample<Q>) -> impl Serialize + use<Q> {
    (response_numbers(structure, sample), sample.motion.phase.name(), sample.motion.transitions)
}

/// Names and units of the components of a state.
pub fn components<Q: Shown>(structure: &Q::Structure) -> Vec<Named> {
    let of_base = [("theta".to_owned(), "rad"), ("theta_dot".to_owned(), "rad/s")];
    Q::displacements(structure).into_iter().chain(of_base).collect()
}

/// Values of the components of `state`.
pub fn values<Q: Shown>(structure: &Q::Structure, state: &State<Q>) -> Vec<f64> {
    Q::displaced(structure, state).into_iter().chain([state.theta, state.theta_dot]).collect()
}

/// Headings of the transitions: instant, kind, and the state before and after.
pub fn event_headings<Q: Shown>(structure: &Q::Structure) -> Vec<String> {
    let components = components::<Q>(structure);
    let state = |when| components.iter().map(move |(name, unit)| format!("{name}_{when}[{unit}]"));
    ["time[s]", "kind"].map(str::to_owned).into_iter().chain(state("before")).chain(state("after")).collect()
}

/// A line of the transitions.
pub fn event_line<Q: Shown>(structure: &Q::Structure, transition: &Transition<Q>) -> impl Serialize + use<Q> {
    let Transition { time, kind, before, after } = transition;
    (*time, kind.name(), values(structure, before), values(structure, after))
}
