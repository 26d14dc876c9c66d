//! Finds a value by its operation.

use super::{Operation, Value};
use rustc_hash::FxHasher;
use std::hash::{Hash, Hasher};

/// An open hash table over an arena, which alone holds the operations.
#[derive(Default)]
pub struct Interner {
    /// None, or a power of two of them from 2 on, at most half of them used.
    slots: Vec<Slot>,
    used: usize,
}

/// The hash of an operation and its value.
#[derive(Clone, Copy)]
struct Slot {
    hash: u32,
    value: Value,
}

impl Slot {
    const FREE: Slot = Slot { hash: 0, value: Value(u32::MAX) };

    fn is_free(self) -> bool {
        self.value == Slot::FREE.value
    }
}

/// The hash of an operation that has no value yet.
#[derive(Clone, Copy)]
pub struct Vacant(u32);

impl Interner {
    /// With room for that many operations.
    pub fn with_capacity(operations: usize) -> Interner {
        let slots = if operations == 0 { 0 } else { (operations * 2).next_power_of_two() };
        Interner { slots: vec![Slot::FREE; slots], used: 0 }
    }

    /// The value of an operation of the arena.
    ///
    /// # Errors
    /// It has none.
    pub fn find(&self, operation: &Operation, arena: &[Operation]) -> Result<Value, Vacant> {
        let mut hasher = FxHasher::default();
        operation.hash(&mut hasher);
        let hash = hasher.finish() as u32;
        let mut place = hash as usize;
        while let Some(slot) = self.slots.get(place & self.slots.len().wrapping_sub(1)) {
            if slot.is_free() {
                break;
            }
            if slot.hash == hash && arena[slot.value.0 as usize] == *operation {
                return Ok(slot.value);
            }
            place += 1;
        }
        Err(Vacant(hash))
    }

    /// Notes the value of an operation that had none.
    pub fn insert(&mut self, vacant: Vacant, value: Value) {
        if self.used * 2 >= self.slots.len() {
            self.grow();
        }
        self.place(Slot { hash: vacant.0, value });
        self.used += 1;
    }

    fn grow(&mut self) {
        let slots = vec![Slot::FREE; (self.slots.len() * 2).max(16)];
        for slot in std::mem::replace(&mut self.slots, slots) {
            if !slot.is_free() {
                self.place(slot);
            }
        }
    }

    /// Into the first free slot from where it belongs; there always is one.
    fn place(&mut self, slot: Slot) {
        let mask = self.slots.len() - 1;
        let mut place = slot.hash as usize;
        while !self.slots[place & mask].is_free() {
            place += 1;
        }
        self.slots[place & mask] = slot;
    }
}

#[cfg(test)]
mod tests {
    use super::{Interner, Operation, Value};

    #[test]
    fn room_of_any_size_is_enough() {
        for room in 0..5 {
            let mut interner = Interner::with_capacity(room);
            let arena: Vec<Operation> = (0..40).map(Operation::Input).collect();
            for (n, operation) in (0..).zip(&arena) {
                let vacant = interner.find(operation, &arena).expect_err("it is new");
                interner.insert(vacant, Value(n));
                assert_eq!(interner.find(operation, &arena).ok(), Some(Value(n)), "room {room}");
            }
        }
    }
}
