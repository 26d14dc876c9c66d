//! What the author calls values.

use super::Value;
use std::sync::Arc;

/// Names of some of the values of a function. They lie beside the values, and copies share them.
#[derive(Clone, Debug, Default)]
pub struct Names(Vec<Option<Arc<str>>>);

impl Names {
    /// The name of a value.
    pub fn get(&self, value: Value) -> Option<&Arc<str>> {
        self.0.get(value.0 as usize)?.as_ref()
    }

    /// Whether a value has a name.
    pub fn contains(&self, value: Value) -> bool {
        self.get(value).is_some()
    }

    /// Names a value; its old name is gone.
    pub fn insert(&mut self, value: Value, name: impl Into<Arc<str>>) {
        let place = value.0 as usize;
        if place >= self.0.len() {
            self.0.resize(place + 1, None);
        }
        self.0[place] = Some(name.into());
    }

    /// The name of a value, which has none from then on.
    pub fn take(&mut self, value: Value) -> Option<Arc<str>> {
        self.0.get_mut(value.0 as usize)?.take()
    }

    /// Leaves the first so many values their names.
    pub fn truncate(&mut self, values: usize) {
        self.0.truncate(values);
    }

    /// The named values in order, each with its name.
    pub fn iter(&self) -> impl Iterator<Item = (Value, &Arc<str>)> {
        (0..).map(Value).zip(&self.0).filter_map(|(value, name)| Some((value, name.as_ref()?)))
    }
}
