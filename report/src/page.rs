//! The page that shows a run, and its content.

use crate::run::{MotionCurve, RunReport, RunSetup};
use rocking::mechanics::shown::{GROUND, Legend, Place, Reader, UNITS, in_pictures};
use rocking::run::RunError;
use rocking::structure::derived::OF_MODE;
use rocking::{Body, Detail, Output, Structure};
pub use rocking_view::Sizes;
use rocking_view::{DrawnPeak, Quanta, ShownQuantity, ShownScene, quanta};

/// Parts of a peak by which what is shown may miss the motion: units of the last digit of its numbers. The first is taken
/// that needs no more than [`MOST_VALUES`].
const PARTS: [f64; 3] = [1e-4, 1e-3, 1e-2];

/// The largest number of values: about 7 MB.
const MOST_VALUES: usize = 1_800_000;

impl RunSetup {
    pub fn page(&self) -> Result<String, RunError> {
        let is_small = |scene: &Result<ShownScene, RunError>| match scene {
            Ok(scene) => scene.values() <= MOST_VALUES,
            Err(error) => !matches!(error, RunError::TooManyPoints { .. }),
        };
        let [finer @ .., coarsest] = PARTS;
        let small = finer.into_iter().map(|part| self.scene(part)).find(is_small);
        Ok(small.unwrap_or_else(|| self.scene(coarsest))?.page())
    }

    /// The content of a page about the run, with lines that leave the motion by at most this `part` of its peaks.
    pub fn scene(&self, part: f64) -> Result<ShownScene, RunError> {
        let MotionCurve { found, times, phases, columns } = self.curve(part)?;
        let mut phases: Vec<_> = phases.iter().map(|phase| phase.name()).enumerate().collect();
        phases.dedup_by_key(|(_, phase)| *phase);
        let peaks = |found: &RunReport| -> Vec<DrawnPeak> {
            found.peaks.iter().map(|peak| (peak.name.clone(), peak.magnitude, peak.time)).collect()
        };
        let has_fixed = !self.structure.is_one_mass() && self.conditions.detail != Detail::FixedBase;
        let fixed = has_fixed.then(|| self.on_fixed_base(found.end).ok()).flatten();
        Ok(ShownScene {
            title: self.ground.title().into(),
            parameters: sizes(&self.structure.at(self.conditions.detail)),
            start: found.start,
            ending: found.ending,
            fall: found.fall,
            part,
            time: Quanta::of_time(&times, found.start),
            quantities: quantities(&self.structure),
            columns: columns.into_iter().map(|(name, values)| (name, Quanta::new(&values))).collect(),
            phases,
            transitions: found.events.iter().map(|at| (quanta(at.time - found.start), at.kind.name())).collect(),
            peaks: peaks(&found),
            fixed: fixed.as_ref().map_or(Vec::new(), peaks),
        })
    }
}

/// What the page shows of `structure`: the ground acceleration, the numbers at the cursor, and then what is shown over the height alone.
fn quantities(structure: &Structure) -> Vec<ShownQuantity> {
    let g = structure.base().g;
    let [numbers, histories] = [Place::Numbers, Place::Page].map(|place| Output::shown_in(place, structure));
    let quantity = |name, legend: Legend, of: &'static str, over| {
        let (per, unit) = in_pictures(of, g);
        let axis = |(name, unit, size, reader): &(&'static str, _, Option<f64>, _)| match reader {
            Reader::Axes(from, below) if *unit == of => Some((*name, size.unwrap_or(g), *from, *below)),
            _ => None,
        };
        ShownQuantity { name, legend, unit, per, axes: UNITS.iter().filter_map(axis).collect(), over }
    };
    let of_output = |of: Output| {
        let before = &histories[..histories.iter().position(|own| *own == of).unwrap_or(0)];
        let over = before.iter().find_map(|before| Some((before.symbol(), of.over(*before, structure)?)));
        quantity(of.symbol(), *of.legend()?, of.unit(), over).into()
    };
    let over_height = Output::over_height().map(|(of, _)| of).filter(|of| !numbers.contains(of));
    let once = numbers.iter().copied().filter(|of| of.number().is_none_or(|number| number == 0));
    let outputs = once.chain(over_height).filter_map(of_output);
    [quantity(GROUND.symbol, GROUND, "m/s2", None)].into_iter().chain(outputs).collect()
}

pub fn sizes(structure: &Structure) -> Sizes {
    let (base, shown) = (structure.base(), Output::with_peak(structure));
    let ties = Output::OF_TIES.into_iter().zip([0.0, base.ties.xi_d, -base.ties.xi_d]);
    let tie = |(of, along): (Output, f64)| {
        let (per, unit) = in_pictures(of.unit(), base.g);
        (of.symbol(), along, per, unit)
    };
    let ties = ties.filter(|(of, _)| shown.contains(of)).map(tie).collect();
    let (&Body { m_s: m, m0, S_1, .. }, floors) = (structure.body(), structure.floors());
    let H = floors.last().map_or(S_1 / m, |floor| floor.height);
    let f_fc = structure.mode_table().next().map_or(0.0, |first| (OF_MODE[0].value)(&first));
    let floors = (!structure.is_one_mass()).then(|| floors.iter().map(|floor| [floor.mass, floor.height]).collect());
    let points = structure.foundation().map_or(Vec::new(), |of| of.points.iter().map(|point| point.xi).collect());
    Sizes { m, m0, H, B: base.B, f_fc, g: base.g, ties, points, floors }
}
