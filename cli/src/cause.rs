//! The origin of a result: program, structure, ground motion, and the conditions of the computation.
use crate::record_args::RecordArgs;
use crate::scene_args::{MotionArgs, OneOrMore};
use FlexibleRocking::BUILD;
use rocking::run::record::Record;
use rocking::{Parameters, State, Structure};
use rocking_records::Column;
use rocking_report::{describe, run::RunSetup};
use rocking_sweep::plan::Conditions;
use rocking_sweep::row_file::Program;
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The origin of a result, part by part under its name; a part without influence on the result is left out.
pub struct Cause(Vec<(&'static str, CausePart)>);

#[derive(Serialize)]
#[serde(untagged)]
enum CausePart {
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

fn text((name, of): (&'static str, Option<String>)) -> (&'static str, CausePart) {
    (name, CausePart::Text(of))
}

impl Cause {
    pub fn of_program() -> Cause {
        Cause(vec![text(("version", Some(Program::of(BUILD).version)))])
    }

    pub fn new(structure: impl Into<Structure>) -> Cause {
        let (structure, mut cause) = (structure.into(), Cause::of_program());
        let numbers = || describe::numbers(&structure).into_iter().map(|of| (of.name, of.value)).collect();
        let one = structure.one().map(|one| CausePart::OneMass(*one.parameters()));
        cause.0.push(("structure", one.unwrap_or_else(|| CausePart::Numbers(numbers()))));
        cause
    }

    pub fn under(mut self, args: &RecordArgs, record: &Record) -> Cause {
        let RecordArgs { record: file, vertical, options } = args;
        let path = |file: Option<&PathBuf>| file.map(|path| path.display().to_string());
        let column = |of: &Option<Column>| of.as_ref().map(Column::as_asked);
        self.0.extend([("record", Some(record.title().into())), ("file", path(file.as_ref()))].map(text));
        let asked = [
            ("file_v", path(vertical.file(file.as_ref()))),
            ("record_unit", options.unit.map(|unit| unit.to_string())),
            ("record_column", column(&options.column)),
            ("record_column_v", column(&vertical.column_v)),
        ];
        self.0.extend(asked.into_iter().filter(|(_, of)| of.is_some()).map(text));
        self.0.extend(options.dt.map(|dt| ("record_dt", CausePart::Number(dt))));
        let [time_scale, scale] = options.factors().map(CausePart::Number);
        self.0.extend([("time_scale", time_scale), ("scale", scale)]);
        self
    }

    pub fn of(args: &MotionArgs, run: &RunSetup) -> Cause {
        let mut cause = Cause::new(run.structure.clone()).under(&args.ground.record, &run.ground);
        cause.0.extend(args.ground.force.iter().map(|path| text(("force", Some(path.display().to_string())))));
        cause
    }

    pub fn computed(mut self, conditions: &Conditions) -> Cause {
        let &Conditions { detail, tolerance, ref initial, .. } = conditions;
        self.0.extend([
            ("detail", CausePart::Text(Some(detail.name().into()))),
            ("tolerance", CausePart::Number(tolerance)),
        ]);
        self.with_initial(initial)
    }

    pub fn with_initial(mut self, initial: &State<Vec<f64>>) -> Cause {
        let [u, u_dot] = [&initial.u, &initial.u_dot].map(|of| match of[..] {
            [] => OneOrMore::One(0.0),
            [one] => OneOrMore::One(one),
            _ => OneOrMore::More(of.clone()),
        });
        let &State { theta, theta_dot, .. } = initial;
        self.0.push(("initial", CausePart::State(State { u, u_dot, theta, theta_dot })));
        self
    }
}
