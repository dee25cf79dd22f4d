//! Measured limits of stability against theory, and the trap of uplift.

use study::fixed_step::TEXTBOOK;
use study::response::RunFailure;
use study::stability::limits::measure;
use study::stability::uplift_trap;
use study::stability::vibration::FreeVibration;

/// Limits of ω_u h by theory, as functions of ζ_u; infinite where there is no limit. The limit of RK4 is a root of its polynomial.
static THEORY: [fn(f64) -> f64; TEXTBOOK.len()] = [
    |zeta| if zeta <= 1.0 { 2.0 * zeta } else { 2.0 / (zeta + (zeta * zeta - 1.0).sqrt()) },
    |zeta| 2.0 * ((1.0 + zeta * zeta).sqrt() - zeta),
    |_| 2.0,
    |zeta| if zeta < 0.5 { 8f64.sqrt() } else { 2.785_293_563_405_282 },
    |_| f64::INFINITY,
    |_| f64::INFINITY,
];

#[test]
fn measured_limits_are_those_of_theory() {
    for (textbook, theory) in TEXTBOOK.iter().zip(THEORY) {
        for (chi, zeta_u) in [(0.0, 0.0), (0.9, 0.0), (0.5, 0.02), (0.9, 0.3), (0.0, 1.0), (0.98, 1.0), (0.7, 1.3)] {
            if textbook.name == "RK4" && ![0.0, 1.0].contains(&zeta_u) {
                continue;
            }
            let limit = measure(textbook.method, &FreeVibration { chi, zeta_fc: zeta_u * f64::sqrt(1.0 - chi) });
            let (expected, name) = (theory(zeta_u), textbook.name);
            let is_near = limit == expected || (limit - expected).abs() < 0.02 * expected;
            assert!(is_near, "{name}, χ = {chi}, ζ_u = {zeta_u}: {limit} {expected}");
        }
    }
}

/// The same step before and after uplift: as exact as the next method down, gone soon after.
#[test]
fn a_step_that_is_stable_down_is_unstable_up() {
    let scene = uplift_trap::scene();
    let (omega_fc, omega_u) = (scene.structure.omega_fc, scene.structure.omega_u);
    assert!(omega_fc * uplift_trap::STEP < 2.0 && omega_u * uplift_trap::STEP > 2.0);
    let exact = study::engine::reference(&scene);
    let unstable = uplift_trap::response(&scene, 2);
    let Some(RunFailure::Diverged { time }) = unstable.failure else { panic!("{:?}", unstable.failure) };
    let uplift = exact.samples.iter().position(|sample| sample.theta != 0.0).unwrap();
    assert!(time > uplift as f64 * uplift_trap::STEP);
    for (sample, exact) in unstable.samples.iter().zip(&exact.samples).take(uplift) {
        assert!((sample.u - exact.u).abs() < 0.02 * scene.structure.u_cr);
    }
    assert_eq!(uplift_trap::response(&scene, 4).failure, None);
}
