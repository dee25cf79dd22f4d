//! Stability of the textbook methods: measured limits of the step, and what happens when a structure that
//! was down lifts off.

pub mod limits;
pub mod uplift_trap;
pub mod vibration;

use crate::fixed_step::TEXTBOOK;
use anyhow::Result;
use limits::{Limit, measure};
use minijinja::{Value, context};
use rocking::{Parameters, Structure};
use std::f64::consts::TAU;
use std::path::Path;
use vibration::Vibration;

/// Damping ratios ζ_u of the table of limits.
const DAMPING: [f64; 4] = [0.0, 0.05, 0.2, 1.0];

/// The structures whose frequencies the page has.
const SPECIMENS: [(&str, Parameters); 2] = [("Evison", Parameters::EVISON), ("McManus", Parameters::MCMANUS)];

/// `limit` with three digits behind the point.
fn shown(limit: Limit) -> String {
    match limit {
        Limit::Never => "0".into(),
        Limit::At(limit) => format!("{limit:.3}"),
        Limit::Unbounded => "any".into(),
    }
}

/// Writes `docs/evidence/stability.md` with its picture.
pub fn write(docs: &Path) -> Result<()> {
    let trap = uplift_trap::save(docs)?;
    let structures = SPECIMENS.map(|(_, parameters)| Structure::new(parameters));
    let structures = structures.into_iter().collect::<Result<Vec<_>, _>>()?;
    let specimens = SPECIMENS.iter().zip(&structures).map(|((name, parameters), structure)| {
        let (f_u, f_fc) = (structure.omega_u / TAU, parameters.f_fc);
        let [ratio, f_fc, f_u] = [f_u / f_fc, f_fc, f_u].map(|value| format!("{value:.1}"));
        context! { name => *name, f_fc, f_u, ratio }
    });
    let rows = TEXTBOOK.iter().map(|textbook| {
        let limit = |zeta| shown(measure(textbook.method, &Vibration { chi: 0.0, zeta_fc: zeta }));
        context! { method => textbook.name, limits => DAMPING.map(limit).to_vec() }
    });
    let values = context! {
        damping => DAMPING.to_vec(),
        specimens => specimens.collect::<Vec<Value>>(),
        rows => rows.collect::<Vec<Value>>(),
        trap,
    };
    crate::page::write(docs, "stability", include_str!("../pages/stability.md"), &values, "stability")
}
