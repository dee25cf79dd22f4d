//! The repaired rule of uplift is what it says, and the structures of the maps are what the page says.
#![allow(non_snake_case)]

mod synthetic;

use rocking::Detail;
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::run::record::Record;
use study::validity::Change;
use study::validity::population::{Case, FREQUENCY, SLENDERNESS, STRUCTURES, both, case};

/// By the model's rule tension holds the base down, by the repaired one none does, and both lift it off.
#[test]
fn the_repaired_rule_leaves_no_tension() {
    let scene = synthetic::scene().scaled(1.5);
    let pair = both(&scene.run(Detail::Auto, DEFAULT_TOLERANCE)).unwrap();
    let [model, repaired] = [&pair.model, &pair.repaired].map(|response| response.found.worst[0].value);
    assert!(model > 0.01, "{model}");
    assert!(repaired.abs() < 1e-9, "{repaired}");
    assert!(pair.model.transitions > 2 && pair.repaired.transitions > 2);
    let change = Change::of(&pair);
    assert!(change.theta > 0.0 && change.a_t > 0.0, "{change:?}");
}

/// They fill slenderness and frequency evenly, a quarter of them have r = 1, and each has the strength it is given.
#[test]
fn the_structures_fill_the_maps() {
    let ground = Record::from_samples("", vec![0.0, 1.0, 2.0], vec![0.0, 2.0, -1.0]).unwrap();
    let records = [ground.clone(), ground];
    let (mut cells, mut elastic) = ([[0_usize; 4]; 4], 0_usize);
    for k in 0..STRUCTURES {
        let Case { structure, ground } = case(k, &records);
        let parameters = structure.parameters();
        let across = (parameters.H / parameters.B - SLENDERNESS.0) / (SLENDERNESS.1 - SLENDERNESS.0);
        let up = (parameters.f_fc / FREQUENCY.0).ln() / (FREQUENCY.1 / FREQUENCY.0).ln();
        cells[(4.0 * across) as usize][(4.0 * up) as usize] += 1;
        elastic += usize::from(parameters.r == 1.0);
        let strength = ground.pga() / (parameters.g * structure.tan_alpha_cg);
        assert!((1.0 - 1e-12..=4.0 + 1e-12).contains(&strength), "{strength}");
    }
    let expected = STRUCTURES / 16;
    assert!(cells.iter().flatten().all(|count| count.abs_diff(expected) < expected / 4), "{cells:?}");
    assert!(elastic.abs_diff(STRUCTURES / 4) < STRUCTURES / 40, "{elastic}");
}
