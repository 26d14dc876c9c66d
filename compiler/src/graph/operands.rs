//! The operands of an operation.

use super::Value;
use std::hash::{Hash, Hasher};
use std::ops::{Deref, DerefMut};

/// Any number of operands; up to four lie in the operation itself and are copied as a whole.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Operands(Store);

/// Equal operands are stored in the same way: the rest of the few is always the same.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Store {
    Few(u8, [Value; 4]),
    Many(Box<[Value]>),
}

impl Deref for Operands {
    type Target = [Value];

    fn deref(&self) -> &[Value] {
        match &self.0 {
            Store::Few(length, values) => values.get(..usize::from(*length)).unwrap_or(values),
            Store::Many(values) => values,
        }
    }
}

impl DerefMut for Operands {
    fn deref_mut(&mut self) -> &mut [Value] {
        match &mut self.0 {
            Store::Few(length, values) => {
                let length = usize::from(*length).min(values.len());
                &mut values[..length]
            }
            Store::Many(values) => values,
        }
    }
}

impl From<&[Value]> for Operands {
    fn from(values: &[Value]) -> Operands {
        let mut few = [Value(0); 4];
        Operands(match few.get_mut(..values.len()) {
            Some(slots) => {
                slots.copy_from_slice(values);
                Store::Few(values.len() as u8, few)
            }
            None => Store::Many(values.into()),
        })
    }
}

impl FromIterator<Value> for Operands {
    fn from_iter<I: IntoIterator<Item = Value>>(values: I) -> Operands {
        let mut values = values.into_iter();
        let mut few = [Value(0); 4];
        let mut length = 0;
        for slot in &mut few {
            let Some(value) = values.next() else { return Operands(Store::Few(length, few)) };
            *slot = value;
            length += 1;
        }
        match values.next() {
            Some(next) => Operands(Store::Many(few.into_iter().chain([next]).chain(values).collect())),
            None => Operands(Store::Few(length, few)),
        }
    }
}

impl Hash for Operands {
    fn hash<H: Hasher>(&self, state: &mut H) {
        match &self.0 {
            Store::Few(length, [a, b, c, d]) => {
                let pair = |low: &Value, high: &Value| u64::from(low.0) | u64::from(high.0) << 32;
                state.write_u64(pair(a, b));
                state.write_u64(pair(c, d) ^ u64::from(*length) << 56);
            }
            Store::Many(values) => values.hash(state),
        }
    }
}
