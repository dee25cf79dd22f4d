//! Where the model itself ends: how often and how far structures go beyond what it takes for granted, which of the
//! paper's scenes do, and what changes when uplift is repaired.

pub mod population;

use crate::scene::Scene;
use crate::tables;
use anyhow::Result;
use population::{Pair, both};
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::mechanics::impact;
use rocking::run::validity::{ASSUMPTIONS, Limits, TENSION, WEIGHT};
use rocking::{Detail, Parameters};
use std::path::Path;

/// The paper's scenes, and two more of its specimens.
fn scenes(records: &Path) -> Result<[(&'static str, Scene); 4]> {
    Ok([
        ("Evison, free vibration (Fig 5)", Scene::evison_free_vibration()),
        ("McManus, Pacoima Dam (Fig 9)", Scene::mcmanus_pacoima(records)?),
        ("McManus, El Centro 1940", Scene::mcmanus_el_centro(records)?),
        ("McManus at 30 Hz, El Centro 1940", Scene::stiff_el_centro(records)?),
    ])
}

/// Writes `validity.csv` into `folder`: a row for each of the paper's scenes, and one for each structure.
pub fn write(records: &Path, folder: &Path) -> Result<()> {
    let scenes = scenes(records)?.map(|(name, scene)| Ok((name, both(&scene.run(Detail::Auto, DEFAULT_TOLERANCE))?)));
    let scenes = scenes.into_iter().collect::<Result<Vec<_>>>()?;
    let pairs = scenes.into_iter().chain(population::all(records)?.into_iter().map(|pair| ("", pair)));
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
            let [theta, a_t] = [of.peaks.theta().magnitude, of.peaks.a_t().magnitude];
            [theta, a_t, of.transitions as f64, f64::from(of.overturns), of.found.worst[TENSION].value]
        });
        let numbers = of.into_iter().chain(counts).chain(worst).chain(rules).map(|number| format!("{number:.8e}"));
        std::iter::once(scene.to_string()).chain(numbers).collect::<Vec<_>>()
    };
    tables::save(&folder.join("validity.csv"), &columns.join(","), pairs.map(row))
}
