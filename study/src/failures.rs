//! The gallery of failures: of each the curves of its picture, and the numbers of its cause and its remedy.

pub mod chatter;
pub mod double_crossing;
pub mod energy_gain;
pub mod fall;
pub mod grazing;
pub mod history;
pub mod overturning;
pub mod zeno;

// The modules of the failures share these names.
use crate::equations::PhaseEquations;
use crate::fixed_step::{FixedStep, MovingPoint};
use crate::guards::{displacement_excess, uplift_excess};
use crate::hybrid::{self, Grid, Transitions};
use crate::scene::{StudyScene, structure};
use crate::tables::{self, ChartLine, PageValues, series, values};
use anyhow::{Context, Result};
use history::{ReferenceHistory, at_rest, every, exact, is_impact, milli};
use rayon::prelude::*;
use rocking::series::bisection::last_where;
use rocking::{Detail, Motion, Parameters, Phase, Ramp, Side, State, Transition, TransitionKind};
use std::cell::Cell;
use std::path::Path;

pub struct Exhibit {
    pub key: &'static str, // name in file names
    pub values: PageValues,
    pub series: Vec<ChartLine>, // of its picture
}

/// Writes the curves of each failure, and the values of all, into `folder`; some failures happen under Pacoima Dam and El Centro.
pub fn write(pacoima: &StudyScene, el_centro: &StudyScene, folder: &Path) -> Result<()> {
    let exhibits: [&(dyn Fn() -> Result<Exhibit> + Sync); 7] = [
        &|| fall::show(pacoima),
        &double_crossing::show,
        &|| chatter::show(el_centro),
        &zeno::show,
        &grazing::show,
        &overturning::show,
        &energy_gain::show,
    ];
    let exhibits = exhibits.into_par_iter().map(|show| show()).collect::<Result<Vec<_>>>()?;
    for Exhibit { key, series, .. } in &exhibits {
        tables::save_series(&folder.join(format!("failure-{key}.csv")), series)?;
    }
    let rows = exhibits.into_iter().flat_map(|Exhibit { key, values, .. }| {
        values.into_iter().map(move |(name, value)| [key.replace('-', "_"), name.into(), value])
    });
    tables::save(&folder.join("failures.csv"), "failure,name,value", rows)
}
