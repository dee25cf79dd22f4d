//! The tables of a run: the response and its transitions.
use rocking::engine::piece::Sample;
use rocking::mechanics::outputs::OUTPUTS;
use rocking::mechanics::restraint::{Dissipators, Restraints};
use rocking::{Impulse, Reactions, State, Transition};
use serde::Serialize;

/// Headings of the response: the ground accelerations, and the outputs of the FMU under their names and units.
pub const RESPONSE: [&str; AROUND.len() + OUTPUTS.len()] = {
    let mut headings = [""; AROUND.len() + OUTPUTS.len()];
    let mut i = 0;
    while i < headings.len() {
        headings[i] = if i < BEFORE {
            AROUND[i]
        } else if i < BEFORE + OUTPUTS.len() {
            OUTPUTS[i - BEFORE].heading
        } else {
            AROUND[i - OUTPUTS.len()]
        };
        i += 1;
    }
    headings
};

/// The number of columns before the outputs.
const BEFORE: usize = 2;

/// The columns before and after the outputs.
const AROUND: [&str; 18] = [
    "time[s]",
    "a_g[m/s2]",
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

/// The numbers of a line of the response, in the order of [`RESPONSE`]; phase and transitions follow.
pub fn response_numbers(sample: &Sample) -> [f64; RESPONSE.len() - 2] {
    let &Sample { motion, load, .. } = sample;
    let Reactions { R_h, R_v, R_m } = sample.reactions();
    let Impulse { I_h, I_v, I_m } = motion.impulse;
    let Restraints { P_t, F_d1, F_d2 } = sample.restraints();
    let Dissipators { plastic: [e_p1, e_p2], viscous, hysteretic, .. } = motion.dissipators;
    let (before, outputs) = ([motion.time, load.a_g], sample.outputs().values());
    let of_ground = [R_h, R_v, R_m, I_h, I_v, I_m];
    let of_restraints = [load.a_v, P_t, F_d1, F_d2, e_p1, e_p2, viscous, hysteretic];
    let mut numbers = [before.as_slice(), &outputs, &of_ground, &of_restraints].into_iter().flatten();
    std::array::from_fn(|_| *numbers.next().expect("as many as there are headings"))
}

/// A line of the response.
pub fn response_line(sample: &Sample) -> impl Serialize + use<> {
    (response_numbers(sample), sample.motion.phase.name(), sample.motion.transitions)
}

/// Headings of the transitions.
pub const EVENTS: [&str; 10] = [
    "time[s]",
    "kind",
    "u_before[m]",
    "u_dot_before[m/s]",
    "theta_before[rad]",
    "theta_dot_before[rad/s]",
    "u_after[m]",
    "u_dot_after[m/s]",
    "theta_after[rad]",
    "theta_dot_after[rad/s]",
];

/// A line of the transitions.
pub fn event_line(transition: &Transition) -> impl Serialize + use<> {
    let &Transition { time, kind, before, after } = transition;
    let values = |State { u, u_dot, theta, theta_dot }| (u, u_dot, theta, theta_dot);
    (time, kind.name(), values(before), values(after))
}
