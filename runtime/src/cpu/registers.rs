//! Gives the values of a function their registers: as few as there are values alive at a time, so
//! that a frame stays in the first-level cache.
//!
//! Steps come in with a register of its own for each result. Code has no jumps backward (a fold's
//! body is a function), so a register is free after the last step that reads it. A step reads all
//! before it writes, so its results may go where its operands were.

use super::plan::{Planned, Register, Step};

/// Leaves out what nobody reads, and shares registers. The first `pinned` ones keep their place and
/// are never used for anything else; further inputs keep it until they have been read.
pub fn allocate(planned: &mut Planned, registers: usize, pinned: usize) {
    let last = remove_dead(planned, registers);
    let mut sharing =
        Sharing { places: vec![0; registers], free: Vec::new(), size: pinned.max(planned.inputs) };
    for input in 0..planned.inputs {
        sharing.places[input] = input as u32;
    }
    for input in (pinned..planned.inputs).filter(|input| last[*input].is_none()) {
        sharing.free.push(input as u32);
    }
    for (now, step) in planned.steps.iter_mut().enumerate() {
        let mut done = Vec::new();
        step.for_operands(|register| {
            if let Register::Frame(n) = register {
                let own = *n as usize;
                *n = sharing.places[own];
                if own >= pinned && last[own] == Some(now) && !done.contains(n) {
                    done.push(*n);
                }
            }
        });
        sharing.free.extend(done);
        step.retain_targets(|register| {
            *register = sharing.take(*register);
            true
        });
    }
    for output in &mut planned.outputs {
        if let Register::Frame(n) = output {
            *n = sharing.places[*n as usize];
        }
    }
    planned.size = sharing.size.max(planned.inputs + 1);
    close_arms(&mut planned.steps);
}

/// Which physical register each has.
struct Sharing {
    places: Vec<u32>,
    free: Vec<u32>,
    size: usize,
}

impl Sharing {
    fn take(&mut self, register: Register) -> Register {
        let Register::Frame(n) = register else { return register };
        let place = self.free.pop().unwrap_or_else(|| {
            self.size += 1;
            self.size as u32 - 1
        });
        self.places[n as usize] = place;
        Register::Frame(place)
    }
}

/// Removes steps whose results nobody reads; for each register the last step that reads it, of the
/// steps that are left. What the outputs read lasts for ever.
fn remove_dead(planned: &mut Planned, registers: usize) -> Vec<Option<usize>> {
    // Counted from the end, as the number of steps is not known yet.
    let mut last: Vec<Option<usize>> = vec![None; registers];
    for output in &planned.outputs {
        if let Register::Frame(n) = output {
            last[*n as usize] = Some(0);
        }
    }
    let mut kept = Vec::with_capacity(planned.steps.len());
    for mut step in std::mem::take(&mut planned.steps).into_iter().rev() {
        let mut wanted = matches!(step, Step::Arm { .. } | Step::Join);
        step.retain_targets(|register| {
            let read = matches!(register, Register::Frame(n) if last[*n as usize].is_some());
            wanted |= read;
            read
        });
        if !wanted || removes_arm(&step, &mut kept) {
            continue;
        }
        kept.push(step);
        let from_end = kept.len();
        if let Some(step) = kept.last_mut() {
            step.for_operands(|register| {
                if let Register::Frame(n) = register {
                    last[*n as usize].get_or_insert(from_end);
                }
            });
        }
    }
    kept.reverse();
    planned.steps = kept;
    let count = planned.steps.len();
    last.iter().map(|last| last.map(|from_end| count - from_end)).collect()
}

/// Whether a step begins an arm that has become empty; its end is then removed.
fn removes_arm(step: &Step, after: &mut Vec<Step>) -> bool {
    let empty = matches!(step, Step::Arm { .. }) && matches!(after.last(), Some(Step::Join));
    if empty {
        after.pop();
    }
    empty
}

/// Tells every arm where it ends.
fn close_arms(steps: &mut [Step]) {
    let mut open = Vec::new();
    for i in 0..steps.len() {
        match steps[i] {
            Step::Arm { .. } => open.push(i),
            Step::Join => {
                if let Some(Step::Arm { end, .. }) = open.pop().and_then(|arm| steps.get_mut(arm)) {
                    *end = i + 1;
                }
            }
            _ => {}
        }
    }
}
