//! Limits of stability by theory, as ω h, for an oscillator ẍ + 2 ζ ω ẋ + ω² x = 0.
//!
//! | method | limit of ω h |
//! |---|---|
//! | explicit Euler | 2ζ for ζ ≤ 1, 2/(ζ + √(ζ²−1)) beyond: \|1 + hλ\| = 1 |
//! | semi-implicit Euler | 2 (√(1+ζ²) − ζ): the trace and determinant of its step, 2 − 2ζΩ − Ω² and 1 − 2ζΩ, end the stable region where 1 + tr + det = 0 |
//! | central difference | 2, whatever the damping |
//! | RK4 | where \|1 + z + z²/2 + z³/6 + z⁴/24\| = 1 at z = hλ: 2√2 without damping |
//! | Newmark average acceleration, HHT-α | none |
//!
//! λ = ω (−ζ ± √(ζ²−1)).

use nalgebra::Complex;

/// Explicit Euler.
pub fn explicit_euler(zeta: f64) -> Option<f64> {
    Some(if zeta <= 1.0 { 2.0 * zeta } else { 2.0 / (zeta + (zeta * zeta - 1.0).sqrt()) })
}

/// Semi-implicit Euler.
pub fn semi_implicit_euler(zeta: f64) -> Option<f64> {
    Some(2.0 * ((1.0 + zeta * zeta).sqrt() - zeta))
}

/// Central difference with damping at the sample.
pub fn central_difference(_: f64) -> Option<f64> {
    Some(2.0)
}

/// RK4.
pub fn runge_kutta_4(zeta: f64) -> Option<f64> {
    let root = Complex::from(zeta * zeta - 1.0).sqrt();
    let grows = |omega_h: f64| {
        [root, -root].into_iter().any(|root| {
            let z = (root - zeta) * omega_h;
            (z * (z * (z * (z / 4.0 + 1.0) / 3.0 + 1.0) / 2.0 + 1.0) + 1.0).norm() > 1.0 + 1e-14
        })
    };
    // The stable stretch of a ray begins at 0 (rounding aside) and is shorter than 4.
    let coarse = (100..4000).map(|k| 1e-3 * f64::from(k)).find(|omega_h| grows(*omega_h))?;
    let (mut low, mut high) = (coarse - 1e-3, coarse);
    while high - low > 1e-12 {
        let middle = 0.5 * (low + high);
        *(if grows(middle) { &mut high } else { &mut low }) = middle;
    }
    Some(low)
}

/// Newmark with average acceleration, and HHT-α.
pub fn unbounded(_: f64) -> Option<f64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn runge_kutta_ends_at_its_textbook_limits() {
        assert_relative_eq!(runge_kutta_4(0.0).unwrap(), 8f64.sqrt(), max_relative = 1e-6);
        assert_relative_eq!(runge_kutta_4(1.0).unwrap(), 2.785_293_563_405_282, max_relative = 1e-9); // the real axis
    }
}
