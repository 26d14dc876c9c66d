//! What of a texture has changed, as few rectangles.

/// Rectangles that are given at most.
pub const MAX_WRITES: usize = 64;

/// Changed texels of rows, which are numbered through all layers.
#[derive(Clone, Debug)]
pub struct Changes {
    /// The first changed column of a row and the one behind the last; the same where nothing has.
    rows: Vec<[u32; 2]>,
    /// The rows with changes, each once.
    changed: Vec<u32>,
}

/// A rectangle of one layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    pub layer: u32,
    pub row: u32,
    pub column: u32,
    pub width: u32,
    pub height: u32,
}

impl Changes {
    /// None yet, in so many rows.
    pub fn new(rows: usize) -> Changes {
        Changes { rows: vec![[0, 0]; rows], changed: Vec::new() }
    }

    /// A texel has changed.
    pub fn mark(&mut self, row: usize, column: u32) {
        let Some(span) = self.rows.get_mut(row) else { return };
        if span[0] == span[1] {
            *span = [column, column + 1];
            self.changed.push(row as u32);
        } else {
            *span = [span[0].min(column), span[1].max(column + 1)];
        }
    }

    /// All changes, which are forgotten. `height` is that of a layer, in rows.
    pub fn take(&mut self, height: usize) -> Vec<Span> {
        let mut changed = std::mem::take(&mut self.changed);
        changed.sort_unstable();
        let (height, layers) = (height.max(1) as u32, self.rows.len() / height.max(1));
        // A rectangle ends with its layer, so there is one more for each that begins.
        let together = changed.len().div_ceil((MAX_WRITES + 1).saturating_sub(layers.max(1)).max(1)).max(1);
        let mut spans = Vec::new();
        for of_layer in changed.chunk_by(|a, b| a / height == b / height) {
            spans.extend(of_layer.chunks(together).filter_map(|rows| self.around(rows, height)));
        }
        for row in changed {
            if let Some(span) = self.rows.get_mut(row as usize) {
                *span = [0, 0];
            }
        }
        spans
    }

    /// The rectangle around the changes of some rows of a layer.
    fn around(&self, rows: &[u32], height: u32) -> Option<Span> {
        let (first, last) = (*rows.first()?, *rows.last()?);
        let spans = rows.iter().filter_map(|row| self.rows.get(*row as usize));
        let [from, to] = spans.copied().reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])?;
        let (layer, row) = (first / height, first % height);
        Some(Span { layer, row, column: from, width: to - from, height: last - first + 1 })
    }
}
