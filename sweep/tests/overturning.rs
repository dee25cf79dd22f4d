//! Overturning under pulses: maps that refine, conditions.

use rocking::run::{Ending, Run};
use rocking::structure::description::{Damping, Storey};
use rocking::structure::natural_quantities::Numbers;
use rocking::{Detail, OneMass, Parameters, Structure};
use rocking_sweep::condition::digits;
use rocking_sweep::map::{Axis, Fate, GridPlace, Map, MapPoint, PARTS, nearest};
use rocking_sweep::outcome::{Outcome, Summary};
use rocking_sweep::plan::{Conditions, NamedRecord, Plan, Population};
use rocking_sweep::pulse::{Pulse, Shape};
use std::collections::{BTreeSet, HashMap};

/// A map of McManus at a level that costs little: some of all classes that a sine has.
fn map(count: usize, finds_condition: bool) -> Map {
    let axis = |from: f64, to: f64| {
        let last = (count - 1) as f64;
        Axis { values: (0..count).map(|i| from + (to - from) * i as f64 / last).collect(), is_log: false }
    };
    let structure = OneMass::new(Parameters { r: 0.9, ..Parameters::MCMANUS }).unwrap();
    let pulse = Pulse { error: 1e-3, ..Pulse::new(Shape::Sine, 1.0, 1.0) };
    let map = Map::new(structure, pulse, [axis(1.0, 9.0), axis(0.5, 8.5)], true).unwrap();
    map.computed_by(Detail::Modal, 1e-9, finds_condition).unwrap()
}

/// All points of `map`, refined so many times.
fn complete(map: &Map, refinements: u32) -> HashMap<GridPlace, MapPoint> {
    let mut all = HashMap::new();
    let add = |_, lacking: Vec<GridPlace>, all: &mut HashMap<_, _>| {
        all.extend(lacking.into_iter().map(|place| (place, map.run(place))));
        Ok::<_, ()>(())
    };
    map.complete(refinements, &mut all, add).unwrap();
    all
}

/// A refined map has every point of the boundary of a grid as fine, at a fraction of the runs. If two neighbours of the fine
/// grid differ, the refined map has both points, with the same results.
#[test]
fn a_refined_map_has_the_boundary_of_a_fine_grid() {
    let (coarse, fine) = (map(17, false), map(33, false));
    let (refined, all) = (complete(&coarse, 1), complete(&fine, 0));
    assert!(refined.len() < all.len() * 3 / 4, "{} of {}", refined.len(), all.len());
    let classes: BTreeSet<_> = all.values().map(MapPoint::class).collect();
    assert!(classes.len() >= 4, "{classes:?}");
    let mut differing = 0;
    for (place, point) in &all {
        let on_coarse = GridPlace { amplitude: place.amplitude / 2, frequency: place.frequency / 2 };
        if let Some(known) = refined.get(&on_coarse) {
            assert_eq!(known, point, "{place:?}");
        }
        // what was left out has the class of the corner that stands for it, but for islands smaller than a square
        differing += usize::from(nearest(&refined, on_coarse, 1).unwrap().class() != point.class());
    }
    assert!(differing <= all.len() / 100, "{differing} of {}", all.len());
}

/// The map's structure under each of the `pulses`, with sure digits.
fn digits_under(map: &Map, pulses: &[Pulse], tolerance: f64) -> Vec<Summary> {
    let named = |(i, pulse): (usize, &Pulse)| NamedRecord::new(i.to_string(), pulse.record().unwrap(), 1.0).unwrap();
    let conditions = Conditions { detail: map.detail, tolerance, finds_condition: true, ..Conditions::default() };
    let pier = vec![Population::new("pier", map.structure.clone())];
    let plan = Plan::new(pier, pulses.iter().enumerate().map(named).collect(), vec![1.0], conditions).unwrap();
    let mut all = vec![None; plan.len()];
    plan.each_outcome(&Vec::from_iter(0..plan.len()), false, |case, outcome, _| {
        let Outcome::Ended(summary) = outcome else { panic!("{outcome:?}") };
        all[case.index] = Some(summary);
        true
    });
    all.into_iter().flatten().collect()
}

#[test]
fn a_run_has_the_digits_that_the_condition_of_its_point_on_a_map_leaves() {
    let map = map(9, true);
    let map = Map { pulse: Pulse { cycles: 20.0, ..map.pulse }, detail: Detail::Auto, ..map };
    let (places, points): (Vec<_>, Vec<_>) = complete(&map, 0).into_iter().unzip();
    let runs = digits_under(&map, &Vec::from_iter(places.iter().map(|place| map.pulse(*place))), map.tolerance);
    let mut found = BTreeSet::new();
    for (point, run) in points.iter().zip(&runs) {
        assert_eq!(run.digits, Some(digits(point.condition.unwrap())), "{point:?}");
        found.insert((run.ending == Ending::Overturned, run.digits));
    }
    assert!(found.len() >= 8, "{found:?}");
}

/// At a tighter tolerance the engine takes other steps and rounds otherwise: what it rounds stays within the last sure digit.
#[test]
fn long_rocking_leaves_fewer_digits_and_those_are_true() {
    let map = map(5, false).computed_by(Detail::Auto, 1e-9, false).unwrap();
    let fewest = [1.0, 40.0].map(|cycles| {
        let at = |i: u32| GridPlace { amplitude: PARTS * (i % 20) / 5, frequency: PARTS * (i / 20) / 5 };
        let pulses = Vec::from_iter((0..400).map(|i| Pulse { cycles, ..map.pulse(at(i)) }));
        let [usual, tight] = [1e-9, 1e-13].map(|tolerance| digits_under(&map, &pulses, tolerance));
        for (usual, tight) in usual.iter().zip(&tight).filter(|(usual, _)| usual.transitions > 0) {
            let result = |of: &Summary| if usual.ending == Ending::Overturned { of.end } else { of.peaks[0] };
            let change = (result(tight) / result(usual) - 1.0).abs();
            assert!(change < 2.0 * 0.1_f64.powi(usual.digits.unwrap().into()), "{change} {usual:?}");
        }
        usual.iter().filter_map(|of| of.digits).min().unwrap()
    });
    assert!(fewest[0] >= 12 && fewest[1] <= 7, "{fewest:?}");
}

/// Each point of a map of three storeys is the run of its pulse.
#[test]
fn a_building_has_a_map() {
    let base = Numbers::of(&[("m0", 2e4), ("J0", 0.0), ("B", 1.5)]).unwrap();
    let storeys = [3.5, 7.0, 10.5].map(|h| Storey { m: 4e4, h, k: 6e7 });
    let structure = Structure::from_storeys(&base, &Damping::All(0.02), &storeys).unwrap();
    let axis = |values: [f64; 4]| Axis { values: values.into(), is_log: false };
    let axes = [axis([2.0, 4.0, 6.0, 9.0]), axis([1.0, 3.0, 6.0, 9.0])];
    let map =
        Map::new(structure.clone(), Pulse { error: 1e-3, ..Pulse::new(Shape::Sine, 1.0, 1.0) }, axes, true).unwrap();
    let (mut classes, alpha_cg) = (std::collections::BTreeSet::new(), structure.base().tan_alpha_cg.atan());
    for place in map.grid() {
        let (point, ground) = (map.run(place), map.pulse(place).record().unwrap());
        let (peaks, finish) = Run::of_modes(structure.clone(), &ground).peaks().unwrap();
        assert_eq!((point.end, point.transitions), (finish.motion.time, finish.motion.transitions), "{place:?}");
        assert!((point.theta * alpha_cg - peaks.theta().magnitude).abs() <= 1e-15, "{place:?}");
        assert_eq!(point.fate == Fate::Overturns, finish.ending.overturned() == Some(true));
        classes.insert(point.class());
    }
    assert!(classes.len() >= 3, "{classes:?}");
    let refused = map.computed_by(Detail::Modal, 1e-9, false).unwrap_err().to_string();
    assert!(refused.starts_with("detail = modal moves structures of one mass alone"), "{refused}");
}
