//! Observed orders of convergence, through transitions.

use study::engine;
use study::fixed_step::{Method, TEXTBOOK};
use study::guards::uplift_excess;
use study::hybrid::{self, Grid, Transitions};
use study::scene::Scene;

/// The error in θ of Evison's free vibration, with its eight impacts, by `steps` steps between samples.
fn error(method: Method, transitions: Transitions, steps: u32) -> f64 {
    let scene = Scene::evison_free_vibration();
    let grid = Grid { method, h: scene.dt() / f64::from(steps) };
    let response = hybrid::run(&scene, &grid, transitions, uplift_excess, &mut |_, _| ());
    response.errors(&engine::reference(&scene)).unwrap().theta
}

/// Order from the errors at h and h/2.
fn order(coarse: f64, fine: f64) -> f64 {
    (coarse / fine).log2()
}

#[test]
fn textbook_methods_have_their_order_where_transitions_are_located() {
    for textbook in &TEXTBOOK {
        // Fine enough for the leading term, coarse enough to be above rounding.
        let steps = if textbook.order == 1 { 4096 } else { 64 };
        let [coarse, fine] = [steps, 2 * steps].map(|steps| error(textbook.method, Transitions::Located, steps));
        let (observed, nominal) = (order(coarse, fine), f64::from(textbook.order));
        assert!((observed - nominal).abs() < 0.1, "{}: {observed} instead of {nominal}", textbook.name);
    }
}

/// Taken at step ends they leave RK4 with the error of a first-order method.
#[test]
fn transitions_at_step_ends_cost_the_order() {
    let error = |transitions, steps| error(Method::RungeKutta4, transitions, steps);
    assert!(error(Transitions::AtStepEnds, 256) > 1e6 * error(Transitions::Located, 256));
    let over_four_halvings = order(error(Transitions::AtStepEnds, 64), error(Transitions::AtStepEnds, 1024)) / 4.0;
    assert!(over_four_halvings < 1.3, "{over_four_halvings}");
}
