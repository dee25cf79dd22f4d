//! Directional derivatives: of the outputs by the inputs, as a host asks for them.

use crate::host::*;
use approx::assert_relative_eq;

const OUTPUTS: [&str; 6] = ["a_t", "V_t", "M_t", "R_h", "R_v", "R_m"];

/// θ, θ̇ and u̇ large: every term counts.
fn rocking() -> Host {
    Host::started(&[("theta_0", 0.3), ("theta_dot_0", -0.4), ("u_0", 2e-3), ("u_dot_0", 0.3), ("J0", 2.0)])
}

/// For directions of any size, and along two at once.
#[test]
fn they_are_linear_in_the_direction() {
    let host = rocking();
    assert_eq!(host.set(&[("a_g", 3.0), ("F_t", -50.0)]), OK);
    let by = |knowns: &[(&str, f64)]| host.derive(&OUTPUTS, knowns).unwrap();
    let (by_ground, by_force) = (by(&[("a_g", 1.0)]), by(&[("F_t", 1.0)]));
    let both = by(&[("a_g", -2.0), ("F_t", 10.0), ("F_t", 20.0)]);
    let [tiny, huge] = [1e-200, 1e100].map(|size| by(&[("F_t", size)]));
    for detail in [1.0, 3.0, 5.0] {
        let host = Host::started(&[("theta_0", 0.3), ("detail", detail)]);
        let upwards = host.derive(&["R_v", "der(theta_dot)"], &[("a_v", 1.0)]).unwrap();
        assert!(upwards.iter().all(|by| *by != 0.0), "{upwards:?}, of an input that has not been set");
    }
    for (i, name) in OUTPUTS.into_iter().enumerate() {
        assert!(by_force[i] != 0.0, "{name}");
        assert_relative_eq!(both[i], -2.0 * by_ground[i] + 30.0 * by_force[i], max_relative = 1e-12, epsilon = 1e-12);
        assert_relative_eq!(tiny[i] / 1e-200, by_force[i], max_relative = 1e-13);
        assert_relative_eq!(huge[i] / 1e100, by_force[i], max_relative = 1e-13);
    }
    assert_eq!((by(&[("a_g", 0.0)]), by(&[])), (vec![0.0; 6], vec![0.0; 6]));
    let of_state_or_events = ["theta", "u_dot", "v_t", "I_v"];
    assert_eq!(host.derive(&of_state_or_events, &[("a_g", 1.0), ("F_t", 1e3)]), Ok(vec![0.0; 4]));
}

/// However large the elastic force: ∂a_t/∂F_t = cos θ/m.
#[test]
fn they_keep_their_digits_beside_large_forces() {
    let host = Host::started(&[("theta_0", 0.3), ("u_0", 5e-3), ("f_fc", 1e3)]);
    let found = host.derive(&["a_t"], &[("F_t", 1.0)]).unwrap();
    assert_relative_eq!(found[0], 0.3_f64.cos() / host.get("m"), max_relative = 1e-12);
}

/// During initialization and at the instant of overturning the outputs follow the inputs as they do in between.
#[test]
fn they_exist_from_initialization_to_overturning() {
    let initializing = Host::initializing(&[("theta_0", 0.3), ("u_0", 2e-3)]);
    let started = Host::started(&[("theta_0", 0.3), ("u_0", 2e-3)]);
    let knowns = [("a_g", 1.0), ("F_t", 20.0)];
    assert_eq!(initializing.derive(&OUTPUTS, &knowns), started.derive(&OUTPUTS, &knowns));
    for detail in 1..=5 {
        let host = Host::initializing(&[("theta_0", 1.2)]);
        assert_eq!((host.set_integer("detail", detail), host.exit()), (OK, OK));
        assert_eq!(host.step(0.0, 10.0), DISCARD);
        let found = host.derive(&["a_t"], &[("F_t", 1.0)]).unwrap()[0];
        // along the strut, which lies down, nothing pushes u; the rigid structure is turned about its pivot
        let p_l = host.get("p_l");
        let J_P = host.get("m") * host.get("g") * host.get("H") / (p_l * p_l);
        let expected = if detail == 5 { host.get("H") * host.get("B") / J_P } else { 0.0 };
        assert_relative_eq!(found, expected, max_relative = 1e-9, epsilon = 1e-12);
    }
}

/// The top mass above the pivot of a foundation without inertia: nothing says how it turns.
#[test]
fn where_the_equations_are_singular_neither_they_nor_the_reactions_exist() {
    let host = Host::started(&[("m0", 0.0), ("J0", 0.0), ("B", 0.25), ("u_0", 0.25), ("theta_0", 0.01)]);
    let message = "fmi2GetDirectionalDerivative: the derivative of R_h does not exist at t = 0 s";
    host.assert_refused(|| host.derive(&["R_h"], &[("F_t", 1.0)]), Err(ERROR), message);
    let message = "fmi2GetReal: R_m does not exist at t = 0 s: the top mass is above the pivot of a foundation without \
                   inertia (m0, J0 too small)";
    host.assert_refused(|| host.try_get(&["theta", "R_m"]), Err(ERROR), message);
    assert_eq!(host.try_get(&["theta", "I_v"]), Ok(vec![0.01, 0.0]));
    assert_eq!((host.step(1e-6, 0.1), host.get("time")), (ERROR, 0.0));
}
