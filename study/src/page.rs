//! The pages: templates filled in with what the commands have measured.

use anyhow::{Result, anyhow};
use minijinja::syntax::SyntaxConfig;
use minijinja::value::Serde;
use minijinja::{Environment, UndefinedBehavior};
use serde::Serialize;
use std::path::Path;

/// Templates by name.
const TEMPLATES: [(&str, &str); 4] = [
    ("accuracy", include_str!("../pages/accuracy.md")),
    ("stability", include_str!("../pages/stability.md")),
    ("failures", include_str!("../pages/failures.md")),
    ("validity", include_str!("../pages/validity.md")),
];

/// Writes the page `name`, its template filled in with `context`, into the folder `docs`.
pub fn write(docs: &Path, name: &str, context: &impl Serialize) -> Result<()> {
    let (_, template) =
        TEMPLATES.iter().find(|(known, _)| *known == name).ok_or_else(|| anyhow!("there is no page {name}"))?;
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment
        .set_syntax(SyntaxConfig::builder().trim_blocks(true).lstrip_blocks(true).keep_trailing_newline(true).build()?);
    let page = environment.render_str(template, Serde(context))?;
    std::fs::write(docs.join(format!("{name}.md")), page)?;
    Ok(())
}
