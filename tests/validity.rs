//! What motions go beyond, against free bodies and states: the reactions of every scene solved anew from the equilibrium of
//! top mass, strut and foundation, the impulses and energies of impacts from the velocities before and after.
#![allow(non_snake_case)]

mod shaking;

use nalgebra::{Matrix2, SMatrix, SVector, Vector2};
use rocking::run::record::Record;
use rocking::run::validity::{ASSUMPTIONS, Limits};
use rocking::run::{End, Run};
use rocking::{Detail, Parameters, Phase, Side, State, Structure, Transition, TransitionKind};
use shaking::shaking;

/// Ten scenes: every level, both specimens, stocky and slender, with little and full restitution.
fn scenes() -> Vec<(Parameters, State, Detail, Record)> {
    let (evison, mcmanus) = (Parameters::EVISON, Parameters::MCMANUS);
    let at_rest = State::default();
    let released = State { theta: 0.03, u: 1e-3, ..State::default() };
    let turned = State { theta: 0.03, ..State::default() };
    let bent = State { u: 2e-3, u_dot: 0.05, ..State::default() };
    let elastic = Parameters { r: 1.0, zeta_fc: 0.05, ..evison };
    let dull = Parameters { r: 0.5, f_fc: 2.0, ..mcmanus };
    let soft = Parameters { zeta_fc: 0.1, c_ratio: 0.3, f_fc: 1.5, ..mcmanus };
    vec![
        (mcmanus, at_rest, Detail::Auto, shaking(1, 0.01, 200, 1.3)),
        (mcmanus, at_rest, Detail::Nonlinear, shaking(2, 0.01, 200, 2.0)),
        (evison, released, Detail::Auto, Record::at_rest(1.0)),
        (elastic, at_rest, Detail::Auto, shaking(3, 0.02, 100, 3.0)),
        (dull, State { theta: 0.02, ..at_rest }, Detail::Auto, Record::at_rest(1.0)),
        (soft, bent, Detail::Auto, shaking(9, 0.05, 40, 1.5)),
        (evison, at_rest, Detail::Linear, shaking(3, 0.02, 100, 2.5)),
        (mcmanus, at_rest, Detail::Modal, shaking(4, 0.01, 200, 2.0)),
        (mcmanus, turned, Detail::Rigid, shaking(5, 0.01, 150, 1.0)),
        (mcmanus, bent, Detail::FixedBase, shaking(6, 0.01, 200, 3.0)),
    ]
}

/// R_h, R_v and R_m on the ground in `phase` and `state` under the ground acceleration `a_g` (m/s²).
fn reactions(structure: &Structure, detail: Detail, phase: Phase, state: &State, a_g: f64) -> [f64; 3] {
    let &Parameters { m, m0, H, B, J0, g, .. } = structure.parameters();
    let &Structure { k, c_fc, c_u, J_P, p_l, omega_u, zeta_u, chi, .. } = structure;
    let &State { u, u_dot, theta, theta_dot } = state;
    let s = phase.side().sign();
    let (sin, cos) = theta.sin_cos();
    // what the top mass and the middle of the base have of acceleration: [per ü, per θ̈, rest], to the right and upwards
    let [x, y] = [s * B * (1.0 - cos) + u * cos + H * sin, s * B * sin - u * sin + H * cos];
    let [x0, y0] = [s * B * (1.0 - cos), s * B * sin];
    let turning = |x: f64, y: f64, u_dot: f64| {
        let [dx, dy] = [x - s * B, y];
        let rest = Vector2::new(-dx, -dy) * theta_dot.powi(2) - 2.0 * u_dot * theta_dot * Vector2::new(sin, cos);
        (Vector2::new(dy, -dx), rest)
    };
    let ([by_top, rest_top], [by_base, rest_base]) =
        (<[_; 2]>::from(turning(x, y, u_dot)), <[_; 2]>::from(turning(x0, y0, 0.0)));
    let by_u = Vector2::new(cos, -sin);
    let accelerations = match (phase, detail) {
        (Phase::FullContact, Detail::Rigid) => [0.0; 2],
        (Phase::FullContact, _) => [-a_g - (c_fc * u_dot + k * u) / m, 0.0],
        (_, Detail::Auto | Detail::Nonlinear) => {
            // five free-body equations for ü, θ̈, the strut's axial force N, R_h and R_v: the strut, without mass, hands
            // its force along u, its axial force and their moment on from the top mass to the foundation
            let strut = c_u * u_dot + k * u;
            let axis = Vector2::new(sin, cos);
            let mut matrix = SMatrix::<f64, 5, 5>::zeros();
            let mut right = SVector::<f64, 5>::zeros();
            for i in 0..2 {
                // m a = m (−a_g, −g) − strut e_u + N axis
                matrix[(i, 0)] = m * by_u[i];
                matrix[(i, 1)] = m * by_top[i];
                matrix[(i, 2)] = -axis[i];
                right[i] = -m * [a_g, g][i] - strut * by_u[i] - m * rest_top[i];
                // m0 a0 = m0 (−a_g, −g) + strut e_u − N axis + the ground's (−R_h, R_v)
                matrix[(2 + i, 1)] = m0 * by_base[i];
                matrix[(2 + i, 2)] = axis[i];
                matrix[(2 + i, 3 + i)] = [1.0, -1.0][i];
                right[2 + i] = -m0 * [a_g, g][i] + strut * by_u[i] - m0 * rest_base[i];
            }
            // about the middle of the base, positive as θ: J0 θ̈ = the strut's force at the top mass and the ground's at
            // the pivot
            let moment = |arm: Vector2<f64>, force: Vector2<f64>| arm.y * force.x - arm.x * force.y;
            let arm = Vector2::new(x - x0, y - y0);
            let pivot = Vector2::new(s * B - x0, -y0);
            matrix[(4, 1)] = J0;
            matrix[(4, 2)] = moment(arm, axis);
            matrix[(4, 3)] = moment(pivot, Vector2::x());
            matrix[(4, 4)] = -moment(pivot, Vector2::y());
            right[4] = strut * moment(arm, by_u);
            let solved = matrix.lu().solve(&right).unwrap();
            return [solved[3], solved[4], s * B * solved[4]];
        }
        (_, Detail::Linear) => {
            let mass = Matrix2::new(1.0, H, H, J_P / m);
            let force = Vector2::new(
                -a_g - (c_u * u_dot + k * u) / m + g * theta,
                g * u + g * H * theta - H * a_g - s * (m + m0) / m * g * B,
            );
            mass.lu().solve(&force).unwrap().into()
        }
        (_, Detail::Modal) => {
            let tan = structure.tan_alpha_cg;
            let q_r = theta + p_l * p_l / g * u;
            let q_r_ddot = p_l * p_l * (q_r - a_g / g - s * tan);
            let u_ddot =
                -a_g + s * chi / (1.0 - chi) * g * tan - 2.0 * zeta_u * omega_u * u_dot - omega_u * omega_u * u;
            [u_ddot, q_r_ddot - p_l * p_l / g * u_ddot]
        }
        // a rigid body about its pivot
        _ => {
            let height = (m * y + m0 * y0) / (m + m0);
            let arm = s * B - (m * x + m0 * x0) / (m + m0);
            [0.0, (m + m0) * (-g * arm - a_g * height) / J_P]
        }
    };
    let [top, base] =
        [by_u * accelerations[0] + by_top * accelerations[1] + rest_top, by_base * accelerations[1] + rest_base];
    let ([f, fy], [f0, fy0]) = ([-m * (top.x + a_g), m * (top.y + g)], [-m0 * (base.x + a_g), m0 * (base.y + g)]);
    [f + f0, fy + fy0, y * f + x * fy + y0 * f0 + x0 * fy0 - J0 * accelerations[1]]
}

/// Momentum to the right, downwards and about the middle of the base, and kinetic energy, of a structure that touches the
/// ground.
fn at_the_ground(structure: &Structure, phase: Phase, state: &State) -> [f64; 4] {
    let &Parameters { m, m0, H, B, J0, .. } = structure.parameters();
    let &State { u, u_dot, theta_dot, .. } = state;
    let pivot = phase.side().sign() * B;
    let (top, base) = ([u_dot + H * theta_dot, (pivot - u) * theta_dot], [0.0, pivot * theta_dot]);
    [
        m * top[0] + m0 * base[0],
        -m * top[1] - m0 * base[1],
        m * (H * top[0] - u * top[1]) + J0 * theta_dot,
        0.5 * (m * (top[0].powi(2) + top[1].powi(2)) + m0 * base[1].powi(2) + J0 * theta_dot * theta_dot),
    ]
}

/// What a scene goes beyond, seen from outside.
struct Seen<'a> {
    structure: &'a Structure,
    detail: Detail,
    /// tension_max, R_v_min, mu_required; mu_impact, tension_impact, energy_gain_max.
    worst: [f64; 6],
    /// Instants close to the worst of the first three.
    near: [Vec<(f64, f64)>; 3],
    /// How many samples of the first three, and how many impacts, are beyond their limits, and the first of them.
    beyond: [(f64, Option<f64>); 6],
    gains: u64,
}

impl Seen<'_> {
    fn values(&self, phase: Phase, state: &State, a_g: f64) -> [Option<f64>; 3] {
        let &Parameters { m, m0, B, g, .. } = self.structure.parameters();
        let weight = (m + m0) * g;
        let [R_h, R_v, R_m] = reactions(self.structure, self.detail, phase, state, a_g);
        [
            (phase == Phase::FullContact).then(|| (R_m.abs() / B - R_v) / weight),
            Some(R_v / weight),
            Some(if R_v > 0.0 { R_h.abs() / R_v } else { f64::INFINITY }),
        ]
    }

    fn see(&mut self, time: f64, phase: Phase, state: &State, a_g: f64, is_sample: bool) {
        if let Phase::Overturned(_) = phase {
            return;
        }
        for (i, value) in self.values(phase, state, a_g).into_iter().enumerate() {
            let Some(value) = value else { continue };
            let sign = if i == 1 { -1.0 } else { 1.0 };
            if sign * value > sign * self.worst[i] {
                self.worst[i] = value;
            }
            let limit = (ASSUMPTIONS[i].limit)(&Limits::default());
            if is_sample && sign * value > sign * limit {
                self.beyond[i].0 += 1.0;
                self.beyond[i].1.get_or_insert(time);
            }
            if sign * value > sign * self.worst[i] - 1e-3 * (1.0 + value.abs()) {
                self.near[i].push((time, value));
            }
        }
    }

    fn see_impact(&mut self, side: Side, transition: &Transition) {
        let after = match transition.kind {
            TransitionKind::Impact(side) => Phase::Rocking(side),
            _ => Phase::FullContact,
        };
        let before = at_the_ground(self.structure, Phase::Rocking(side), &transition.before);
        let after = at_the_ground(self.structure, after, &transition.after);
        let [I_h, I_v, I_m] = [0, 1, 2].map(|i| before[i] - after[i]);
        let gain = (after[3] - before[3]) / before[3];
        let values = [I_h.abs() / I_v, I_m.abs() / self.structure.parameters().B / I_v - 1.0, gain];
        for (i, value) in (3..).zip(values) {
            self.worst[i] = self.worst[i].max(value);
            if value > (ASSUMPTIONS[i].limit)(&Limits::default()) + if i == 5 { 1e-12 } else { 0.0 } {
                self.beyond[i].0 += 1.0;
                self.beyond[i].1.get_or_insert(transition.time);
            }
        }
        self.gains += u64::from(gain > 1e-12);
    }
}

/// The scene seen every `step` (s), and again a thousand times as often where something was worst.
fn seen<'a>(run: &'a Run, step: f64) -> Seen<'a> {
    let a_g = |time: f64| {
        let times = run.ground.times();
        let i = times.partition_point(|t| *t <= time).clamp(1, times.len() - 1);
        let [a, b] = [i - 1, i].map(|i| run.ground.acceleration()[i]);
        a + (b - a) * (time - times[i - 1]) / (times[i] - times[i - 1])
    };
    let mut seen = Seen {
        structure: &run.structure,
        detail: run.detail,
        worst: [-1.0, f64::INFINITY, 0.0, 0.0, -1.0, 0.0],
        near: Default::default(),
        beyond: [(0.0, None); 6],
        gains: 0,
    };
    let end = run.ground.end();
    let mut transitions = Vec::new();
    let mut samples = Vec::new();
    let grid = (0..=(end / step) as u32).map(|i| f64::from(i) * step);
    run.sample(grid, |sample| samples.push(sample.motion), &mut |transition: &Transition| {
        transitions.push(*transition)
    })
    .unwrap();
    for motion in &samples {
        seen.see(motion.time, motion.phase, &motion.state, a_g(motion.time), true);
    }
    let mut phase = run.initial.initial_phase().unwrap();
    for (i, transition) in transitions.iter().enumerate() {
        let lasts = |other: Option<&Transition>| other.is_none_or(|other| other.time != transition.time);
        let (lasted, will_last) = (lasts(i.checked_sub(1).map(|i| &transitions[i])), lasts(transitions.get(i + 1)));
        if lasted {
            seen.see(transition.time, phase, &transition.before, a_g(transition.time), false);
        }
        let next = match transition.kind {
            TransitionKind::Uplift(side) | TransitionKind::Impact(side) => Phase::Rocking(side),
            TransitionKind::Landing => Phase::FullContact,
            kind => panic!("{kind:?}"),
        };
        if will_last {
            seen.see(transition.time, next, &transition.after, a_g(transition.time), false);
        }
        let comes_to_rest = run.detail == Detail::Rigid && next == Phase::FullContact;
        if let (Phase::Rocking(side), false) = (phase, comes_to_rest) {
            seen.see_impact(side, transition);
        }
        phase = next;
    }
    let mut closer: Vec<f64> = Vec::new();
    for i in 0..3 {
        let near = std::mem::take(&mut seen.near[i]);
        let is_worst = |value: f64| (value - seen.worst[i]).abs() <= 1e-3 * (1.0 + value.abs());
        let around = near.iter().filter(|(_, value)| is_worst(*value)).map(|(time, _)| *time);
        closer.extend(around.flat_map(|time| (-500..=500).map(move |k| time + f64::from(k) * step / 500.0)));
    }
    closer.retain(|time| (0.0..=end).contains(time));
    closer.sort_unstable_by(f64::total_cmp);
    closer.dedup();
    let mut samples = Vec::new();
    run.sample(closer, |sample| samples.push(sample.motion), &mut ()).unwrap();
    for motion in &samples {
        seen.see(motion.time, motion.phase, &motion.state, a_g(motion.time), false);
    }
    seen
}

#[test]
fn ten_scenes_go_beyond_what_free_bodies_say() {
    let step = 5e-5;
    let mut infinite = 0;
    let mut tried = [0; 6];
    for (i, (parameters, initial, detail, ground)) in scenes().into_iter().enumerate() {
        let structure = Structure::new(parameters).unwrap();
        let run = Run { initial, detail, tolerance: 1e-12, end: End::At(ground.end()), ..Run::new(structure, &ground) };
        let (found, finish) = run.validity(Limits::default()).unwrap();
        assert!((found.duration - (ground.end() - ground.start())).abs() < 1e-12);
        let seen = seen(&run, step);
        println!(
            "scene {i}, {}: {} transitions, {found:#?} {:?}",
            detail.name(),
            finish.motion.transitions,
            seen.worst
        );
        for (which, assumption) in ASSUMPTIONS.iter().enumerate() {
            let (worst, expected) = (&found.worst[which], seen.worst[which]);
            let name = format!("scene {i}, {}", assumption.name);
            infinite += usize::from(expected.is_infinite());
            let off =
                if worst.value == expected { 0.0 } else { (worst.value - expected).abs() / (1.0 + expected.abs()) };
            assert!(off < 1e-9, "{name}: {} {expected}, off by {off:e}", worst.value);
            let (amount, first) = seen.beyond[which];
            let (unit, slack) = if assumption.is_of_impacts { (1.0, 0.0) } else { (step, 20.0 * step) };
            assert!((worst.beyond - unit * amount).abs() <= slack, "{name}: {} {}", worst.beyond, unit * amount);
            match (worst.first_beyond, first) {
                (Some(found), Some(seen)) => assert!((found - seen).abs() <= slack.min(step), "{name}: {found} {seen}"),
                // shorter than the step of the samples
                (Some(_), None) => assert!(worst.beyond < 2.0 * step, "{name}"),
                (found, seen) => assert_eq!(found, seen, "{name}"),
            }
            tried[which] += usize::from(worst.first_beyond.is_some());
        }
        assert_eq!(found.gains, seen.gains, "scene {i}");
    }
    assert!(infinite > 2 && tried.iter().all(|count| *count > 0), "{infinite} {tried:?}");
}
