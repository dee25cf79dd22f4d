//! The model in a browser: the functions that the page calls. Each takes the scene as JSON of its fields and answers in JSON.

mod map;
mod scene;
mod take;

use fmu_export::{Library, ModelName, Version};
use rocking::Parameters;
use rocking::levels::detail::Detail;
use rocking::run::RunError;
use rocking::run::levels::{Choice, Criterion, RULE, relative};
use rocking::run::validity::{ASSUMPTIONS, Assumption, Limits, Worst, of_structure};
use rocking::structure::natural_quantities::NATURAL;
use rocking::structure::parameters::{PARAMETERS, PRESETS, TIES};
use rocking_records::{Origin, Unit};
use rocking_report::{
    advice::LevelAdvice,
    describe,
    record::Understood,
    run::{RunSetup, usual_periods},
};
use rocking_sweep::{map::CLASSES, pulse::Shape};
use scene::{Fields, File, Files, MOTIONS, NUMBERS, OF_GROUND, READING, numbers_of};
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;
use take::{TABLE, VERTICAL, taken_along};
use wasm_bindgen::prelude::wasm_bindgen;

/// Largest error of an advised level of detail, as in `advise`.
const WITHIN: f64 = 0.05;

fn says(error: impl std::error::Error) -> String {
    error.to_string()
}

/// The library's tables, of which the page makes its controls.
#[wasm_bindgen]
pub fn tables() -> String {
    let parameter = |of: &rocking::Quantity<Parameters>| json!({ "name": of.name, "unit": of.unit, "description": of.description, "min": of.min, "max": of.max });
    let natural = |of: &rocking::structure::natural_quantities::Natural| {
        let derived = of.derived();
        json!({
            "name": of.name, "unit": derived.unit, "description": derived.description, "min": of.min, "max": of.max,
            "stands_for": of.stands_for,
        })
    };
    let shape = |of: Shape| json!({ "name": of.name(), "definition": of.definition(), "cycles": of.cycles(), "numbers": numbers_of(of.name()) });
    let preset = |(name, parameters): &(&str, Parameters)| json!({ "name": name, "parameters": parameters });
    json!({
        "parameters": PARAMETERS.iter().map(parameter).collect::<Vec<_>>(),
        "ties": TIES.iter().map(|of| of.name).collect::<Vec<_>>(),
        "natural": NATURAL.iter().map(natural).collect::<Vec<_>>(),
        "presets": PRESETS.iter().map(preset).collect::<Vec<_>>(),
        "shapes": Shape::ALL.map(shape),
        "numbers": NUMBERS,
        "motions": MOTIONS,
        "ground": OF_GROUND,
        "reading": READING,
        "details": Detail::ALL.map(Detail::name),
        "units": Unit::NAMES.map(|(name, _)| name),
        "classes": CLASSES.map(|(_, name)| name),
    })
    .to_string()
}

/// The files of the page: records, and the shared libraries for an FMU.
#[wasm_bindgen]
#[derive(Default)]
pub struct Explorer {
    files: Files,
    libraries: Vec<Library>,
}

#[wasm_bindgen]
impl Explorer {
    #[wasm_bindgen(constructor)]
    pub fn new() -> Explorer {
        Explorer::default()
    }

    /// Takes the file of the record of El Centro that the page contains.
    pub fn take_el_centro(&mut self, name: &str, bytes: Vec<u8>) {
        self.files.el_centro = Ok(File::new(name, bytes));
    }

    /// Takes the record's file, in the place of the one before.
    pub fn take_record(&mut self, name: &str, bytes: Vec<u8>) {
        self.files.own = Ok(File::new(name, bytes));
    }

    /// Takes the record away. A scene that needs it is then rejected with `why`.
    pub fn take_no_record(&mut self, why: String) {
        self.files.own = Err(why);
    }

    /// Takes the libraries of the FMU in `bytes`, or the one library there. The answer names their platforms.
    pub fn take_libraries(&mut self, name: &str, bytes: Vec<u8>) -> Result<String, String> {
        self.libraries = Library::from_bytes(Path::new(name), bytes).map_err(says)?;
        Ok(self.libraries.iter().map(|library| library.platform.tuple()).collect::<Vec<_>>().join(", "))
    }

    /// The run of the scene, with remarks on its ground motion.
    fn load(&mut self, fields: &str) -> Result<(Fields, RunSetup, Understood), String> {
        let fields = Fields::read(fields)?;
        let structure = fields.structure()?;
        let motion = fields.motion(&mut self.files, structure.base().g)?;
        let run = RunSetup { structure, ground: Arc::new(motion.record.clone()), conditions: fields.conditions()? };
        Ok((fields, run, motion))
    }

    /// The run as the script of `view` shows it, exact to this `part` of each peak.
    pub fn show(&mut self, fields: &str, part: f64) -> Result<String, String> {
        let (_, run, _) = self.load(fields)?;
        Ok(run.scene(part).map_err(says)?.json())
    }

    /// The exact peaks of the structure by name, in SI units. They are the peaks of `show`, without its curve.
    pub fn peaks(&mut self, fields: &str) -> Result<String, String> {
        let (_, run, _) = self.load(fields)?;
        let found = run.found(None, &mut ()).map_err(says)?;
        let peaks = found.peaks[1..].iter().map(|peak| json!([peak.name, peak.magnitude, peak.time]));
        Ok(json!({
            "peaks": Value::from_iter(peaks), "transitions": found.transitions, "end": found.end,
            "steps": found.work.steps, "evaluations": found.work.evaluations,
        })
        .to_string())
    }

    /// Derived quantities of the structure, remarks on the record's file, and warnings about the parameters.
    pub fn about(&mut self, fields: &str) -> Result<String, String> {
        let (_, run, Understood { record, source, sentences, .. }) = self.load(fields)?;
        let warnings: Vec<_> = sentences
            .into_iter()
            .skip(1)
            .chain(run.structure.doubts())
            .chain(of_structure(&run.structure, run.conditions.detail))
            .collect();
        let of_file = |of: Origin| [format!("{}, {}", of.format, of.unit)].into_iter().chain(of.remarks);
        let remarks: Vec<_> = source.into_iter().flat_map(of_file).collect();
        Ok(json!({
            "parameters": run.structure.parameters(), "derived": describe::derived(&run.structure),
            "modes": describe::modes(&run.structure), "warnings": warnings, "remarks": remarks,
            "samples": record.times().len(), "pga": record.pga() / run.structure.base().g,
        })
        .to_string())
    }

    /// The assumptions of the model, each with its worst value in this run.
    pub fn validity(&mut self, fields: &str) -> Result<String, String> {
        let (_, run, _) = self.load(fields)?;
        let limits = Limits::default();
        let found = run.validity(limits, &mut ()).map_err(says)?;
        let row = |(assumption, worst): (&Assumption, &Worst)| {
            let of = if assumption.is_of_impacts { found.impacts as f64 } else { found.duration };
            json!({
                "name": assumption.name, "description": assumption.description, "meaning": assumption.meaning,
                "limit": (assumption.limit)(&limits), "value": worst.value.to_string(), "time": worst.time,
                "first_beyond": worst.first_beyond, "part": relative((worst.beyond, of)),
            })
        };
        Ok(Value::from_iter(ASSUMPTIONS.iter().zip(&found.worst).map(row)).to_string())
    }

    /// The periods of floor spectra, s, and the spectrum of each floor from below with a damping ratio of 5 %, m/s².
    pub fn spectra(&mut self, fields: &str) -> Result<String, String> {
        let (_, run, _) = self.load(fields)?;
        let (found, periods) = (run.found(None, &mut ()).map_err(says)?, usual_periods());
        let floors = Vec::from_iter(0..run.structure.floors().len());
        let spectra = run.spectra(&found, &floors, &periods, 0.05, &mut ());
        Ok(json!([periods, spectra.map_err(|error| rocking_report::message(&error))?]).to_string())
    }

    /// The levels of detail, compared on this scene as `advise` compares them.
    pub fn compare(&mut self, fields: &str) -> Result<String, String> {
        let (_, run, _) = self.load(fields)?;
        let advice = run.advice(WITHIN, &Criterion::ALL).map_err(says)?;
        let row = |level: &LevelAdvice| {
            json!({
                "level": level.choice.to_string(), "detail": level.choice.detail.name(),
                "keep": level.choice.modes.filter(|[kept, all]| *kept > 0 && kept < all).map(|[kept, _]| kept.to_string()), "errors": level.errors.map(|error| error.to_string()),
                "overturns": level.overturned, "transitions": level.transitions, "cost": level.cost,
            })
        };
        let refused = |(choice, error): &(Choice, RunError)| json!([choice.to_string(), error.to_string()]);
        Ok(json!({
            "advised": advice.advised.map(|choice| choice.to_string()), "rule": RULE,
            "levels": advice.levels.iter().map(row).collect::<Vec<_>>(),
            "refused": advice.refused.iter().map(refused).collect::<Vec<_>>(),
        })
        .to_string())
    }

    /// The ground motion before it is scaled, as a CSV file that every command reads.
    pub fn record_file(&mut self, fields: &str) -> Result<String, String> {
        let fields = Fields::read(fields)?;
        let g = fields.structure()?.base().g;
        Ok(fields.multiplied(&mut self.files, [1.0; 2], g)?.tables().map_err(|error| error.to_string())?.0)
    }

    /// The scene as commands, as a script in Python, and as values that a host must set in its FMU.
    pub fn taken_along(&mut self, fields: &str) -> Result<String, String> {
        let (fields, ..) = self.load(fields)?;
        let path = self.files.own.as_ref().ok().map(|file| file.path.as_path());
        Ok(json!(taken_along(&fields, path)?).to_string())
    }

    /// The FMU of this structure under this ground motion, for FMI 2.0, or 3.0 if `fmi` is 3.
    pub fn export(&mut self, fields: &str, fmi: u32) -> Result<Vec<u8>, String> {
        let (fields, RunSetup { structure, .. }, motion) = self.load(fields)?;
        let version = if fmi == 3 { Version::Fmi3 } else { Version::Fmi2 };
        let is_as_read = fields.of_file().all(|key| fields.text(key).is_none());
        let (table, vertical) = motion.tables().map_err(|error| error.to_string())?;
        let record = match (fields.kind(), &self.files.own) {
            ("free", _) => Vec::new(),
            ("record", Ok(file)) if is_as_read => vec![(file.path.clone(), file.bytes.clone())],
            ("record", Ok(file)) => vec![(file.path.with_extension("csv"), table.into_bytes())],
            _ => vec![(TABLE.into(), table.into_bytes())],
        };
        let vertical = vertical.map(|table| (VERTICAL.into(), table.into_bytes()));
        let exported =
            fmu_export::export(version, &ModelName::default(), structure.into(), record, vertical, &self.libraries);
        Ok(exported.map_err(says)?.1)
    }
}
