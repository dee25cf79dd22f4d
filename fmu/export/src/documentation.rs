//! `documentation/index.html`: the model, its variables and how to use it.

use crate::Version;
use crate::library::{Library, Platform};
use crate::model_description::{DESCRIPTION, EVENTS};
use crate::significant::{in_full, significant};
use FlexibleRocking::resources::Contents;
use FlexibleRocking::variables::Table;
use fmi_unit::logger::Category;
use fmi_unit::{Causality, DataType, Value, Variable};
use minijinja::{Environment, UndefinedBehavior, Value as Filling, context};
use rocking::engine::{DEFAULT_TOLERANCE, MAX_STEPS_PER_ADVANCE};
use rocking::levels::rules::MAX_TRANSITIONS_PER_PERIOD;
use rocking::run::record::MAX_SAMPLES;
use rocking::structure::DERIVED;
use rocking::structure::any::AnyStructure;
use rocking::structure::parameters::MAX_SLENDERNESS;
use rocking_records::MAX_FILE;

const TEMPLATE: &str = include_str!("../resources/index.html");
const ICON: &str = include_str!("../resources/model.svg");

/// The page of the FMU `name` with these `contents` and `libraries`.
pub fn documentation(
    version: Version,
    name: &str,
    contents: &Contents,
    libraries: &[&Library],
) -> Result<String, minijinja::Error> {
    let groups = [
        ("Inputs", Causality::Input),
        ("Outputs", Causality::Output),
        ("Local variables", Causality::Local),
        ("Parameters and initial values", Causality::Parameter),
        ("Calculated parameters", Causality::CalculatedParameter),
    ];
    let table = Table::new(contents);
    let group = |(title, causality)| {
        let variables = table.variables.iter().filter(|variable| variable.causality == causality);
        let rows = variables.map(|variable| row(variable, &table, &contents.structure)).collect::<Vec<_>>();
        context! { title, rows }
    };
    let (floors, modes) = match &contents.structure {
        AnyStructure::One(_) => (0, 0),
        AnyStructure::Many(frame) => (frame.floors().len(), frame.modes().len()),
    };
    let page = context! {
        floors, // none of one mass
        modes,
        model_name => name,
        platforms => libraries.iter().map(|library| platform(version, library.platform)).collect::<Vec<_>>(),
        fmi => if version == Version::Fmi2 { 2 } else { 3 }, // version of the standard
        record => contents.default_record(),
        description => DESCRIPTION,
        version => env!("CARGO_PKG_VERSION"),
        guid => FlexibleRocking::guid(contents),
        icon => ICON,
        groups => groups.map(group).to_vec(),
        tolerance => format!("{DEFAULT_TOLERANCE:e}"),
        log_categories => Category::ALL.map(log_category).to_vec(),
        max_slenderness => MAX_SLENDERNESS.to_string(),
        max_transitions => MAX_TRANSITIONS_PER_PERIOD,
        max_steps => MAX_STEPS_PER_ADVANCE,
        max_samples => MAX_SAMPLES as u64,
        max_file => MAX_FILE >> 20,
    };
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    let name = "index.html"; // the extension switches HTML escaping on
    environment.render_named_str(name, TEMPLATE, page)
}

fn platform(version: Version, platform: Platform) -> Filling {
    let name = match platform {
        Platform::Linux64 => "Linux on x86-64",
        Platform::LinuxArm64 => "Linux on 64-bit ARM",
        Platform::Windows64 => "Windows on x86-64, 10 or later",
        Platform::Darwin64 => "macOS on x86-64 and Apple silicon",
        Platform::DarwinArm64 => "macOS on Apple silicon, for hosts that look for its FMI 3.0 name",
    };
    context! { folder => platform.folder(version), name }
}

fn log_category(category: Category) -> Filling {
    context! { name => category.name().to_string_lossy().into_owned(), description => if category == Category::Events { EVENTS } else { category.description() } }
}

fn row(variable: &Variable, table: &Table, structure: &AnyStructure) -> Filling {
    let (unit, range) = match variable.data_type {
        DataType::Real { unit, range } => (if unit == "1" { "–" } else { unit }, range),
        _ => ("", None),
    };
    let meaning = match variable.data_type {
        DataType::Real { .. } => variable.description.to_string(),
        DataType::Integer => format!("{} (Integer)", variable.description),
        DataType::Boolean => format!("{} (Boolean)", variable.description),
        DataType::String => format!("{} (String)", variable.description),
        DataType::Enumeration(literals) => {
            let literals: Vec<_> =
                (1..).zip(literals.items).map(|(number, name): (u32, _)| format!("{number} {name}")).collect();
            format!("{}: {}", variable.description, literals.join(", "))
        }
    };
    context! {
        name => &*variable.name,
        unit,
        value => value(variable, table, structure),
        range => range.map_or(String::new(), |(min, max)| format!("{} … {}", in_full(min), in_full(max))),
        meaning,
    }
}

/// The value of a variable before the simulation, as far as it is known: start value, or result of the parameters.
fn value(variable: &Variable, table: &Table, structure: &AnyStructure) -> String {
    match variable.start.clone() {
        Some(Value::Real(start)) => return in_full(start),
        Some(Value::Integer(start)) => return start.to_string(),
        Some(Value::Boolean(start)) => return start.to_string(),
        Some(Value::String(start)) => return start,
        None => (),
    }
    let value = match structure {
        AnyStructure::One(one) => {
            DERIVED.iter().find(|derived| derived.name == variable.name).map(|of| (of.value)(one))
        }
        AnyStructure::Many(_) => table.known(&variable.name),
    };
    value.map_or(String::new(), significant)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rocking::{Parameters, Structure};

    #[test]
    fn the_page_has_a_row_for_every_variable() {
        let contents = Contents::from(AnyStructure::One(Structure::new(Parameters::EVISON).unwrap()));
        let page = documentation(Version::Fmi2, "Pier", &contents, &[]).unwrap();
        for variable in
            Table::new(&contents).variables.iter().filter(|variable| variable.causality != Causality::Independent)
        {
            let cell = format!("<tr><td class=\"n\"><code>{}</code></td><td class=\"n\">", variable.name);
            assert_eq!(page.matches(&cell).count(), 1, "{}", variable.name);
        }
        let cells = |name, unit, value, range, meaning| {
            let n = |cell| format!("<td class=\"n\">{cell}</td>");
            format!("<code>{name}</code></td>{}{}{}<td>{meaning}</td></tr>", n(unit), n(value), n(range))
        };
        for row in [
            cells("m", "kg", "125.8", "1e-6 … 1e12", "top mass"),
            cells("zeta_fc", "–", "0.015", "0 … 0.99", "damping ratio in full contact"),
            cells("u_cr", "m", "0.000752467", "", "critical displacement at uplift"),
            cells("overturned", "", "", "", "whether the structure has overturned (Boolean)"),
            cells(
                "phase",
                "",
                "",
                "",
                "phase of the motion: 1 full contact, 2 rocking left, 3 rocking right, 4 overturned",
            ),
        ] {
            assert!(page.contains(&row), "{row}\n{page}");
        }
        assert!(page.contains("or 1e-9. A step must start"));
        assert!(page.contains("<code>logEvents</code></td><td>uplift, impact, landing"));
    }
}
