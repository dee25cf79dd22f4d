//! The classical Runge–Kutta method of fixed step, as it is often coded, beside the engine: Eq 1 in full contact, Eqs 5 and 6
//! while rocking, and each transition taken at the end of the step on which its condition is met.

use rocking::Restraint;
use rocking::levels::{full_contact, nonlinear};
use rocking::mechanics::impact;
use rocking::run::record::Record;
use rocking::{Dissipators, Load, Phase, Ramp, Side, State, Structure};
use std::f64::consts::FRAC_PI_2;

/// More evaluations than these are not waited for.
const MOST_EVALUATIONS: f64 = 2e7;

/// From the state `initial` under `ground` in steps of `h` (s), cut evenly between `instants` (s): the record's samples, and later
/// ones at which the ground is at rest. The states at the instants, as far as it goes, and the evaluations.
pub fn run(
    structure: &Structure,
    ground: &Record,
    instants: &[f64],
    initial: State,
    h: f64,
) -> Result<(Vec<State>, u64), String> {
    let (times, a) = (ground.times(), ground.acceleration());
    let parts = |i: usize| ((instants[i] - instants[i - 1]) / h - 1e-9).ceil().max(1.0);
    let needed = 4.0 * (1..instants.len()).map(parts).sum::<f64>();
    if !(h > 0.0 && needed <= MOST_EVALUATIONS) {
        return Err(format!(
            "step = {h} s is out of range: it takes {needed:.0e} evaluations, and {MOST_EVALUATIONS:e} are possible"
        ));
    }
    let (mut states, mut evaluations) = (vec![initial], 0);
    let (mut phase, mut state) = (initial.initial_phase().map_err(|error| error.to_string())?, initial);
    let mut dissipators = Dissipators::NEW.moved(structure, phase.side(), state.theta);
    for i in 1..instants.len() {
        let (dt, parts) = (instants[i] - instants[i - 1], parts(i));
        let ramp = match i < times.len() {
            true => Ramp::between(a[i - 1], a[i], dt),
            false => Ramp::default(),
        };
        let step = dt / parts;
        for part in 0..parts as u64 {
            state = stepped(structure, phase, &state, &dissipators, |tau| ramp.at(part as f64 * step + tau), step);
            dissipators = dissipators.moved(structure, phase.side(), state.theta);
            evaluations += 4;
            (phase, state) = next(structure, phase, &state, &dissipators).unwrap_or((phase, state));
            if let Phase::Overturned(_) = phase {
                return Ok((states, evaluations));
            }
        }
        states.push(state);
    }
    Ok((states, evaluations))
}

/// One step over `h` (s): k₁ … k₄ in the textbook's order. At each of them the `dissipators`, as they are at the start, are moved
/// to the rotation there.
fn stepped(
    structure: &Structure,
    phase: Phase,
    from: &State,
    dissipators: &Dissipators,
    a_g: impl Fn(f64) -> f64,
    h: f64,
) -> State {
    let rates = |state: &State, tau: f64| {
        let load = Load::ground(a_g(tau));
        let [u_ddot, theta_ddot] = match phase {
            Phase::Rocking(side) => {
                let moved = dissipators.moved(structure, side, state.theta);
                nonlinear::accelerations(structure, side, state, load, &moved).map_or([f64::NAN; 2], Into::into)
            }
            _ => [full_contact::acceleration(structure, state, load), 0.0],
        };
        State { u: state.u_dot, u_dot: u_ddot, theta: state.theta_dot, theta_dot: theta_ddot }
    };
    let k1 = rates(from, 0.0);
    let k2 = rates(&moved(from, &k1, 0.5 * h), 0.5 * h);
    let k3 = rates(&moved(from, &k2, 0.5 * h), 0.5 * h);
    let k4 = rates(&moved(from, &k3, h), h);
    [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)].iter().fold(*from, |state, (k, part)| moved(&state, k, part * h / 6.0))
}

fn moved(from: &State, rates: &State, tau: f64) -> State {
    State {
        u: from.u + tau * rates.u,
        u_dot: from.u_dot + tau * rates.u_dot,
        theta: from.theta + tau * rates.theta,
        theta_dot: from.theta_dot + tau * rates.theta_dot,
    }
}

/// Phase and state after the end of the `phase`, if it has ended in `state`.
fn next(structure: &Structure, phase: Phase, state: &State, dissipators: &Dissipators) -> Option<(Phase, State)> {
    match phase {
        Phase::FullContact => {
            let side = Side::of(state.u);
            let lifts = || {
                let rates = nonlinear::accelerations(structure, side, state, Load::default(), dissipators);
                rates.is_some_and(|rates| rates[1] * side.sign() > 0.0)
            };
            let is_due =
                state.u.abs() >= Restraint::about(structure, side, dissipators).uplift_displacement(0.0) && lifts();
            is_due.then_some((Phase::Rocking(side), *state))
        }
        Phase::Rocking(side) if side.sign() * state.theta >= FRAC_PI_2 => Some((Phase::Overturned(side), *state)),
        Phase::Rocking(side) if side.sign() * state.theta < 0.0 => Some(impact::resolve(structure, side, state)),
        _ => None,
    }
}
