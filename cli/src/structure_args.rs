//! Which structure a command works on: one of the paper's specimens, or parameters from a file.
use anyhow::Context;
use rocking::{Parameters, Structure};
use std::path::{Path, PathBuf};

/// The structure asked for.
#[derive(clap::Args, Debug)]
pub struct StructureArgs {
    /// Specimen of the paper
    #[arg(long, value_enum, default_value_t = Preset::Mcmanus, conflicts_with = "parameters")]
    preset: Preset,
    /// TOML file with m, m0, H, B, f_fc, zeta_fc, r (SI units) and, where they differ from 0, 1 and 9.81, J0, c_ratio,
    /// g
    #[arg(long, value_name = "FILE.toml")]
    parameters: Option<PathBuf>,
}

/// A specimen of the paper.
#[derive(Clone, Copy, Debug, clap::ValueEnum, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Preset {
    /// Shear wall (Table 1)
    Evison,
    /// Bridge pier (Table 2)
    Mcmanus,
}

impl Preset {
    /// Its parameters.
    pub fn parameters(self) -> Parameters {
        match self {
            Preset::Evison => Parameters::EVISON,
            Preset::Mcmanus => Parameters::MCMANUS,
        }
    }
}

impl StructureArgs {
    /// The file that is read, if any.
    pub fn input(&self) -> Option<&Path> {
        self.parameters.as_deref()
    }

    /// Reads the parameters and derives the structure; a refusal names the file, the line and the key.
    pub fn load(&self) -> anyhow::Result<Structure> {
        let Some(path) = &self.parameters else {
            return Ok(Structure::new(self.preset.parameters())?);
        };
        let read = || -> anyhow::Result<Structure> {
            let parameters: Parameters = toml::from_str(&std::fs::read_to_string(path)?)?;
            Ok(Structure::new(parameters)?)
        };
        read().with_context(|| format!("parameters in {}", path.display()))
    }
}
