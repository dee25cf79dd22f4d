//! The pages: templates filled in with what the commands have measured.

use anyhow::{Context, Result};
use minijinja::syntax::SyntaxConfig;
use minijinja::{Environment, UndefinedBehavior, Value};
use std::path::Path;
use std::process::Command;

/// Writes the page `name`, its `template` filled in with `values`, into the folder `docs`; its last line says by which `command`
/// it is [`made`].
pub fn write(docs: &Path, name: &str, template: &str, values: &Value, command: &str) -> Result<()> {
    write_as(docs, name, template, values, &made(command)?)
}

/// Writes the page as [`write`] does; `made` is its last line.
pub fn write_as(docs: &Path, name: &str, template: &str, values: &Value, made: &str) -> Result<()> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment
        .set_syntax(SyntaxConfig::builder().trim_blocks(true).lstrip_blocks(true).keep_trailing_newline(true).build()?);
    let page = environment.render_str(template, values)?;
    Ok(std::fs::write(docs.join(format!("{name}.md")), format!("{}\n\n{made}\n", page.trim_end()))?)
}

/// The last line of a page: which `command` makes it, when, and on which processor.
pub fn made(command: &str) -> Result<String> {
    let command = format!("cargo run --release --manifest-path study/Cargo.toml -- {command}");
    let today = String::from_utf8(Command::new("date").arg("+%F").output()?.stdout)?;
    let processors = std::fs::read_to_string("/proc/cpuinfo")?;
    let processor = processors.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    let (_, processor) = processor.context("/proc/cpuinfo has no model name")?;
    let (version, today) = (env!("CARGO_PKG_VERSION"), today.trim());
    Ok(format!("*Made by `{command}`, {today}, version {version}, on one machine with {processor}.*"))
}
