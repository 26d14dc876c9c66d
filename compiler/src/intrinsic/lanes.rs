//! The values of rows, one at a time and side by side.
//!
//! A row gives a scalar function once; [`each!`] and [`whole!`] make of it what [`Evaluate`] holds:
//! the function for one value, and a loop over [`LANES`] of them that the compiler can turn into
//! vector instructions. Both run the same code, so a folded constant and a pixel agree in every bit.
//!
//! [`Evaluate`]: super::Evaluate

use super::value::{finite, map};
use crate::graph::{Constant, Scalar};
use fearless_simd::Simd;

/// How many values stand side by side.
pub const LANES: usize = 128;

/// One component of [`LANES`] values: its bits, as a [`Constant`] holds them.
pub type Lanes = [u32; LANES];

/// The components of an argument; 0 where it has none.
pub type Vector<'a> = [&'a Lanes; 4];

/// What stands for a component that an argument does not have.
pub static ZERO: Lanes = [0; LANES];

/// One component of a function's argument or value.
pub trait Word: Copy + Default {
    /// Its type in the graph; none for that of the first argument.
    const SCALAR: Option<Scalar>;
    /// From what a constant holds.
    fn of(bits: u32) -> Self;
    /// What a constant holds.
    fn bits(self) -> u32;
    /// The same where a float is known to be finite.
    fn raw(self) -> u32;
}

impl Word for f32 {
    const SCALAR: Option<Scalar> = Some(Scalar::Float);

    #[inline(always)]
    fn of(bits: u32) -> f32 {
        f32::from_bits(bits)
    }

    #[inline(always)]
    fn bits(self) -> u32 {
        finite(self).to_bits()
    }

    #[inline(always)]
    fn raw(self) -> u32 {
        self.to_bits()
    }
}

impl Word for i32 {
    const SCALAR: Option<Scalar> = Some(Scalar::Int);

    #[inline(always)]
    fn of(bits: u32) -> i32 {
        bits as i32
    }

    #[inline(always)]
    fn bits(self) -> u32 {
        self as u32
    }

    #[inline(always)]
    fn raw(self) -> u32 {
        self as u32
    }
}

impl Word for bool {
    const SCALAR: Option<Scalar> = Some(Scalar::Bool);

    #[inline(always)]
    fn of(bits: u32) -> bool {
        bits != 0
    }

    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(self)
    }

    #[inline(always)]
    fn raw(self) -> u32 {
        u32::from(self)
    }
}

/// Bits of any type, which are passed on as they are.
#[derive(Clone, Copy, Default)]
pub struct Bits(u32);

impl Word for Bits {
    const SCALAR: Option<Scalar> = None;

    #[inline(always)]
    fn of(bits: u32) -> Bits {
        Bits(bits)
    }

    #[inline(always)]
    fn bits(self) -> u32 {
        self.0
    }

    #[inline(always)]
    fn raw(self) -> u32 {
        self.0
    }
}

/// A whole argument: a word, or an array of them.
pub trait Argument: Copy {
    /// Of one value.
    fn of(value: &Constant) -> Self;
    /// Of the value in a lane.
    fn lane(lanes: &Vector<'_>, i: usize) -> Self;
    /// Of its components.
    fn of_words(words: [u32; 4]) -> Self;
}

impl<T: Word> Argument for T {
    fn of(value: &Constant) -> T {
        T::of(value.int(0) as u32)
    }

    #[inline(always)]
    fn lane(lanes: &Vector<'_>, i: usize) -> T {
        T::of(lanes[0][i])
    }

    #[inline(always)]
    fn of_words([x, ..]: [u32; 4]) -> T {
        T::of(x)
    }
}

impl<T: Word, const N: usize> Argument for [T; N] {
    fn of(value: &Constant) -> [T; N] {
        std::array::from_fn(|c| T::of(value.int(c) as u32))
    }

    #[inline(always)]
    fn lane(lanes: &Vector<'_>, i: usize) -> [T; N] {
        let mut vector = [T::default(); N];
        for c in 0..N {
            vector[c] = T::of(lanes[c][i]);
        }
        vector
    }

    #[inline(always)]
    fn of_words(words: [u32; 4]) -> [T; N] {
        let mut vector = [T::default(); N];
        for c in 0..N {
            vector[c] = T::of(words[c]);
        }
        vector
    }
}

/// A whole value: a word, or an array of them.
pub trait Outcome: Copy {
    /// The type of a component; none for that of the first argument.
    const SCALAR: Option<Scalar>;
    /// As one value; `first` is the first argument.
    fn constant(self, first: &Constant) -> Constant;
    /// Into a lane.
    fn store(self, lanes: &mut [Lanes; 4], i: usize);
    /// Its components, where floats are known to be finite.
    fn raw_words(self) -> [u32; 4];
}

impl<T: Word> Outcome for T {
    const SCALAR: Option<Scalar> = <T as Word>::SCALAR;

    fn constant(self, first: &Constant) -> Constant {
        Constant::new(<T as Word>::SCALAR.unwrap_or(first.scalar()), [self.bits()])
    }

    #[inline(always)]
    fn store(self, lanes: &mut [Lanes; 4], i: usize) {
        lanes[0][i] = self.bits();
    }

    #[inline(always)]
    fn raw_words(self) -> [u32; 4] {
        [self.raw(), 0, 0, 0]
    }
}

impl<T: Word, const N: usize> Outcome for [T; N] {
    const SCALAR: Option<Scalar> = <T as Word>::SCALAR;

    fn constant(self, first: &Constant) -> Constant {
        Constant::new(<T as Word>::SCALAR.unwrap_or(first.scalar()), map(self, T::bits))
    }

    #[inline(always)]
    fn store(self, lanes: &mut [Lanes; 4], i: usize) {
        for c in 0..N {
            lanes[c][i] = self[c].bits();
        }
    }

    #[inline(always)]
    fn raw_words(self) -> [u32; 4] {
        let mut words = [0; 4];
        for c in 0..N {
            words[c] = self[c].raw();
        }
        words
    }
}

/// Runs a loop compiled for the widest vectors that this machine has. They hold the same numbers:
/// nothing is contracted or reordered.
#[inline(always)]
pub fn wide<R>(work: impl FnOnce() -> R) -> R {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    match fearless_simd::Level::new() {
        fearless_simd::Level::Avx512(simd) => simd.vectorize(work),
        fearless_simd::Level::Avx2(simd) => simd.vectorize(work),
        _ => work(),
    }
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    work()
}

/// A function of one word, of one value.
#[inline(always)]
pub fn one1<A: Word, R: Word>([a, ..]: [u32; 3], f: impl Fn(A) -> R) -> u32 {
    f(A::of(a)).bits()
}

/// The same where the value is not made finite.
#[inline(always)]
pub fn raw1<A: Word, R: Word>([a, ..]: [u32; 3], f: impl Fn(A) -> R) -> u32 {
    f(A::of(a)).raw()
}

/// A function of two words, of one value.
#[inline(always)]
pub fn one2<A: Word, B: Word, R: Word>([a, b, _]: [u32; 3], f: impl Fn(A, B) -> R) -> u32 {
    f(A::of(a), B::of(b)).bits()
}

/// The same where the value is not made finite.
#[inline(always)]
pub fn raw2<A: Word, B: Word, R: Word>([a, b, _]: [u32; 3], f: impl Fn(A, B) -> R) -> u32 {
    f(A::of(a), B::of(b)).raw()
}

/// A function of three words, of one value.
#[inline(always)]
pub fn one3<A: Word, B: Word, C: Word, R: Word>([a, b, c]: [u32; 3], f: impl Fn(A, B, C) -> R) -> u32 {
    f(A::of(a), B::of(b), C::of(c)).bits()
}

/// The same where the value is not made finite.
#[inline(always)]
pub fn raw3<A: Word, B: Word, C: Word, R: Word>([a, b, c]: [u32; 3], f: impl Fn(A, B, C) -> R) -> u32 {
    f(A::of(a), B::of(b), C::of(c)).raw()
}

/// A function of one word, in all lanes.
#[inline(always)]
pub fn all1<A: Word, R: Word>([a, ..]: [&Lanes; 3], out: &mut Lanes, f: impl Fn(A) -> R) {
    wide(
        #[inline(always)]
        move || {
            for (out, a) in out.iter_mut().zip(a) {
                *out = f(A::of(*a)).bits();
            }
        },
    );
}

/// A function of two words, in all lanes.
#[inline(always)]
pub fn all2<A: Word, B: Word, R: Word>([a, b, _]: [&Lanes; 3], out: &mut Lanes, f: impl Fn(A, B) -> R) {
    wide(
        #[inline(always)]
        move || {
            for ((out, a), b) in out.iter_mut().zip(a).zip(b) {
                *out = f(A::of(*a), B::of(*b)).bits();
            }
        },
    );
}

/// A function of three words, in all lanes.
#[inline(always)]
pub fn all3<A: Word, B: Word, C: Word, R: Word>(
    [a, b, c]: [&Lanes; 3],
    out: &mut Lanes,
    f: impl Fn(A, B, C) -> R,
) {
    wide(
        #[inline(always)]
        move || {
            for (((out, a), b), c) in out.iter_mut().zip(a).zip(b).zip(c) {
                *out = f(A::of(*a), B::of(*b), C::of(*c)).bits();
            }
        },
    );
}

/// A function of a whole argument, of one value.
#[inline(always)]
pub fn whole_one1<A: Argument, R: Outcome>([a, _]: [Constant; 2], f: impl Fn(A) -> R) -> Constant {
    f(A::of(&a)).constant(&a)
}

/// A function of two whole arguments, of one value.
#[inline(always)]
pub fn whole_one2<A: Argument, B: Argument, R: Outcome>(
    [a, b]: [Constant; 2],
    f: impl Fn(A, B) -> R,
) -> Constant {
    f(A::of(&a), B::of(&b)).constant(&a)
}

/// A function of a whole argument, of its components; the value is not made finite.
#[inline(always)]
pub fn whole_raw1<A: Argument, R: Outcome>([a, _]: [[u32; 4]; 2], f: impl Fn(A) -> R) -> [u32; 4] {
    f(A::of_words(a)).raw_words()
}

/// A function of two whole arguments, of their components; the value is not made finite.
#[inline(always)]
pub fn whole_raw2<A: Argument, B: Argument, R: Outcome>(
    [a, b]: [[u32; 4]; 2],
    f: impl Fn(A, B) -> R,
) -> [u32; 4] {
    f(A::of_words(a), B::of_words(b)).raw_words()
}

/// A function of a whole argument, in all lanes.
#[inline(always)]
pub fn whole_all1<A: Argument, R: Outcome>(
    [a, _]: [Vector<'_>; 2],
    out: &mut [Lanes; 4],
    f: impl Fn(A) -> R,
) {
    wide(
        #[inline(always)]
        move || {
            // Of its own, so that a store can't change where arguments are.
            let a = a;
            for i in 0..LANES {
                f(A::lane(&a, i)).store(out, i);
            }
        },
    );
}

/// A function of two whole arguments, in all lanes.
#[inline(always)]
pub fn whole_all2<A: Argument, B: Argument, R: Outcome>(
    [a, b]: [Vector<'_>; 2],
    out: &mut [Lanes; 4],
    f: impl Fn(A, B) -> R,
) {
    wide(
        #[inline(always)]
        move || {
            let (a, b) = (a, b);
            for i in 0..LANES {
                f(A::lane(&a, i), B::lane(&b, i)).store(out, i);
            }
        },
    );
}

/// What a row is worth by a function that applies to each component on its own, as in
/// `each!((f32, f32) -> bool, |a, b| a < b)`.
macro_rules! each {
    (($a:ty) -> $r:ty, $f:expr) => {
        each!(one1, raw1, all1, $r, <$a, $r>, $f)
    };
    (($a:ty, $b:ty) -> $r:ty, $f:expr) => {
        each!(one2, raw2, all2, $r, <$a, $b, $r>, $f)
    };
    (($a:ty, $b:ty, $c:ty) -> $r:ty, $f:expr) => {
        each!(one3, raw3, all3, $r, <$a, $b, $c, $r>, $f)
    };
    ($one:ident, $raw:ident, $all:ident, $r:ty, <$($t:ty),+>, $f:expr) => {
        $crate::intrinsic::Evaluate::Each {
            scalar: <$r as $crate::intrinsic::lanes::Word>::SCALAR,
            one: |words| $crate::intrinsic::lanes::$one::<$($t),+>(words, $f),
            raw: {
                #[inline(always)]
                fn raw(words: [u32; 3]) -> u32 {
                    $crate::intrinsic::lanes::$raw::<$($t),+>(words, $f)
                }
                raw
            },
            all: |arguments, out| $crate::intrinsic::lanes::$all::<$($t),+>(arguments, out, $f),
        }
    };
}

/// What a row is worth by a function of whole arguments, as in
/// `whole!(([f32; N], [f32; N]) -> f32, value::dot)`, where `N` is the width of the first.
macro_rules! whole {
    (($a:ty) -> $r:ty, $f:expr) => {
        whole!(whole_one1, whole_raw1, whole_all1, $r, <$a, $r>, $f)
    };
    (($a:ty, $b:ty) -> $r:ty, $f:expr) => {
        whole!(whole_one2, whole_raw2, whole_all2, $r, <$a, $b, $r>, $f)
    };
    ($one:ident, $raw:ident, $all:ident, $r:ty, <$($t:ty),+>, $f:expr) => {
        $crate::intrinsic::Evaluate::Whole {
            scalar: {
                #[allow(dead_code, reason = "only some rows have a width")]
                const N: usize = 1;
                <$r as $crate::intrinsic::lanes::Outcome>::SCALAR
            },
            one: |width, arguments| {
                fn one<const N: usize>(arguments: [$crate::graph::Constant; 2]) -> $crate::graph::Constant {
                    $crate::intrinsic::lanes::$one::<$($t),+>(arguments, $f)
                }
                match width {
                    1 => one::<1>(arguments),
                    2 => one::<2>(arguments),
                    3 => one::<3>(arguments),
                    _ => one::<4>(arguments),
                }
            },
            raw: {
                #[inline(always)]
                fn raw<const N: usize>(arguments: [[u32; 4]; 2]) -> [u32; 4] {
                    $crate::intrinsic::lanes::$raw::<$($t),+>(arguments, $f)
                }
                #[inline(always)]
                fn any(width: usize, arguments: [[u32; 4]; 2]) -> [u32; 4] {
                    match width {
                        1 => raw::<1>(arguments),
                        2 => raw::<2>(arguments),
                        3 => raw::<3>(arguments),
                        _ => raw::<4>(arguments),
                    }
                }
                any
            },
            all: |width, arguments, out| {
                fn all<const N: usize>(
                    arguments: [$crate::intrinsic::lanes::Vector<'_>; 2],
                    out: &mut [$crate::intrinsic::lanes::Lanes; 4],
                ) {
                    $crate::intrinsic::lanes::$all::<$($t),+>(arguments, out, $f);
                }
                match width {
                    1 => all::<1>(arguments, out),
                    2 => all::<2>(arguments, out),
                    3 => all::<3>(arguments, out),
                    _ => all::<4>(arguments, out),
                }
            },
        }
    };
}

pub(super) use {each, whole};

#[cfg(test)]
mod tests {
    use super::{LANES, Lanes, ZERO};
    use crate::graph::Constant;
    use crate::intrinsic::{Evaluate, Intrinsic};

    /// Bits that are floats of all kinds, and ints of all kinds.
    fn words(seed: u32) -> Lanes {
        let edges = [0, 1, 2, 5, -1i32 as u32, i32::MIN as u32, 1.5f32.to_bits(), (-0.25f32).to_bits()];
        let word = |i: u32| {
            let random = (i + LANES as u32 * seed).wrapping_mul(2_654_435_769);
            edges.get((random >> 28) as usize).copied().unwrap_or(random.rotate_left(9))
        };
        std::array::from_fn(|i| word(i as u32))
    }

    /// The lanes of every row, at every width, are what the row says of each value.
    #[test]
    fn lanes_are_the_row() {
        let lanes: Vec<Lanes> = (0..12).map(words).collect();
        for intrinsic in Intrinsic::all() {
            for width in 1..=4 {
                let mut out = [ZERO; 4];
                let vector =
                    |k: usize| std::array::from_fn(|c| if c < width { &lanes[4 * k + c] } else { &ZERO });
                match intrinsic.row().value {
                    Evaluate::Each { all, .. } => {
                        for (c, out) in out.iter_mut().enumerate().take(width) {
                            all([&lanes[c], &lanes[4 + c], &lanes[8 + c]], out);
                        }
                    }
                    Evaluate::Whole { all, .. } => all(width, [vector(0), vector(1)], &mut out),
                }
                for i in 0..LANES {
                    let argument = |k: usize| {
                        let word = |c: usize| lanes[4 * k + c][i];
                        Constant::new(crate::graph::Scalar::Int, (0..width).map(word))
                    };
                    let wanted = intrinsic.evaluate(&[argument(0), argument(1), argument(2)]);
                    let found: Vec<u32> =
                        out.iter().map(|lanes| lanes[i]).take(wanted.bits().len()).collect();
                    assert_eq!(found, wanted.bits(), "{} of width {width}", intrinsic.row().name);
                }
            }
        }
    }
}
