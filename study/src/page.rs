//! The pages: templates filled in with what the commands have measured.

use anyhow::Result;
use minijinja::syntax::SyntaxConfig;
use minijinja::{Environment, UndefinedBehavior, Value};
use std::path::Path;

/// Writes the page `name`, its `template` filled in with `values`, into the folder `docs`.
pub fn write(docs: &Path, name: &str, template: &str, values: Value) -> Result<()> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment
        .set_syntax(SyntaxConfig::builder().trim_blocks(true).lstrip_blocks(true).keep_trailing_newline(true).build()?);
    Ok(std::fs::write(docs.join(format!("{name}.md")), environment.render_str(template, values)?)?)
}
