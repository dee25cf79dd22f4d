//! Limits of the model: how often and how far structures exceed its assumptions, and what a repaired rule of uplift changes.

pub mod population;

use crate::scene::Scene;
use crate::tables;
use anyhow::Result;
use population::{Pair, both};
use rocking::Output;
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::mechanics::impact;
use rocking::run::validity::{ASSUMPTIONS, Limits, TENSION, WEIGHT};
use rocking::{Detail, Parameters};
use std::path::Path;

/// Names of the scenes of [`Scene::all`] on the page.
const SCENES: [&str; 4] = [
    "Evison, free vibration (Fig 5)",
    "McManus, Pacoima Dam (Fig 9)",
    "McManus, El Centro 1940",
    "McManus at 30 Hz, El Centro 1940",
];

/// Writes `validity.csv` into `folder`: a row for each of the paper's scenes, and one for each structure.
pub fn write(records: &Path, folder: &Path) -> Result<()> {
    let both_of = |scene: &Scene| Ok(both(&scene.run(Detail::Auto, DEFAULT_TOLERANCE))?);
    let scenes = Scene::all(records)?.iter().map(both_of).collect::<Result<Vec<_>>>()?;
    let scenes = SCENES.into_iter().zip(scenes);
    let pairs = scenes.chain(population::all(records)?.into_iter().map(|pair| ("", pair)));
    let assumptions = || ASSUMPTIONS.iter().take(WEIGHT); // the ground moves horizontally alone
    let limits = Limits::default();
    let limits =
        assumptions().map(|of| [of.name.to_string(), (of.limit)(&limits).to_string(), of.is_of_impacts.to_string()]);
    tables::save(&folder.join("validity-limits.csv"), "name,limit,is_of_impacts", limits)?;
    let columns = "scene,m,m0,H,B,J0,f_fc,zeta_fc,r,u_cr,pulling_r,impacts,energy_gains,settlings";
    let found = assumptions().flat_map(|of| [of.name.to_string(), format!("{}_beyond", of.name)]);
    let rules = ["", "_repaired"].into_iter().flat_map(|rule| {
        ["peak_theta", "peak_a_t", "transitions", "overturned", "tension"].map(|name| format!("{name}{rule}"))
    });
    let columns: Vec<_> = std::iter::once(columns.to_string()).chain(found).chain(rules).collect();
    let row = |(scene, Pair { structure, model, repaired }): (&str, Pair)| {
        let &Parameters { m, m0, H, B, J0, f_fc, zeta_fc, r, .. } = structure.parameters();
        let of = [m, m0, H, B, J0, f_fc, zeta_fc, r, structure.u_cr, impact::pulling_restitution(structure.base())];
        let counts = [model.found.impacts, model.found.gains, model.found.settlings].map(|count| count as f64);
        let worst = model.found.worst.iter().take(WEIGHT).flat_map(|worst| {
            let share = worst.first_beyond.map_or(f64::NAN, |_| worst.beyond / model.found.duration);
            [worst.value, share]
        });
        let rules = [&model, &repaired].into_iter().flat_map(|of| {
            let [theta, a_t] = [of.peaks.theta().magnitude, of.peaks.of(Output::a_t(0)).unwrap().magnitude];
            [theta, a_t, of.transitions as f64, f64::from(of.overturns), of.found.worst[TENSION].value]
        });
        let numbers = of.into_iter().chain(counts).chain(worst).chain(rules).map(|number| format!("{number:.8e}"));
        std::iter::once(scene.to_string()).chain(numbers).collect::<Vec<_>>()
    };
    tables::save(&folder.join("validity.csv"), &columns.join(","), pairs.map(row))
}
