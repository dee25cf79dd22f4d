//! Names, units and numbers of a run, of one mass or of many, in the same order at every door.

use rocking::engine::piece::Sample;
use rocking::engine::{Engine, Settings};
use rocking::mechanics::outputs::OUTPUTS;
use rocking::run::fall::Peaked;
use rocking::run::peaks::{self, Peak, Peaks};
use rocking::run::profile::Profile;
use rocking::run::record::Record;
use rocking::run::validity;
use rocking::run::{End, RunError};
use rocking::{Detail, Frame, FrameOutput, Modes, Run, State, Structure};
use rocking_sweep::plan::Conditions;

/// Name and unit of a quantity.
pub type Named = (String, &'static str);

/// Names and units of the peaks of a floor, and of the storey below the floor.
pub const OF_FLOOR: [(&str, &str); 7] =
    [("h", "m"), ("u", "m"), ("drift", "m"), ("delta_t", "m"), ("a_t", "m/s2"), ("V", "N"), ("M", "N.m")];

/// Lateral coordinates of the structures whose runs are shown: u of one mass, or the coordinates of many.
pub trait Shown: Peaked<Structure: Send + Sync, Peaks: Send + Sync> + Send + Sync {
    /// Whether the summary has a table of floors.
    const HAS_FLOORS: bool;

    /// The run of `structure` under `ground`.
    fn run<'a>(
        structure: &Self::Structure,
        ground: &'a Record,
        conditions: &Conditions,
    ) -> Result<Run<'a, Self>, RunError>;

    /// Refuses, with the reason, what no run of `structure` can have.
    fn check(structure: &Self::Structure, conditions: &Conditions) -> anyhow::Result<()>;

    /// The outputs.
    fn outputs(structure: &Self::Structure) -> Vec<Named>;

    /// Values of the outputs.
    fn values(structure: &Self::Structure, sample: &Sample<Self>) -> Vec<f64>;

    /// The elastic displacements and velocities of a state.
    fn displacements(structure: &Self::Structure) -> Vec<Named>;

    /// Values of the elastic displacements and velocities.
    fn displaced(structure: &Self::Structure, state: &State<Self>) -> Vec<f64>;

    /// The peaks of the structure.
    fn peaks(structure: &Self::Structure, peaks: &Self::Peaks) -> Vec<(Named, Peak)>;

    /// Right-hand-side evaluations that the search for the peaks took, if it counts them.
    fn evaluations(peaks: &Self::Peaks) -> Option<u64>;

    /// The peaks of each floor from below, in the order of [`OF_FLOOR`]. One mass is a floor.
    fn floors(structure: &Self::Structure, peaks: &Self::Peaks) -> Vec<[f64; OF_FLOOR.len()]>;

    /// Acceleration of a floor along the turning e_x, m/s². Floors count from 0.
    fn floor_acceleration(sample: &Sample<Self>, floor: usize) -> f64;

    /// The warnings that follow from `structure` at the level `detail`, before anything moves.
    fn warnings(structure: &Self::Structure, detail: Detail) -> Vec<String>;
}

impl Shown for f64 {
    const HAS_FLOORS: bool = false;

    fn run<'a>(structure: &Structure, ground: &'a Record, conditions: &Conditions) -> Result<Run<'a>, RunError> {
        Ok(conditions.run(*structure, ground))
    }

    fn check(structure: &Structure, conditions: &Conditions) -> anyhow::Result<()> {
        Ok(conditions.check(structure)?)
    }

    fn outputs(_: &Structure) -> Vec<Named> {
        OUTPUTS.iter().map(|output| (output.name.into(), output.unit)).collect()
    }

    fn values(_: &Structure, sample: &Sample) -> Vec<f64> {
        sample.outputs().values().to_vec()
    }

    fn displacements(_: &Structure) -> Vec<Named> {
        vec![("u".into(), "m"), ("u_dot".into(), "m/s")]
    }

    fn displaced(_: &Structure, state: &State) -> Vec<f64> {
        vec![state.u, state.u_dot]
    }

    fn peaks(structure: &Structure, peaks: &Peaks) -> Vec<(Named, Peak)> {
        peaks::of(structure).map(|of| ((of.name.into(), of.unit), of.of(peaks))).collect()
    }

    fn evaluations(peaks: &Peaks) -> Option<u64> {
        Some(peaks.evaluations())
    }

    fn floors(structure: &Structure, peaks: &Peaks) -> Vec<[f64; OF_FLOOR.len()]> {
        let [u, delta_t, a_t, V, M] =
            [peaks.u(), peaks.delta_t(), peaks.a_t(), peaks.V_t(), peaks.M_t()].map(|peak| peak.magnitude);
        vec![[structure.parameters().H, u, u, delta_t, a_t, V, M]]
    }

    fn floor_acceleration(sample: &Sample, _: usize) -> f64 {
        sample.outputs().a_t
    }

    fn warnings(structure: &Structure, detail: Detail) -> Vec<String> {
        validity::of_parameters(structure, detail)
    }
}

impl Shown for Modes {
    const HAS_FLOORS: bool = true;

    fn run<'a>(frame: &Frame, ground: &'a Record, conditions: &Conditions) -> Result<Run<'a, Modes>, RunError> {
        let &Conditions { ref initial, detail, tolerance, duration } = conditions;
        let end = duration.map_or(End::AtRest, |duration| End::At(ground.start() + duration));
        Ok(Run { detail, tolerance, end, ..Run::of_modes(frame.clone(), ground).from(initial)? })
    }

    fn check(frame: &Frame, conditions: &Conditions) -> anyhow::Result<()> {
        conditions.check_duration()?;
        let still = Record::at_rest(1.0);
        let Run { structure, initial, detail, tolerance, .. } = Modes::run(frame, &still, conditions)?;
        Engine::of_modes(structure, initial, 0.0, Settings { detail, tolerance, ..Settings::default() })?;
        Ok(())
    }

    fn outputs(frame: &Frame) -> Vec<Named> {
        FrameOutput::all(frame).map(|output| (output.name(), output.unit())).collect()
    }

    fn values(frame: &Frame, sample: &Sample<Modes>) -> Vec<f64> {
        FrameOutput::all(frame).map(sample.outputs()).collect()
    }

    fn displacements(frame: &Frame) -> Vec<Named> {
        let is_one = |of: &FrameOutput| matches!(of, FrameOutput::u(_) | FrameOutput::u_dot(_));
        FrameOutput::all(frame).filter(is_one).map(|output| (output.name(), output.unit())).collect()
    }

    fn displaced(frame: &Frame, state: &State<Modes>) -> Vec<f64> {
        let of = |part| frame.floors().iter().map(move |floor| floor.displacement(part));
        of(&state.u).chain(of(&state.u_dot)).collect()
    }

    fn peaks(_: &Frame, peaks: &Profile) -> Vec<(Named, Peak)> {
        peaks.peaks().map(|(of, peak)| ((of.name(), of.unit()), peak)).collect()
    }

    fn evaluations(_: &Profile) -> Option<u64> {
        None
    }

    fn floors(frame: &Frame, peaks: &Profile) -> Vec<[f64; OF_FLOOR.len()]> {
        use FrameOutput::{M, V, a_t, delta_t, drift, u};
        let peak = |output| peaks.of(output).map_or(f64::NAN, |peak| peak.magnitude);
        let of = |i: usize| {
            let peaks = [u(i), drift(i), delta_t(i), a_t(i), V(i), M(i)].map(peak);
            std::array::from_fn(|k| if k == 0 { frame.floors()[i].height } else { peaks[k - 1] })
        };
        (0..frame.floors().len()).map(of).collect()
    }

    fn floor_acceleration(sample: &Sample<Modes>, floor: usize) -> f64 {
        sample.output(FrameOutput::a_t(floor))
    }

    fn warnings(frame: &Frame, detail: Detail) -> Vec<String> {
        validity::of_frame(frame, detail)
    }
}
