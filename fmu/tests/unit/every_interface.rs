//! Tests of all interfaces of both versions, with one mass and with many.

use crate::host::*;
use approx::assert_relative_eq;
use fmi_unit::variables::dependencies;
use fmi_unit::{Causality, DataType, Role, Variable};
use libc::c_int;
use tempfile::TempDir;

/// Does the same with every interface; `check` is given what makes instances, and the name of a force.
fn with_each(check: impl Fn(&dyn Fn(fn(bool)) -> Host, &str)) {
    for (folder, force) in [(resources as fn() -> TempDir, "F_t"), (resources_of_many, "F_t[1]")] {
        for (is_fmi_3, fmu_type) in [(false, 0), (false, 1), (true, 0), (true, 1)] {
            let new = |around| {
                let arguments =
                    Instantiate { is_fmi_3, fmu_type, around, resources: folder(), ..Instantiate::default() };
                let host = Host::instantiate(arguments).unwrap();
                host.write("quake.csv", "t (s),a (m/s2)\n0,0.5\n0.1,-3\n0.2,2\n");
                assert_eq!(host.set_record("quake.csv"), OK);
                host
            };
            check(&new, force);
        }
    }
}

fn is_real(variable: &Variable) -> bool {
    matches!(variable.data_type, DataType::Real { .. })
}

/// A variable that the model description lists as depending on a real number has a derivative by it.
#[test]
fn what_is_listed_has_a_derivative() {
    let ties = [("P_0", 200.0), ("k_t", 1e5), ("xi_d", 0.2), ("c_d", 50.0), ("k_d", 1e6), ("F_y", 1e3)];
    with_each(|new, force| {
        for theta_0 in [0.0, 0.02] {
            let host = new(|_| ());
            let variables = &host.variables;
            let derive = |of: usize, at_start: bool| {
                let by = dependencies(variables, of, at_start).into_iter().map(|by| &variables[by]);
                // one mode moves both floors of the fixture together
                let is_alone = |by: &Variable| force == "F_t" || !by.name.starts_with("u_");
                let is_one =
                    |by: &&Variable| is_real(by) && is_alone(by) && (at_start || by.causality != Causality::Parameter);
                by.filter(is_one).for_each(|by| _ = host.derivative(&variables[of].name, &by.name));
            };
            let unknowns = || (0..variables.len()).filter(|of| is_real(&variables[*of]));
            let ties = if force == "F_t" { &ties[..] } else { &[] };
            assert_eq!((host.set(ties), host.set(&[("theta_0", theta_0)]), host.enter()), (OK, OK, OK));
            if theta_0 != 0.0 {
                unknowns().filter(|of| variables[*of].is_initial_unknown()).for_each(|of| derive(of, true));
                assert_relative_eq!(host.derivative("theta", "theta_0"), 1.0, max_relative = 1e-9);
            }
            if force == "F_t" {
                let [m, m0, H, B, alpha] = ["m", "m0", "H", "B", "alpha_cg"].map(|name| host.get(name));
                let by_m = -alpha.cos().powi(2) * B / H * m0 / (m * m);
                assert_relative_eq!(host.derivative("alpha_cg", "m"), by_m, max_relative = 1e-9);
            }
            host.start();
            let is_one = |of: &Variable| of.causality == Causality::Output || matches!(of.role, Role::RateOf(_));
            unknowns().filter(|of| is_one(&variables[*of])).for_each(|of| derive(of, false));
            assert_eq!(["a_g", force].map(|by| host.derivative("alpha_cg", by)), [0.0; 2]);
            // the unknowns are affine in the inputs
            assert_eq!(host.set(&[("a_g", 1.0)]), OK);
            let shown = || ["R_h", "R_v", "R_m"].map(|name| host.get(name));
            let before = shown();
            assert_eq!(host.set(&[(force, 1e4)]), OK);
            for ((name, after), before) in ["R_h", "R_v", "R_m"].into_iter().zip(shown()).zip(before) {
                let (found, epsilon) = (host.derivative(name, force), 1e-12 * (1.0 + before.abs() / 1e4));
                assert_relative_eq!(found, (after - before) / 1e4, max_relative = 1e-12, epsilon = epsilon);
            }
        }
    });
}

#[cfg(all(target_os = "linux", target_arch = "x86_64", target_env = "gnu"))]
mod floating_point {
    use super::*;

    unsafe extern "C" {
        fn feclearexcept(which: c_int) -> c_int;
        fn fetestexcept(which: c_int) -> c_int;
        fn feenableexcept(which: c_int) -> c_int;
        fn fedisableexcept(which: c_int) -> c_int;
        fn fesetround(way: c_int) -> c_int;
        fn fegetround() -> c_int;
    }

    /// Invalid operation, division by zero, overflow.
    const WRONG: c_int = 1 | 4 | 8;
    const UPWARD: c_int = 0x800;

    /// A host that rounds up and traps operations without a result, as it still does after a call.
    fn strict(is_before: bool) {
        if is_before {
            unsafe { (feenableexcept(WRONG), fesetround(UPWARD)) };
        } else {
            assert_eq!(unsafe { (fegetround(), fedisableexcept(WRONG) & WRONG, fesetround(0)) }, (UPWARD, WRONG, 0));
        }
    }

    /// A host that looks for operations without a result.
    fn watchful(is_before: bool) {
        assert!(is_before || unsafe { fetestexcept(WRONG) } == 0);
        unsafe { feclearexcept(WRONG) };
    }

    /// All real numbers along a run, as bits; where the host integrates, it does by Euler's method.
    fn run(host: &Host, force: &str, detail: i32) -> Vec<u64> {
        let mut shown = Vec::new();
        let mut show = || shown.extend(host.variables.iter().filter(|of| is_real(of)).map(|of| host.get(&of.name)));
        let switches = ["a_g_late", "F_t_extrapolated", "peaks", "validity"].map(|name| host.set_boolean(name, 1));
        let theta_0 = if detail == 6 { 0.0 } else { 0.02 };
        assert_eq!((switches, host.set_integer("detail", detail)), ([OK; 4], OK));
        assert_eq!((host.set(&[("theta_0", theta_0)]), host.enter()), (OK, OK));
        show();
        host.start();
        for step in 0..40 {
            let (time, length) = (f64::from(step) / 64.0, 1.0 / 64.0); // exact, as is the end of the step
            let input = (9.0 * time).sin();
            assert_eq!(host.set(&[("a_g", input), (force, input)]), OK);
            if host.is_model {
                let states = host.states().unwrap().into_iter().zip(host.derivatives().unwrap());
                let end: Vec<_> = states.map(|(state, rate)| state + length * rate).collect();
                host.go_to(time + length, &end);
            } else {
                assert_eq!(host.step(time, length), OK);
            }
            show();
            ["a_g", "theta"].iter().for_each(|by| _ = host.derivative("R_m", by));
        }
        shown.into_iter().map(f64::to_bits).collect()
    }

    /// No valid scene needs an operation that has no result, and how the host rounds changes no bit.
    #[test]
    fn no_operation_is_invalid_and_the_hosts_control_is_its_own() {
        for detail in 1..=6 {
            with_each(|new, force| {
                if detail != 4 || force == "F_t" {
                    let [usual, strict] = [watchful, strict].map(|around| run(&new(around), force, detail));
                    assert!(strict == usual, "detail = {detail}"); // `modal` is of one mass
                }
            });
        }
    }
}
