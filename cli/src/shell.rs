//! `completions` and `man`: what a shell and a reader of manuals want to know of this program.
use crate::{CommandLine, results::print};
use anyhow::Context;
use clap::CommandFactory;
use clap_complete::Shell;
use clap_mangen::Man;

/// For which shell.
#[derive(clap::Args)]
pub struct CompletionsArgs {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

/// Which page.
#[derive(clap::Args)]
pub struct ManArgs {
    /// A command of this program [default: the program]
    command: Option<String>,
}

/// Prints the completions.
pub fn completions(args: &CompletionsArgs) -> anyhow::Result<()> {
    let (mut command, mut script) = (CommandLine::command(), Vec::new());
    let name = command.get_name().to_owned();
    clap_complete::generate(args.shell, &mut command, name, &mut script);
    // clap_complete's script for bash looks for the commands of a program with a dash under another name than it gives them
    print(&String::from_utf8(script)?.replace("rocking__subcmd__fmu", "rocking__fmu"))
}

/// Prints the page.
pub fn man(args: &ManArgs) -> anyhow::Result<()> {
    let mut program = CommandLine::command();
    program.build();
    let command = match &args.command {
        None => program,
        Some(name) => {
            let command = program.find_subcommand(name).with_context(|| format!("there is no command {name:?}"))?;
            let page = format!("rocking-fmu-{name}");
            command.clone().name(page)
        }
    };
    let mut page = Vec::new();
    Man::new(command).render(&mut page)?;
    print(&String::from_utf8(page)?)
}
