//! A structure of many masses: a rigid base and the modes of vibration in full contact.

use crate::mechanics::lateral::MOST_MODES;
use crate::series::bisection::last_where;
use crate::structure::{Base, Mode, Vibration};

/// A rigid base that carries modes. Its modes carry all moments of the mass about the height of the pivots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    pub(crate) base: Base,
    count: usize,
    modes: [Mode; MOST_MODES],
    pub(crate) vibration: Vibration,
}

/// More modes than a structure may have, or none.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{0} modes are given: a structure has 1 to {MOST_MODES}")]
pub struct NumberOfModes(usize);

impl Frame {
    /// The structure of this `base` and these `modes`.
    pub fn new(base: Base, modes: &[Mode]) -> Result<Frame, NumberOfModes> {
        let count = modes.len();
        let Some(first) = modes.first().filter(|_| count <= MOST_MODES) else { return Err(NumberOfModes(count)) };
        let mut kept = [*first; MOST_MODES];
        kept[..count].copy_from_slice(modes);
        Ok(Frame { base, count, modes: kept, vibration: vibration(&base, modes) })
    }

    /// The modes of vibration in full contact.
    #[inline(always)]
    pub fn modes(&self) -> &[Mode] {
        &self.modes[..self.count]
    }

    /// First moment of the mass above the base S_1, kg·m.
    pub fn first_moment(&self) -> f64 {
        self.modes().iter().map(|mode| mode.gamma * mode.height).sum()
    }
}

/// The frequencies of vibration. While the structure rocks they are the roots of (M13):
///
/// ```text
/// J_P = Σ μ h² λ/(λ − ω²)
/// ```
fn vibration(base: &Base, modes: &[Mode]) -> Vibration {
    let square = |mode: &Mode| mode.stiffness / mode.mass;
    let inertia = |mode: &Mode| mode.mass * mode.height * mode.height;
    let held = base.J_P - modes.iter().map(inertia).sum::<f64>();
    let lowest = modes.iter().map(square).fold(f64::INFINITY, f64::min);
    let highest = modes.iter().map(square).fold(0.0, f64::max);
    // each root lies between two frequencies of full contact, or beyond the last
    let roots_below = |lambda: f64| {
        let passed = modes.iter().filter(|mode| square(mode) < lambda).count();
        let secular = modes.iter().map(|mode| square(mode) * inertia(mode) / (square(mode) - lambda)).sum::<f64>();
        passed - usize::from(passed > 0 && held + secular < 0.0)
    };
    let beyond = highest * (2.0 * base.J_P / held);
    let root = |roots: usize| last_where(lowest, beyond, |lambda| roots_below(lambda) < roots).sqrt();
    Vibration { contact: lowest.sqrt(), rocking: [root(1), root(modes.len())] }
}
