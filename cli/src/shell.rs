//! `completions`: what a shell wants to know of this program.
use crate::{CommandLine, results::print};
use clap::CommandFactory;
use clap_complete::Shell;

/// For which shell.
#[derive(clap::Args)]
pub struct CompletionsArgs {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

/// Prints the completions.
pub fn completions(args: &CompletionsArgs) -> anyhow::Result<()> {
    let (mut command, mut script) = (CommandLine::command(), Vec::new());
    let name = command.get_name().to_owned();
    clap_complete::generate(args.shell, &mut command, name, &mut script);
    // clap_complete's script for bash looks for the commands of a program with a dash under another name than it gives them
    print(&String::from_utf8(script)?.replace("rocking__subcmd__fmu", "rocking__fmu"))
}
