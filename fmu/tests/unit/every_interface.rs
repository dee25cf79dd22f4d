//! What holds of all interfaces of both versions, of one mass and of many.

use crate::host::*;
use FlexibleRocking::any::AnyUnit;
use FlexibleRocking::fmi2::{self, CallbackFunctions};
use FlexibleRocking::fmi3;
use approx::assert_relative_eq;
use fmi_unit::variables::{dependencies, position, state_references};
use fmi_unit::{Causality, DataType, Model, Role, Value, Variable};
use libc::{c_int, c_void};
use std::ffi::CString;
use std::ptr::{null, null_mut};
use std::sync::Arc;

/// Called before and after each call of an instance; whether it is before.
type Around = fn(bool);

struct Instance {
    c: *mut c_void,
    is_fmi_3: bool,
    is_model: bool,
    variables: Arc<[Variable]>,
    around: Around,
}

/// Calls the function of the instance's version with arguments that are known before.
macro_rules! call {
    ($of:ident, $two:ident($($a:expr),*), $three:ident($($b:expr),*)) => {{
        ($of.around)(true);
        let status = unsafe { if $of.is_fmi_3 { fmi3::$three($of.c, $($b),*) } else { fmi2::$two($of.c, $($a),*) } };
        ($of.around)(false);
        assert_eq!(status, OK, stringify!($three));
    }};
}

impl Instance {
    /// The value reference of a variable.
    fn at(&self, name: &str) -> u32 {
        position(&self.variables, name) as u32 + u32::from(self.is_fmi_3)
    }

    fn set(&self, name: &str, value: Value) {
        let at = self.at(name);
        match value {
            Value::Real(value) => call!(self, fmi2SetReal(&at, 1, &value), fmi3SetFloat64(&at, 1, &value, 1)),
            Value::Integer(value) => {
                call!(self, fmi2SetInteger(&at, 1, &value), fmi3SetInt64(&at, 1, &i64::from(value), 1));
            }
            Value::Boolean(on) => {
                call!(self, fmi2SetBoolean(&at, 1, &on.into()), fmi3SetBoolean(&at, 1, &on.into(), 1))
            }
            Value::String(text) => {
                let text = CString::new(text).unwrap();
                call!(self, fmi2SetString(&at, 1, &text.as_ptr()), fmi3SetString(&at, 1, &text.as_ptr(), 1));
            }
        }
    }

    fn get(&self, name: &str) -> f64 {
        let (at, mut value) = (self.at(name), f64::NAN);
        call!(self, fmi2GetReal(&at, 1, &mut value), fmi3GetFloat64(&at, 1, &mut value, 1));
        value
    }

    fn derivative(&self, of: &str, by: &str) -> f64 {
        let (of, by, mut found) = (self.at(of), self.at(by), f64::NAN);
        call!(
            self,
            fmi2GetDirectionalDerivative(&of, 1, &by, 1, &1.0, &mut found),
            fmi3GetDirectionalDerivative(&of, 1, &by, 1, &1.0, 1, &mut found, 1)
        );
        found
    }

    fn initialize(&self) {
        call!(self, fmi2EnterInitializationMode(), fmi3EnterInitializationMode(0, 0.0, 0.0, 0, 0.0));
    }

    fn start(&self) {
        call!(self, fmi2ExitInitializationMode(), fmi3ExitInitializationMode());
        if self.is_model {
            self.leave_event();
        }
    }

    /// From event mode to continuous-time mode.
    fn leave_event(&self) {
        let (mut info, mut flags) = (unsafe { std::mem::zeroed() }, [0; 5]);
        let [a, b, c, d, e] = &mut flags;
        call!(self, fmi2NewDiscreteStates(&mut info), fmi3UpdateDiscreteStates(a, b, c, d, e, &mut 0.0));
        call!(self, fmi2EnterContinuousTimeMode(), fmi3EnterContinuousTimeMode());
    }

    /// Advances from `from` to `to` (s); where the host integrates, by Euler's method.
    fn step(&self, from: f64, to: f64) {
        let (n, step, mut flags) = (state_references(&self.variables).count(), to - from, [0; 3]);
        let [event, end, early] = &mut flags;
        if !self.is_model {
            return call!(self, fmi2DoStep(from, step, 0), fmi3DoStep(from, step, 0, event, end, early, &mut 0.0));
        }
        let (mut x, mut rates, mut needed) = (vec![0.0; n], vec![0.0; n], 0);
        let (to_x, to_rates) = (x.as_mut_ptr(), rates.as_mut_ptr());
        call!(self, fmi2GetContinuousStates(to_x, n), fmi3GetContinuousStates(to_x, n));
        call!(self, fmi2GetDerivatives(to_rates, n), fmi3GetContinuousStateDerivatives(to_rates, n));
        x.iter_mut().zip(rates).for_each(|(x, rate)| *x += step * rate);
        call!(self, fmi2SetTime(to), fmi3SetTime(to));
        call!(self, fmi2SetContinuousStates(x.as_ptr(), n), fmi3SetContinuousStates(x.as_ptr(), n));
        call!(self, fmi2CompletedIntegratorStep(0, &mut needed, &mut 0), fmi3CompletedIntegratorStep(0, event, end));
        if needed == 1 || *event == 1 {
            call!(self, fmi2EnterEventMode(), fmi3EnterEventMode());
            self.leave_event();
        }
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        unsafe { if self.is_fmi_3 { fmi3::fmi3FreeInstance(self.c) } else { fmi2::fmi2FreeInstance(self.c) } }
    }
}

/// Does the same with every interface; `check` is given what makes instances, and the name of a force.
fn with_each(check: impl Fn(&dyn Fn(Around) -> Instance, &str)) {
    for (resources, force) in [(resources(), "F_t"), (resources_of_many(), "F_t[1]")] {
        std::fs::write(resources.path().join("quake.csv"), "t (s),a (m/s2)\n0,0.5\n0.1,-3\n0.2,2\n").unwrap();
        let (model, path) = (AnyUnit::open(resources.path()).unwrap(), resources.path().to_str().unwrap());
        let texts = ["wall", &model.token(), path, &format!("file://{path}")].map(|text| CString::new(text).unwrap());
        let [name, token, folder, uri] = texts.each_ref().map(|text| text.as_ptr());
        for (is_fmi_3, is_model) in [(false, false), (false, true), (true, false), (true, true)] {
            let make = |around: Around| unsafe {
                let (functions, none) = (CallbackFunctions { logger: None, ..callbacks(null_mut()) }, null_mut());
                let (of_3, slave_of_3) = (fmi3::fmi3InstantiateModelExchange, fmi3::fmi3InstantiateCoSimulation);
                around(true);
                let c = match (is_fmi_3, is_model) {
                    (true, true) => of_3(name, token, folder, 0, 0, none, None),
                    (true, false) => slave_of_3(name, token, folder, 0, 0, 0, 0, null(), 0, none, None, None),
                    _ => fmi2::fmi2Instantiate(name, (!is_model).into(), token, uri, &functions, 0, 0),
                };
                around(false);
                assert!(!c.is_null());
                Instance { c, is_fmi_3, is_model, variables: model.variables(), around }
            };
            check(&make, force);
        }
    }
}

fn is_real(variable: &Variable) -> bool {
    matches!(variable.data_type, DataType::Real { .. })
}

/// Whatever the model description lists as depending on a real number has a derivative by it.
#[test]
fn what_is_listed_has_a_derivative() {
    let ties = [("P_0", 200.0), ("k_t", 1e5), ("xi_d", 0.2), ("c_d", 50.0), ("k_d", 1e6), ("F_y", 1e3)];
    with_each(|new, force| {
        for theta_0 in [0.0, 0.02] {
            let instance = new(|_| ());
            let variables = &instance.variables;
            let derive = |of: usize, at_start: bool| {
                let by = dependencies(variables, of, at_start).into_iter().map(|by| &variables[by]);
                let is_one = |by: &&Variable| is_real(by) && (at_start || by.causality != Causality::Parameter);
                by.filter(is_one).for_each(|by| _ = instance.derivative(&variables[of].name, &by.name));
            };
            let unknowns = || (0..variables.len()).filter(|of| is_real(&variables[*of]));
            if force == "F_t" {
                ties.iter().for_each(|(name, value)| instance.set(name, Value::Real(*value)));
            }
            instance.set("theta_0", Value::Real(theta_0));
            instance.set("record", Value::String("quake.csv".to_owned()));
            instance.initialize();
            if theta_0 != 0.0 {
                unknowns().filter(|of| variables[*of].is_initial_unknown()).for_each(|of| derive(of, true));
                assert_relative_eq!(instance.derivative("theta", "theta_0"), 1.0, max_relative = 1e-9);
            }
            if force == "F_t" {
                let [m, m0, H, B, alpha] = ["m", "m0", "H", "B", "alpha_cg"].map(|name| instance.get(name));
                let by_m = -alpha.cos().powi(2) * B / H * m0 / (m * m);
                assert_relative_eq!(instance.derivative("alpha_cg", "m"), by_m, max_relative = 1e-9);
            }
            instance.start();
            let is_one = |of: &Variable| of.causality == Causality::Output || matches!(of.role, Role::RateOf(_));
            unknowns().filter(|of| is_one(&variables[*of])).for_each(|of| derive(of, false));
            assert_eq!(["a_g", force].map(|by| instance.derivative("alpha_cg", by)), [0.0; 2]);
            // the unknowns are affine in the inputs
            instance.set("a_g", Value::Real(1.0));
            let shown = || ["R_h", "R_v", "R_m"].map(|name| instance.get(name));
            let before = shown();
            instance.set(force, Value::Real(1e4));
            for ((name, after), before) in ["R_h", "R_v", "R_m"].into_iter().zip(shown()).zip(before) {
                let (found, epsilon) = (instance.derivative(name, force), 1e-12 * (1.0 + before.abs() / 1e4));
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

    /// All real numbers along a run, as bits.
    fn run(instance: &Instance, force: &str, detail: i32) -> Vec<u64> {
        let mut shown = Vec::new();
        let mut show =
            || shown.extend(instance.variables.iter().filter(|of| is_real(of)).map(|of| instance.get(&of.name)));
        instance.set("detail", Value::Integer(detail));
        ["a_g_late", "F_t_extrapolated", "peaks", "validity"]
            .iter()
            .for_each(|name| instance.set(name, Value::Boolean(true)));
        instance.set("theta_0", Value::Real(if detail == 6 { 0.0 } else { 0.02 }));
        instance.set("record", Value::String("quake.csv".to_owned()));
        instance.initialize();
        show();
        instance.start();
        for step in 0..40 {
            let time = f64::from(step) / 64.0; // exact, as is the end of the step
            ["a_g", force].iter().for_each(|input| instance.set(input, Value::Real((9.0 * time).sin())));
            instance.step(time, time + 1.0 / 64.0);
            show();
            ["a_g", "theta"].iter().for_each(|by| _ = instance.derivative("R_m", by));
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
