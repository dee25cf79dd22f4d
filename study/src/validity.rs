//! Where the model itself ends: how often and how far structures go beyond what it takes for granted, which of the
//! paper's scenes do, and what changes when uplift is repaired.

pub mod population;

use crate::scene::{PACOIMA, Scene, read_record};
use anyhow::Result;
use indicatif::ProgressBar;
use minijinja::{Value, context};
use population::{Pair, both};
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::mechanics::impact;
use rocking::run::validity::{
    ASSUMPTIONS, EDGE_LOAD, ENERGY, FRICTION, Found, IMPACT_FRICTION, IMPACT_TENSION, TENSION,
};
use rocking::{Detail, Parameters};
use std::path::Path;

/// Frequencies in full contact, Hz, by which structures are told apart.
const BANDS: [(f64, f64); 3] = [(0.3, 1.5), (1.5, 6.0), (6.0, 30.0)];

/// How much the repaired rule of uplift changes the peaks, over those of the model.
#[derive(Clone, Copy, Debug)]
pub struct Change {
    pub theta: f64, // of |θ|; that of a base that lifts by one rule alone is 1
    pub a_t: f64,   // of |a_t|
}

impl Change {
    /// For one structure.
    pub fn of(pair: &Pair) -> Change {
        let [theta, a_t] = [rocking::run::peaks::Peaks::theta, rocking::run::peaks::Peaks::a_t].map(|of| {
            let [model, repaired] = [&pair.model, &pair.repaired].map(|response| of(&response.peaks).magnitude);
            let difference = (repaired - model).abs();
            if difference == 0.0 { 0.0 } else { (difference / model).min(1.0) }
        });
        Change { theta, a_t }
    }
}

/// The paper's scenes, and two more of its specimens.
fn scenes(records: &Path) -> Result<Vec<(String, Scene)>> {
    let pacoima = Scene::mcmanus_pacoima(records)?;
    let slow = Parameters { f_fc: 0.05, ..Parameters::MCMANUS };
    Ok(vec![
        ("Evison, free vibration (Fig 5)".into(), Scene::evison_free_vibration()),
        ("McManus, Pacoima Dam (Fig 9)".into(), pacoima.clone()),
        ("McManus, El Centro 1940".into(), Scene::mcmanus_el_centro(records)?),
        ("McManus at 30 Hz, El Centro 1940".into(), Scene::stiff_el_centro(records)?),
        (
            "McManus at 0.05 Hz, 5 times Pacoima Dam as recorded".into(),
            Scene {
                structure: crate::scene::structure(slow),
                ground: read_record(records, PACOIMA)?.scaled(1.0, 5.0)?,
                ..pacoima
            },
        ),
    ])
}

fn number(value: f64) -> String {
    let text = if value.is_infinite() { "∞".into() } else { format!("{value:.3}") };
    text.replace('-', "−")
}

fn percent(part: f64) -> String {
    let percent = 100.0 * part;
    if percent == 0.0 { "0 %".into() } else { format!("{percent:.2} %") }
}

/// The value, and for how much of the time it is beyond its limit.
fn with_share(found: &Found, which: usize) -> String {
    let worst = &found.worst[which];
    match worst.first_beyond {
        None => number(worst.value),
        Some(_) => format!("{} ({})", number(worst.value), percent(worst.beyond / found.duration)),
    }
}

fn scene_row(name: String, pair: &Pair) -> Value {
    let found = &pair.model.found;
    let of_impacts = |which: usize| if found.impacts == 0 { "–".into() } else { number(found.worst[which].value) };
    let change = Change::of(pair);
    context! {
        name,
        tension => with_share(found, TENSION),
        load => with_share(found, EDGE_LOAD),
        friction => with_share(found, FRICTION),
        impact_friction => of_impacts(IMPACT_FRICTION),
        pull => of_impacts(IMPACT_TENSION),
        gains => format!("{} of {}", found.gains, found.impacts),
        theta => percent(change.theta),
        a_t => percent(change.a_t),
        transitions => format!("{} → {}", pair.model.transitions, pair.repaired.transitions),
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

fn rows(population: &[Pair]) -> Vec<Value> {
    let row = |(which, assumption): (usize, &rocking::run::validity::Assumption)| {
        let of = |pair: &Pair| pair.model.found.worst[which].value;
        let is_beyond = |pair: &Pair| pair.model.found.worst[which].first_beyond.is_some();
        let share = |(low, high): (f64, f64)| {
            let of_band = population.iter().filter(|pair| (low..high).contains(&pair.structure.parameters().f_fc));
            let beyond: Vec<_> = of_band.map(is_beyond).collect();
            format!("{:.0} %", 100.0 * beyond.iter().filter(|is| **is).count() as f64 / beyond.len() as f64)
        };
        let values: Vec<_> = population
            .iter()
            .filter(|pair| !assumption.is_of_impacts || pair.model.found.impacts > 0)
            .map(of)
            .collect();
        let worst = if which == EDGE_LOAD {
            values.iter().copied().fold(f64::INFINITY, f64::min)
        } else {
            values.iter().copied().filter(|value| value.is_finite()).fold(f64::NEG_INFINITY, f64::max)
        };
        context! {
            name => assumption.name,
            limit => (assumption.limit)(&rocking::run::validity::Limits::default()),
            beyond => population.iter().filter(|pair| is_beyond(pair)).count(),
            by_frequency => BANDS.map(share).to_vec(),
            median => number(median(values)),
            worst => number(worst),
        }
    };
    ASSUMPTIONS.iter().enumerate().map(row).collect()
}

fn gains(population: &[Pair]) -> Value {
    let limit = |pair: &Pair| impact::lossless_restitution(&pair.structure, 0.0).map_or(0.0, |[least, _]| least);
    let r = |pair: &Pair| pair.structure.parameters().r;
    let above: Vec<_> = population.iter().filter(|pair| pair.model.found.gains > 0 && r(pair) >= limit(pair)).collect();
    let gain = |pair: &Pair| pair.model.found.worst[ENERGY].value;
    let largest = above.iter().filter(|pair| r(pair) < 1.0).max_by(|a, b| gain(a).total_cmp(&gain(b)));
    let of_largest = |of: &dyn Fn(&Pair) -> f64, digits: usize| {
        largest.map_or("–".into(), |pair| format!("{:.digits$}", of(pair)))
    };
    context! {
        above => above.len(),
        elastic => above.iter().filter(|pair| r(pair) == 1.0).count(),
        warned => above.iter().filter(|pair| impact::greatest_gain(&pair.structure, pair.structure.u_cr) > 0.0).count(),
        largest => of_largest(&|pair| 100.0 * gain(pair), 1),
        r => of_largest(&r, 3),
        limit => of_largest(&limit, 3),
    }
}

fn repair(population: &[Pair]) -> Value {
    let rocking: Vec<_> =
        population.iter().filter(|pair| pair.model.transitions + pair.repaired.transitions > 0).collect();
    let changes: Vec<_> = rocking.iter().map(|pair| Change::of(pair)).collect();
    let count = |of: fn(&Pair) -> bool| population.iter().filter(|pair| of(pair)).count();
    let tension = population.iter().map(|pair| pair.repaired.found.worst[TENSION].value).fold(-1.0, f64::max);
    context! {
        rocking => rocking.len(),
        theta_median => percent(median(changes.iter().map(|change| change.theta).collect())),
        theta_beyond => changes.iter().filter(|change| change.theta > 0.05).count(),
        a_t_median => percent(median(changes.iter().map(|change| change.a_t).collect())),
        a_t_beyond => changes.iter().filter(|change| change.a_t > 0.05).count(),
        overturns_model => count(|pair| pair.model.overturns),
        overturns_repaired => count(|pair| pair.repaired.overturns),
        overturns_changed => count(|pair| pair.model.overturns != pair.repaired.overturns),
        tension => crate::chart::scientific(tension.max(0.0)),
    }
}

/// Writes `docs/explain/validity.md` with its pictures and numbers.
pub fn write(records: &Path, docs: &Path, progress: &ProgressBar) -> Result<()> {
    progress.set_message("structures");
    let population = population::all(records)?;
    let scenes = scenes(records)?
        .into_iter()
        .map(|(name, scene)| Ok((name, both(&scene.run(Detail::Auto, DEFAULT_TOLERANCE))?)))
        .collect::<Result<Vec<_>>>()?;
    save_numbers(&population, &docs.join("validity.csv"))?;
    let slow = &scenes[4].1;
    let count = |of: &dyn Fn(&Pair) -> bool| population.iter().filter(|pair| of(pair)).count();
    let values = context! {
        structures => population.len(),
        rows => rows(&population),
        gains => gains(&population),
        slow => context! {
            u_cr => format!("{:.1}", slow.structure.u_cr),
            transitions => slow.model.transitions,
            tension => number(slow.model.found.worst[TENSION].value),
            repaired => match slow.repaired.overturns {
                true => format!("it overturns after {} transitions", slow.repaired.transitions),
                false => format!("there are {} transitions", slow.repaired.transitions),
            },
        },
        above_b => count(&|pair| pair.structure.u_cr > pair.structure.parameters().B),
        pulling => count(&|pair| pair.structure.parameters().r < impact::pulling_restitution(&pair.structure)),
        settlings => count(&|pair| pair.model.found.settlings > 0),
        repair => repair(&population),
        scenes => scenes.iter().map(|(name, pair)| scene_row(name.clone(), pair)).collect::<Vec<_>>(),
    };
    crate::page::write(docs, "validity", include_str!("../pages/validity.md"), &values, "validity")
}

/// A row for every structure: what it is, what it goes beyond, what the repaired rule changes.
fn save_numbers(population: &[Pair], path: &Path) -> Result<()> {
    let mut csv = csv::Writer::from_path(path)?;
    let structure = ["m", "m0", "H", "B", "J0", "f_fc", "zeta_fc", "r"];
    let repair = ["energy_gains", "peak_theta", "peak_a_t", "peak_theta_repaired", "peak_a_t_repaired"];
    let names = ASSUMPTIONS.iter().map(|assumption| assumption.name);
    csv.write_record(structure.into_iter().chain(names).chain(repair))?;
    for Pair { structure, model, repaired } in population {
        let &Parameters { m, m0, H, B, J0, f_fc, zeta_fc, r, .. } = structure.parameters();
        let peaks = [model, repaired].map(|of| [of.peaks.theta().magnitude, of.peaks.a_t().magnitude]);
        let numbers = [m, m0, H, B, J0, f_fc, zeta_fc, r].into_iter().chain(model.found.worst.map(|worst| worst.value));
        let numbers = numbers.chain([model.found.gains as f64]).chain(peaks.into_iter().flatten());
        csv.write_record(numbers.map(|number| format!("{number:.5}")))?;
    }
    Ok(csv.flush()?)
}
