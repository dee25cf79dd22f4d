//! `view`: a page that shows the structure in motion, one file that needs nothing else.
use crate::{scene_args::MotionArgs, talk::write_as};
use rocking_report::{input, output_files::OutputFiles};
use std::path::PathBuf;

/// Arguments of `view`.
#[derive(clap::Args)]
pub struct ViewArgs {
    #[command(flatten)]
    motion: MotionArgs,
    /// The page, `-` for standard output [default: the record's name and _view.html, in this folder]
    #[arg(short, long, value_name = "FILE.html", help_heading = "Results")]
    output: Option<PathBuf>,
}

/// Follows the motion and writes the page.
pub fn run(args: &ViewArgs) -> anyhow::Result<()> {
    let run = args.motion.load()?;
    let file = OutputFiles::of_inputs(args.motion.inputs()).create(&args.output_path())?;
    write_as(file, "view", run.page()?.as_bytes())
}

impl ViewArgs {
    fn output_path(&self) -> PathBuf {
        match (&self.output, &self.motion.ground.record.record) {
            (Some(path), _) => path.clone(),
            (None, Some(record)) => format!("{}_view.html", input::stem(record)).into(),
            (None, None) => "free_vibration_view.html".into(),
        }
    }
}
