//! How far something moves: a sum of products of numbers and atoms, which are numbers that nobody
//! knows before anything is drawn (see [`Atoms`]).
//!
//! Factors are worked out in 64 bits from the 32 bits that a program has. A quotient counts as whole
//! if it is as near to a whole number as the rounding of four floats can bring it, and never farther
//! than 2⁻¹⁰: so 0.1 · 10 and three thirds are 1, and 1000.001 is not 1000.

use super::Atoms;
use smallvec::{SmallVec, smallvec};

/// Sums of more products are not followed.
const MOST_TERMS: usize = 16;
/// Products of more atoms are not followed.
const MOST_ATOMS: usize = 6;
/// Greater denominators of a common measure are not looked for.
const MOST_DENOMINATOR: u32 = 64;
/// How far from a whole number a quotient may be, as a part of it: 2⁻²², what four floats lose.
const NEAR: f64 = 1.0 / 4_194_304.0;
/// How far it may be at most: 2⁻¹⁰.
const NEAR_AT_MOST: f64 = 1.0 / 1024.0;
/// What is left of a difference of equals, as a part of them, in 64 bits.
const LEFT_OVER: f64 = 1e-13;

/// A sum of products; 0 has none.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Amount(SmallVec<[Term; 1]>);

/// A number times atoms.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Term {
    /// In ascending order; a power is written several times.
    atoms: SmallVec<[u32; 4]>,
    /// The bits of a finite float, not 0.
    factor: u64,
}

impl Term {
    fn factor(&self) -> f64 {
        f64::from_bits(self.factor)
    }

    fn with(&self, factor: f64) -> Term {
        Term { atoms: self.atoms.clone(), factor: factor.to_bits() }
    }
}

impl Amount {
    /// A number.
    pub fn number(x: f64) -> Amount {
        Amount::of(SmallVec::new(), x)
    }

    /// An atom.
    pub fn atom(atom: u32) -> Amount {
        Amount::of(smallvec![atom], 1.0)
    }

    fn of(atoms: SmallVec<[u32; 4]>, factor: f64) -> Amount {
        if factor == 0.0 {
            Amount::default()
        } else {
            Amount(smallvec![Term { atoms, factor: factor.to_bits() }])
        }
    }

    /// Whether it is nothing.
    pub fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    /// The number that it is, if it has no atoms.
    pub fn as_number(&self) -> Option<f64> {
        match self.0.as_slice() {
            [] => Some(0.0),
            [term] if term.atoms.is_empty() => Some(term.factor()),
            _ => None,
        }
    }

    /// The greatest of the numbers before its products.
    pub fn greatest_factor(&self) -> f64 {
        self.0.iter().map(|term| term.factor().abs()).fold(0.0, f64::max)
    }

    /// The sum; none if it has too many terms.
    pub fn plus(&self, other: &Amount) -> Option<Amount> {
        let mut sum = self.0.clone();
        for term in &other.0 {
            let Some(place) = sum.iter().position(|own| own.atoms == term.atoms) else {
                sum.push(term.clone());
                continue;
            };
            let (a, b) = (sum[place].factor(), term.factor());
            if (a + b).abs() <= LEFT_OVER * a.abs() {
                sum.remove(place);
            } else {
                sum[place] = term.with(a + b);
            }
        }
        Amount::sorted(sum)
    }

    fn sorted(mut terms: SmallVec<[Term; 1]>) -> Option<Amount> {
        terms.sort_by(|a, b| a.atoms.cmp(&b.atoms));
        let is_finite = terms.iter().all(|term| term.factor().is_finite());
        (is_finite && terms.len() <= MOST_TERMS).then_some(Amount(terms))
    }

    /// So many times as much.
    pub fn scaled(&self, by: f64) -> Amount {
        let terms = self.0.iter().map(|term| term.with(term.factor() * by));
        Amount(terms.filter(|term| term.factor() != 0.0).collect())
    }

    /// The negative.
    pub fn negative(&self) -> Amount {
        self.scaled(-1.0)
    }

    /// The product; none if it is too long.
    pub fn times(&self, other: &Amount) -> Option<Amount> {
        let mut product = Amount::default();
        for a in &self.0 {
            for b in &other.0 {
                let mut atoms: SmallVec<[u32; 4]> = a.atoms.iter().chain(&b.atoms).copied().collect();
                atoms.sort_unstable();
                if atoms.len() > MOST_ATOMS {
                    return None;
                }
                product = product.plus(&Amount::of(atoms, a.factor() * b.factor()))?;
            }
        }
        Some(product)
    }

    /// The quotient by a single product; none where it would have a fraction of an atom.
    fn over(&self, other: &Amount) -> Option<Amount> {
        let [divisor] = other.0.as_slice() else { return None };
        let quotient = self.0.iter().map(|term| {
            let atoms = without(&term.atoms, &divisor.atoms)?;
            Some(Term { atoms, factor: (term.factor() / divisor.factor()).to_bits() })
        });
        Amount::sorted(quotient.collect::<Option<_>>()?)
    }

    /// How often another amount, which is not 0, goes into it: a whole number of times, whatever the
    /// atoms are. None where that is not sure.
    pub fn multiple_of(&self, other: &Amount, atoms: &Atoms) -> Option<Amount> {
        let quotient = self.over(other)?;
        let terms = quotient.0.iter().map(|term| {
            let is_whole = term.atoms.iter().all(|atom| atoms.is_int(*atom));
            near_whole(term.factor()).filter(|_| is_whole).map(|whole| term.with(whole))
        });
        Some(Amount(terms.collect::<Option<_>>()?))
    }

    /// Whether it is a whole number, exactly, whatever the atoms are.
    pub fn is_whole(&self, atoms: &Atoms) -> bool {
        self.0
            .iter()
            .all(|term| term.factor().fract() == 0.0 && term.atoms.iter().all(|atom| atoms.is_int(*atom)))
    }

    /// The exact quotient by a number or product that can't be 0; none where there is none.
    pub fn divided(&self, other: &Amount) -> Option<Amount> {
        self.over(other)
    }

    /// A common measure: both are whole multiples of it, whatever the atoms are. None where none is
    /// found.
    pub fn measure(&self, other: &Amount, atoms: &Atoms) -> Option<Amount> {
        let mut terms = self.0.iter().chain(&other.0);
        let first = terms.next()?;
        let (mut common, mut factor) = (first.atoms.clone(), first.factor().abs());
        for term in terms {
            factor = common_factor(factor, term.factor().abs())?;
            let rest = without_what_is(&common, &term.atoms);
            common = without(&common, &rest)?;
        }
        let measure = Amount::of(common, factor);
        let divides = |amount: &Amount| amount.multiple_of(&measure, atoms).is_some();
        (divides(self) && divides(other)).then_some(measure)
    }

    /// The least and the greatest number that it may be.
    pub fn bounds(&self, atoms: &Atoms) -> (f64, f64) {
        let mut sum = (0.0, 0.0);
        for term in &self.0 {
            let start = (term.factor(), term.factor());
            let (low, high) = term.atoms.iter().fold(start, |range, atom| times(range, atoms.bounds(*atom)));
            sum = (sum.0 + low, sum.1 + high);
        }
        if sum.0.is_nan() || sum.1.is_nan() { (f64::NEG_INFINITY, f64::INFINITY) } else { sum }
    }

    /// In the words of an error: `2.5`, `0.5·cells`.
    pub fn show(&self, atoms: &Atoms) -> String {
        let term = |term: &Term| {
            let names = term.atoms.iter().map(|atom| atoms.name(*atom));
            let number = show_number(term.factor());
            let number = if number == "1" && !term.atoms.is_empty() { None } else { Some(number) };
            number.into_iter().chain(names).collect::<Vec<_>>().join("·")
        };
        let terms: Vec<String> = self.0.iter().map(term).collect();
        if terms.is_empty() { "0".to_owned() } else { terms.join(" + ") }
    }
}

/// A number with as many digits as a reader wants.
pub fn show_number(x: f64) -> String {
    let digits = 5 - (x.abs().max(1e-6).log10().floor() as i32).clamp(-6, 5);
    let text = format!("{x:.*}", digits.max(0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// The whole number that a quotient is, up to the rounding of floats.
pub fn near_whole(x: f64) -> Option<f64> {
    let whole = x.round();
    ((x - whole).abs() <= (whole.abs() * NEAR).min(NEAR_AT_MOST)).then_some(whole)
}

/// Atoms without others that must be among them.
fn without(atoms: &[u32], others: &[u32]) -> Option<SmallVec<[u32; 4]>> {
    let mut rest: SmallVec<[u32; 4]> = atoms.into();
    for other in others {
        let place = rest.iter().position(|atom| atom == other)?;
        rest.remove(place);
    }
    Some(rest)
}

/// Those of some atoms that are not among others.
fn without_what_is(atoms: &[u32], others: &[u32]) -> SmallVec<[u32; 4]> {
    let mut others: SmallVec<[u32; 4]> = others.into();
    let mut rest: SmallVec<[u32; 4]> = atoms.into();
    rest.retain(|atom| match others.iter().position(|other| other == atom) {
        Some(place) => {
            others.remove(place);
            false
        }
        None => true,
    });
    rest
}

/// The greatest number of which both are whole multiples, if their ratio is a simple fraction.
fn common_factor(a: f64, b: f64) -> Option<f64> {
    let denominator = (1..=MOST_DENOMINATOR).map(f64::from).find(|n| near_whole(a * n / b).is_some())?;
    Some(b / denominator)
}

/// The product of two ranges; 0 times anything is 0.
fn times(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    let product = |x: f64, y: f64| if x == 0.0 || y == 0.0 { 0.0 } else { x * y };
    let all = [product(a.0, b.0), product(a.0, b.1), product(a.1, b.0), product(a.1, b.1)];
    all.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)))
}

#[cfg(test)]
mod tests {
    use super::{Amount, Atoms, near_whole, show_number};

    #[test]
    fn only_rounding_is_forgiven() {
        let tenth = f64::from(0.1f32);
        assert_eq!(near_whole(tenth * 10.0), Some(1.0));
        assert_eq!(near_whole(f64::from(1.0f32 / 3.0) * 3.0), Some(1.0));
        assert_eq!(near_whole(f64::from(1000.001f32)), None);
        assert_eq!(near_whole(1e-7), None, "nothing but 0 is 0");
        assert_eq!(near_whole(100_000.01), None, "never farther than 2⁻¹⁰");
    }

    #[test]
    fn a_measure_divides_both() {
        let atoms = Atoms::default();
        let measure = |a: f64, b: f64| {
            Amount::number(a).measure(&Amount::number(b), &atoms).and_then(|amount| amount.as_number())
        };
        assert_eq!(measure(0.5, 0.75), Some(0.25));
        assert_eq!(measure(4.0, -6.0), Some(2.0));
        assert_eq!(measure(1.0, std::f64::consts::SQRT_2), None);
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(show_number(2.5), "2.5");
        assert_eq!(show_number(-1.0 / 3.0), "-0.333333");
        assert_eq!(show_number(4.0), "4");
        assert_eq!(show_number(1e9), "1000000000");
    }
}
