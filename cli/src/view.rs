//! `view`: a page that shows the structure in motion, one file that needs nothing else.
use crate::scene_args::{LevelArgs, MotionArgs};
use crate::talk::write_as;
use anyhow::ensure;
use rocking_report::{input, output_files::OutputFiles};
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct ViewArgs {
    #[command(flatten)]
    motion: MotionArgs,
    #[command(flatten)]
    level: LevelArgs,
    /// The page, `-` for standard output [default: the record's name and _view.html, in this folder]
    #[arg(short, long, value_name = "FILE.html", help_heading = "Results")]
    output: Option<PathBuf>,
}

pub fn run(args: &ViewArgs) -> anyhow::Result<()> {
    let output = match (&args.output, &args.motion.ground.record.record) {
        (Some(path), _) => path.clone(),
        (None, Some(record)) => format!("{}_view.html", input::stem(record)).into(),
        (None, None) => "free_vibration_view.html".into(),
    };
    let is_page = output.extension().is_none_or(|ending| ending.eq_ignore_ascii_case("html"));
    ensure!(is_page, "{}: a page's name ends in .html; `simulate --picture` draws .svg", output.display());
    let run = args.motion.load(args.level.conditions())?;
    let file = OutputFiles::of_inputs(args.motion.inputs()).create(&output)?;
    write_as(file, "view", run.page()?.as_bytes())
}
