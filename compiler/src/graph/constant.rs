//! Known numbers: what a [`Constant`] operation holds, and how the CPU carries any value.

use super::{Scalar, Type};

/// One to four components of one type, compared and hashed by their bits.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Constant {
    scalar: Scalar,
    width: u8,
    bits: [u32; 4],
}

impl Constant {
    /// Floats. At most four count.
    pub fn floats(components: &[f32]) -> Constant {
        Constant::new(Scalar::Float, components.iter().map(|f| f.to_bits()))
    }

    /// Ints. At most four count.
    pub fn ints(components: &[i32]) -> Constant {
        Constant::new(Scalar::Int, components.iter().map(|i| *i as u32))
    }

    /// Bools. At most four count.
    pub fn bools(components: &[bool]) -> Constant {
        Constant::new(Scalar::Bool, components.iter().map(|b| u32::from(*b)))
    }

    /// From the bits of each component.
    pub fn new(scalar: Scalar, components: impl IntoIterator<Item = u32>) -> Constant {
        let mut bits = [0; 4];
        let mut width = 0;
        for (slot, component) in bits.iter_mut().zip(components) {
            *slot = component;
            width += 1;
        }
        Constant { scalar, width, bits }
    }

    /// All components 0 or false.
    pub fn zero(scalar: Scalar, width: u8) -> Constant {
        Constant { scalar, width, bits: [0; 4] }
    }

    /// Its type.
    pub fn ty(&self) -> Type {
        Type::Vector(self.scalar, self.width)
    }

    /// The type of a component.
    pub fn scalar(&self) -> Scalar {
        self.scalar
    }

    /// Components.
    pub fn width(&self) -> u8 {
        self.width
    }

    /// The bits of each component.
    pub fn bits(&self) -> &[u32] {
        &self.bits[..usize::from(self.width)]
    }

    /// Component `i` as a float; meaningful for floats only. Beyond the last component: 0.
    pub fn float(&self, i: usize) -> f32 {
        f32::from_bits(self.bits.get(i).copied().unwrap_or(0))
    }

    /// Component `i` as an int; meaningful for ints only. Beyond the last component: 0.
    pub fn int(&self, i: usize) -> i32 {
        self.bits.get(i).copied().unwrap_or(0) as i32
    }

    /// Component `i` as a bool; meaningful for bools only. Beyond the last component: false.
    pub fn bool(&self, i: usize) -> bool {
        self.bits.get(i).copied().unwrap_or(0) != 0
    }

    /// One component as a scalar.
    pub fn component(&self, i: usize) -> Constant {
        Constant::new(self.scalar, [self.bits.get(i).copied().unwrap_or(0)])
    }

    /// Whether all components are the same, bit for bit.
    pub fn is_splat(&self) -> bool {
        self.bits().iter().all(|bits| *bits == self.bits[0])
    }

    /// A scalar in every component.
    pub fn splat(&self, width: u8) -> Constant {
        Constant::new(self.scalar, std::iter::repeat_n(self.bits[0], usize::from(width)))
    }
}

impl std::fmt::Debug for Constant {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let components: Vec<String> = (0..usize::from(self.width))
            .map(|i| match self.scalar {
                Scalar::Float => format!("{:?}", self.float(i)),
                Scalar::Int => self.int(i).to_string(),
                Scalar::Bool => self.bool(i).to_string(),
            })
            .collect();
        write!(f, "{}", components.join(", "))
    }
}
