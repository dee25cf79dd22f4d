//! What a result comes from, so that it can be traced: program, structure, ground motion, and how it was computed.
use crate::record_args::RecordArgs;
use FlexibleRocking::BUILD;
use rocking::{Detail, Parameters, State, Structure, parameters::PARAMETERS, record::Record, state::INITIAL_VALUES};
use serde::Serialize;

/// Version of the program, and the first digits of its build.
pub fn version() -> String {
    format!("{}+{}", env!("CARGO_PKG_VERSION"), &BUILD[1..9])
}

/// The heading of a column of numbers.
pub fn heading(name: &str, unit: &str) -> String {
    if unit == "1" { name.into() } else { format!("{name}[{unit}]") }
}

/// What a result comes from; what has no part in it is left out.
#[derive(Serialize)]
pub struct Cause {
    version: String,
    structure: Parameters,
    #[serde(flatten)]
    ground: Option<Ground>,
    #[serde(flatten)]
    run: Option<OfRun>,
}

/// A ground motion.
#[derive(Serialize)]
struct Ground {
    /// Its title.
    record: String,
    /// Its name, as far as it is text.
    file: Option<String>,
    time_scale: f64,
    scale: f64,
}

/// How a run was computed.
#[derive(Serialize)]
struct OfRun {
    #[serde(flatten)]
    level: Option<Level>,
    initial: State,
}

#[derive(Serialize)]
struct Level {
    detail: &'static str,
    tolerance: f64,
}

impl Cause {
    /// Of what follows from `structure`.
    pub fn new(structure: &Structure) -> Cause {
        Cause { version: version(), structure: *structure.parameters(), ground: None, run: None }
    }

    /// The same under the `record` that `args` ask for.
    pub fn under(self, args: &RecordArgs, record: &Record) -> Cause {
        let [time_scale, scale] = args.factors();
        let file = args.record.as_ref().map(|path| path.display().to_string());
        let ground = Ground { record: record.title().into(), file, time_scale, scale };
        Cause { ground: Some(ground), ..self }
    }

    /// The same of a run from `initial`, at one level of detail or at all.
    pub fn computed(self, level: Option<(Detail, f64)>, initial: State) -> Cause {
        let level = level.map(|(detail, tolerance)| Level { detail: detail.name(), tolerance });
        Cause { run: Some(OfRun { level, initial }), ..self }
    }

    /// As columns of a table: headings and values.
    pub fn columns(&self) -> Vec<(String, String)> {
        let mut columns = vec![("version".to_owned(), self.version.clone())];
        let number = |name: &str, unit, value: f64| (heading(name, unit), format!("{value:?}"));
        columns.extend(PARAMETERS.iter().map(|of| number(of.name, of.unit, (of.get)(&self.structure))));
        if let Some(Ground { record, file, time_scale, scale }) = &self.ground {
            let file = file.clone().unwrap_or_default();
            columns.extend([("record".to_owned(), record.clone()), ("file".to_owned(), file)]);
            columns.extend([number("time_scale", "1", *time_scale), number("scale", "1", *scale)]);
        }
        if let Some(OfRun { level, initial }) = &self.run {
            if let Some(Level { detail, tolerance }) = level {
                columns.extend([("detail".to_owned(), (*detail).to_owned()), number("tolerance", "1", *tolerance)]);
            }
            columns.extend(INITIAL_VALUES.iter().map(|of| number(of.name, of.unit, (of.get)(initial))));
        }
        columns
    }
}
