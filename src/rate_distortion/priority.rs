//! Finite numbers in a form that queues can order.

/// A whole number for each finite one, in the same order; both zeros are one.
pub(super) fn rank(value: f64) -> i64 {
    let bits = (value + 0.0).to_bits() as i64;
    // Below zero, more bits mean less.
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}

#[cfg(test)]
mod tests {
    use super::rank;

    #[test]
    fn ranks_are_in_the_order_of_numbers() {
        let ascending = [f64::MIN, -1.5, -1.0, -f64::MIN_POSITIVE, 0.0, 5e-324, 1.0, 1.5, f64::MAX];
        assert!(ascending.is_sorted_by(|&a, &b| rank(a) < rank(b)));
        assert_eq!(rank(-0.0), rank(0.0));
    }
}
