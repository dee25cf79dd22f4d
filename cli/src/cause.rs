//! The origin of a result: program, structure, ground motion, and the conditions of the computation.
use crate::record_args::{RecordArgs, RecordOptions};
use crate::scene_args::OneOrMore;
use rocking::run::record::Record;
use rocking::{Parameters, State, Structure};
use rocking_records::{Column, Unit};
use rocking_report::{describe, program::version, record::Understood};
use rocking_sweep::plan::Conditions;
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The origin of a result, part by part under its name; a part without influence on the result is left out.
pub struct Cause(Vec<(&'static str, Part)>);

#[derive(Serialize)]
#[serde(untagged)]
enum Part {
    Text(Option<String>),
    Number(f64),
    OneMass(Parameters),
    Numbers(BTreeMap<String, f64>),
    State(State<OneOrMore>),
}

impl Serialize for Cause {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, part)| (name, part)))
    }
}

impl Cause {
    fn of(structure: Option<Part>) -> Cause {
        let version = ("version", Part::Text(Some(version())));
        Cause([version].into_iter().chain(structure.map(|part| ("structure", part))).collect())
    }

    /// The cause of results of `structure`.
    pub fn new(structure: impl Into<Structure>) -> Cause {
        let structure = structure.into();
        let numbers = || describe::numbers(&structure).into_iter().map(|of| (of.name, of.value)).collect();
        let one = structure.one().map(|one| Part::OneMass(*one.parameters()));
        Cause::of(Some(one.unwrap_or_else(|| Part::Numbers(numbers()))))
    }

    /// The cause of results of the record in the file at `path` only, which is understood as `options` say.
    pub fn of_record(path: &Path, options: &RecordOptions, understood: &Understood) -> Cause {
        Cause::of(None).on([Some(path), None], &understood.record, Some(understood.unit), options, None)
    }

    /// This cause under the `record` that `args` ask for.
    pub fn under(self, args: &RecordArgs, record: &Record) -> Cause {
        let files =
            [args.record.as_ref(), args.vertical.file(args.record.as_ref())].map(|file| file.map(PathBuf::as_path));
        self.on(files, record, args.options.unit, &args.options, args.vertical.column_v.as_ref())
    }

    /// This cause under the `record` from `files`, its accelerations in `unit`; the second file is the vertical component from `column_v`.
    fn on(
        mut self,
        files: [Option<&Path>; 2],
        record: &Record,
        unit: Option<Unit>,
        options: &RecordOptions,
        column_v: Option<&Column>,
    ) -> Cause {
        let [file, file_v] = files.map(|path| path.map(|path| path.display().to_string()));
        self.0.extend([("record", Part::Text(Some(record.title().into()))), ("file", Part::Text(file))]);
        let [column, column_v] = [options.column.as_ref(), column_v].map(|column| column.map(Column::as_asked));
        let unit = unit.map(|unit| unit.to_string());
        let asked =
            [("file_v", file_v), ("record_unit", unit), ("record_column", column), ("record_column_v", column_v)];
        self.0
            .extend(asked.into_iter().filter(|(_, text)| text.is_some()).map(|(name, text)| (name, Part::Text(text))));
        self.0.extend(options.dt.map(|dt| ("record_dt", Part::Number(dt))));
        let [time_scale, scale] = options.factors().map(Part::Number);
        self.0.extend([("time_scale", time_scale), ("scale", scale)]);
        self
    }

    /// This cause of a run under these `conditions`.
    pub fn computed(mut self, conditions: &Conditions) -> Cause {
        let &Conditions { detail, tolerance, ref initial, .. } = conditions;
        self.0.extend([("detail", Part::Text(Some(detail.name().into()))), ("tolerance", Part::Number(tolerance))]);
        self.with_initial(initial)
    }

    /// This cause of runs from `initial`.
    pub fn with_initial(mut self, initial: &State<Vec<f64>>) -> Cause {
        let [u, u_dot] = [&initial.u, &initial.u_dot].map(|of| match of[..] {
            [] => OneOrMore::One(0.0),
            [one] => OneOrMore::One(one),
            _ => OneOrMore::More(of.clone()),
        });
        let &State { theta, theta_dot, .. } = initial;
        self.0.push(("initial", Part::State(State { u, u_dot, theta, theta_dot })));
        self
    }
}
