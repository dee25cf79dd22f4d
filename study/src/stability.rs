//! Stability of the textbook methods: measured limits of the step, with both pivots down and while rocking, and what
//! happens when a structure that was down lifts off.

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

/// The structures in the table of steps.
const SPECIMENS: [(&str, Parameters); 3] = [
    ("Evison", Parameters::EVISON),
    ("McManus", Parameters::MCMANUS),
    ("McManus, 30 Hz", Parameters { f_fc: 30.0, ..Parameters::MCMANUS }),
];

/// `limit` times `unit`, with three digits behind the point.
fn in_units(limit: Limit, unit: f64) -> String {
    match limit {
        Limit::Never => "0".into(),
        Limit::At(limit) => format!("{:.3}", limit * unit),
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
        let limit = |chi, zeta_fc| measure(textbook.method, &Vibration { chi, zeta_fc });
        let steps = structures.iter().map(|structure| {
            let zeta_fc = structure.parameters().zeta_fc;
            let down = in_units(limit(0.0, zeta_fc), 1e3 / structure.omega_fc);
            let up = in_units(limit(structure.chi, zeta_fc), 1e3 / structure.omega_u);
            format!("{down} → {up}")
        });
        context! {
            method => textbook.name,
            limits => DAMPING.map(|zeta| in_units(limit(0.0, zeta), 1.0)).to_vec(),
            steps => steps.collect::<Vec<_>>(),
        }
    });
    let values = context! {
        damping => DAMPING.to_vec(),
        specimens => specimens.collect::<Vec<Value>>(),
        rows => rows.collect::<Vec<Value>>(),
        trap,
    };
    crate::page::write(docs, "stability", include_str!("../pages/stability.md"), &values, "stability")
}
