//! The command line, run as a user would: a folder with a ground motion, commands, what they print.

mod cli;
mod tour;
