//! Stability of the textbook methods: measured limits of the step against theory, over modal participation and damping,
//! and what happens when a structure that was down lifts off.

mod figures;
pub mod limits;
pub mod theory;
pub mod uplift_trap;
pub mod vibration;

use crate::fixed_step::TEXTBOOK;
use anyhow::Result;
use indicatif::ProgressBar;
use limits::{Limit, THEORY, measure};
use minijinja::{Value, context};
use rayon::prelude::*;
use rocking::{Parameters, Structure};
use std::f64::consts::TAU;
use std::path::Path;
use vibration::Vibration;

/// One measurement on the map.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    pub method: usize, // which of [`TEXTBOOK`]
    pub vibration: Vibration,
    pub measured: Limit,     // its largest stable step, as ω_u h
    pub theory: Option<f64>, // the same by theory; none where there is no limit
}

impl Cell {
    fn measure(method: usize, vibration: Vibration) -> Cell {
        let measured = measure(TEXTBOOK[method].method, &vibration);
        Cell { method, vibration, measured, theory: THEORY[method](vibration.zeta_u()) }
    }

    /// Relative distance of measurement and theory; 0 where both say never or both say always.
    pub fn deviation(&self) -> f64 {
        match (self.measured, self.theory) {
            (Limit::At(measured), Some(theory)) => (measured / theory - 1.0).abs(),
            (Limit::Unbounded, None) => 0.0,
            (Limit::Never, Some(theory)) if theory < limits::RANGE.0 => 0.0,
            _ => f64::INFINITY,
        }
    }
}

/// Modal participations and damping ratios of the map: centres of its cells.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    pub columns: usize, // cells over χ from 0 to [`MOST_CHI`]
    pub rows: usize,    // cells over ζ_fc from 0 to [`MOST_ZETA`]
}

/// The map of the full study.
pub const FULL: Grid = Grid { columns: 49, rows: 20 };

/// Right edge of the map.
pub const MOST_CHI: f64 = 0.98;

/// Upper edge of the map.
pub const MOST_ZETA: f64 = 0.2;

impl Grid {
    fn vibrations(self) -> impl ParallelIterator<Item = Vibration> {
        let centre = |k: usize, number: usize, most: f64| (k as f64 + 0.5) / number as f64 * most;
        (0..self.columns * self.rows).into_par_iter().map(move |k| Vibration {
            chi: centre(k % self.columns, self.columns, MOST_CHI),
            zeta_fc: centre(k / self.columns, self.rows, MOST_ZETA),
        })
    }
}

/// Every method at every cell of `grid`, and without damping.
pub fn map(grid: Grid, progress: &ProgressBar) -> Vec<Cell> {
    progress.inc_length(TEXTBOOK.len() as u64);
    let of_method = |method: usize| {
        progress.set_message(TEXTBOOK[method].name);
        let undamped = [0.0, 0.5, 0.9].map(|chi| Vibration { chi, zeta_fc: 0.0 });
        let vibrations: Vec<_> = grid.vibrations().chain(undamped).collect();
        let cells: Vec<_> = vibrations.into_par_iter().map(|vibration| Cell::measure(method, vibration)).collect();
        progress.inc(1);
        cells
    };
    (0..TEXTBOOK.len()).flat_map(of_method).collect()
}

/// The structures in the table of steps.
const SPECIMENS: [(&str, Parameters); 3] = [
    ("Evison", Parameters::EVISON),
    ("McManus", Parameters::MCMANUS),
    ("McManus, 30 Hz", Parameters { f_fc: 30.0, ..Parameters::MCMANUS }),
];

/// The largest stable step (s) of a method on a structure, with both pivots down and while rocking.
fn steps(method: usize, parameters: Parameters) -> Result<[Limit; 2]> {
    let structure = Structure::new(parameters)?;
    let down = measure(TEXTBOOK[method].method, &Vibration { chi: 0.0, zeta_fc: parameters.zeta_fc });
    let up = measure(TEXTBOOK[method].method, &Vibration { chi: structure.chi, zeta_fc: parameters.zeta_fc });
    let in_seconds = |limit, omega: f64| if let Limit::At(limit) = limit { Limit::At(limit / omega) } else { limit };
    Ok([in_seconds(down, structure.omega_fc), in_seconds(up, structure.omega_u)])
}

fn milliseconds(limit: Limit) -> String {
    match limit {
        Limit::Never => "0".into(),
        Limit::At(h) => format!("{:.2}", 1e3 * h),
        Limit::Unbounded => "any".into(),
    }
}

fn percent(part: f64) -> String {
    format!("{:.2} %", 100.0 * part)
}

/// Writes `docs/evidence/stability.md` with its pictures and numbers.
pub fn write(grid: Grid, docs: &Path, progress: &ProgressBar) -> Result<()> {
    let cells = map(grid, progress);
    figures::save(&cells, docs)?;
    let trap = uplift_trap::save(docs)?;
    let specimens = SPECIMENS.iter().map(|(name, parameters)| {
        let structure = Structure::new(*parameters)?;
        let f_u = structure.omega_u / TAU;
        let f_fc = parameters.f_fc;
        let [ratio, f_fc, f_u] = [f_u / f_fc, f_fc, f_u].map(|value| format!("{value:.1}"));
        Ok(context! { name => *name, f_fc, f_u, ratio })
    });
    let rows = TEXTBOOK.iter().enumerate().map(|(method, textbook)| {
        let steps = SPECIMENS.iter().map(|(_, parameters)| {
            let [down, up] = steps(method, *parameters)?;
            Ok(format!("{} → {}", milliseconds(down), milliseconds(up)))
        });
        let deviation = cells.iter().filter(|cell| cell.method == method).map(Cell::deviation).fold(0.0, f64::max);
        Ok(context! {
            method => textbook.name,
            undamped => THEORY[method](0.0).map_or("none".into(), |limit| format!("{limit:.3}")),
            deviation => percent(deviation),
            steps => steps.collect::<Result<Vec<_>>>()?,
        })
    });
    let values = context! {
        cells => cells.len(),
        deviation => percent(cells.iter().map(Cell::deviation).fold(0.0, f64::max)),
        specimens => specimens.collect::<Result<Vec<Value>>>()?,
        rows => rows.collect::<Result<Vec<Value>>>()?,
        trap,
    };
    crate::page::write(docs, "stability", include_str!("../pages/stability.md"), values)
}
