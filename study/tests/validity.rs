//! The repaired rule of uplift leaves no tension.

mod synthetic;

use rocking::Detail;
use rocking::Output;
use rocking::engine::DEFAULT_TOLERANCE;
use study::validity::population::both;

/// By the model's rule tension holds the base down, by the repaired one none does, and both lift it off.
#[test]
fn the_repaired_rule_leaves_no_tension() {
    let scene = synthetic::scene().scaled(1.5);
    let pair = both(&scene.run(Detail::Auto, DEFAULT_TOLERANCE)).unwrap();
    let [model, repaired] = [&pair.model, &pair.repaired].map(|response| response.found.worst[0].value);
    assert!(model > 0.01, "{model}");
    assert!(repaired.abs() < 1e-9, "{repaired}");
    assert!(pair.model.transitions > 2 && pair.repaired.transitions > 2);
    let [model, repaired] = [&pair.model, &pair.repaired]
        .map(|of| (of.peaks.theta().magnitude, of.peaks.of(Output::a_t(0)).unwrap().magnitude));
    assert!(model.0 != repaired.0 && model.1 != repaired.1, "{model:?} {repaired:?}");
}
