//! A positions map while it is edited: against a model that looks at every cell anew, and on both
//! renderers.

mod common;

use common::decals::{DECALS, SPRITES, decals, edited};
use common::folder;
use std::collections::BTreeMap;
use texgraph_runtime::cpu;
use texgraph_runtime::render::{RenderError, Request};
use texgraph_runtime::resource::positions::{MAX_WRITES, Positions, Refused, Sprite, SpriteId};

/// The same numbers on every machine.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as u32
    }

    fn below(&mut self, limit: u32) -> u32 {
        self.next() % limit
    }

    fn part(&mut self) -> f32 {
        (self.next() >> 8) as f32 / (1 << 23) as f32
    }

    /// One that fits a cell however it is turned, and anything now and then.
    fn sprite(&mut self) -> Sprite {
        let scale = if self.below(20) == 0 { 2.0 * self.part() } else { 0.1 + 0.6 * self.part() };
        let at = [3.0 * self.part() - 1.0, self.part()];
        Sprite { pattern: self.below(9), at, scale, turn: self.part() }
    }
}

const GRID: [u32; 2] = [9, 6];
const PATTERNS: u32 = 8;

/// The cells that a sprite's corners and middle lie in, and those between.
fn cells(sprite: &Sprite) -> Vec<[u32; 2]> {
    let angle = f64::from(sprite.turn) * std::f64::consts::TAU;
    let half = f64::from(sprite.scale) * (angle.sin().abs() + angle.cos().abs()) / 2.0;
    let axis = |i: usize| {
        let middle = f64::from(sprite.at[i]).rem_euclid(1.0) * f64::from(GRID[i]);
        let unit = 1.0 / 32768.0;
        let (first, last) = ((middle - half + unit).floor() as i64, (middle + half - unit).ceil() as i64);
        (first..last).map(move |cell| cell.rem_euclid(i64::from(GRID[i])) as u32).collect::<Vec<_>>()
    };
    let (columns, rows) = (axis(0), axis(1));
    rows.iter().flat_map(|y| columns.iter().map(|x| [*x, *y])).collect()
}

/// What a cell of the texture holds, by its pattern.
fn pattern(map: &Positions, [x, y]: [u32; 2], layer: u32) -> i32 {
    let index = ((layer * GRID[1] + y) * GRID[0] + x) as usize * 16;
    let word = &map.bytes()[index..index + 4];
    i32::from_le_bytes([word[0], word[1], word[2], word[3]])
}

fn wanted(sprite: &Sprite) -> bool {
    let angle = f64::from(sprite.turn) * std::f64::consts::TAU;
    let around = f64::from(sprite.scale) * (angle.sin().abs() + angle.cos().abs());
    sprite.pattern < PATTERNS && sprite.scale >= 1.0 / 256.0 && around <= 1.0 + 1.0 / 32768.0
}

/// Ten thousand edits, of which many are refused: what is there is what the model says, and what is
/// written is all that has changed.
#[test]
fn edits_do_what_a_model_does() {
    for layers in [1, 3] {
        let mut random = Random(u64::from(layers));
        let mut map = Positions::new(GRID, layers, PATTERNS).expect("it can be");
        let mut model: BTreeMap<SpriteId, Sprite> = BTreeMap::new();
        let (mut texture, mut refused) = (map.bytes().to_vec(), 0);
        for step in 0..10_000 {
            let known: Vec<SpriteId> = model.keys().copied().collect();
            let some = known.get(random.below(known.len().max(1) as u32) as usize).copied();
            match (random.below(3), some) {
                (0, Some(id)) => assert_eq!(map.remove(id), model.remove(&id)),
                (1, Some(id)) => {
                    let sprite = random.sprite();
                    match map.place(id, sprite) {
                        Ok(()) => drop(model.insert(id, sprite)),
                        Err(reason) => refused += check(&map, &model, Some(id), &sprite, reason),
                    }
                }
                _ => {
                    let sprite = random.sprite();
                    match map.insert(sprite) {
                        Ok(id) => assert_eq!(model.insert(id, sprite), None),
                        Err(reason) => refused += check(&map, &model, None, &sprite, reason),
                    }
                }
            }
            assert_eq!(map.sprites().collect::<BTreeMap<_, _>>(), model);
            if step % 10 == 0 {
                apply(&mut map, &mut texture);
                assert_eq!(texture, map.bytes());
                cells_hold_the_sprites(&map, &model, layers);
            }
        }
        assert!(refused > 500 && model.len() > 3, "{refused} refused, {} left", model.len());
    }
}

/// A refusal names a true reason.
fn check(
    map: &Positions,
    model: &BTreeMap<SpriteId, Sprite>,
    own: Option<SpriteId>,
    sprite: &Sprite,
    reason: Refused,
) -> u32 {
    match reason {
        Refused::Taken { cell, by } => {
            assert!(wanted(sprite) && Some(by) != own);
            assert!(cells(sprite).contains(&cell) && cells(&model[&by]).contains(&cell));
        }
        Refused::NoPattern { pattern, count } => assert!(pattern == sprite.pattern && pattern >= count),
        Refused::Size { .. } => assert!(!wanted(sprite)),
        other => panic!("{other}: {map:?}"),
    }
    1
}

/// Each sprite stands in its cells, and no cell holds another.
fn cells_hold_the_sprites(map: &Positions, model: &BTreeMap<SpriteId, Sprite>, layers: u32) {
    let mut expected: BTreeMap<[u32; 2], Vec<i32>> = BTreeMap::new();
    for sprite in model.values() {
        for cell in cells(sprite) {
            expected.entry(cell).or_default().push(sprite.pattern as i32);
        }
    }
    for cell in (0..GRID[1]).flat_map(|y| (0..GRID[0]).map(move |x| [x, y])) {
        let mut found: Vec<i32> = (0..layers).map(|layer| pattern(map, cell, layer)).collect();
        found.retain(|pattern| *pattern >= 0);
        found.sort_unstable();
        let mut wanted = expected.remove(&cell).unwrap_or_default();
        wanted.sort_unstable();
        assert_eq!(found, wanted, "{cell:?}");
    }
}

/// Does to a texture what the map says has changed.
fn apply(map: &mut Positions, texture: &mut [u8]) {
    let writes = map.take_writes();
    assert!(writes.len() <= MAX_WRITES);
    for write in writes {
        let [x, y, layer] = write.origin;
        for row in 0..write.height {
            let to = (((layer * GRID[1] + y + row) * GRID[0]) + x) as usize * 16;
            let from = (row * write.bytes_per_row) as usize;
            let length = (write.width * write.texel_bytes) as usize;
            texture[to..to + length].copy_from_slice(&write.bytes[from..from + length]);
        }
    }
}

#[test]
fn what_is_gone_is_gone() {
    let mut map = Positions::new(GRID, 1, PATTERNS).expect("it can be");
    let sprite = Sprite { pattern: 0, at: [0.5, 0.5], scale: 0.5, turn: 0.0 };
    let first = map.insert(sprite).expect("it is free");
    assert_eq!(map.remove(first), Some(sprite));
    let second = map.insert(sprite).expect("it is free again");
    assert_ne!(first, second);
    assert_eq!(
        (map.sprite(first), map.remove(first), map.place(first, sprite)),
        (None, None, Err(Refused::Gone))
    );
    assert_eq!(map.sprite(second), Some(sprite));
}

#[test]
fn maps_and_sprites_that_can_not_be_are_refused() {
    for (grid, layers) in [([1, 8], 1), ([8, 4097], 1), ([8, 8], 0), ([8, 8], 9), ([4096, 4096], 5)] {
        assert_eq!(Positions::new(grid, layers, 1).err(), Some(Refused::Map { grid, layers }));
    }
    let mut map = Positions::new(GRID, 1, PATTERNS).expect("it can be");
    let fine = Sprite { pattern: 0, at: [0.5, 0.5], scale: 1.0, turn: 0.25 };
    for sprite in [
        Sprite { scale: 1.1, ..fine },
        Sprite { turn: 0.125, ..fine },
        Sprite { scale: 0.003, ..fine },
        Sprite { scale: f32::NAN, ..fine },
        Sprite { turn: f32::INFINITY, ..fine },
        Sprite { at: [f32::NAN, 0.5], ..fine },
    ] {
        assert!(matches!(map.insert(sprite), Err(Refused::Size { .. })), "{sprite:?}");
    }
    assert!(map.take_writes().is_empty());
    assert!(map.insert(fine).is_ok());
}

/// However many sprites move: as many writes as there are rows that change, or 64.
#[test]
fn changes_are_few_writes() {
    for (layers, sprites, most) in [(1, 1, 4), (1, 1000, MAX_WRITES), (8, 1000, MAX_WRITES)] {
        let mut map = Positions::new([128, 128], layers, PATTERNS).expect("it can be");
        let mut random = Random(7);
        for _ in 0..sprites {
            let sprite = Sprite { pattern: 0, scale: 0.5, ..random.sprite() };
            // Some are in the way of others.
            let _ = map.insert(sprite);
        }
        let writes = map.take_writes();
        assert!((1..=most).contains(&writes.len()), "{} writes", writes.len());
        assert!(map.take_writes().is_empty());
    }
}

#[test]
fn cells_are_those_around() {
    // Across four cells and across the map's own border.
    for (at, count) in
        [([4.0 / 9.0, 0.5], 4), ([0.0, 0.0], 4), ([1.5 / 9.0, 1.5 / 6.0], 1), ([1.0 / 9.0, 1.5 / 6.0], 2)]
    {
        let mut map = Positions::new(GRID, 1, PATTERNS).expect("it can be");
        map.insert(Sprite { pattern: 5, at, scale: 1.0, turn: 0.0 }).expect("it fits");
        let cells = (0..GRID[1]).flat_map(|y| (0..GRID[0]).map(move |x| [x, y]));
        let count_of = cells.filter(|cell| pattern(&map, *cell, 0) == 5).count();
        assert_eq!(count_of, count, "{at:?}");
    }
}

/// What is edited while a scene draws looks as if the file had been edited; bakes that read it too.
#[test]
fn an_edited_map_is_drawn_as_edited() {
    let (before, after) = (folder(), folder());
    let (program, tables, mut map) = decals(before.path(), &SPRITES);
    assert_eq!(tables.get(DECALS, "cells").map(|bytes| &bytes[..]), Some(map.bytes()));
    let mut scene = cpu::Scene::new(&program, &tables, 0).expect("the tables are whole");
    let request = Request { region: [0.0, 0.0, 2.0, 1.0], ..Request::new([120, 50]) };
    let draw = |scene: &mut cpu::Scene<'_>| scene.render(&request, &|_| {}).expect("it can be drawn");
    let old = draw(&mut scene);
    let sprites = edited(&mut map);
    scene.write(DECALS, "cells", &map.take_writes()).expect("it is there");
    let new = draw(&mut scene);
    assert_ne!(old, new);

    let (program, tables, _) = decals(after.path(), &sprites);
    let mut fresh = cpu::Scene::new(&program, &tables, 0).expect("the tables are whole");
    assert_eq!(new, draw(&mut fresh));
}

#[test]
fn writes_outside_a_texture_are_errors() {
    let folder = folder();
    let (program, tables, _) = decals(folder.path(), &SPRITES);
    let mut scene = cpu::Scene::new(&program, &tables, 0).expect("the tables are whole");
    let mut larger = Positions::new([7, 5], 2, 2).expect("it can be");
    larger.insert(Sprite { at: [0.99, 0.5], ..SPRITES[0] }).expect("it is free");
    let writes = larger.take_writes();
    for (resource, field) in [(DECALS, "cells"), (DECALS, "layers"), (0, "cells"), (9, "cells")] {
        let refused = scene.write(resource, field, &writes);
        assert!(matches!(refused, Err(RenderError::NoTable { .. })), "{resource}, {field}: {refused:?}");
    }
}
