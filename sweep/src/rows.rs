//! The rows of a sweep: headings, and what they say of each run; and the sweep that goes on where its rows end.
//!
//! A run's key stands for names, parameters, samples, scale factors, conditions, the build of the program.

use crate::outcome::{Measure, Outcome, Summary, column};
use crate::plan::{AXES, Case, Conditions, NamedRecord, Plan, values_of};
use crate::row_file::{Digest, Known, Program, RowFile, do_runs, fixed, heading, line};
use anyhow::{bail, ensure};
use csv::StringRecord;
use rayon::prelude::*;
use rocking::estimates::intensity::IntensityMeasure;
use rocking::mechanics::state::INITIAL_VALUES;
use rocking::run::Ending;
use rocking::run::record::Record;
use rocking::run::validity::{ASSUMPTIONS, Findings};
use std::collections::HashMap;
use std::io::Write;
use std::path::Path;
use std::sync::OnceLock;
use uuid::Uuid;

/// The word for the ending of a run that has none.
pub const FAILED: &str = "failed";

/// How many numbers a row has of the check of validity.
const BEYOND: usize = 2 * ASSUMPTIONS.len() + 2;

/// A plan with its runs, as far as they are done.
#[derive(Debug)]
pub struct Sweep<'a> {
    plan: &'a Plan,
    program: &'a Program,
    validity: bool,
    /// Of every run, what stands for all that the run depends on.
    keys: Vec<Uuid>,
    /// Digest of the samples of each ground motion, whatever its file is called.
    digests: Vec<Uuid>,
    done: Vec<OnceLock<RunDone>>,
    file: Option<RowFile>,
    /// Number of rows of the file that are not of this sweep.
    pub others: usize,
}

#[derive(Debug)]
struct RunDone {
    outcome: Outcome,
    /// Results of the check of validity, in the order of the headings; none if these were not asked for.
    beyond: Box<[f64]>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Cell<'a> {
    Text(&'a str),
    Ending(Ending),
    Number(f64),
    Count(u64),
    /// The first half, of 16 digits.
    Digest(Uuid),
    /// A number for each floor, as a text with spaces between them.
    Floors(&'a [f64]),
    Empty,
}

fn spaced(of: &[f64]) -> String {
    of.iter().map(f64::to_string).collect::<Vec<_>>().join(" ")
}

fn digits(of: Uuid) -> String {
    format!("{:016x}", of.as_u64_pair().0)
}

impl Cell<'_> {
    /// Adds the cell and a comma to a row of CSV; a number reads back to the same bits.
    fn write(self, row: &mut Vec<u8>) {
        match self {
            Cell::Text(text) if text.contains(['"', ',', '\n', '\r']) => {
                row.extend(line(&[text]));
                row.pop();
            }
            Cell::Text(text) => row.extend(text.as_bytes()),
            Cell::Ending(ending) => write!(row, "{ending}").expect("memory can be written"),
            Cell::Number(of) if of.abs() >= 1e16 => {
                row.extend(zmij::Buffer::new().format(of).replace('+', "").as_bytes())
            }
            Cell::Number(of) => row.extend(zmij::Buffer::new().format(of).as_bytes()),
            Cell::Count(count) => row.extend(itoa::Buffer::new().format(count).as_bytes()),
            Cell::Digest(of) => row.extend(digits(of).as_bytes()),
            Cell::Floors(of) => row.extend(spaced(of).as_bytes()),
            Cell::Empty => {}
        }
        row.push(b',');
    }
}

/// The values of one column, row by row.
#[derive(Clone, Debug, PartialEq)]
pub enum RowColumn {
    /// Numbers; NaN where a row has nothing.
    Numbers(Vec<f64>),
    /// Counts, of which every row has one.
    Counts(Vec<u64>),
    /// Texts, each once, and of every row the position of its text; [`u32::MAX`] where a row has nothing.
    Texts(Vec<String>, Vec<u32>),
}

impl<'a> Sweep<'a> {
    /// The sweep of `plan`, none of whose runs is done, or those whose rows are in the file at `path`, which is begun if there
    /// is none. With `validity` a row says what its run goes beyond, too. Refuses runs that are the same, and a file whose rows
    /// are not of a sweep.
    pub fn open(
        plan: &'a Plan,
        validity: bool,
        program: &'a Program,
        path: Option<&Path>,
    ) -> anyhow::Result<Sweep<'a>> {
        let digests: Vec<_> = plan.motions.iter().map(|motion| digest_of(&motion.record)).collect();
        check_records(&plan.motions)?;
        let keys = keys(plan, &digests, validity, program);
        let mut seen = HashMap::new();
        for (run, key) in keys.iter().enumerate() {
            let number = run / (plan.len() / plan.size()[0]) + 1;
            if let Some(first) = seen.insert(key, number) {
                bail!("two runs are the same: structures {first} and {number} differ by rounding at most");
            }
        }
        let (file, known) = path.map(|path| open(path, plan, validity)).transpose()?.unzip();
        let mut others: Known<RunDone> = known.unwrap_or_default();
        let known = |key| others.remove(key).map_or_else(OnceLock::new, OnceLock::from);
        let done = keys.iter().map(known).collect();
        Ok(Sweep { plan, program, validity, keys, digests, done, file, others: others.len() })
    }

    pub fn missing(&self) -> Vec<usize> {
        (0..self.plan.len()).filter(|index| self.done[*index].get().is_none()).collect()
    }

    /// Does the runs that are not done, on all threads, and adds their rows to the file as they end. After each run
    /// `goes_on` is asked; once it says no, the rest is left undone and that is an error.
    pub fn finish(&self, goes_on: impl Fn() -> bool + Sync) -> anyhow::Result<()> {
        let run = |indices: &[usize], hand_out: &mut dyn FnMut(_, &[u8]) -> bool| {
            let (mut structure, mut of_structure, mut row) = (usize::MAX, Vec::new(), Vec::new());
            self.plan.each_outcome(indices, self.validity, |case, outcome, findings| {
                let findings = findings.filter(|_| matches!(outcome, Outcome::Ended(_)));
                let done = RunDone { beyond: findings.map_or_else(Box::default, beyond), outcome };
                if self.file.is_some() {
                    if structure != case.structure_number() {
                        structure = case.structure_number();
                        of_structure.clear();
                        self.of_structure(case).into_iter().for_each(|cell| cell.write(&mut of_structure));
                    }
                    row.clear();
                    Cell::Text(self.keys[case.index].hyphenated().encode_lower(&mut Uuid::encode_buffer()))
                        .write(&mut row);
                    row.extend(&of_structure);
                    self.of_run(case, &done).into_iter().for_each(|cell| cell.write(&mut row));
                    *row.last_mut().expect("a comma") = b'\n';
                }
                hand_out((case.index, done), &row)
            });
        };
        let keep = |(index, done): (usize, RunDone)| {
            self.done[index].set(done).expect("each run is done once");
            ensure!(goes_on(), "stopped: the runs that are finished are kept");
            Ok(())
        };
        do_runs(&self.missing(), self.file.as_ref(), run, keep)
    }

    /// The key of every run of the plan, which its row begins with, and what became of it, once all are done.
    pub fn outcomes(self) -> (Vec<Uuid>, Vec<Outcome>) {
        let done = self.done.into_iter().map(|done| done.into_inner().expect("every run is done"));
        (self.keys, done.map(|done| done.outcome).collect())
    }

    /// The rows of the runs that are done, in the order of the plan: their keys, and the columns with their headings. The
    /// column of `measure` is among them.
    pub fn table(self, measure: IntensityMeasure) -> (Vec<Uuid>, Vec<(String, RowColumn)>) {
        let done = || (0..self.plan.len()).filter(|index| self.done[*index].get().is_some());
        let rows = done().count();
        let added = Some(measure).filter(|measure| !IntensityMeasure::COLUMNS.contains(measure));
        let headings = headings(self.plan, self.validity).into_iter().skip(1);
        let headings = headings.chain(added.map(|of| heading(&of.name(), of.unit())));
        let mut columns: Vec<_> = headings.map(|of| (of, RowColumn::Counts(Vec::with_capacity(rows)))).collect();
        let mut texts = vec![HashMap::new(); columns.len()];
        let (mut structure, mut of_structure) = (usize::MAX, Vec::new());
        for case in self.plan.cases_of(done()) {
            if structure != case.structure_number() {
                (structure, of_structure) = (case.structure_number(), self.of_structure(&case));
            }
            let of_run = self.of_run(&case, self.done[case.index].get().expect("it is done"));
            let added = added.map(|measure| Cell::Number(case.intensity(measure)));
            let cells = of_structure.iter().copied().chain(of_run).chain(added);
            let columns = columns.iter_mut().zip(&mut texts);
            columns.zip(cells).for_each(|(((_, column), texts), cell)| column.push(cell, texts));
        }
        let keys = self.keys.into_iter().zip(&self.done).filter_map(|(key, done)| done.get().map(|_| key));
        (keys.collect(), columns)
    }

    /// The cells of a row that depend on its structure alone, without the key of the run.
    fn of_structure<'b>(&'b self, case: &Case<'b>) -> Vec<Cell<'b>> {
        let digest = Digest::new(&Uuid::NAMESPACE_OID).and(&case.structure.numbers()).uuid();
        let names = [Cell::Text(&case.population.name), Cell::Digest(digest), Cell::Text(&self.program.version)];
        let others = values_of(&case.structure, &self.plan.numbers);
        let numbers = AXES.map(|axis| case.value(axis)).into_iter().chain(others);
        names.into_iter().chain(numbers.map(Cell::Number)).collect()
    }

    /// The other cells of the row of a run that is done.
    fn of_run<'b>(&'b self, case: &Case<'b>, RunDone { outcome, beyond }: &'b RunDone) -> Vec<Cell<'b>> {
        let Conditions { initial, detail, tolerance, duration, finds_condition } = &self.plan.conditions;
        let mut row = Vec::with_capacity(64);
        row.extend([Cell::Text(&case.motion.name), Cell::Digest(self.digests[case.motion_number()])]);
        row.extend([case.motion.scale, case.scale].map(Cell::Number));
        row.extend(IntensityMeasure::COLUMNS.map(|measure| Cell::Number(case.intensity(measure))));
        row.extend([Cell::Text(detail.name()), Cell::Number(*tolerance), duration.map_or(Cell::Empty, Cell::Number)]);
        row.extend(initial.numbers().map(|of| match *of {
            [] => Cell::Number(0.0),
            [one] => Cell::Number(one),
            _ => Cell::Floors(of),
        }));
        let reason = match outcome {
            Outcome::Ended(of) => {
                row.extend([Cell::Ending(of.ending), Cell::Number(of.end)]);
                row.extend(of.peaks.iter().copied().map(Cell::Number));
                let counts = [of.transitions, of.steps, of.evaluations].into_iter().chain(of.digits.map(u64::from));
                row.extend(counts.map(Cell::Count));
                Cell::Empty
            }
            Outcome::Failed { time, reason } => {
                row.extend([Cell::Text(FAILED), Cell::Number(*time)]);
                row.resize(row.len() + self.plan.measures.len() + 3 + usize::from(*finds_condition), Cell::Empty);
                Cell::Text(reason)
            }
        };
        if self.validity {
            let with_beyond = row.len() + BEYOND;
            row.extend(beyond.iter().copied().map(Cell::Number));
            row.resize(with_beyond, Cell::Empty);
        }
        row.push(reason);
        row
    }
}

/// The numbers of a row that say how far a run breaks the assumptions of the model.
fn beyond(Findings { worst, gains, settlings, .. }: Findings) -> Box<[f64]> {
    let worst = worst.iter().flat_map(|worst| [worst.value, worst.time]);
    worst.chain([gains as f64, settlings as f64]).collect()
}

impl RowColumn {
    /// Adds the value of the next row. The values decide whether the column has counts, numbers or texts. The positions of its
    /// texts are kept in `known`.
    fn push(&mut self, cell: Cell, known: &mut HashMap<String, u32>) {
        match (&mut *self, cell) {
            (RowColumn::Counts(of), Cell::Count(count)) => of.push(count),
            (RowColumn::Numbers(of), Cell::Count(count)) => of.push(count as f64),
            (RowColumn::Numbers(of), Cell::Number(number)) => of.push(number),
            (RowColumn::Numbers(of), Cell::Empty) => of.push(f64::NAN),
            (RowColumn::Texts(texts, of), Cell::Text(text)) => {
                let last = of.last().copied().filter(|last| texts.get(*last as usize).is_some_and(|of| of == text));
                of.push(last.or_else(|| known.get(text).copied()).unwrap_or(texts.len() as u32));
                if of.last() == Some(&(texts.len() as u32)) {
                    known.insert(text.into(), texts.len() as u32);
                    texts.push(text.into());
                }
            }
            (RowColumn::Texts(_, of), Cell::Empty) => of.push(u32::MAX),
            (_, Cell::Digest(of)) => self.push(Cell::Text(&digits(of)), known),
            (_, Cell::Floors(of)) => self.push(Cell::Text(&spaced(of)), known),
            (_, Cell::Ending(ending)) => self.push(Cell::Text(&ending.to_string()), known),
            (RowColumn::Numbers(of), Cell::Text(_)) => {
                // nothing so far
                let mut positions = Vec::with_capacity(of.capacity());
                positions.resize(of.len(), u32::MAX);
                *self = RowColumn::Texts(Vec::new(), positions);
                self.push(cell, known);
            }
            (RowColumn::Counts(of), cell) => {
                let mut numbers = Vec::with_capacity(of.capacity());
                numbers.extend(of.iter().map(|count| *count as f64));
                *self = RowColumn::Numbers(numbers);
                self.push(cell, known);
            }
            (RowColumn::Texts(..), cell) => unreachable!("a column of texts has {cell:?}"),
        }
    }
}

fn digest_of(record: &Record) -> Uuid {
    let samples = Digest::new(&Uuid::NAMESPACE_OID).and(&(record.times(), record.acceleration()));
    match (record.vertical(), record.force()) {
        (None, None) => samples.uuid(),
        (Some(vertical), None) => samples.and(&vertical).uuid(),
        (vertical, force) => samples.and(&vertical).and(&force).uuid(),
    }
}

/// Refuses two ground motions that are the same: each of their runs would count twice.
pub(crate) fn check_records(motions: &[NamedRecord]) -> anyhow::Result<()> {
    for (i, motion) in motions.iter().enumerate() {
        if let Some(NamedRecord { name, .. }) = motions[..i].iter().find(|first| first.is_same(motion)) {
            let second = &motion.name;
            bail!("the ground motions {name:?} and {second:?} are the same and would count twice: leave one out");
        }
    }
    Ok(())
}

/// The key of each run of `plan`, which is another one where it is asked what a run goes beyond. Runs of a structure under a ground
/// motion share the digest of these two.
fn keys(plan: &Plan, digests: &[Uuid], validity: bool, program: &Program) -> Vec<Uuid> {
    const TOGETHER: usize = 1024;
    let of_some = |first: usize| {
        let (mut last, mut of_pair) = (None, Digest::new(&program.build));
        let of_case = move |case: Case| {
            if last != Some(case.pair()) {
                let names = (&case.population.name, &case.motion.name);
                let motion = (digests[case.motion_number()].into_bytes(), case.motion.scale);
                let pair = Digest::new(&program.build).and(&(names, case.structure.numbers(), motion));
                (last, of_pair) = (Some(case.pair()), pair);
            }
            of_pair.clone().and(&(case.scale, &plan.conditions, validity)).uuid()
        };
        plan.cases_of(first..plan.len().min(first + TOGETHER)).map(of_case)
    };
    (0..plan.len()).into_par_iter().step_by(TOGETHER).flat_map_iter(of_some).collect()
}

/// Opens the file at `path`, or begins it, and reads what its rows say.
fn open(path: &Path, plan: &Plan, validity: bool) -> anyhow::Result<(RowFile, Known<RunDone>)> {
    let headings = headings(plan, validity);
    let at = |heading: &str| headings.iter().position(|found| found == heading).expect("it is one of them");
    let (ending, counts, after, reason) = (at("ending"), at("transitions"), at("evaluations") + 1, at("reason"));
    let with_digits = after + usize::from(plan.conditions.finds_condition);
    RowFile::open(path, &headings, |row| {
        if &row[ending] == FAILED {
            let outcome = Outcome::Failed { time: row[ending + 1].parse()?, reason: row[reason].into() };
            return Ok(RunDone { outcome, beyond: Box::default() });
        }
        let peaks = row.iter().take(counts).skip(ending + 2).map(str::parse).collect::<Result<_, _>>()?;
        let others: StringRecord = row.iter().skip(ending).take(2).chain(row.iter().take(after).skip(counts)).collect();
        let (ending, end, transitions, steps, evaluations) = others.deserialize(None)?;
        let digits = row.iter().take(with_digits).skip(after).map(str::parse).next().transpose()?;
        let summary = Summary { ending, end, peaks, transitions, steps, evaluations, digits };
        let beyond = row.iter().take(reason).skip(with_digits).filter(|number| !number.is_empty()).map(str::parse);
        Ok(RunDone { outcome: Outcome::Ended(summary), beyond: beyond.collect::<Result<_, _>>()? })
    })
}

/// The headings of the parameters of a structure, and of these `numbers` of storeys and of ground.
pub fn of_numbers(numbers: &[Measure]) -> Vec<String> {
    let axes = AXES.iter().map(|axis| heading(axis.name, axis.unit));
    axes.chain(numbers.iter().map(|(name, unit)| heading(name, unit))).collect()
}

/// Headings of the rows, with those of the check of validity if it is asked for.
fn headings(Plan { measures, numbers, conditions, .. }: &Plan, validity: bool) -> Vec<String> {
    let intensities = IntensityMeasure::COLUMNS.map(|measure| heading(&measure.name(), measure.unit()));
    let initial = INITIAL_VALUES.each_ref().map(|quantity| heading(quantity.name, quantity.unit));
    let peaks = measures.iter().map(|(name, unit)| heading(&column(name), unit)).collect();
    let beyond = ASSUMPTIONS.iter().flat_map(|of| [of.name.to_owned(), heading(of.time_name, "s")]);
    let beyond = beyond.chain(fixed(&["energy_gains", "settlings"]));
    [
        fixed(&["run", "structures", "structure_digest", "version"]),
        of_numbers(numbers),
        fixed(&["record", "record_digest", "record_scale", "scale"]),
        intensities.into(),
        fixed(&["detail", "tolerance", "duration[s]"]),
        initial.into(),
        fixed(&["ending", "end[s]"]),
        peaks,
        fixed(&["transitions", "steps", "evaluations"]),
        fixed(if conditions.finds_condition { &["digits"] } else { &[] }),
        beyond.filter(|_| validity).collect(),
        fixed(&["reason"]),
    ]
    .concat()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Population;
    use rocking::structure::description::{Damping, Storey};
    use rocking::structure::natural_quantities::Numbers;
    use rocking::{Ground, Parameters, Structure};

    /// Two files of one ground motion, in g and in m/s², differ in the last digits.
    #[test]
    fn a_record_and_its_copy_are_refused_and_a_record_at_two_scales_is_not() {
        let program = Program { build: Uuid::nil(), version: "0".into() };
        let opened = |scale: f64, factor: f64| {
            let record = Record::from_samples("", vec![0.0, 1.0, 2.0], vec![0.0, 1.0, 1e-9]).unwrap();
            let copies = [("one", 1.0, 1.0), ("two", scale, factor)];
            let motion = |(name, scale, factor)| NamedRecord::new(name, record.clone().multiplied(factor), scale);
            let motions = copies.map(|copy| motion(copy).unwrap());
            let only = Population::new("only", Structure::new(Parameters::EVISON).unwrap());
            let plan = Plan::new(vec![only], motions.into(), vec![1.0], Conditions::default()).unwrap();
            Sweep::open(&plan, false, &program, None).map(|_| ()).map_err(|error| error.to_string())
        };
        let refused = "the ground motions \"one\" and \"two\" are the same and would count twice: leave one out";
        for (scale, factor) in [(1.0, 1.0), (1.0, 1.00001), (0.5, 2.0)] {
            assert_eq!(opened(scale, factor), Err(refused.into()), "{scale} {factor}");
        }
        assert_eq!((opened(-1.0, 1.0), opened(1.0, 1.01)), (Ok(()), Ok(())));
    }

    /// The key of a run is the digest of all that it depends on, in one piece.
    #[test]
    fn a_run_on_other_ground_has_another_key() {
        let program = Program { build: Uuid::max(), version: "0".into() };
        let key = |f_v: f64| {
            let ground = Ground { f_v: Some(f_v), zeta_v: Some(0.2), n_points: Some(3.0), ..Ground::default() };
            let wall = Structure::new(Parameters { J0: 1.2, ..Parameters::EVISON }).unwrap().on(&ground).unwrap();
            let only = Population::new("only", wall);
            let record = Record::from_samples("", vec![0.0, 1.0], vec![0.0, 1.0]).unwrap();
            let (motion, conditions) = (NamedRecord::new("one", record, 2.0).unwrap(), Conditions::default());
            let plan = Plan::new(vec![only], vec![motion], vec![1.0, 3.0], conditions.clone()).unwrap();
            let Sweep { keys, .. } = Sweep::open(&plan, false, &program, None).unwrap();
            let case = plan.case(1);
            let motion = (digest_of(&case.motion.record).into_bytes(), 2.0, 3.0);
            let all = (("only", "one"), case.structure.numbers(), motion, conditions, false);
            assert_eq!(keys[1], Uuid::new_v5(&program.build, &postcard::to_allocvec(&all).unwrap()));
            keys[1]
        };
        assert_eq!((key(60.0) == key(60.0), key(60.0) == key(90.0)), (true, false));
    }

    /// Of a pier on ground and of a building, under one name each.
    #[test]
    fn a_column_has_each_number_that_varies_and_a_digest_tells_structures_apart() {
        let program = Program { build: Uuid::nil(), version: "0".into() };
        let stiff = |k_v: f64| Ground { k_v: Some(k_v), ..Ground::default() };
        let wall = |k_v| Structure::new(Parameters { J0: 1.2, ..Parameters::EVISON }).unwrap().on(&stiff(k_v)).unwrap();
        let core = |k| {
            let base = Numbers::of(&[("m0", 20e3), ("J0", 3e4), ("B", 1.5)]).unwrap();
            let storeys = [(3.5, 6e7), (7.0, k)].map(|(h, k)| Storey { m: 4e4, h, k });
            Structure::from_storeys(&base, &Damping::All(0.02), &storeys).unwrap()
        };
        let walls = Population::new("walls", wall(1e7)).vary("k_v", vec![2e7, 3e7]).unwrap();
        let cores = Population::new("cores", core(5e7)).vary("k[2]", vec![4e7, 3e7]).unwrap();
        let record = Record::from_samples("", vec![0.0, 0.2, 0.4, 0.6], vec![0.0, 4.0, -4.0, 0.0]).unwrap();
        let motion = NamedRecord::new("one", record, 1.0).unwrap();
        let plan = Plan::new(vec![walls, cores], vec![motion.clone()], vec![1.0], Conditions::default()).unwrap();
        for (case, expected) in plan.cases().zip([wall(2e7), wall(3e7), core(4e7), core(3e7)]) {
            let alone = Population::new("alone", expected.clone());
            let alone = Plan::new(vec![alone], vec![motion.clone()], vec![1.0], Conditions::default()).unwrap();
            let [found, expected] = [case.outcome(), alone.case(0).outcome()].map(|of| {
                let Outcome::Ended(Summary { mut peaks, steps, .. }) = of else { panic!("{of:?}") };
                peaks.retain(|peak| !peak.is_nan());
                peaks.sort_by(f64::total_cmp); // each plan has its own order
                (peaks, steps)
            });
            assert_eq!(found, expected);
        }
        let sweep = Sweep::open(&plan, false, &program, None).unwrap();
        sweep.finish(|| true).unwrap();
        let columns: HashMap<_, _> = sweep.table(IntensityMeasure::Pga).1.into_iter().collect();
        let nan = f64::NAN;
        for (name, expected) in [
            ("k_v[N/m]", [2e7, 3e7, nan, nan]),
            ("m[kg]", [125.8, 125.8, nan, nan]),
            ("k[2][N/m]", [nan, nan, 4e7, 3e7]),
            ("k[1][N/m]", [nan, nan, 6e7, 6e7]),
        ] {
            let RowColumn::Numbers(found) = &columns[name] else { panic!("{name}") };
            assert!(found.iter().zip(expected).all(|(a, b)| a.total_cmp(&b).is_eq()), "{name}: {found:?}");
        }
        let RowColumn::Texts(digests, _) = &columns["structure_digest"] else { panic!() };
        assert_eq!(digests.len(), 4);
    }

    /// As the crate csv writes them, which finds the digits in another way.
    #[test]
    fn cells_are_written_as_csv() {
        let (mut random, special) =
            (fastrand::Rng::with_seed(1), [0.0, -0.0, 1e-5, 1e15, 1e16, -1.5e17, f64::MAX, f64::NAN]);
        let numbers = (0..20_000).map(|_| f64::from_bits(random.u64(..))).chain(special).chain([f64::INFINITY, 5e-324]);
        for (number, text) in numbers.zip(["", "a b", "a, b", "\"a\"", "a\nb", "a\r"].into_iter().cycle()) {
            let mut row = Vec::new();
            [Cell::Number(number), Cell::Text(text), Cell::Count(7), Cell::Ending(Ending::AtRest), Cell::Empty]
                .into_iter()
                .for_each(|cell| cell.write(&mut row));
            row.pop();
            let expected = line(&(number, text, 7, Ending::AtRest, ""));
            assert_eq!(String::from_utf8(row).unwrap() + "\n", String::from_utf8(expected).unwrap());
        }
    }
}
