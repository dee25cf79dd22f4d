//! The instant at which a guard closes within a step: secants within a bracket.

/// The search ends when it moves by less than this part of the bracket; what is left is smaller by orders of magnitude.
const CONVERGED: f64 = 1e-12;

/// Halvings of the bracket that reach rounding from anywhere.
const MAX_ITERATIONS: usize = 100;

/// The root of a guard that is `open` (> 0) at 0 and ≤ 0 at `end`. `guard` yields its value and whatever belongs to it.
pub fn first_root<T, E>(open: f64, end: f64, mut guard: impl FnMut(f64) -> Result<(f64, T), E>) -> Result<(f64, T), E> {
    let (mut low, mut high) = (0.0, end);
    let (mut last, mut last_value) = (0.0, open);
    let (mut tau, (mut value, mut found)) = (end, guard(end)?);
    for _ in 0..MAX_ITERATIONS {
        if value == 0.0 {
            break;
        }
        let mut next = tau - value * (tau - last) / (value - last_value);
        if !(next > low && next < high) {
            next = low + 0.5 * (high - low);
        }
        (last, last_value) = (tau, value);
        tau = next;
        (value, found) = guard(tau)?;
        if (tau - last).abs() <= CONVERGED * end {
            break;
        }
        *(if value > 0.0 { &mut low } else { &mut high }) = tau;
    }
    Ok((tau, found))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_root_is_found_to_rounding_with_few_evaluations() {
        let mut evaluations = 0;
        let guard = |tau: f64| {
            evaluations += 1;
            Ok::<_, ()>((tau.cos() - tau, tau))
        };
        let (tau, found) = first_root(1.0, 1.0, guard).unwrap();
        assert_relative_eq!(tau, 0.739_085_133_215_160_6, max_relative = 1e-15);
        assert_eq!(tau, found);
        assert!(evaluations <= 8, "{evaluations}");
    }

    /// A secant across the kink points far from the root.
    #[test]
    fn a_kink_that_misleads_the_secant_is_bracketed() {
        let guard = |tau: f64| Ok::<_, ()>((if tau < 0.9 { 1e-3 * (0.9 - tau) } else { 10.0 * (0.9 - tau) }, ()));
        assert_relative_eq!(first_root(9e-4, 1.0, guard).unwrap().0, 0.9, max_relative = 1e-11);
    }
}
