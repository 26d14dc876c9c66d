//! Every rule held against what its row computes.

use super::{Arguments, Tiling};
use crate::graph::{Constant, Scalar};
use crate::intrinsic::{Intrinsic, TABLE};
use crate::tiling::{Amount, Atoms, Shift, near_whole};

/// Numbers at random.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, sides: i32) -> i32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        ((self.0 >> 33) as i32).rem_euclid(sides)
    }

    /// A component here, the same a period on, and what is said of it.
    fn component(&mut self, scalar: Scalar) -> (f64, f64, Shift) {
        let is_whole = scalar != Scalar::Float || self.roll(2) == 0;
        let unit = if is_whole { 1.0 } else { 0.25 };
        let x = f64::from(self.roll(17) - 8) * unit;
        let step = f64::from([1, 2, 3, 4, 6, 8][self.roll(6) as usize]) * unit;
        let by = Amount::number(step);
        match self.roll(5) {
            _ if scalar == Scalar::Bool => (x.abs() % 2.0, x.abs() % 2.0, Shift::Same { whole: true }),
            0 => (x, x, Shift::Known(constant(scalar, [x]))),
            1 => (x, x, Shift::Same { whole: is_whole }),
            2 | 3 => (x, x + step, Shift::Moves { by, whole: is_whole }),
            _ => (x, x + step * f64::from(self.roll(5) - 2), Shift::Varies { by, whole: is_whole }),
        }
    }
}

fn constant(scalar: Scalar, numbers: impl IntoIterator<Item = f64>) -> Constant {
    let bits = numbers.into_iter().map(|x| match scalar {
        Scalar::Float => (x as f32).to_bits(),
        Scalar::Int | Scalar::Bool => x as i32 as u32,
    });
    Constant::new(scalar, bits)
}

fn number(c: &Constant, i: usize) -> f64 {
    if c.scalar() == Scalar::Float { c.float(i).into() } else { c.int(i).into() }
}

/// What the inputs of a row are, dimensions being 3.
fn inputs(signature: &str) -> Vec<(Scalar, usize)> {
    let inside = signature.split_once('(').and_then(|(_, rest)| rest.split_once(')')).expect("inputs").0;
    let ty = |input: &str| {
        let name = input.split_once(": ").expect("a type").1.split(' ').next().unwrap_or_default();
        let (name, width) = match name.split_once('<') {
            Some((name, _)) => (name, 3),
            None => match name.strip_suffix(|c: char| c.is_ascii_digit()) {
                Some(stem) => (stem, name[stem.len()..].parse().expect("a width")),
                None => (name, 1),
            },
        };
        let scalar = match name {
            "int" | "ivec" => Scalar::Int,
            "bool" | "bvec" => Scalar::Bool,
            _ => Scalar::Float,
        };
        (scalar, width)
    };
    inside.split(", ").map(ty).collect()
}

/// Whether what is said of a component is so.
fn holds(said: &Shift, here: f64, there: f64) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-4 * a.abs().max(1.0);
    let whole = said.is_whole(&Atoms::default());
    let is_whole = !whole || (here.fract() == 0.0 && there.fract() == 0.0);
    is_whole
        && match said {
            Shift::Known(c) => near(here, number(c, 0)) && near(there, number(c, 0)),
            Shift::Uniform(amount) => amount.as_number().is_none_or(|x| near(here, x)) && near(here, there),
            Shift::Same { .. } => near(here, there),
            Shift::Moves { by, .. } => near(there - here, by.as_number().expect("a number")),
            Shift::Varies { by, .. } => {
                let steps = (there - here) / by.as_number().expect("a number");
                near_whole(steps).is_some() || near(steps, steps.round())
            }
            Shift::Broken(_) => true,
        }
}

#[test]
fn every_rule_says_what_its_row_does() {
    let mut dice = Dice(0x9E37_79B9_7F4A_7C15);
    for intrinsic in Intrinsic::all() {
        let row = intrinsic.row();
        let inputs = inputs(row.signature);
        let mut said = 0;
        for _ in 0..3000 {
            let (mut here, mut there, mut shifts) = (Vec::new(), Vec::new(), Vec::new());
            for (scalar, width) in &inputs {
                let components: Vec<(f64, f64, Shift)> =
                    (0..*width).map(|_| dice.component(*scalar)).collect();
                here.push(constant(*scalar, components.iter().map(|(x, ..)| *x)));
                there.push(constant(*scalar, components.iter().map(|(_, x, _)| *x)));
                shifts.push(components.into_iter().map(|(.., shift)| shift).collect::<Vec<_>>());
            }
            let (here, there) = (intrinsic.evaluate(&here), intrinsic.evaluate(&there));
            let arguments: Vec<&[Shift]> = shifts.iter().map(Vec::as_slice).collect();
            let atoms = &mut Atoms::default();
            for component in 0..usize::from(here.width()) {
                let scalar = here.scalar();
                let row_index = intrinsic.index();
                let mut of = Arguments { arguments: &arguments, component, row: row_index, scalar, atoms };
                let result = match row.tiling {
                    Tiling::Plain => of.all_repeat().map(|()| of.repeated()),
                    Tiling::By(rule) => rule(&mut of),
                };
                let Ok(shift) = result else { continue };
                said += 1;
                let numbers = (number(&here, component), number(&there, component));
                assert!(
                    holds(&shift, numbers.0, numbers.1),
                    "{} of {shifts:?}: {shift:?}, and {numbers:?}",
                    row.name
                );
            }
        }
        assert!(said > 0, "{} says nothing", row.name);
    }
    assert!(TABLE.iter().any(|row| matches!(row.tiling, Tiling::By(_))));
}
