//! Limits of the model: how often and how far structures exceed its assumptions.

pub mod population;

use crate::scene::StudyScene;
use crate::tables;
use anyhow::Result;
use population::{MemberResult, respond};
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::mechanics::impact;
use rocking::run::validity::{ASSUMPTIONS, Limits, WEIGHT};
use rocking::{Detail, Parameters};
use std::path::Path;

/// Names of the scenes of [`StudyScene::all`] on the page.
const SCENES: [&str; 4] = [
    "Evison, free vibration (Fig 5)",
    "McManus, Pacoima Dam (Fig 9)",
    "McManus, El Centro 1940",
    "McManus at 30 Hz, El Centro 1940",
];

/// Writes `validity.csv` into `folder`: a row for each of the paper's scenes, and one for each structure.
pub fn write(records: &Path, folder: &Path) -> Result<()> {
    let response = |scene: &StudyScene| Ok(respond(&scene.run(Detail::Auto, DEFAULT_TOLERANCE))?);
    let scenes = StudyScene::all(records)?.iter().map(response).collect::<Result<Vec<_>>>()?;
    let scenes = SCENES.into_iter().zip(scenes);
    let responses = scenes.chain(population::all(records)?.into_iter().map(|response| ("", response)));
    let assumptions = || ASSUMPTIONS.iter().take(WEIGHT); // the ground moves horizontally alone
    let limits = Limits::default();
    let limits =
        assumptions().map(|of| [of.name.to_string(), (of.limit)(&limits).to_string(), of.is_of_impacts.to_string()]);
    tables::save(&folder.join("validity-limits.csv"), "name,limit,is_of_impacts", limits)?;
    let columns = "scene,m,m0,H,B,J0,f_fc,zeta_fc,r,u_cr,pulling_r,impacts,energy_gains,settlings";
    let found = assumptions().flat_map(|of| [of.name.to_string(), format!("{}_beyond", of.name)]);
    let columns: Vec<_> = std::iter::once(columns.to_string()).chain(found).collect();
    let row = |(scene, MemberResult { structure, found }): (&str, MemberResult)| {
        let &Parameters { m, m0, H, B, J0, f_fc, zeta_fc, r, .. } = structure.parameters();
        let of = [m, m0, H, B, J0, f_fc, zeta_fc, r, structure.u_cr, impact::pulling_restitution(structure.base())];
        let counts = [found.impacts, found.gains, found.settlings].map(|count| count as f64);
        let worst = found.worst.iter().take(WEIGHT).flat_map(|worst| {
            let share = worst.first_beyond.map_or(f64::NAN, |_| worst.beyond / found.duration);
            [worst.value, share]
        });
        let numbers = of.into_iter().chain(counts).chain(worst).map(|number| format!("{number:.8e}"));
        std::iter::once(scene.to_string()).chain(numbers).collect::<Vec<_>>()
    };
    tables::save(&folder.join("validity.csv"), &columns.join(","), responses.map(row))
}
