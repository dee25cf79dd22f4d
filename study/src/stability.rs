//! Stability of the textbook methods: measured limits of the step, and what happens when a structure that
//! was down lifts off.

pub mod limits;
pub mod uplift_trap;
pub mod vibration;

use crate::fixed_step::TEXTBOOK;
use crate::tables;
use anyhow::Result;
use limits::measure;
use std::path::Path;
use vibration::FreeVibration;

/// Damping ratios ζ_u of the table of limits.
const DAMPING: [f64; 4] = [0.0, 0.05, 0.2, 1.0];

/// Writes the responses to uplift, the values of the page, and the limits of the step (0: none is stable, inf: all are).
pub fn write(folder: &Path) -> Result<()> {
    let values = uplift_trap::save(folder)?.into_iter().map(|(name, value)| [name.to_string(), value]);
    tables::save(&folder.join("stability.csv"), "name,value", values)?;
    let limits = TEXTBOOK.iter().flat_map(|textbook| {
        DAMPING.map(|zeta| {
            let limit = measure(textbook.method, &FreeVibration { chi: 0.0, zeta_fc: zeta });
            [textbook.name.to_string(), zeta.to_string(), limit.to_string()]
        })
    });
    tables::save(&folder.join("stability-limits.csv"), "method,zeta_u,limit", limits)
}
