//! How intrinsics repeat: what becomes of a component of the result where the place moves by a
//! period, by what becomes of the arguments. None of these is given a broken argument, and known
//! arguments are evaluated instead.

use super::value::LEAST;
use crate::graph::{Constant, Scalar};
use crate::tiling::{Amount, Atoms, Shift, Source, Why};

/// How an intrinsic repeats.
#[derive(Clone, Copy)]
pub enum Tiling {
    /// Where all its arguments do, and not otherwise.
    Plain,
    /// By this rule.
    By(fn(&mut Arguments) -> Result<Shift, Why>),
}

/// What a rule works with.
pub struct Arguments<'a> {
    /// The components of each argument.
    pub arguments: &'a [&'a [Shift]],
    /// Which component of the result is asked for.
    pub component: usize,
    /// The index of the intrinsic's row.
    pub row: usize,
    /// What a component of the result is.
    pub scalar: Scalar,
    /// What is known only when drawing.
    pub atoms: &'a mut Atoms,
}

/// An int that moves farther in one period leaves the ints in a few.
const FARTHEST_INT: f64 = 16_777_216.0;

/// Longer names of quotients are not shown.
const MOST_LETTERS: usize = 30;

impl Arguments<'_> {
    /// The component of argument `i` that stands where the result's does.
    fn x(&self, i: usize) -> &Shift {
        let components = self.arguments[i];
        &components[self.component.min(components.len() - 1)]
    }

    /// The sum of two components, or their difference.
    fn sum(&self, is_difference: bool) -> Result<Shift, Why> {
        let is_far = |i: usize| {
            let number = self.x(i).amount().and_then(|amount| amount.as_number());
            number.is_some_and(|number| number.abs() > FARTHEST_INT)
        };
        let sum = self.x(0).plus(self.x(1), is_difference, self.atoms)?;
        if self.scalar == Scalar::Int && !sum.repeats() && (is_far(0) || is_far(1)) {
            return Err(Why::Wraps);
        }
        within_ints(sum, self.scalar)
    }

    fn show(&self, i: usize) -> String {
        self.x(i).show(self.atoms)
    }

    /// Whether argument `i` moves by whole multiples of an amount, or repeats.
    fn is_multiple(&self, i: usize, of: &Amount) -> bool {
        let step = self.x(i).step();
        step.is_zero() || (!of.is_zero() && step.multiple_of(of, self.atoms).is_some())
    }

    /// The same of an amount that is a number, in the words of an error.
    fn must_be_multiple(&self, i: usize, of: &Amount, named: Option<&str>) -> Result<(), Why> {
        let of_what = || named.map_or_else(|| of.show(self.atoms), str::to_owned);
        let wrong = || Why::NotMultiple { by: self.show(i), of: of_what() };
        self.is_multiple(i, of).then_some(()).ok_or_else(wrong)
    }

    /// What the components that stand where the result's does have in common: they all move alike.
    fn together(&self, count: usize) -> Result<Amount, Why> {
        let first = self.x(0).exact();
        for i in 1..count {
            if first.is_none() || self.x(i).exact() != first {
                return Err(Why::Apart { by: self.show(0), other: self.show(i) });
            }
        }
        first.ok_or_else(|| Why::Moves { by: self.show(0) })
    }

    /// A result that repeats: an atom, if all that it is made of is the same everywhere.
    pub fn repeated(&mut self) -> Shift {
        let whole = self.scalar != Scalar::Float;
        let all = self.arguments.iter().flat_map(|components| components.iter());
        let Some(amounts) = all.map(Shift::amount).collect::<Option<Vec<Amount>>>() else {
            return Shift::Same { whole };
        };
        let source = Source::Of(self.row, amounts, self.component as u8);
        let bounds =
            if self.scalar == Scalar::Bool { (0.0, 1.0) } else { (f64::NEG_INFINITY, f64::INFINITY) };
        Shift::Uniform(self.atoms.of(source, || ("…".to_owned(), whole, bounds)))
    }

    /// A whole number that repeats.
    fn repeated_whole(&mut self) -> Shift {
        match self.repeated() {
            Shift::Same { .. } => Shift::Same { whole: true },
            known => known,
        }
    }

    /// All arguments repeat, or one of them breaks it.
    pub fn all_repeat(&self) -> Result<(), Why> {
        let moving = self.arguments.iter().flat_map(|components| components.iter()).find(|x| !x.repeats());
        moving.map_or(Ok(()), |moving| Err(Why::Moves { by: moving.show(self.atoms) }))
    }
}

/// Ints that leave the ints soon wrap at other places in each period.
fn within_ints(shift: Shift, scalar: Scalar) -> Result<Shift, Why> {
    let is_far = scalar == Scalar::Int && shift.step().greatest_factor() > FARTHEST_INT;
    if is_far { Err(Why::Wraps) } else { Ok(shift) }
}

/// Of a negation.
pub fn negate(a: &mut Arguments) -> Result<Shift, Why> {
    Shift::int(0).plus(a.x(0), true, a.atoms)
}

/// Of a sum.
pub fn add(a: &mut Arguments) -> Result<Shift, Why> {
    a.sum(false)
}

/// Of a difference: what moves alike has one that repeats.
pub fn subtract(a: &mut Arguments) -> Result<Shift, Why> {
    a.sum(true)
}

/// Of a product.
pub fn multiply(a: &mut Arguments) -> Result<Shift, Why> {
    within_ints(a.x(0).times(a.x(1), a.atoms)?, a.scalar)
}

/// Of a quotient of floats: by what is the same everywhere it moves too.
pub fn divide(a: &mut Arguments) -> Result<Shift, Why> {
    let (of, by) = (a.x(0).clone(), a.x(1).clone());
    if of.repeats() && by.repeats() {
        return Ok(a.repeated());
    }
    let Some(divisor) = by.amount() else { return Err(Why::Moves { by: moving_of(a) }) };
    let part = |step: &Amount, a: &mut Arguments| match divisor.as_number() {
        Some(number) if number.abs() >= LEAST.into() => Ok(step.scaled(1.0 / number)),
        Some(_) => Ok(Amount::default()),
        None => quotient(step, &divisor, a).ok_or(Why::TooLong),
    };
    match of {
        Shift::Moves { by, .. } => Ok(Shift::moving(part(&by, a)?, false)),
        Shift::Varies { by, .. } => Ok(Shift::varying(part(&by, a)?, false)),
        _ => Err(Why::Moves { by: moving_of(a) }),
    }
}

/// A quotient by what only drawing tells: exact where that can't be 0, else times one over it.
fn quotient(step: &Amount, divisor: &Amount, a: &mut Arguments) -> Option<Amount> {
    let is_safe = divisor.is_whole(a.atoms) && is_not_zero(divisor, a.atoms);
    let exact = step.divided(divisor).filter(|_| is_safe);
    exact.or_else(|| {
        let source = Source::Of(a.row, vec![divisor.clone()], 0);
        let name = divisor.show(a.atoms);
        let name = if name.len() > MOST_LETTERS { "…".to_owned() } else { format!("1/({name})") };
        let one_over = a.atoms.of(source, || (name, false, (f64::NEG_INFINITY, f64::INFINITY)));
        step.times(&one_over)
    })
}

fn is_not_zero(amount: &Amount, atoms: &Atoms) -> bool {
    let (low, high) = amount.bounds(atoms);
    low >= LEAST.into() || high <= (-LEAST).into()
}

/// How the first argument that moves does.
fn moving_of(a: &Arguments) -> String {
    let moving = (0..a.arguments.len()).find(|i| !a.x(*i).repeats());
    moving.map_or(String::new(), |i| a.show(i))
}

/// Of a quotient of ints, rounded down: it moves where the dividend moves by multiples of the
/// divisor.
pub fn divide_int(a: &mut Arguments) -> Result<Shift, Why> {
    if a.x(0).repeats() && a.x(1).repeats() {
        return Ok(a.repeated());
    }
    let Some(divisor) = a.x(1).amount().filter(|divisor| is_not_zero(divisor, a.atoms)) else {
        return Err(Why::Moves { by: moving_of(a) });
    };
    a.must_be_multiple(0, &divisor, None)?;
    let part = |step: &Amount| step.multiple_of(&divisor, a.atoms).unwrap_or_default();
    Ok(match a.x(0) {
        Shift::Varies { by, .. } => Shift::varying(part(by), true),
        other => Shift::moving(part(&other.step()), true),
    })
}

/// Of a remainder: it repeats where the dividend moves by multiples of the divisor.
pub fn remainder(a: &mut Arguments) -> Result<Shift, Why> {
    if a.x(0).repeats() && a.x(1).repeats() {
        let is_whole = a.x(0).is_whole(a.atoms) && a.x(1).is_whole(a.atoms);
        return Ok(if is_whole { a.repeated_whole() } else { a.repeated() });
    }
    let Some(divisor) = a.x(1).amount() else { return Err(Why::Moves { by: moving_of(a) }) };
    if !divisor.is_zero() {
        a.must_be_multiple(0, &divisor, None)?;
    }
    Ok(Shift::Same { whole: a.x(0).is_whole(a.atoms) && divisor.is_whole(a.atoms) })
}

/// Of a comparison: it repeats where both sides move alike.
fn compare(a: &mut Arguments, truth: fn((f64, f64)) -> Option<bool>) -> Result<Shift, Why> {
    a.together(2)?;
    let known = difference(a).and_then(truth);
    Ok(known.map_or_else(|| a.repeated(), |holds| Shift::Known(Constant::bools(&[holds]))))
}

/// Between what numbers the difference of two whole ones lies, if that is known without rounding.
fn difference(a: &Arguments) -> Option<(f64, f64)> {
    let (left, right) = (a.x(0).amount()?, a.x(1).amount()?);
    let is_exact = |amount: &Amount| {
        let (low, high) = amount.bounds(a.atoms);
        amount.is_whole(a.atoms) && low >= -FARTHEST_INT && high <= FARTHEST_INT
    };
    let is_known = is_exact(&left) && is_exact(&right);
    Some(left.plus(&right.negative()).filter(|_| is_known)?.bounds(a.atoms))
}

/// Of `<`
pub fn less(a: &mut Arguments) -> Result<Shift, Why> {
    compare(a, |(low, high)| (high < 0.0).then_some(true).or((low >= 0.0).then_some(false)))
}

/// Of `<=`
pub fn less_equal(a: &mut Arguments) -> Result<Shift, Why> {
    compare(a, |(low, high)| (high <= 0.0).then_some(true).or((low > 0.0).then_some(false)))
}

/// Of `>`
pub fn greater(a: &mut Arguments) -> Result<Shift, Why> {
    compare(a, |(low, high)| (low > 0.0).then_some(true).or((high <= 0.0).then_some(false)))
}

/// Of `>=`
pub fn greater_equal(a: &mut Arguments) -> Result<Shift, Why> {
    compare(a, |(low, high)| (low >= 0.0).then_some(true).or((high < 0.0).then_some(false)))
}

/// Of whether whole vectors are equal: each pair of components moves alike.
pub fn equal(a: &mut Arguments) -> Result<Shift, Why> {
    equality(a, true)
}

/// Of whether they differ.
pub fn not_equal(a: &mut Arguments) -> Result<Shift, Why> {
    equality(a, false)
}

fn equality(a: &mut Arguments, if_equal: bool) -> Result<Shift, Why> {
    let mut is_unequal = false;
    for component in 0..a.arguments[0].len() {
        a.component = component;
        a.together(2)?;
        is_unequal |= difference(a).is_some_and(|(low, high)| low > 0.0 || high < 0.0);
    }
    a.component = 0;
    let unequal = || Shift::Known(Constant::bools(&[!if_equal]));
    Ok(if is_unequal { unequal() } else { a.repeated() })
}

/// Of a conjunction: one that never holds decides.
pub fn and(a: &mut Arguments) -> Result<Shift, Why> {
    decided(a, false)
}

/// Of a disjunction: one that always holds decides.
pub fn or(a: &mut Arguments) -> Result<Shift, Why> {
    decided(a, true)
}

fn decided(a: &mut Arguments, by: bool) -> Result<Shift, Why> {
    let [x, y] = [0, 1].map(|i| a.x(i).truth());
    Ok(match (x, y) {
        (Some(truth), _) if truth == by => a.x(0).clone(),
        (_, Some(truth)) if truth == by => a.x(1).clone(),
        (Some(_), _) => a.x(1).clone(),
        (_, Some(_)) => a.x(0).clone(),
        _ => a.repeated(),
    })
}

/// Of what rounds to one side: it moves as its argument does, if that is by whole numbers.
pub fn floor(a: &mut Arguments) -> Result<Shift, Why> {
    rounded(a, 1.0)
}

/// Of what rounds halves to the even number: that is the same by even numbers only.
pub fn round(a: &mut Arguments) -> Result<Shift, Why> {
    rounded(a, 2.0)
}

fn rounded(a: &mut Arguments, unit: f64) -> Result<Shift, Why> {
    let x = a.x(0).clone();
    if x.is_whole(a.atoms) {
        return Ok(x);
    }
    a.must_be_multiple(0, &Amount::number(unit), None)?;
    let whole = |by: &Amount| by.multiple_of(&Amount::number(1.0), a.atoms).unwrap_or_default();
    match &x {
        Shift::Moves { by, .. } => within_ints(Shift::moving(whole(by), true), a.scalar),
        Shift::Varies { by, .. } => within_ints(Shift::varying(whole(by), true), a.scalar),
        Shift::Uniform(_) => match a.repeated() {
            Shift::Uniform(amount) => Ok(Shift::Uniform(a.named_whole(amount))),
            other => Ok(other),
        },
        _ => Ok(Shift::Same { whole: true }),
    }
}

impl Arguments<'_> {
    /// An atom that is a whole number, in the place of one that may not be said to be.
    fn named_whole(&mut self, amount: Amount) -> Amount {
        let source = Source::Of(usize::MAX, vec![amount], 0);
        self.atoms.of(source, || ("…".to_owned(), true, (f64::NEG_INFINITY, f64::INFINITY)))
    }
}

/// Of what is left after rounding down.
pub fn fract(a: &mut Arguments) -> Result<Shift, Why> {
    a.must_be_multiple(0, &Amount::number(1.0), None)?;
    Ok(if a.x(0).repeats() { a.repeated() } else { Shift::Same { whole: false } })
}

/// Of an int of a float: one that is whole already moves on.
pub fn to_int(a: &mut Arguments) -> Result<Shift, Why> {
    match a.x(0).clone() {
        x if x.is_whole(a.atoms) => within_ints(x, Scalar::Int),
        x if x.repeats() => Ok(a.repeated_whole()),
        x => Err(Why::Truncates { by: x.show(a.atoms) }),
    }
}

/// Of a float of an int.
pub fn to_float(a: &mut Arguments) -> Result<Shift, Why> {
    Ok(a.x(0).clone())
}

/// Of one of two, or of what lies between them: all move alike.
pub fn either(a: &mut Arguments) -> Result<Shift, Why> {
    among(a, 2)
}

/// Of a number held between two others: all move alike.
pub fn clamp(a: &mut Arguments) -> Result<Shift, Why> {
    among(a, 3)
}

fn among(a: &mut Arguments, count: usize) -> Result<Shift, Why> {
    let by = a.together(count)?;
    if by.is_zero() {
        let is_whole = (0..count).all(|i| a.x(i).is_whole(a.atoms));
        return Ok(if is_whole { a.repeated_whole() } else { a.repeated() });
    }
    let whole = (0..count).all(|i| a.x(i).is_whole(a.atoms));
    Ok(Shift::moving(by, whole))
}

/// Of a mixture: its ends move alike, and its share repeats.
pub fn mix(a: &mut Arguments) -> Result<Shift, Why> {
    if !a.x(2).repeats() {
        return Err(Why::Moves { by: a.show(2) });
    }
    let by = a.together(2)?;
    Ok(if by.is_zero() { a.repeated() } else { Shift::moving(by, false) })
}

/// Of a step, which has no derivative: the edge moves as what is held against it.
pub fn step(a: &mut Arguments) -> Result<Shift, Why> {
    a.together(2)?;
    Ok(Shift::Same { whole: true })
}

/// Of a smooth step: its bounds move as what is held against them.
pub fn smoothstep(a: &mut Arguments) -> Result<Shift, Why> {
    a.together(3)?;
    Ok(Shift::Same { whole: false })
}

/// Of a sine or cosine.
pub fn wave(a: &mut Arguments) -> Result<Shift, Why> {
    turning(a, std::f64::consts::TAU, "a turn (`1turn`)")
}

/// Of a tangent.
pub fn tangent(a: &mut Arguments) -> Result<Shift, Why> {
    turning(a, std::f64::consts::PI, "half a turn (`0.5turn`)")
}

fn turning(a: &mut Arguments, period: f64, named: &str) -> Result<Shift, Why> {
    a.must_be_multiple(0, &Amount::number(period), Some(named))?;
    Ok(if a.x(0).repeats() { a.repeated() } else { Shift::Same { whole: false } })
}

/// Of a dot product: the sum of the products.
pub fn dot(a: &mut Arguments) -> Result<Shift, Why> {
    let mut sum = Shift::float(0.0);
    for component in 0..a.arguments[0].len() {
        a.component = component;
        sum = sum.plus(&a.x(0).times(a.x(1), a.atoms)?, false, a.atoms)?;
    }
    Ok(sum)
}

/// Of a value that a narrower pixel sees: it is the value, whose width repeats.
pub fn narrow(a: &mut Arguments) -> Result<Shift, Why> {
    if a.x(1).repeats() { Ok(a.x(0).clone()) } else { Err(Why::Moves { by: a.show(1) }) }
}

/// Of a distance: between what moves alike.
pub fn distance(a: &mut Arguments) -> Result<Shift, Why> {
    for component in 0..a.arguments[0].len() {
        a.component = component;
        a.together(2)?;
    }
    Ok(Shift::Same { whole: false })
}

/// Of a component, the index clamped.
pub fn component(a: &mut Arguments) -> Result<Shift, Why> {
    let (all, index) = (a.arguments[0], &a.arguments[1][0]);
    if !index.repeats() {
        return Err(Why::Moves { by: index.show(a.atoms) });
    }
    if let Shift::Known(index) = index {
        let last = all.len() - 1;
        return Ok(all[(index.int(0).max(0) as usize).min(last)].clone());
    }
    let mut any = all[0].clone();
    for other in &all[1..] {
        any = any.or(other, a.atoms)?;
    }
    Ok(any)
}

/// Of the component-wise choice of two.
pub fn choose(a: &mut Arguments) -> Result<Shift, Why> {
    match a.x(0).truth() {
        Some(true) => Ok(a.x(1).clone()),
        Some(false) => Ok(a.x(2).clone()),
        None if a.x(0).repeats() => a.x(1).or(a.x(2), a.atoms),
        None => Err(Why::Moves { by: a.show(0) }),
    }
}

/// Of bits of an int: those that are cut out repeat where it moves by multiples of the next one.
pub fn bits(a: &mut Arguments) -> Result<Shift, Why> {
    if a.x(0).repeats() {
        a.all_repeat()?;
        return Ok(a.repeated());
    }
    let known = |i: usize| a.x(i).amount().and_then(|amount| amount.as_number());
    let (Some(first), Some(count)) = (known(1), known(2)) else { return Err(Why::Moves { by: a.show(0) }) };
    let above = first.clamp(0.0, 31.0) + count.clamp(0.0, 32.0);
    a.must_be_multiple(0, &Amount::number(above.min(32.0).exp2()), None)?;
    Ok(Shift::Same { whole: true })
}

#[cfg(test)]
mod tests;
