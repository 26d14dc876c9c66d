//! Finds a value by its operation.

use super::{Operation, Value};
use hashbrown::HashTable;
use rustc_hash::FxHasher;
use std::hash::{Hash, Hasher};

/// A hash table over an arena, which alone holds the operations. Most operations are new, which a
/// byte each tells: on a large graph the rest of the table is seldom in the cache.
#[derive(Default)]
pub struct Interner(HashTable<Entry>);

/// The hash of an operation and its value.
struct Entry {
    hash: u32,
    value: Value,
}

/// The hash of an operation that has no value yet.
#[derive(Clone, Copy)]
pub struct Vacant(u32);

impl Interner {
    /// With room for that many operations.
    pub fn with_capacity(operations: usize) -> Interner {
        Interner(HashTable::with_capacity(operations))
    }

    /// The value of an operation of the arena.
    ///
    /// # Errors
    /// It has none.
    pub fn find(&self, operation: &Operation, arena: &[Operation]) -> Result<Value, Vacant> {
        let hash = hash_of(operation);
        let is_it = |entry: &Entry| entry.hash == hash && arena[entry.value.0 as usize] == *operation;
        self.0.find(widened(hash), is_it).map_or(Err(Vacant(hash)), |entry| Ok(entry.value))
    }

    /// Notes the value of an operation that had none.
    pub fn insert(&mut self, Vacant(hash): Vacant, value: Value) {
        self.0.insert_unique(widened(hash), Entry { hash, value }, |entry| widened(entry.hash));
    }

    /// Forgets a value and its operation.
    pub fn remove(&mut self, operation: &Operation, value: Value) {
        if let Ok(entry) = self.0.find_entry(widened(hash_of(operation)), |entry| entry.value == value) {
            entry.remove();
        }
    }
}

fn hash_of(operation: &Operation) -> u32 {
    let mut hasher = FxHasher::default();
    operation.hash(&mut hasher);
    hasher.finish() as u32
}

/// The table looks at the first and the last bits of a hash.
fn widened(hash: u32) -> u64 {
    u64::from(hash) << 32 | u64::from(hash)
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
