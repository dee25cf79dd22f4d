//! Overturning spectra: what becomes of a structure under pulses of every frequency and amplitude of a grid.
//!
//! A map is no list of runs: a point's pulse is made of the point's two numbers when it is run, and what it comes to
//! depends on nothing else. Points have places in 1/256 of the grid's steps. A refinement halves the steps where it matters:
//! in squares between neighbouring points that differ in [`Class`], and from there along the boundary wherever the finer
//! points show that it goes.

use crate::condition::{PERTURBATION, changed, condition, paired};
use crate::plan::Conditions;
use crate::pulse::{Pulse, units_of};
use crate::{Refused, ensure};
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::levels::uplift::least_push;
use rocking::run::fall::FallPeaks;
use rocking::run::record::Record;
use rocking::run::{Ending, Finish, Run, RunError, Runs, rocked_each};
use rocking::{Detail, Modes, Structure};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeSet, HashMap};

/// Parts of the grid's steps that a place can have.
pub const PARTS: u32 = 1 << MAX_REFINEMENTS;

/// How often a grid's steps can be halved.
pub const MAX_REFINEMENTS: u32 = 8;

pub const MAX_POINTS: usize = 10_000_000;

/// Values that a pulse's frequency, or its amplitude, goes through.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    pub values: Vec<f64>,
    /// Whether they are spaced evenly in their logarithms between two of them, where a refinement looks.
    pub is_log: bool,
}

/// One structure under one shape of pulse, at every point of which there is such a pulse.
#[derive(Clone, Debug)]
pub struct Map {
    pub structure: Structure,
    /// But for its frequency and its amplitude.
    pub pulse: Pulse,
    /// Frequencies: in Hz, or, where the map is dimensionless, ω/p_l.
    pub frequency: Axis,
    /// Amplitudes: in m/s², or, where the map is dimensionless, a_p/(g tan α_cg).
    pub amplitude: Axis,
    /// Whether the axes are in units of the structure.
    pub is_dimensionless: bool,
    pub detail: Detail,
    /// Relative tolerance of the results.
    pub tolerance: f64,
    pub finds_condition: bool,
}

/// Position of a point along amplitudes and frequencies, in 1/256 of the steps of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct GridPlace {
    pub amplitude: u32,
    pub frequency: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Fate {
    /// Its base stays down.
    #[serde(rename = "no uplift")]
    NoUplift,
    /// It rocks, and stands in the end.
    Stands,
    /// |θ| reaches π/2.
    Overturns,
    /// It still rocks [`LONGEST_REST`](rocking::run::LONGEST_REST) after the pulse: not decided.
    #[serde(rename = "still rocking")]
    StillRocking,
    /// The motion cannot be continued: not decided.
    Failed,
}

/// Class of a point: the fate, and for a structure that overturns the number of impacts before, 2 for more than one.
pub type Class = (Fate, u64);

pub const CLASSES: [(Class, &str); 7] = [
    ((Fate::NoUplift, 0), "no uplift"),
    ((Fate::Stands, 0), "rocks and stands"),
    ((Fate::Overturns, 0), "overturns without impact"),
    ((Fate::Overturns, 1), "overturns after one impact"),
    ((Fate::Overturns, 2), "overturns after more impacts"),
    ((Fate::StillRocking, 0), "still rocking"),
    ((Fate::Failed, 0), "failed"),
];

pub const HEADINGS: [&str; 12] = [
    "refinement",
    "frequency[Hz]",
    "amplitude[m/s2]",
    "omega/p_l",
    "a_p/(g tan alpha_cg)",
    "fate",
    "impacts",
    "theta_max/alpha_cg",
    "transitions",
    "end[s]",
    "condition",
    "reason",
];

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MapPoint {
    pub fate: Fate,
    /// Number of impacts and landings.
    pub impacts: u64,
    /// The largest |θ|/α_cg, exact.
    pub theta: f64,
    /// Transitions of every kind.
    pub transitions: u64,
    /// When the run ended, s after the start of the pulse.
    pub end: f64,
    /// Relative change of `theta`, and of what overturns of `end`, over that of the amplitude, 1e-12; infinite where the
    /// [`Class`] changes.
    pub condition: Option<f64>,
    /// Why it failed; empty if it did not.
    pub reason: String,
}

impl Axis {
    /// The value at `steps` of the grid from its first, between the first and the last.
    pub fn at(&self, steps: f64) -> f64 {
        let steps = steps.clamp(0.0, (self.values.len() - 1) as f64);
        let (from, part) = (self.values[steps as usize], steps.fract());
        if part == 0.0 {
            return from;
        }
        let to = self.values[steps as usize + 1];
        if self.is_log { from * libm::exp(part * libm::log(to / from)) } else { from + part * (to - from) }
    }

    fn check(&self, name: &str) -> Result<(), Refused> {
        let rises = self.values.windows(2).all(|pair| pair[0] < pair[1]);
        let is_finite = self.values.iter().all(|value| *value > 0.0 && value.is_finite());
        ensure(self.values.len() >= 2 && rises && is_finite, || {
            format!("{name} needs two or more finite values greater than 0, each larger than the one before")
        })
    }
}

impl GridPlace {
    /// Point (`frequency`, `amplitude`) of the grid, counted from 0.
    pub fn of_grid(frequency: usize, amplitude: usize) -> GridPlace {
        GridPlace { amplitude: amplitude as u32 * PARTS, frequency: frequency as u32 * PARTS }
    }

    /// Steps of the grid from its first point, along frequencies and amplitudes.
    pub fn steps(self) -> [f64; 2] {
        [self.frequency, self.amplitude].map(|place| f64::from(place) / f64::from(PARTS))
    }
}

impl MapPoint {
    pub fn class(&self) -> Class {
        (self.fate, if self.fate == Fate::Overturns { self.impacts.min(2) } else { 0 })
    }

    fn of<Q: Runs>(run: &Run<Q>, finish: Result<Finish<Q>, RunError>, rocked: FallPeaks) -> MapPoint {
        let theta = rocked.all().theta().magnitude / libm::atan(run.structure.base().tan_alpha_cg);
        let (fate, transitions, end, reason) = match finish {
            Ok(finish) => {
                let fate = match finish.ending {
                    Ending::Overturned => Fate::Overturns,
                    Ending::StillRocking => Fate::StillRocking,
                    Ending::AtRest | Ending::AtTime if finish.motion.transitions == 0 => Fate::NoUplift,
                    Ending::AtRest | Ending::AtTime => Fate::Stands,
                };
                (fate, finish.motion.transitions, finish.motion.time, String::new())
            }
            Err(error) => (Fate::Failed, 0, error.time().unwrap_or(run.ground.start()), error.to_string()),
        };
        MapPoint { fate, impacts: rocked.impacts, theta, transitions, end, condition: None, reason }
    }

    /// How much it differs from `other`, whose amplitude is larger by [`PERTURBATION`].
    fn condition(&self, other: &MapPoint) -> f64 {
        match self.fate {
            _ if self.class() != other.class() => f64::INFINITY,
            Fate::NoUplift | Fate::Failed => 0.0,
            Fate::Overturns => condition(self.end, other.end),
            Fate::Stands | Fate::StillRocking => condition(self.theta, other.theta),
        }
    }
}

impl Map {
    /// Map of `structure` under `pulse` at each of the frequencies (Hz) and amplitudes (m/s²). A map that `is_dimensionless`
    /// has ω/p_l and a_p/(g tan α_cg) instead. The level of detail is `auto`, and the tolerance the default.
    pub fn new(
        structure: impl Into<Structure>,
        pulse: Pulse,
        [frequency, amplitude]: [Axis; 2],
        is_dimensionless: bool,
    ) -> Result<Map, Refused> {
        frequency.check("frequency")?;
        amplitude.check("amplitude")?;
        let [frequencies, amplitudes] = [&frequency, &amplitude].map(|axis| axis.values.len());
        ensure(frequencies.saturating_mul(amplitudes) <= MAX_POINTS, || {
            format!("{frequencies} frequencies x {amplitudes} amplitudes: more than {MAX_POINTS} points")
        })?;
        let (detail, tolerance) = (Detail::default(), DEFAULT_TOLERANCE);
        let (structure, finds_condition) = (structure.into(), false);
        let map = Map { structure, pulse, frequency, amplitude, is_dimensionless, detail, tolerance, finds_condition };
        for place in [GridPlace::of_grid(0, 0), GridPlace::of_grid(frequencies - 1, amplitudes - 1)] {
            map.pulse(place).check()?;
        }
        Ok(map)
    }

    /// The name of a class of this map: on ground that gives, the base touches the ground without impacts.
    pub fn named(&self, class: &str) -> String {
        match self.structure.foundation() {
            Some(_) => class.replace("impacts", "touches").replace("impact", "touch"),
            None => class.into(),
        }
    }

    /// This map to the relative `tolerance`, at the level `detail`, with each point's condition, by a second run, if it
    /// `finds_condition`.
    pub fn computed_by(self, detail: Detail, tolerance: f64, finds_condition: bool) -> Result<Map, Refused> {
        Conditions { detail, tolerance, ..Conditions::default() }.check(&self.structure)?;
        Ok(Map { detail, tolerance, finds_condition, ..self })
    }

    pub fn pulse(&self, place: GridPlace) -> Pulse {
        let [frequency, amplitude] = place.steps();
        let (frequency, amplitude) = (self.frequency.at(frequency), self.amplitude.at(amplitude));
        let (of_amplitude, of_frequency) =
            if self.is_dimensionless { units_of(self.structure.base()) } else { (1.0, 1.0) };
        Pulse { frequency: frequency * of_frequency, amplitude: amplitude * of_amplitude, ..self.pulse }
    }

    /// The row of a `point` at `place`, which the refinement of this `level` has asked for; 0 is the grid.
    pub fn row<'a>(&self, level: u32, place: GridPlace, point: &'a MapPoint) -> impl Serialize + use<'a> {
        let Pulse { frequency, amplitude, .. } = self.pulse(place);
        let (of_amplitude, of_frequency) = units_of(self.structure.base());
        (level, frequency, amplitude, frequency / of_frequency, amplitude / of_amplitude, point)
    }

    /// The pulse at `place` in straight lines. Their corners stand a little outside the curve; where the curve does not push
    /// hard enough to lift a rigid structure off, nor do they.
    fn ground(&self, place: GridPlace) -> Record {
        let pulse = self.pulse(place);
        let ground = pulse.record().expect("the map's corners have been checked");
        let (least, pga) = (least_push(self.structure.base()), ground.pga());
        if !self.detail.has_strut() && pulse.amplitude < least && least < pga {
            return ground.multiplied(pulse.amplitude / pga);
        }
        ground
    }

    pub fn run(&self, place: GridPlace) -> MapPoint {
        let mut run = None;
        self.run_each(&[place], |_, point| {
            run = Some(point);
            true
        });
        run.expect("the place has been run")
    }

    /// Runs the structure under the pulses at `places`, several at a time on one thread, and tells `done` each point with the
    /// place's position. Once `done` says no, the rest is left undone.
    pub fn run_each(&self, places: &[GridPlace], mut done: impl FnMut(usize, MapPoint) -> bool) {
        let mut grounds: Vec<_> = places.iter().map(|place| self.ground(*place)).collect();
        if self.finds_condition {
            grounds.extend_from_within(..);
            grounds.iter_mut().skip(places.len()).for_each(|ground| *ground = changed(ground, PERTURBATION));
        }
        let see = paired(places.len(), self.finds_condition, |at, point: MapPoint, changed| {
            done(at, MapPoint { condition: changed.map(|changed| point.condition(&changed)), ..point })
        });
        match self.structure.of_one_mode() {
            Some(structure) => self.points::<f64>(&structure, &grounds, see),
            None => self.points::<Modes>(&self.structure, &grounds, see),
        }
    }

    /// Runs `structure` under `grounds` and tells `see` each point with its number.
    fn points<Q: Runs>(&self, structure: &Structure, grounds: &[Record], mut see: impl FnMut(usize, MapPoint) -> bool) {
        let conditions = Conditions { detail: self.detail, tolerance: self.tolerance, ..Conditions::default() };
        let run = |ground| conditions.run::<Q>(structure.clone(), ground).expect("it starts at rest");
        let runs: Vec<_> = grounds.iter().map(run).collect();
        rocked_each(&runs, &mut |number, (finish, rocked)| see(number, MapPoint::of(&runs[number], finish, rocked)));
    }

    /// The points of the grid, amplitudes changing last.
    pub fn grid(&self) -> impl Iterator<Item = GridPlace> {
        let frequencies = self.frequency.values.len();
        (0..self.amplitude.values.len())
            .flat_map(move |amplitude| (0..frequencies).map(move |frequency| GridPlace::of_grid(frequency, amplitude)))
    }

    /// Completes the `known` points of the map, refined so many times: `run` adds the places that a refinement needs, 0 for the grid.
    pub fn complete<E>(
        &self,
        refinements: u32,
        known: &mut HashMap<GridPlace, MapPoint>,
        mut run: impl FnMut(u32, Vec<GridPlace>, &mut HashMap<GridPlace, MapPoint>) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut lacking = Vec::from_iter(self.grid().filter(|place| !known.contains_key(place)));
        for level in 0..=refinements {
            while !lacking.is_empty() {
                run(level, lacking, known)?;
                lacking = if level == 0 { Vec::new() } else { self.refinement(level, known) };
            }
            lacking = self.refinement(level + 1, known);
        }
        Ok(())
    }

    /// Points that the `level`th refinement, 1 to [`MAX_REFINEMENTS`], of the `known` points still needs. Each square of the
    /// coarser grid with different classes gets its middle and the middles of its edges. New points can make more squares
    /// differ: the refinement is complete when no point is needed.
    pub fn refinement(&self, level: u32, known: &HashMap<GridPlace, MapPoint>) -> Vec<GridPlace> {
        let half = PARTS >> level;
        let at = |of: GridPlace, [frequency, amplitude]: [u32; 2]| GridPlace {
            amplitude: of.amplitude + amplitude * half,
            frequency: of.frequency + frequency * half,
        };
        let mut lacking = BTreeSet::new();
        for &corner in known.keys() {
            let is_corner = corner.frequency.is_multiple_of(2 * half) && corner.amplitude.is_multiple_of(2 * half);
            let corners = [[0, 0], [2, 0], [0, 2], [2, 2]].map(|part| at(corner, part));
            if !is_corner || !corners.iter().all(|corner| known.contains_key(corner)) {
                continue;
            }
            let between = [[1, 0], [0, 1], [1, 1], [2, 1], [1, 2]].map(|part| at(corner, part));
            let class = known[&corner].class();
            if corners.iter().chain(&between).filter_map(|place| known.get(place)).any(|of| of.class() != class) {
                lacking.extend(between.into_iter().filter(|place| !known.contains_key(place)));
            }
        }
        lacking.into_iter().collect()
    }
}

/// The point of `known` that stands for `place`, one of a map refined `levels` times: itself, or a corner of the square
/// that needed no refinement.
pub fn nearest(known: &HashMap<GridPlace, MapPoint>, place: GridPlace, levels: u32) -> Option<&MapPoint> {
    let corner = |level: u32| {
        let step = PARTS >> level;
        GridPlace { amplitude: place.amplitude / step * step, frequency: place.frequency / step * step }
    };
    (0..=levels).rev().find_map(|level| known.get(&corner(level)))
}
