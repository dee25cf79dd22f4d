//! Directional derivatives: of the outputs by the inputs, as a host asks for them.
#![allow(unsafe_code, non_snake_case)]

mod host;

use FlexibleRocking::fmi2::fmi2GetDirectionalDerivative;
use FlexibleRocking::sensitivity::ACCURACY;
use approx::assert_relative_eq;
use host::*;
use std::f64::consts::TAU;

/// The derivatives of `unknowns` where each of `knowns` changes by so much, or the status.
fn derivatives(host: &Host, unknowns: &[&str], knowns: &[(&str, f64)]) -> Result<Vec<f64>, i32> {
    let references = unknowns.iter().map(|name| reference(name)).collect::<Vec<_>>();
    let (of, by): (Vec<_>, Vec<_>) = knowns.iter().map(|(name, change)| (reference(name), *change)).unzip();
    let mut values = vec![f64::MAX; unknowns.len()];
    let status = unsafe {
        fmi2GetDirectionalDerivative(
            host.component,
            references.as_ptr(),
            references.len(),
            of.as_ptr(),
            of.len(),
            by.as_ptr(),
            values.as_mut_ptr(),
        )
    };
    if status == OK { Ok(values) } else { Err(status) }
}

const OUTPUTS: [&str; 6] = ["a_t", "V_t", "M_t", "R_h", "R_v", "R_m"];

/// θ, θ̇ and u̇ large: every term counts.
fn rocking() -> Host {
    Host::started(&[("theta_0", 0.3), ("theta_dot_0", -0.4), ("u_0", 2e-3), ("u_dot_0", 0.3), ("J0", 2.0)])
}

/// Whatever the size of the direction, and along two at once.
#[test]
fn they_are_linear_in_the_direction() {
    let host = rocking();
    assert_eq!(host.set(&[("a_g", 3.0), ("F_t", -50.0)]), OK);
    let by = |knowns: &[(&str, f64)]| derivatives(&host, &OUTPUTS, knowns).unwrap();
    let (by_ground, by_force) = (by(&[("a_g", 1.0)]), by(&[("F_t", 1.0)]));
    let both = by(&[("a_g", -2.0), ("F_t", 10.0), ("F_t", 20.0)]);
    let [tiny, huge] = [1e-200, 1e100].map(|size| by(&[("F_t", size)]));
    let upwards = derivatives(&host, &["R_v", "der(theta_dot)"], &[("a_v", 1.0)]).unwrap();
    assert!(upwards.iter().all(|by| *by != 0.0), "{upwards:?}, of an input that has not been set");
    for (i, name) in OUTPUTS.into_iter().enumerate() {
        assert!(by_force[i] != 0.0, "{name}");
        assert_relative_eq!(both[i], -2.0 * by_ground[i] + 30.0 * by_force[i], max_relative = 1e-12, epsilon = 1e-12);
        assert_relative_eq!(tiny[i] / 1e-200, by_force[i], max_relative = 1e-13);
        assert_relative_eq!(huge[i] / 1e100, by_force[i], max_relative = 1e-13);
    }
    assert_eq!((by(&[("a_g", 0.0)]), by(&[])), (vec![0.0; 6], vec![0.0; 6]));
    let of_state_or_events = ["theta", "u_dot", "v_t", "I_v"];
    assert_eq!(derivatives(&host, &of_state_or_events, &[("a_g", 1.0), ("F_t", 1e3)]), Ok(vec![0.0; 4]));
}

/// However large the elastic force: ∂a_t/∂F_t = cos θ/m.
#[test]
fn they_keep_their_digits_beside_large_forces() {
    let host = Host::started(&[("theta_0", 0.3), ("u_0", 5e-3), ("f_fc", 1e3)]);
    let found = derivatives(&host, &["a_t"], &[("F_t", 1.0)]).unwrap();
    assert_relative_eq!(found[0], 0.3_f64.cos() / host.get("m"), max_relative = 1e-12);
}

/// During initialization and at the instant of overturning the outputs follow the inputs as they do in between.
#[test]
fn they_exist_from_initialization_to_overturning() {
    let initializing = Host::initializing(&[("theta_0", 0.3), ("u_0", 2e-3)]);
    let started = Host::started(&[("theta_0", 0.3), ("u_0", 2e-3)]);
    let knowns = [("a_g", 1.0), ("F_t", 20.0)];
    assert_eq!(derivatives(&initializing, &OUTPUTS, &knowns), derivatives(&started, &OUTPUTS, &knowns));
    for detail in 1..=5 {
        let host = Host::initializing(&[("theta_0", 1.2)]);
        assert_eq!((host.set_integer("detail", detail), host.exit()), (OK, OK));
        assert_eq!(host.step(0.0, 10.0), DISCARD);
        let found = derivatives(&host, &["a_t"], &[("F_t", 1.0)]).unwrap()[0];
        // along the strut, which lies down, nothing pushes u; the rigid structure is turned about its pivot
        let p_l = host.get("p_l");
        let J_P = host.get("m") * host.get("g") * host.get("H") / (p_l * p_l);
        let expected = if detail == 5 { host.get("H") * host.get("B") / J_P } else { 0.0 };
        assert_relative_eq!(found, expected, max_relative = 1e-9, epsilon = 1e-12);
    }
}

#[test]
fn what_is_no_known_or_unknown_is_refused() {
    let host = rocking();
    let can = "only the inputs can, in initialization mode real parameters and initial values, later u, u_dot, theta, \
               theta_dot and time";
    let no_known = |name: &str| format!("{name} cannot be a known of a directional derivative: {can}");
    for (unknowns, knowns, message) in [
        (["a_t"], [("delta_t", 1.0)], &no_known("delta_t")[..]),
        (["a_t"], [("m", 1.0)], &no_known("m")),
        (["p_l"], [("a_g", 1.0)], "p_l has no derivative: only continuous real outputs have"),
        (["a_t"], [("F_t", f64::NAN)], "the derivative of F_t, NaN, is out of range: it must be finite"),
        (["phase"], [("a_g", 1.0)], "phase has no derivative: only continuous real outputs have"),
        (["F_t"], [("a_g", 1.0)], "F_t has no derivative: only continuous real outputs have"),
    ] {
        let message = format!("fmi2GetDirectionalDerivative: {message}");
        host.assert_refused(|| derivatives(&host, &unknowns, &knowns), Err(ERROR), &message);
    }
    let host = Host::initializing(&[]);
    for name in ["detail", "theta"] {
        let message = format!("fmi2GetDirectionalDerivative: {}", no_known(name));
        host.assert_refused(|| derivatives(&host, &["a_t"], &[(name, 1.0)]), Err(ERROR), &message);
    }
    // free edges rise to either side, and a base in full contact cannot turn
    for (unknown, known) in [("uplift", "theta_0"), ("theta_dot", "theta_dot_0")] {
        let message = format!(
            "fmi2GetDirectionalDerivative: the derivative of {unknown} by {known} does not exist here: {known} cannot \
             change, or not to both sides alike"
        );
        host.assert_refused(|| derivatives(&host, &[unknown], &[(known, 1.0)]), Err(ERROR), &message);
    }
}

/// In initialization mode, what InitialUnknowns lists: outputs and calculated parameters by parameters and initial
/// values. J0 = 0, c_ratio = 0 and theta_0 = 1.5 are at the ends of their ranges, theta_0 = 0 is where phases change.
#[test]
fn those_by_start_values_are_the_closed_forms() {
    for (theta, J0, c_ratio) in [(0.3_f64, 2.0, 0.7), (-0.3, 0.0, 0.0), (1.5, 1e-9, 1.0), (1e-9, 0.0, 1e-3)] {
        let u = 2e-3;
        let host = Host::initializing(&[("theta_0", theta), ("u_0", u), ("u_dot_0", 0.3), ("J0", J0)]);
        host.write("pulse.csv", "t (s),a (m/s2)\n0,1\n1,3\n");
        let placement = [("record_scale", 0.8), ("record_start", -0.25)];
        assert_eq!((host.set_record("pulse.csv"), host.set(&placement)), (OK, OK));
        assert_eq!(host.set(&[("c_ratio", c_ratio), ("a_g", 3.0), ("F_t", -50.0)]), OK);
        let [m, H, B, f, zeta, g, u_dot] = ["m", "H", "B", "f_fc", "zeta_fc", "g", "u_dot"].map(|name| host.get(name));
        let [F_t, h_cg, p_l, chi, u_cr, f_u] = [
            host.get("F_t"),
            B / host.get("alpha_cg").tan(),
            host.get("p_l"),
            host.get("chi"),
            host.get("u_cr"),
            host.get("f_u"),
        ];
        let (s, sin, cos) = (theta.signum(), theta.sin(), theta.cos());
        let (omega, J_P) = (TAU * f, m * g * H / (p_l * p_l));
        for (unknown, known, expected) in [
            ("theta", "theta_0", 1.0),
            ("u_dot", "u_dot_0", 1.0),
            ("a_t", "g", sin),
            ("a_t", "m", -F_t / (m * m) * cos),
            ("a_t", "u_0", -omega * omega),
            ("a_t", "theta_0", g * cos - F_t / m * sin),
            ("a_t", "f_fc", -2.0 * TAU * (zeta * c_ratio * u_dot + omega * u)),
            ("a_t", "c_ratio", -2.0 * zeta * omega * u_dot),
            ("uplift", "theta_0", 2.0 * B * s * cos),
            ("delta_t", "theta_0", (s * B - u) * sin + H * cos),
            ("v_t", "theta_dot_0", (s * B - u) * sin + H * cos),
            ("alpha_cg", "B", h_cg / (h_cg * h_cg + B * B)),
            ("p_l", "J0", -0.5 * p_l / J_P),
            ("chi", "J0", -chi / J_P),
            ("f_u", "J0", -0.5 * f_u * chi / ((1.0 - chi) * J_P)),
            ("u_cr", "f_fc", -2.0 * u_cr / f),
            ("a_ground", "record_scale", (host.get("a_ground") - 3.0) / 0.8),
        ] {
            let found = derivatives(&host, &[unknown], &[(known, 1.0)]).unwrap()[0];
            let value = host.get(unknown).abs();
            assert_relative_eq!(found, expected, max_relative = ACCURACY, epsilon = ACCURACY * value);
        }
        // along several at once
        let by = |knowns: &[(&str, f64)]| derivatives(&host, &["R_h"], knowns).unwrap()[0];
        let alone = by(&[("a_g", 0.5)]) + by(&[("m", -2.0)]) + by(&[("theta_0", 3.0)]);
        assert_relative_eq!(by(&[("a_g", 0.5), ("m", -2.0), ("theta_0", 3.0)]), alone, max_relative = 1e-12);
    }
}

/// The top mass above the pivot of a foundation without inertia: nothing says how it turns.
#[test]
fn where_the_equations_are_singular_neither_they_nor_the_reactions_exist() {
    let host = Host::started(&[("m0", 0.0), ("J0", 0.0), ("B", 0.25), ("u_0", 0.25), ("theta_0", 0.01)]);
    let message = "fmi2GetDirectionalDerivative: the derivative of R_h does not exist at t = 0 s";
    host.assert_refused(|| derivatives(&host, &["R_h"], &[("F_t", 1.0)]), Err(ERROR), message);
    let message = "fmi2GetReal: R_m does not exist at t = 0 s: the top mass is above the pivot of a foundation without \
                   inertia (m0, J0 too small)";
    host.assert_refused(|| host.try_get(&["theta", "R_m"]), Err(ERROR), message);
    assert_eq!(host.try_get(&["theta", "I_v"]), Ok(vec![0.01, 0.0]));
}
