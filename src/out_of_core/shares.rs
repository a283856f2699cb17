//! How many triangles each block is left, so that the next collapse costs the same everywhere.
//!
//! The same ratio for all would thin out what is rich in detail for the sake of what is flat. In one run over a
//! whole mesh, cheap collapses go first, wherever they are; so blocks are followed to one common price.

/// What a block pays on its way: triangles left, which fall, and the binary logarithm of what the next collapses
/// cost there.
pub(super) type Prices = [(usize, f32)];

/// Halving the range of prices so often leaves nothing of it.
const STEPS: usize = 64;

/// For each block how many triangles it is left, together about `goal`, or as few as the prices go down to.
pub(super) fn shares(blocks: &[&Prices], goal: usize) -> Vec<usize> {
    let rising: Vec<Vec<(f64, f64)>> = blocks.iter().map(|prices| rising(prices)).collect();
    let left = |price: f64| rising.iter().map(move |prices| left_at(prices, price));
    let all = || rising.iter().flatten().map(|&(_, price)| price);
    let (mut low, mut high) = all().fold((0.0, 0.0), |(low, high): (f64, f64), p| (low.min(p), high.max(p)));
    low -= 1.0;
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        if left(middle).sum::<f64>() <= goal as f64 { high = middle } else { low = middle }
    }
    let (finer, coarser) = (left(low), left(high));
    // Where many are to be had for one price, `low` and `high` are that price, and the truth lies between.
    let (most, least): (f64, f64) = (left(low).sum(), left(high).sum());
    let part = if most > least { ((goal as f64 - least) / (most - least)).clamp(0.0, 1.0) } else { 0.0 };
    finer.zip(coarser).map(|(finer, coarser)| (coarser + part * (finer - coarser)) as usize).collect()
}

/// The prices as they are paid: one that falls was paid before.
fn rising(prices: &Prices) -> Vec<(f64, f64)> {
    let mut highest = f64::NEG_INFINITY;
    let paid = prices.iter().map(|&(count, price)| {
        highest = highest.max(f64::from(price));
        (count as f64, highest)
    });
    paid.collect()
}

/// How many triangles are left where the next collapses cost `price`.
fn left_at(prices: &[(f64, f64)], price: f64) -> f64 {
    let after = prices.partition_point(|&(_, other)| other <= price);
    match (after.checked_sub(1).map(|before| prices[before]), prices.get(after)) {
        (Some((count, lower)), Some(&(fewer, higher))) => {
            count + (fewer - count) * (price - lower) / (higher - lower)
        }
        (Some((count, _)), None) => count,
        (None, first) => first.map_or(0.0, |&(count, _)| count),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn blocks() -> impl Strategy<Value = Vec<Vec<(usize, f32)>>> {
        let block = prop::collection::vec((1usize..100, -20f32..20.0), 1..6);
        let falling = block.prop_map(|steps| {
            let mut count = 1000;
            let step = |(step, price): (usize, f32)| {
                count -= step;
                (count, price)
            };
            steps.into_iter().map(step).collect()
        });
        prop::collection::vec(falling, 1..6)
    }

    proptest! {
        #[test]
        fn shares_meet_the_goal_where_it_can_be_met(blocks in blocks(), goal in 0usize..6000) {
            let prices: Vec<&Prices> = blocks.iter().map(Vec::as_slice).collect();
            let shares = shares(&prices, goal);
            let ends = |end: fn(&Prices) -> usize| prices.iter().map(|prices| end(prices)).sum::<usize>();
            let (most, least) = (ends(|p| p[0].0), ends(|p| p[p.len() - 1].0));
            let sum: usize = shares.iter().sum();
            let goal = goal.clamp(least, most);
            prop_assert!(sum <= goal && sum + 2 * blocks.len() >= goal, "{shares:?} for {goal}");
            for (share, prices) in shares.iter().zip(&prices) {
                prop_assert!((prices[prices.len() - 1].0..=prices[0].0).contains(share));
            }
        }
    }

    #[test]
    fn detail_is_kept_where_it_is_dear() {
        let (flat, rough) = ([(1000, -30.0), (100, -20.0), (10, -10.0)], [(1000, -12.0), (100, -2.0)]);
        assert_eq!(shares(&[&flat, &rough], 1100), [100, 1000]);
        let shares = shares(&[&flat, &rough], 600);
        assert!(shares[0] < 30 && shares[1] > 500, "{shares:?}");
    }

    #[test]
    fn what_costs_the_same_goes_alike() {
        let block = [(1000, 1.0), (500, 1.0), (100, 1.0)];
        let shares = shares(&[&block, &block], 1000);
        assert!(shares.iter().all(|&share| (499..=500).contains(&share)), "{shares:?}");
    }
}
