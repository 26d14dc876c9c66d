//! `positions`: patterns at places of their own, which may change while a program runs (Lefebvre &
//! Neyret 2003, §3.1, explicit positioning, figure 6).
//!
//! A map is a grid of cells. A sprite is at most as large as a cell, so it reaches into four of them
//! at most; each holds the pattern's number and where the sprite lies from that cell. With several
//! layers a cell holds several sprites. Inserting, moving and removing one takes the same time however
//! many there are. What has changed is given as few rectangles of texels, for a host to write into the
//! texture of field `cells`.
//!
//! ```
//! use texgraph_runtime::resource::positions::{Positions, Refused, Sprite};
//!
//! // 64 × 64 cells of one sprite each, over 8 patterns.
//! let mut map = Positions::new([64, 64], 1, 8)?;
//! let star = map.insert(Sprite { pattern: 3, at: [0.25, 0.5], scale: 0.7, turn: 0.0 })?;
//!
//! // A cell that is taken is no loss: the map stays as it is, and the caller knows.
//! let near = Sprite { pattern: 1, at: [0.251, 0.5], scale: 0.7, turn: 0.125 };
//! assert!(matches!(map.insert(near), Err(Refused::Taken { by, .. }) if by == star));
//!
//! // Each frame: move what moves, then write what has changed.
//! map.place(star, Sprite { at: [0.26, 0.5], ..map.sprite(star).expect("it is there") })?;
//! for write in map.take_writes() {
//!     // With wgpu: queue.write_texture(…, write.bytes, bytes_per_row: write.bytes_per_row, …),
//!     // or Scene::write of this crate's renderers.
//!     assert!(write.width > 0 && write.height > 0);
//! }
//! assert!(map.take_writes().is_empty());
//! # Ok::<(), Refused>(())
//! ```

mod cells;
mod changes;
mod file;

pub(super) use file::make;
pub use file::open;

use super::table::MAX_BYTES;
use cells::{Cover, TEXEL};
use changes::Changes;
use serde::Deserialize;
use std::fmt;
use texgraph_compiler::manifest::{Format, Table};

/// Writes that are needed at most for all changes since the last ones.
pub const MAX_WRITES: usize = changes::MAX_WRITES;

/// A pattern at a place of its own.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sprite {
    /// Which pattern.
    pub pattern: u32,
    /// Where its middle lies, 0 to 1 across and down the map, which wraps.
    pub at: [f32; 2],
    /// Its side in cells, 1/256 to 1; turned by an eighth it may be 0.7 at most, so that it fits a cell.
    #[serde(default = "whole")]
    pub scale: f32,
    /// How far it is turned clockwise: 1 is a full turn.
    #[serde(default)]
    pub turn: f32,
}

fn whole() -> f32 {
    1.0
}

/// A sprite of a map, for as long as it is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SpriteId {
    slot: u32,
    /// Sprites that had the slot before.
    generation: u32,
}

/// Why a map stays as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refused {
    /// In every layer a sprite holds a cell that this one needs; the one in the lowest layer is told.
    Taken {
        /// The cell, across and down.
        cell: [u32; 2],
        /// Who holds it.
        by: SpriteId,
    },
    /// The sprite was removed, or is one of another map.
    Gone,
    /// There is no such pattern.
    NoPattern {
        /// The number that was asked for.
        pattern: u32,
        /// How many there are.
        count: u32,
    },
    /// It is larger than a cell, or smaller than 1/256 of one; or a number is not finite.
    Size {
        /// Its side in cells.
        scale: f32,
        /// The side of the upright square around it, in cells.
        around: f32,
    },
    /// A map of so many cells or layers can't be: its texels may take 1 GiB.
    Map {
        /// Cells across and down: 2 to 4096.
        grid: [u32; 2],
        /// Layers: 1 to 8.
        layers: u32,
    },
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Refused::Taken { cell: [x, y], .. } => write!(f, "the cell in column {x}, row {y} is taken"),
            Refused::Gone => write!(f, "the sprite is not there any more"),
            Refused::NoPattern { pattern, count } => {
                write!(f, "there is no pattern {pattern}: there are {count}, counted from 0")
            }
            Refused::Size { scale, around } => write!(
                f,
                "a side of {scale} and its turn make it {around:.3} cells wide: 1/256 to 1 is possible"
            ),
            Refused::Map { grid: [width, height], layers } => {
                write!(f, "a map of {width}×{height} cells in {layers} layers can't be made")
            }
        }
    }
}

impl std::error::Error for Refused {}

/// A write into the texture of the field `cells`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Write<'a> {
    /// The first texel: column, row, layer.
    pub origin: [u32; 3],
    /// Texels across.
    pub width: u32,
    /// Texels down.
    pub height: u32,
    /// The texels, from the first to the last.
    pub bytes: &'a [u8],
    /// Bytes from one row to the next.
    pub bytes_per_row: u32,
    /// Bytes of a texel.
    pub texel_bytes: u32,
}

/// A slot of a sprite.
#[derive(Clone, Debug)]
struct Slot {
    generation: u32,
    held: Option<Held>,
}

/// A sprite in its layer.
#[derive(Clone, Copy, Debug)]
struct Held {
    sprite: Sprite,
    cover: Cover,
    layer: u32,
}

/// Nobody holds a cell.
const FREE: u32 = u32::MAX;

/// A positions map and its texels.
#[derive(Clone, Debug)]
pub struct Positions {
    grid: [u32; 2],
    layers: u32,
    patterns: u32,
    slots: Vec<Slot>,
    /// Slots without a sprite.
    unused: Vec<u32>,
    /// The slot that holds a cell, layer by layer, row by row.
    owners: Vec<u32>,
    /// The texels, in the same order.
    texels: Vec<u8>,
    changes: Changes,
}

impl Positions {
    /// A map without sprites: cells across and down (2 to 4096), sprites that each may hold (1 to 8),
    /// and how many patterns there are.
    ///
    /// # Errors
    /// [`Refused::Map`].
    pub fn new(grid: [u32; 2], layers: u32, patterns: u32) -> Result<Positions, Refused> {
        let sides = grid.iter().all(|side| (2..=4096).contains(side));
        if !sides || !(1..=8).contains(&layers) {
            return Err(Refused::Map { grid, layers });
        }
        let cells = grid[0] as usize * grid[1] as usize * layers as usize;
        if (cells * TEXEL) as u64 > MAX_BYTES {
            return Err(Refused::Map { grid, layers });
        }
        Ok(Positions {
            grid,
            layers,
            patterns,
            slots: Vec::new(),
            unused: Vec::new(),
            owners: vec![FREE; cells],
            texels: cells::BLANK.repeat(cells),
            changes: Changes::new((grid[1] * layers) as usize),
        })
    }

    /// Adds a sprite, in the lowest layer that is free where it lies.
    ///
    /// # Errors
    /// [`Refused::Taken`], [`Refused::NoPattern`], [`Refused::Size`]; the map stays as it is.
    pub fn insert(&mut self, sprite: Sprite) -> Result<SpriteId, Refused> {
        let held = self.hold(sprite, None)?;
        let slot = self.unused.pop().unwrap_or_else(|| {
            self.slots.push(Slot { generation: 0, held: None });
            self.slots.len() as u32 - 1
        });
        self.fill(slot, held);
        Ok(SpriteId { slot, generation: self.slots.get(slot as usize).map_or(0, |slot| slot.generation) })
    }

    /// Puts a sprite elsewhere, or makes another of it. It stays in its layer if that is free.
    ///
    /// # Errors
    /// [`Refused::Gone`], and as [`Positions::insert`]; the sprite stays where it was.
    pub fn place(&mut self, id: SpriteId, sprite: Sprite) -> Result<(), Refused> {
        let old = self.held(id).ok_or(Refused::Gone)?;
        let held = self.hold(sprite, Some((id, old.layer)))?;
        if held.layer != old.layer || !held.cover.is_where(&old.cover) {
            self.clear(old);
        }
        self.fill(id.slot, held);
        Ok(())
    }

    /// Takes a sprite away; none if it was gone already.
    pub fn remove(&mut self, id: SpriteId) -> Option<Sprite> {
        let held = self.held(id)?;
        self.clear(held);
        let slot = self.slots.get_mut(id.slot as usize)?;
        slot.held = None;
        slot.generation = slot.generation.wrapping_add(1);
        self.unused.push(id.slot);
        Some(held.sprite)
    }

    /// A sprite, if it is there.
    pub fn sprite(&self, id: SpriteId) -> Option<Sprite> {
        self.held(id).map(|held| held.sprite)
    }

    /// All sprites, in the order of their slots: those of a file in its order.
    pub fn sprites(&self) -> impl Iterator<Item = (SpriteId, Sprite)> {
        (0..).zip(&self.slots).filter_map(|(slot, found)| {
            let id = SpriteId { slot, generation: found.generation };
            found.held.map(|held| (id, held.sprite))
        })
    }

    /// What has to be written since the last time, [`MAX_WRITES`] at most: spans of rows, several rows
    /// together where too many have changed. What a rectangle holds besides is as it was.
    pub fn take_writes(&mut self) -> Vec<Write<'_>> {
        let spans = self.changes.take(self.grid[1] as usize);
        let bytes_per_row = self.grid[0] * TEXEL as u32;
        let write = |span: changes::Span| {
            let row = span.layer * self.grid[1] + span.row;
            let first = (row * self.grid[0] + span.column) as usize * TEXEL;
            let length = ((span.height - 1) * self.grid[0] + span.width) as usize * TEXEL;
            let bytes = self.texels.get(first..first + length).unwrap_or_default();
            let origin = [span.column, span.row, span.layer];
            Write {
                origin,
                width: span.width,
                height: span.height,
                bytes,
                bytes_per_row,
                texel_bytes: TEXEL as u32,
            }
        };
        spans.into_iter().map(write).collect()
    }

    /// The texels of all cells, as [`Positions::table`] lays them out.
    pub fn bytes(&self) -> &[u8] {
        &self.texels
    }

    /// The layout of the texture: a texel a cell, a layer a layer.
    pub fn table(&self) -> Table {
        Table::with_levels(Format::Rgba32Sint, self.grid, self.layers, 1)
    }

    fn held(&self, id: SpriteId) -> Option<Held> {
        let slot = self.slots.get(id.slot as usize)?;
        slot.held.filter(|_| slot.generation == id.generation)
    }

    /// A sprite in a layer that is free for it, or for one of this map that takes it first.
    fn hold(&self, sprite: Sprite, own: Option<(SpriteId, u32)>) -> Result<Held, Refused> {
        if sprite.pattern >= self.patterns {
            return Err(Refused::NoPattern { pattern: sprite.pattern, count: self.patterns });
        }
        let cover = Cover::new(&sprite, self.grid)?;
        let slot = own.map_or(FREE, |(id, _)| id.slot);
        let first = own.map(|(_, layer)| layer);
        let layers = first.into_iter().chain((0..self.layers).filter(|layer| Some(*layer) != first));
        let mut taken = None;
        for layer in layers {
            match cover.cells().find_map(|cell| self.other(layer, cell, slot)) {
                None => return Ok(Held { sprite, cover, layer }),
                refused => taken = taken.or(refused),
            }
        }
        Err(taken.unwrap_or(Refused::Map { grid: self.grid, layers: self.layers }))
    }

    /// Who else than a slot holds a cell of a layer.
    fn other(&self, layer: u32, cell: [u32; 2], slot: u32) -> Option<Refused> {
        let owner = *self.owners.get(self.index(layer, cell))?;
        let generation = self.slots.get(owner as usize)?.generation;
        (owner != slot).then_some(Refused::Taken { cell, by: SpriteId { slot: owner, generation } })
    }

    fn index(&self, layer: u32, [x, y]: [u32; 2]) -> usize {
        (layer as usize * self.grid[1] as usize + y as usize) * self.grid[0] as usize + x as usize
    }

    /// Writes a sprite into its cells.
    fn fill(&mut self, slot: u32, held: Held) {
        for (cell, texel) in held.cover.texels(&held.sprite) {
            self.write(held.layer, cell, slot, &texel);
        }
        if let Some(slot) = self.slots.get_mut(slot as usize) {
            slot.held = Some(held);
        }
    }

    /// Leaves the cells of a sprite blank.
    fn clear(&mut self, held: Held) {
        for cell in held.cover.cells() {
            self.write(held.layer, cell, FREE, &cells::BLANK);
        }
    }

    fn write(&mut self, layer: u32, cell: [u32; 2], owner: u32, texel: &[u8; TEXEL]) {
        let index = self.index(layer, cell);
        if let Some(held) = self.owners.get_mut(index) {
            *held = owner;
        }
        if let Some(bytes) = self.texels.get_mut(index * TEXEL..(index + 1) * TEXEL) {
            bytes.copy_from_slice(texel);
        }
        self.changes.mark((layer * self.grid[1] + cell[1]) as usize, cell[0]);
    }
}
