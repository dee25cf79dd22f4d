//! Directional derivatives: of the outputs by the inputs, as a host asks for them.
#![allow(unsafe_code, non_snake_case)]

mod host;

use FlexibleRocking::c_abi::fmi2GetDirectionalDerivative;
use approx::assert_relative_eq;
use host::*;

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

#[test]
fn they_are_linear_in_the_direction() {
    let host = rocking();
    assert_eq!(host.set(&[("a_g", 3.0), ("F_t", -50.0)]), OK);
    let by_ground = derivatives(&host, &OUTPUTS, &[("a_g", 1.0)]).unwrap();
    let by_force = derivatives(&host, &OUTPUTS, &[("F_t", 1.0)]).unwrap();
    let both = derivatives(&host, &OUTPUTS, &[("a_g", -2.0), ("F_t", 30.0)]).unwrap();
    let twice = derivatives(&host, &OUTPUTS, &[("F_t", 0.4), ("F_t", 0.6)]).unwrap();
    let [tiny, huge] = [1e-200, 1e100].map(|size| derivatives(&host, &OUTPUTS, &[("F_t", size)]).unwrap());
    for (i, name) in OUTPUTS.into_iter().enumerate() {
        assert!(by_force[i] != 0.0, "{name}");
        assert_relative_eq!(both[i], -2.0 * by_ground[i] + 30.0 * by_force[i], max_relative = 1e-12, epsilon = 1e-12);
        assert_relative_eq!(twice[i], by_force[i], max_relative = 1e-13);
        assert_relative_eq!(tiny[i] / 1e-200, by_force[i], max_relative = 1e-13);
        assert_relative_eq!(huge[i] / 1e100, by_force[i], max_relative = 1e-13);
    }
    assert_eq!(derivatives(&host, &OUTPUTS, &[("a_g", 0.0)]), Ok(vec![0.0; 6]));
    assert_eq!(derivatives(&host, &OUTPUTS, &[]), Ok(vec![0.0; 6]));
    assert_eq!(derivatives(&host, &["theta", "u_dot", "v_t"], &[("a_g", 1.0), ("F_t", 1e3)]), Ok(vec![0.0; 3]));
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
    for (unknowns, knowns, message) in [
        (["a_t"], [("theta", 1.0)], "theta cannot be a known of a directional derivative: only the inputs can"),
        (["a_t"], [("m", 1.0)], "m cannot be a known of a directional derivative: only the inputs can"),
        (["a_t"], [("F_t", f64::NAN)], "the derivative of F_t, NaN, is out of range: it must be finite"),
        (["I_v"], [("F_t", 1.0)], "I_v has no derivative: only continuous Real outputs have"),
        (["phase"], [("a_g", 1.0)], "phase has no derivative: only continuous Real outputs have"),
        (["F_t"], [("a_g", 1.0)], "F_t has no derivative: only continuous Real outputs have"),
    ] {
        let message = format!("fmi2GetDirectionalDerivative: {message}");
        host.assert_refused(|| derivatives(&host, &unknowns, &knowns), Err(ERROR), &message);
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
