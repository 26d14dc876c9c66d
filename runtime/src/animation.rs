//! Changing animations while they run (Lefebvre & Neyret, Pattern Based Procedural Textures, I3D 2003,
//! §3.4, figure 13).

use std::collections::VecDeque;

/// What cycles follow, and followed before: what `animate` takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change<T> {
    /// What the cycles followed before: `previous_rest`, `previous_density`, or what they come from.
    pub previous: T,
    /// What they follow now.
    pub current: T,
    /// When that began, in frames.
    pub changed: f64,
}

/// Changes of an animation, so far apart that every place has ended its old cycle before the next.
///
/// A texture keeps no state: from one change to the next it takes `2 · frames` until all places have gone
/// over. What is asked for earlier waits here, in order; nothing is lost.
///
/// ```
/// use texgraph_runtime::animation::Changes;
///
/// let mut message = Changes::new("HELLO", 9);
/// message.request("WORLD");
/// message.request("");
/// assert_eq!(message.at(40.5).current, "WORLD");
/// // Eighteen frames for all lamps to follow; then comes the next.
/// assert_eq!((message.at(58.0).current, message.waiting()), ("WORLD", 1));
/// let change = message.at(59.0);
/// assert_eq!((change.previous, change.current, change.changed), ("WORLD", "", 59.0));
/// ```
#[derive(Clone, Debug)]
pub struct Changes<T> {
    last: Change<T>,
    has_changed: bool,
    frames: u32,
    waiting: VecDeque<T>,
}

impl<T: Clone> Changes<T> {
    /// Of an animation of so many frames that follows a value.
    pub fn new(value: T, frames: u32) -> Changes<T> {
        let last = Change { previous: value.clone(), current: value, changed: 0.0 };
        Changes { last, has_changed: false, frames, waiting: VecDeque::new() }
    }

    /// Asks for another value, as soon as may be.
    pub fn request(&mut self, value: T) {
        self.waiting.push_back(value);
    }

    /// What holds at a time, in frames: call it for every picture that is drawn, with times that grow.
    pub fn at(&mut self, time: f64) -> &Change<T> {
        let is_free = !self.has_changed || time >= self.last.changed + 2.0 * f64::from(self.frames);
        if let Some(next) = self.waiting.pop_front_if(|_| is_free && time.is_finite()) {
            let previous = std::mem::replace(&mut self.last.current, next);
            self.last.previous = previous;
            // Whole frames, as `animate` counts them.
            self.last.changed = time.ceil();
            self.has_changed = true;
        }
        &self.last
    }

    /// How many values wait.
    pub fn waiting(&self) -> usize {
        self.waiting.len()
    }
}

#[cfg(test)]
mod tests {
    use super::Changes;

    #[test]
    fn changes_keep_their_order_and_their_distance() {
        let mut changes = Changes::new(0, 7);
        let mut seen = vec![(0, f64::NEG_INFINITY)];
        for step in 1..=2_000 {
            // Requests in bursts.
            if step % 97 < 3 {
                changes.request(step);
            }
            let change = changes.at(f64::from(step) * 0.37);
            let (last, when) = seen[seen.len() - 1];
            if change.current != last {
                assert_eq!(change.previous, last);
                assert!(change.changed - when >= 14.0 && change.current > last);
                seen.push((change.current, change.changed));
            }
        }
        let asked = (1..=2_000).filter(|step| step % 97 < 3).count();
        assert_eq!(seen.len() - 1 + changes.waiting(), asked, "none is lost");
    }
}
