//! `modelDescription.xml`, from the table of variables.

use crate::{Version, units};
use FlexibleRocking::resources::Contents;
use FlexibleRocking::source::Source;
use FlexibleRocking::variables::VariableTable;
use fmi_unit::Variable;
use model_description::{DefaultExperiment, ModelDescription};

pub const DESCRIPTION: &str = "A flexible structure that rocks on its foundation under earthquake ground motion";

/// The content of the log category of events, in one line.
pub const EVENTS: &str = "uplift, impact, landing and overturning, as they happen";

pub fn xml(version: Version, name: &str, contents: &Contents, default_experiment: DefaultExperiment) -> String {
    let (structure, VariableTable { variables, sources }) = (&contents.structure, VariableTable::new(contents));
    let described = |(variable, source): (&Variable, &Source)| Variable {
        display_unit: units::display_unit(variable, structure).map(Into::into),
        nominal: units::nominal(variable, *source, structure),
        ..variable.clone()
    };
    let variables: Vec<_> = variables.iter().zip(&*sources).map(described).collect();
    let description = ModelDescription {
        name,
        token: FlexibleRocking::guid(contents),
        description: DESCRIPTION,
        version: env!("CARGO_PKG_VERSION"),
        license: env!("CARGO_PKG_LICENSE"),
        generation_tool: concat!("rocking-fmu ", env!("CARGO_PKG_VERSION")),
        events: EVENTS,
        has_slopes: true,
        display_units: units::display_units(structure),
        variables: &variables,
        default_experiment,
    };
    description.to_xml(version)
}
