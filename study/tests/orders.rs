//! Observed orders of convergence, through transitions.

use study::engine;
use study::fixed_step::{FixedStep, TEXTBOOK};
use study::guards::uplift_excess;
use study::hybrid::{self, Grid, Transitions};
use study::scene::StudyScene;

/// The error in θ of Evison's free vibration, with its eight impacts, by `steps` steps between samples.
fn error(method: FixedStep, steps: u32) -> f64 {
    let scene = StudyScene::evison_free_vibration();
    let grid = Grid { method, h: scene.dt() / f64::from(steps) };
    let response = hybrid::run(&scene, &grid, Transitions::Located, uplift_excess, &mut |_, _| ());
    response.errors(&engine::reference(&scene)).unwrap().theta
}

#[test]
fn textbook_methods_have_their_order_where_transitions_are_located() {
    for textbook in &TEXTBOOK {
        // Fine enough for the leading term, coarse enough to be above rounding.
        let steps = if textbook.order == 1 { 4096 } else { 64 };
        let [coarse, fine] = [steps, 2 * steps].map(|steps| error(textbook.method, steps));
        let (observed, nominal) = ((coarse / fine).log2(), f64::from(textbook.order));
        assert!((observed - nominal).abs() < 0.1, "{}: {observed} instead of {nominal}", textbook.name);
    }
}
