//! Reactions on the ground and impulses of impacts: the balance of momentum.

use crate::common::{start, transitions};
use rocking::{Detail, Engine, LinearLoad, Load, Parameters, Reactions, State, Transition};

/// Position of the top mass and of the middle of the base, their momenta to the right and upwards, and the angular
/// momentum about the origin, from the geometry as it stands.
struct Balance {
    x: [f64; 2],
    y: [f64; 2],
    right: f64,
    up: f64,
    turning: f64,
}

fn balance(engine: &Engine) -> Balance {
    let &Parameters { m, m0, H, B, J0, .. } = engine.structure().one().unwrap().parameters();
    let motion = engine.motion();
    let State { u, u_dot, theta, theta_dot } = motion.state;
    let s = motion.phase.side().sign();
    let (sin, cos) = theta.sin_cos();
    let x = [s * B * (1.0 - cos) + u * cos + H * sin, s * B * (1.0 - cos)];
    let y = [(s * B - u) * sin + H * cos, s * B * sin];
    let v = [u_dot * cos + y[0] * theta_dot, y[1] * theta_dot];
    let w = [(s * B - x[0]) * theta_dot - u_dot * sin, (s * B - x[1]) * theta_dot];
    Balance {
        x,
        y,
        right: m * v[0] + m0 * v[1],
        up: m * w[0] + m0 * w[1],
        turning: m * (y[0] * v[0] - x[0] * w[0]) + m0 * (y[1] * v[1] - x[1] * w[1]) + J0 * theta_dot,
    }
}

/// Nodes and weights of Gauss and Legendre on [0, 1].
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// Over a whole motion, momentum changes by what gravity, the ground's acceleration and F_t give it less what the
/// reactions and the impulses of impacts hand on to the ground, whatever the level of detail.
#[test]
fn the_momentum_balance_closes_across_impacts() {
    let dt = 2.5e-3;
    let load = |t: f64| Load { a_g: 5.0 * (22.0 * t).sin(), F_t: 150.0 * (9.0 * t).cos(), a_v: 0.0 };
    for (parameters, detail) in [Parameters::MCMANUS, Parameters::EVISON]
        .into_iter()
        .flat_map(|parameters| Detail::ALL.map(|detail| (parameters, detail)))
    {
        let &Parameters { m, m0, g, .. } = &parameters;
        let piece = |k: usize| {
            let (value, next) = (load(k as f64 * dt), load((k + 1) as f64 * dt));
            let slope = Load { a_g: (next.a_g - value.a_g) / dt, F_t: (next.F_t - value.F_t) / dt, a_v: 0.0 };
            LinearLoad { value, slope }
        };
        let fresh = || start(parameters, State::default(), detail);
        let mut cuts = Vec::new();
        let mut engine = fresh();
        for k in 0..800 {
            cuts.push((k as f64 * dt, k));
            let interval = (k + 1) as f64 * dt - engine.motion().time;
            for Transition { time, .. } in transitions(&mut engine, interval, piece(k)) {
                if time > cuts[cuts.len() - 1].0 {
                    cuts.push((time, k));
                }
            }
        }
        assert_eq!(engine.motion().transitions > 5, detail != Detail::FixedBase);
        cuts.push((800.0 * dt, 800));

        let mut engine = fresh();
        let (mut given, mut size) = ([0.0; 3], [0.0; 3]);
        for pair in cuts.windows(2) {
            let [(from, k), (to, _)] = *pair else { unreachable!() };
            for (node, weight) in GAUSS {
                let load = piece(k);
                let at = |t: f64| LinearLoad { value: load.at(t - k as f64 * dt), ..load };
                let until = from + node * (to - from);
                engine.advance(until - engine.motion().time, at(engine.motion().time), &mut ()).unwrap();
                let Load { a_g, F_t, .. } = at(until).value;
                let Reactions { R_h, R_v, R_m } = engine.sample(Load { a_g, F_t, a_v: 0.0 }).reactions();
                let Balance { x, y, .. } = balance(&engine);
                let rates = [
                    F_t - (m + m0) * a_g - R_h,
                    R_v - (m + m0) * g,
                    F_t * y[0] + g * (m * x[0] + m0 * x[1]) - a_g * (m * y[0] + m0 * y[1]) - R_m,
                ];
                for (i, rate) in rates.into_iter().enumerate() {
                    given[i] += weight * (to - from) * rate;
                    size[i] += weight * (to - from) * rate.abs();
                }
            }
            let load = piece(k);
            let here = engine.motion().time;
            let value = load.at(here - k as f64 * dt);
            engine.advance(to - engine.motion().time, LinearLoad { value, ..load }, &mut ()).unwrap();
        }
        let impulse = engine.motion().impulse;
        let Balance { right, up, turning, .. } = balance(&engine);
        let changes = [right + impulse.I_h, up - impulse.I_v, turning + impulse.I_m];
        for i in 0..3 {
            let name = detail.name();
            assert!((changes[i] - given[i]).abs() < 1e-8 * (size[i] + 1.0), "{name} {i}: {changes:?} {given:?}");
        }
        assert_eq!(impulse.I_v > 0.0, detail != Detail::FixedBase);
    }
}
