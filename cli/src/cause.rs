//! The origin of a result: program, structure, ground motion, and the conditions of the computation.
use crate::record_args::{RecordArgs, RecordOptions};
use rocking::run::record::Record;
use rocking::{Parameters, State, Structure};
use rocking_records::Column;
use rocking_report::{describe, program::version, record::Understood};
use rocking_sweep::plan::Conditions;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// The origin of a result; a part without influence on the result is left out.
#[derive(Serialize)]
pub struct Cause {
    version: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    structure: Option<OfStructure>,
    #[serde(flatten)]
    ground: Option<Ground>,
    /// The level of detail of a run, and its relative tolerance.
    #[serde(skip_serializing_if = "Option::is_none")]
    detail: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    tolerance: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    initial: Option<State>,
}

/// The numbers of a structure.
#[derive(Serialize)]
#[serde(untagged)]
enum OfStructure {
    One(Parameters),
    Many(BTreeMap<String, f64>),
}

/// A ground motion.
#[derive(Serialize)]
struct Ground {
    /// Title of the record.
    record: String,
    /// Name of the file, as far as the name is text.
    file: Option<String>,
    /// Name of the file of the vertical component, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    file_v: Option<String>,
    /// Unit of the accelerations in the file, where it is asked for or they are looked at alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    record_unit: Option<String>,
    /// Column of the file, where it is asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    record_column: Option<String>,
    /// Column of the vertical component, where it is asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    record_column_v: Option<String>,
    /// Time between two samples, where it is asked for, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    record_dt: Option<f64>,
    time_scale: f64,
    scale: f64,
}

impl Ground {
    fn new([path, vertical]: [Option<&Path>; 2], options: &RecordOptions, record: &Record) -> Ground {
        let [time_scale, scale] = options.factors();
        let [file, file_v] = [path, vertical].map(|path| path.map(|path| path.display().to_string()));
        let record_unit = options.unit.map(|unit| unit.to_string());
        let record_column = options.column.as_ref().map(Column::as_asked);
        let (record, record_dt) = (record.title().into(), options.dt);
        Ground { record, file, file_v, record_unit, record_column, record_column_v: None, record_dt, time_scale, scale }
    }
}

impl Cause {
    fn of(structure: Option<OfStructure>, ground: Option<Ground>) -> Cause {
        Cause { version: version(), structure, ground, detail: None, tolerance: None, initial: None }
    }

    /// Of what follows from `structure`.
    pub fn new(structure: impl Into<Structure>) -> Cause {
        let structure = structure.into();
        let many = || describe::numbers(&structure).into_iter().map(|of| (of.name, of.value)).collect();
        let structure =
            structure.one().map_or_else(|| OfStructure::Many(many()), |one| OfStructure::One(*one.parameters()));
        Cause::of(Some(structure), None)
    }

    /// Of what follows from the record in the file at `path` alone, which is understood as `options` say.
    pub fn of_record(path: &Path, options: &RecordOptions, understood: &Understood) -> Cause {
        let record_unit = Some(understood.unit.to_string());
        let ground = Ground { record_unit, ..Ground::new([Some(path), None], options, &understood.record) };
        Cause::of(None, Some(ground))
    }

    /// This cause under the `record` that `args` ask for.
    pub fn under(self, args: &RecordArgs, record: &Record) -> Cause {
        let files = [&args.record, &args.vertical.record_v].map(Option::as_deref);
        let record_column_v = args.vertical.column_v.as_ref().map(Column::as_asked);
        Cause { ground: Some(Ground { record_column_v, ..Ground::new(files, &args.options, record) }), ..self }
    }

    /// This cause of a run under these `conditions`.
    pub fn computed(self, conditions: &Conditions) -> Cause {
        let &Conditions { detail, tolerance, initial, .. } = conditions;
        Cause { detail: Some(detail.name()), tolerance: Some(tolerance), initial: Some(initial), ..self }
    }

    /// This cause of runs from `initial` at every level.
    pub fn with_initial(self, initial: State) -> Cause {
        Cause { initial: Some(initial), ..self }
    }
}
