//! Levels of detail by name.

use crate::Structure;
use crate::mechanics::restraint::Angles;
use serde::{Deserialize, Serialize};

/// A level of detail.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Detail {
    /// The motion of `Nonlinear` at the least cost.
    #[default]
    Auto,
    /// Eqs 1, 5, 6, integrated throughout.
    Nonlinear,
    /// Eqs 1, 7, 8: small angles.
    Linear,
    /// Eqs 1, 11, 18: small angles and two uncoupled modes.
    Modal,
    /// Eq 6 with u = 0: no elastic motion.
    Rigid,
    /// Eq 1 alone: no uplift.
    FixedBase,
}

impl Detail {
    /// All levels, in the order of the table.
    pub const ALL: [Detail; 6] =
        [Detail::Auto, Detail::Nonlinear, Detail::Linear, Detail::Modal, Detail::Rigid, Detail::FixedBase];

    /// The name of the level in files, on the command line and in the FMU.
    pub const fn name(self) -> &'static str {
        match self {
            Detail::Auto => "auto",
            Detail::Nonlinear => "nonlinear",
            Detail::Linear => "linear",
            Detail::Modal => "modal",
            Detail::Rigid => "rigid",
            Detail::FixedBase => "fixed_base",
        }
    }

    /// Whether the base can lift off at this level.
    pub const fn has_uplift(self) -> bool {
        !matches!(self, Detail::FixedBase)
    }

    /// Whether an elastic strut carries the top mass at this level.
    pub const fn has_strut(self) -> bool {
        !matches!(self, Detail::Rigid)
    }

    /// The angles at which the ties elongate at this level.
    pub(crate) fn angles(self) -> Angles {
        if self == Detail::Linear { Angles::Small } else { Angles::Any }
    }
}

impl Structure {
    /// This structure as the level `detail` shows it: a fixed base stands on no ground that gives, and has no outputs of such ground.
    pub fn at(&self, detail: Detail) -> Structure {
        if detail.has_uplift() { self.clone() } else { self.on_rigid_ground() }
    }

    /// This structure as the level `detail` moves it, whose places a state has: many masses that move rigidly have no modes.
    pub fn moved_at(&self, detail: Detail) -> Structure {
        if detail == Detail::Rigid && self.one().is_none() { self.with_lowest(0) } else { self.at(detail) }
    }
}
