//! An overturning spectrum that the page draws while it is computed, from coarse to fine.

use crate::scene::Fields;
use rocking_sweep::map::{Axis, CLASSES, GridPlace, Map, MapPoint};
use rocking_sweep::pulse::units_of;
use serde_json::json;
use std::collections::{HashMap, VecDeque};
use wasm_bindgen::prelude::wasm_bindgen;

/// Number of steps of the grid along each axis, a power of 2, and number of refinements.
const STEPS: usize = 32;
const REFINEMENTS: u32 = 3;

/// Ranges of ω/p_l and of a_p/(g tan α_cg).
const RANGES: [(f64, f64); 2] = [(0.5, 16.0), (0.8, 16.0)];

/// A map that is being computed.
#[wasm_bindgen]
pub struct MapComputation {
    map: Map,
    known: HashMap<GridPlace, MapPoint>,
    queue: VecDeque<GridPlace>,
    level: u32,
}

#[wasm_bindgen]
impl MapComputation {
    /// The map of the scene's structure under pulses of the scene's shape.
    #[wasm_bindgen(constructor)]
    pub fn new(fields: &str) -> Result<MapComputation, String> {
        let fields = Fields::read(fields)?;
        let structure = fields.structure()?;
        let axis = |(from, to): (f64, f64)| {
            let at = |i| from * (to / from).powf(i as f64 / STEPS as f64);
            Axis { values: (0..=STEPS).map(at).collect(), is_log: true }
        };
        let (pulse, detail, tolerance) = (fields.pulse(structure.base().g)?, fields.detail()?, fields.tolerance()?);
        let map = Map::new(structure, pulse, RANGES.map(axis), true)
            .and_then(|map| map.computed_by(detail, tolerance, false))
            .map_err(|refused| refused.to_string())?;
        let mut queue: Vec<_> = map.grid().collect();
        queue.sort_by(|a, b| size(*b).total_cmp(&size(*a)));
        Ok(MapComputation { map, known: HashMap::new(), queue: queue.into(), level: 0 })
    }

    /// The ranges of the axes in units of the structure, these units in Hz and m/s², and the names of the classes.
    pub fn axes(&self) -> String {
        let [frequency, amplitude] = RANGES.map(|(from, to)| [from, to]);
        let (of_amplitude, of_frequency) = units_of(self.map.structure.base());
        let classes = CLASSES.map(|(_, name)| self.map.named(name));
        json!({
            "frequency": frequency, "amplitude": amplitude, "of_frequency": of_frequency, "of_amplitude": of_amplitude,
            "classes": classes,
        })
        .to_string()
    }

    /// Runs the next points, at most `count`. Each point is five numbers: its steps along frequency and amplitude, the size of
    /// its square in steps, its class, and the largest θ/α_cg. The answer is empty at the end of the map.
    pub fn next(&mut self, count: usize) -> Vec<f64> {
        let mut done = Vec::new();
        while done.len() < 5 * count
            && let Some(place) = self.next_place()
        {
            let point = self.map.run(place);
            let class = CLASSES.iter().position(|(class, _)| *class == point.class()).expect("it is one of them");
            let [x, y] = place.steps();
            let steps = if self.level == 0 { size(place) } else { 0.5_f64.powi(self.level as i32) };
            done.extend([x, y, steps, class as f64, point.theta]);
            self.known.insert(place, point);
        }
        done
    }

    fn next_place(&mut self) -> Option<GridPlace> {
        while self.queue.is_empty() {
            if self.level > 0 {
                self.queue = self.map.refinement(self.level, &self.known).into();
            }
            if self.queue.is_empty() && self.level == REFINEMENTS {
                return None;
            }
            self.level += u32::from(self.queue.is_empty());
        }
        self.queue.pop_front()
    }
}

/// Size of the point's square, in steps of the grid, until its neighbours are known.
fn size(place: GridPlace) -> f64 {
    let is_on = |step: &f64| place.steps().iter().all(|at| at % step == 0.0);
    [4.0, 2.0].into_iter().find(is_on).unwrap_or(1.0)
}
