//! Observed orders of convergence: on smooth motion, and through transitions that are located.
#![allow(non_snake_case)]

use rocking::{Parameters, State, Structure};
use study::engine;
use study::fixed_step::TEXTBOOK;
use study::guards::uplift_excess;
use study::hybrid::{self, Grid, Transitions};
use study::response::{Errors, Response};
use study::scene::{Scene, ground};

/// A textbook method's response with `steps` steps between samples.
fn textbook(scene: &Scene, method: usize, transitions: Transitions, steps: u32) -> Response {
    let grid = Grid { method: TEXTBOOK[method].method, h: scene.dt() / f64::from(steps) };
    hybrid::run(scene, &grid, transitions, uplift_excess, &mut |_, _| ())
}

fn error(response: &Response, exact: &Response) -> f64 {
    Errors::of(response, exact).unwrap().theta
}

/// Order from the errors at h and h/2.
fn order(coarse: f64, fine: f64) -> f64 {
    (coarse / fine).log2()
}

/// McManus's specimen on its way down from a large angle, under a ramp of ground acceleration: no transition.
fn smooth() -> Scene {
    Scene {
        key: "smooth",
        title: "smooth",
        structure: Structure::new(Parameters::MCMANUS).unwrap(),
        initial: State { theta: 0.1, theta_dot: 0.2, u: 1e-3, u_dot: -0.1 },
        ground: ground(0.02, (0..6).map(|k| 0.3 - 0.1 * f64::from(k)).collect()),
    }
}

#[test]
fn textbook_methods_have_their_order_on_smooth_motion() {
    let scene = smooth();
    let exact = engine::reference(&scene);
    assert_eq!(exact.transitions, 0);
    for (method, textbook_method) in TEXTBOOK.iter().enumerate() {
        // Fine enough for the leading term, coarse enough to be above rounding.
        let steps = if textbook_method.order == 1 { 4096 } else { 64 };
        let error = |steps| error(&textbook(&scene, method, Transitions::Located, steps), &exact);
        let observed = order(error(steps), error(2 * steps));
        let nominal = f64::from(textbook_method.order);
        assert!((observed - nominal).abs() < 0.1, "{}: {observed} instead of {nominal}", textbook_method.name);
    }
}

/// Eight impacts on the way, and the order is still there.
#[test]
fn located_transitions_keep_the_order() {
    let scene = Scene::evison_free_vibration();
    let exact = engine::reference(&scene);
    for (method, textbook_method) in TEXTBOOK.iter().enumerate().filter(|(_, method)| method.order > 1) {
        let error = |steps| error(&textbook(&scene, method, Transitions::Located, steps), &exact);
        let observed = order(error(64), error(128));
        let nominal = f64::from(textbook_method.order);
        assert!((observed - nominal).abs() < 0.1, "{}: {observed} instead of {nominal}", textbook_method.name);
    }
}

/// Taken at step ends they leave RK4 with the error of a first-order method.
#[test]
fn transitions_at_step_ends_cost_the_order() {
    let scene = Scene::evison_free_vibration();
    let exact = engine::reference(&scene);
    let error = |transitions, steps| error(&textbook(&scene, 3, transitions, steps), &exact);
    assert!(error(Transitions::AtStepEnds, 256) > 1e6 * error(Transitions::Located, 256));
    let over_four_halvings = order(error(Transitions::AtStepEnds, 64), error(Transitions::AtStepEnds, 1024)) / 4.0;
    assert!(over_four_halvings < 1.3, "{over_four_halvings}");
}
