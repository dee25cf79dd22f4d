//! Measured limits of stability against theory, and the trap of uplift.

use study::fixed_step::TEXTBOOK;
use study::response::Failure;
use study::stability::limits::{Limit, measure};
use study::stability::uplift_trap;
use study::stability::vibration::Vibration;

/// Limits of ω_u h by theory, as functions of ζ_u; none where there is no limit. The limit of RK4 is a root of its polynomial.
static THEORY: [fn(f64) -> Option<f64>; TEXTBOOK.len()] = [
    |zeta| Some(if zeta <= 1.0 { 2.0 * zeta } else { 2.0 / (zeta + (zeta * zeta - 1.0).sqrt()) }),
    |zeta| Some(2.0 * ((1.0 + zeta * zeta).sqrt() - zeta)),
    |_| Some(2.0),
    |zeta| Some(if zeta < 0.5 { 8f64.sqrt() } else { 2.785_293_563_405_282 }),
    |_| None,
    |_| None,
];

#[test]
fn measured_limits_are_those_of_theory() {
    for (textbook, theory) in TEXTBOOK.iter().zip(THEORY) {
        for (chi, zeta_u) in [(0.0, 0.0), (0.9, 0.0), (0.5, 0.02), (0.9, 0.3), (0.0, 1.0), (0.98, 1.0), (0.7, 1.3)] {
            if textbook.name == "RK4" && ![0.0, 1.0].contains(&zeta_u) {
                continue;
            }
            let limit = measure(textbook.method, &Vibration { chi, zeta_fc: zeta_u * f64::sqrt(1.0 - chi) });
            match (limit, theory(zeta_u)) {
                (Limit::At(measured), Some(theory)) => assert!(
                    (measured / theory - 1.0).abs() < 0.02,
                    "{}, χ = {chi}, ζ_u = {zeta_u}: {measured} {theory}",
                    textbook.name
                ),
                (Limit::Unbounded, None) => (),
                (Limit::Never, Some(0.0)) => (),
                other => panic!("{}, χ = {chi}, ζ_u = {zeta_u}: {other:?}", textbook.name),
            }
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
    let Some(Failure::Diverged { time }) = unstable.failure else { panic!("{:?}", unstable.failure) };
    let uplift = exact.samples.iter().position(|sample| sample.theta != 0.0).unwrap();
    assert!(time > uplift as f64 * uplift_trap::STEP);
    for (sample, exact) in unstable.samples.iter().zip(&exact.samples).take(uplift) {
        assert!((sample.u - exact.u).abs() < 0.02 * scene.structure.u_cr);
    }
    assert_eq!(uplift_trap::response(&scene, 4).failure, None);
}
