//! The trap of uplift.

use study::fixed_step::Method;
use study::response::Failure;
use study::stability::{STEP, response, scene};

/// The same step before and after uplift: as exact as the next method down, gone soon after.
#[test]
fn a_step_that_is_stable_down_is_unstable_up() {
    let scene = scene();
    let (omega_fc, omega_u) = (scene.structure.omega_fc, scene.structure.omega_u);
    assert!(omega_fc * STEP < 2.0 && omega_u * STEP > 2.0);
    let exact = study::engine::reference(&scene);
    let unstable = response(&scene, Method::CENTRAL_DIFFERENCE);
    let Some(Failure::Diverged { time }) = unstable.failure else { panic!("{:?}", unstable.failure) };
    let uplift = exact.samples.iter().position(|sample| sample.theta != 0.0).unwrap();
    assert!(time > uplift as f64 * STEP);
    for (sample, exact) in unstable.samples.iter().zip(&exact.samples).take(uplift) {
        assert!((sample.u - exact.u).abs() < 0.02 * scene.structure.u_cr);
    }
    assert_eq!(response(&scene, Method::AVERAGE_ACCELERATION).failure, None);
}
