//! Which lanes of a batch are meant.

use texgraph_compiler::intrinsic::{LANES, Lanes, wide};

/// A bit for each lane, the first lowest.
pub type Mask = u128;

/// The lanes of a mask.
pub fn lanes_of(mut mask: Mask) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = mask.trailing_zeros() as usize;
        mask &= mask.wrapping_sub(1);
        (lane < LANES).then_some(lane)
    })
}

/// Does something for each lane of a mask. Most often those are all.
#[inline(always)]
pub fn each_lane(mask: Mask, mut work: impl FnMut(usize)) {
    if mask == Mask::MAX {
        for i in 0..LANES {
            work(i);
        }
    } else {
        lanes_of(mask).for_each(work);
    }
}

/// The lanes where a condition holds.
pub fn mask_of(condition: &Lanes) -> Mask {
    gather(
        #[inline(always)]
        |i| condition[i] != 0,
    )
}

/// The lanes with more steps than have been taken.
pub fn above(steps: &Lanes, taken: u32) -> Mask {
    i32::try_from(taken).map_or(0, |taken| gather(|i| steps[i] as i32 > taken))
}

/// The lanes that are something.
#[inline(always)]
pub fn gather(is: impl Fn(usize) -> bool) -> Mask {
    let bytes: [u8; LANES] = wide(
        #[inline(always)]
        || std::array::from_fn(|i| u8::from(is(i))),
    );
    // The product moves the lowest bit of each of eight bytes into its highest byte.
    let eight = |chunk: &[u8; 8]| u64::from_le_bytes(*chunk).wrapping_mul(0x0102_0408_1020_4080) >> 56;
    bytes.as_chunks().0.iter().rev().fold(0, |mask, chunk| mask << 8 | Mask::from(eight(chunk)))
}

/// 1 in the lanes of a mask.
pub fn spread(mask: Mask) -> Lanes {
    let bytes = mask.to_le_bytes();
    std::array::from_fn(|i| u32::from(bytes[i / 8]) >> (i % 8) & 1)
}

/// The first where the condition holds, else the second.
pub fn choose(condition: &Lanes, yes: &Lanes, no: &Lanes, to: &mut Lanes) {
    wide(
        #[inline(always)]
        || {
            for (((to, condition), yes), no) in to.iter_mut().zip(condition).zip(yes).zip(no) {
                *to = if *condition != 0 { *yes } else { *no };
            }
        },
    );
}
