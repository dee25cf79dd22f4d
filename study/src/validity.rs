//! Where the model itself ends: how often and how far structures go beyond what it takes for granted, which of the
//! paper's scenes do, and what changes when uplift is repaired.

pub mod population;

use crate::scene::Scene;
use anyhow::Result;
use indicatif::ProgressBar;
use minijinja::{Value, context};
use population::{Pair, both};
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::mechanics::impact;
use rocking::run::validity::{
    ASSUMPTIONS, EDGE_LOAD, FRICTION, Findings, IMPACT_FRICTION, IMPACT_TENSION, TENSION, WEIGHT,
};
use rocking::{Detail, Parameters};
use std::path::Path;

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
fn scenes(records: &Path) -> Result<[(&'static str, Scene); 4]> {
    Ok([
        ("Evison, free vibration (Fig 5)", Scene::evison_free_vibration()),
        ("McManus, Pacoima Dam (Fig 9)", Scene::mcmanus_pacoima(records)?),
        ("McManus, El Centro 1940", Scene::mcmanus_el_centro(records)?),
        ("McManus at 30 Hz, El Centro 1940", Scene::stiff_el_centro(records)?),
    ])
}

fn number(value: f64) -> String {
    match value {
        f64::INFINITY => "∞".into(),
        f64::NEG_INFINITY => "none".into(),
        _ => format!("{value:.3}").replace('-', "−"),
    }
}

fn percent(part: f64) -> String {
    let percent = 100.0 * part;
    if percent == 0.0 { "0 %".into() } else { format!("{percent:.2} %") }
}

/// The value, and for how much of the time it is beyond its limit.
fn with_share(found: &Findings, which: usize) -> String {
    let worst = &found.worst[which];
    match worst.first_beyond {
        None => number(worst.value),
        Some(_) => format!("{} ({})", number(worst.value), percent(worst.beyond / found.duration)),
    }
}

fn scene_row(name: &str, pair: &Pair) -> Value {
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
            median => number(median(values)),
            worst => number(worst),
        }
    };
    ASSUMPTIONS.iter().take(WEIGHT).enumerate().map(row).collect() // the ground moves horizontally alone
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
        .map(|(name, scene)| Ok(scene_row(name, &both(&scene.run(Detail::Auto, DEFAULT_TOLERANCE))?)))
        .collect::<Result<Vec<_>>>()?;
    save_numbers(&population, &docs.join("validity.csv"))?;
    let count = |of: &dyn Fn(&Pair) -> bool| population.iter().filter(|pair| of(pair)).count();
    let values = context! {
        structures => population.len(),
        rows => rows(&population),
        above_b => count(&|pair| pair.structure.u_cr > pair.structure.parameters().B),
        pulling => count(&|pair| pair.structure.parameters().r < impact::pulling_restitution(&pair.structure)),
        settlings => count(&|pair| pair.model.found.settlings > 0),
        repair => repair(&population),
        scenes,
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
        csv.write_record(numbers.map(|number| format!("{number:.6e}")))?;
    }
    Ok(csv.flush()?)
}
