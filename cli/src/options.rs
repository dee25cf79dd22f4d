//! Options of the command line: their names, and values by name.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

/// The option of the number called `name`: `--f-fc` of f_fc.
pub fn on_command_line(name: &str) -> String {
    format!("--{}", option_name(name))
}

pub fn option_name(name: &str) -> String {
    name.replace('_', "-")
}

/// Takes one of `all` by its name.
pub fn one_of<T: Copy + Send + Sync + 'static>(
    all: impl IntoIterator<Item = (impl Into<PossibleValue>, T)>,
) -> impl TypedValueParser<Value = T> {
    let (names, values): (Vec<PossibleValue>, Vec<T>) = all.into_iter().map(|(name, of)| (name.into(), of)).unzip();
    PossibleValuesParser::new(names.clone()).map(move |asked| {
        let found = names.iter().position(|name| name.matches(&asked, false));
        values[found.expect("clap accepts these names alone")]
    })
}
