//! Generated inputs: well-typed random programs, mutants of real ones, and what must hold for them.
//!
//! Everything follows from a seed (or, for a fuzzer, from its bytes), so a failure can be replayed.
//! Used by `tests/generated.rs`, by the example `generated` and by the targets of `fuzz/`.

#![allow(dead_code, reason = "every user takes its own part")]

mod calls;
pub mod choices;
pub mod corpus;
mod expression;
pub mod features;
pub mod hash;
mod items;
pub mod judge;
mod later;
pub mod mutant;
mod names;
pub mod pool;
pub mod program;
mod shape;
mod statements;
mod types;
