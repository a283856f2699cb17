//! Numbers that look random, and are the same for a seed on every machine and with every release: results
//! are promised to be, and generators in crates may change with theirs.

/// SplitMix64 (Steele, Lea and Flood, 2014). Its state is a counter, so that a block of samples can
/// start anywhere in the one stream of a seed without drawing what comes before.
pub(crate) struct SplitMix64(u64);

impl SplitMix64 {
    const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

    /// The stream of `seed`, after `drawn` numbers.
    pub(crate) fn at(seed: u64, drawn: u64) -> Self {
        // Seeds are mixed once: plain ones a step apart would give one stream shifted by one.
        Self(Self::mix(seed).wrapping_add(Self::STEP.wrapping_mul(drawn)))
    }

    fn mix(mut bits: u64) -> u64 {
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        bits ^ (bits >> 31)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(Self::STEP);
        Self::mix(self.0)
    }

    /// The next number in `0.0..1.0`.
    #[cfg(feature = "deviation")]
    pub(crate) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 * (-53f64).exp2()
    }

    /// The next number below `count`, which is at most 2³²: the upper half of a draw, multiplied and shifted.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        (((self.next() >> 32) * count as u64) >> 32) as usize
    }
}
