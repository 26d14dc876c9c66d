//! Tile sets: edges that fit, codes that mean what they say, the same bytes for any number of threads.

use rayon::ThreadPoolBuilder;
use texgraph_runtime::tiles::{self, Bitmap, Corners, Family, Side, TilesError};

const RED: [u8; 4] = [200, 30, 20, 255];
const BLUE: [u8; 4] = [10, 60, 220, 255];

/// Pebbles, sort of: smooth random spots of several sizes.
fn photo(side: u32, seed: u32) -> Bitmap {
    let hash = |x: u32, y: u32, of: u32| {
        let mixed =
            (x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77) ^ of.wrapping_mul(0xC2B2_AE3D))
                .wrapping_add(seed.wrapping_mul(0x27D4_EB2F));
        let mixed = (mixed ^ (mixed >> 15)).wrapping_mul(0x2C1B_3C6D);
        f64::from(mixed ^ (mixed >> 12)) / f64::from(u32::MAX)
    };
    let spots = |x: u32, y: u32, size: u32, of: u32| {
        let [u, v] = [x, y].map(|at| f64::from(at % size) / f64::from(size));
        let value = |i: u32, j: u32| hash(x / size + i, y / size + j, of);
        let row = |j: u32| value(0, j) + (value(1, j) - value(0, j)) * u;
        row(0) + (row(1) - row(0)) * v
    };
    Bitmap::new([side, side], |x, y| {
        let grey = 0.5 * spots(x, y, 9, 1) + 0.3 * spots(x, y, 4, 2) + 0.2 * spots(x, y, 2, 3);
        [(255.0 * grey) as u8, (200.0 * grey) as u8, (90.0 + 60.0 * grey) as u8, 255]
    })
}

fn flat(color: [u8; 4]) -> Bitmap {
    Bitmap::new([80, 70], |_, _| color)
}

#[test]
fn any_two_made_tiles_fit() {
    for (side, grid) in [(16, [3, 2]), (17, [2, 2]), (33, [4, 4]), (64, [2, 3])] {
        let sheet = tiles::make(&photo(160, 1), grid, side, 7).expect("it is made");
        assert_eq!(sheet.size(), [grid[0] * side, grid[1] * side]);
        let report = tiles::check(&sheet, grid, 1).expect("it is a sheet");
        let tiles = u64::from(grid[0] * grid[1]);
        assert_eq!((report.pairs, report.facing.max), (2 * tiles * tiles, 0), "side {side}");
        assert!(report.inside.mean() > 3.0, "there is something to see: {report:?}");
    }
}

#[test]
fn interiors_differ_and_the_seed_chooses_them() {
    let sheet = |seed| tiles::make(&photo(160, 1), [4, 4], 32, seed).expect("it is made");
    let tiles = sheet(0).tiles([4, 4]).expect("16 tiles");
    for (i, tile) in tiles.iter().enumerate() {
        assert!(!tiles[..i].contains(tile), "tile {i} is there twice");
    }
    assert_eq!(sheet(3), sheet(3));
    assert_ne!(sheet(3), sheet(4));
}

/// Across the border a picture goes on as it does inside: just beside the edge it is one photograph.
#[test]
fn nothing_shows_where_tiles_meet() {
    let side = 48;
    let sheet = tiles::make(&photo(256, 2), [4, 4], side, 0).expect("it is made");
    let tiles = sheet.tiles([4, 4]).expect("16 tiles");
    let apart = |a: [u8; 4], b: [u8; 4]| (0..3).map(|i| f64::from(a[i].abs_diff(b[i]))).sum::<f64>() / 3.0;
    let (mut beside, mut count) = (0.0, 0.0);
    for (a, b) in tiles.iter().flat_map(|a| tiles.iter().map(move |b| (a, b))) {
        for at in 0..side {
            // Left and right of the common edge: two texels from each other.
            beside +=
                apart(a.texel(side - 2, at), b.texel(1, at)) + apart(a.texel(at, side - 2), b.texel(at, 1));
            count += 2.0;
        }
    }
    let inside =
        tiles.iter().flat_map(|tile| (2..side).map(move |x| apart(tile.texel(x, 24), tile.texel(x - 2, 24))));
    let inside = inside.sum::<f64>() / f64::from(side - 2) / 16.0;
    let ratio = beside / count / inside;
    assert!((0.7..1.3).contains(&ratio), "{ratio} times the difference inside");
}

#[test]
fn transitions_are_in_the_order_of_their_corner_codes() {
    let side = 40;
    let families = [RED, BLUE].map(|color| Family::cut(&flat(color), side, 1, 0).expect("it is cut"));
    let sheet = tiles::transition(&families[0], &families[1], 0).expect("it is made");
    let tiles = sheet.tiles([4, 4]).expect("16 tiles");
    let last = side - 1;
    for (index, tile) in (0u32..).zip(&tiles) {
        for (bit, place) in [[0, 0], [last, 0], [0, last], [last, last]].into_iter().enumerate() {
            let expected = if index >> bit & 1 == 1 { BLUE } else { RED };
            assert_eq!(tile.texel(place[0], place[1]), expected, "tile {index} at {place:?}");
        }
    }
    assert!(tiles[0].texels().iter().all(|texel| *texel == RED));
    assert!(tiles[15].texels().iter().all(|texel| *texel == BLUE));
    let report = tiles::check(&sheet, [4, 4], 2).expect("it is a sheet");
    assert_eq!((report.pairs, report.facing.max), (128, 0));
    assert_eq!(tiles::check(&sheet, [4, 4], 1).expect("it is a sheet").facing.max, 200, "red beside blue");
}

#[test]
fn transitions_of_photographs_fit_the_tiles_that_are_made_of_them() {
    let (side, seed) = (32, 5);
    let photos = [photo(120, 1), photo(130, 9)];
    let [a, b] = photos.each_ref().map(|photo| Family::cut(photo, side, 16, seed).expect("it is cut"));
    let sheet = tiles::transition(&a, &b, seed).expect("it is made");
    assert_eq!(tiles::check(&sheet, [4, 4], 2).expect("it is a sheet").facing.max, 0);
    let tiles = sheet.tiles([4, 4]).expect("16 tiles");
    assert_eq!((&tiles[0], &tiles[15]), (&a.tiles()[0], &b.tiles()[15]));
    for (plain, photo) in [&tiles[0], &tiles[15]].into_iter().zip(&photos) {
        let made = tiles::make(photo, [2, 1], side, seed).expect("it is made");
        let row = [plain.clone(), made.part([0, 0], [side, side]), made.part([side, 0], [side, side])];
        let report = tiles::check(&Bitmap::sheet(&row, 3), [3, 1], 1).expect("it is a sheet");
        assert_eq!(report.facing.max, 0);
    }
    let sheets = [&a, &b].map(|family| Bitmap::sheet(family.tiles(), 4));
    let again = sheets.each_ref().map(|sheet| Family::of_sheet(sheet, [4, 4]).expect("a sheet"));
    assert_eq!(tiles::transition(&again[0], &again[1], seed), Ok(sheet));
}

#[test]
fn borders_are_alpha_over_the_familys_colours() {
    let family = Family::cut(&photo(120, 1), 32, 16, 0).expect("it is cut");
    let sheet = tiles::border(&family, 0).expect("it is made");
    assert_eq!(tiles::check(&sheet, [4, 4], 2).expect("it is a sheet").facing.max, 0);
    let tiles = sheet.tiles([4, 4]).expect("16 tiles");
    for (index, tile) in (0u32..).zip(&tiles) {
        let Corners(codes) = Corners::of(index, 2);
        let alpha = [[0, 0], [31, 0], [0, 31], [31, 31]].map(|[x, y]| tile.texel(x, y)[3]);
        assert_eq!(alpha, codes.map(|code| 255 * code as u8), "tile {index}");
        let plain = &family.tiles()[index as usize];
        let colors = tile.texels().iter().zip(plain.texels()).all(|(a, b)| a[..3] == b[..3]);
        assert!(colors, "tile {index} has other colours than its family");
    }
    assert!(tiles[0].texels().iter().all(|texel| texel[3] == 0));
    assert_eq!(tiles[15], family.tiles()[15]);
}

#[test]
fn layouts_show_their_codes_and_fit() {
    for families in 1..=4 {
        let columns = families * families;
        let sheet = tiles::layout(families, 40).expect("it is drawn");
        let report = tiles::check(&sheet, [columns; 2], families).expect("it is a sheet");
        assert_eq!((report.tiles, report.facing.max), (families.pow(4), 0));
        let tiles = sheet.tiles([columns; 2]).expect("tiles");
        let color =
            |code: u32| tiles[(code * (families.pow(4) - 1) / (families - 1).max(1)) as usize].texel(0, 0);
        for (index, tile) in (0..).zip(&tiles) {
            let seen = [[0, 0], [39, 0], [0, 39], [39, 39]].map(|[x, y]| tile.texel(x, y));
            assert_eq!(
                seen,
                Corners::of(index, families).0.map(color),
                "tile {index} of {families} families"
            );
        }
    }
    let error = tiles::layout(5, 64).expect_err("625 tiles");
    assert!(error.to_string().contains("625") && error.to_string().contains("--border"), "{error}");
}

#[test]
fn a_wrong_texel_is_found_with_its_pair() {
    let sheet = tiles::make(&flat(RED), [2, 2], 16, 0).expect("it is made");
    // At the right edge of tile 2, and at the bottom of it.
    let broken = Bitmap::new(sheet.size(), |x, y| match (x, y) {
        (15, 20) => [RED[0] - 9, RED[1], RED[2] + 3, 255],
        (4, 31) => [RED[0], RED[1] + 2, RED[2], 255],
        _ => sheet.texel(x, y),
    });
    let report = tiles::check(&broken, [2, 2], 1).expect("it is a sheet");
    assert_eq!((report.facing.max, report.worst.len()), (9, 5));
    let named: Vec<_> =
        report.worst.iter().map(|pair| (pair.first, pair.side, pair.second, pair.apart.max)).collect();
    let right = |second| (2, Side::Right, second, 9);
    assert_eq!(named[..4], [right(0), right(1), right(2), right(3)]);
    assert_eq!(named[4], (2, Side::Bottom, 0, 2));
    let mean = report.worst[0].apart.mean();
    assert!((mean - 12.0 / 48.0).abs() < 1e-12, "{mean}");
}

#[test]
fn threads_do_not_change_a_byte() {
    let made = |threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let a = Family::cut(&photo(140, 1), 40, 16, 2).expect("it is cut");
            let b = Family::cut(&photo(140, 2), 40, 16, 2).expect("it is cut");
            let sheet = tiles::transition(&a, &b, 2).expect("it is made");
            let report = tiles::check(&sheet, [4, 4], 1).expect("it is a sheet");
            (sheet.to_png().expect("a PNG"), Bitmap::sheet(a.tiles(), 4), report)
        })
    };
    assert_eq!(made(1), made(5));
}

#[test]
fn what_can_not_be_is_an_error() {
    let small = photo(60, 1);
    let too_small = TilesError::PhotoTooSmall { size: [60, 60], side: 64, needed: 79, largest: Some(48) };
    assert_eq!(tiles::make(&small, [4, 4], 64, 0), Err(too_small));
    assert!(tiles::make(&small, [1, 1], 48, 0).is_ok(), "the side that the error names is enough");
    let tiny = tiles::make(&photo(12, 1), [4, 4], 16, 0).expect_err("too small for anything");
    assert!(tiny.to_string().ends_with("take a larger one"), "{tiny}");
    for grid in [[0, 4], [4, 0], [17, 16], [u32::MAX; 2]] {
        assert_eq!(tiles::make(&small, grid, 16, 0), Err(TilesError::Count { grid }));
        assert_eq!(tiles::check(&small, grid, 1), Err(TilesError::Count { grid }));
    }
    for side in [0, 15, 1025, u32::MAX] {
        assert_eq!(tiles::make(&small, [1, 1], side, 0), Err(TilesError::TileSide { side }));
        assert_eq!(tiles::layout(2, side), Err(TilesError::TileSide { side }));
        assert_eq!(Family::cut(&small, side, 1, 0), Err(TilesError::TileSide { side }));
    }
    let large = TilesError::SheetTooLarge { grid: [16, 16], side: 1024 };
    assert_eq!(tiles::make(&small, [16, 16], 1024, 0), Err(large));
    let uneven = TilesError::UnevenGrid { size: [60, 60], grid: [7, 1] };
    assert_eq!(tiles::check(&small, [7, 1], 1), Err(uneven));
    let codes = TilesError::Codes { grid: [3, 3], families: 2 };
    assert_eq!(tiles::check(&small, [3, 3], 2), Err(codes));
    assert_eq!(Family::of_sheet(&small, [2, 1]), Err(TilesError::NotSquare { size: [30, 60] }));
    let family = |side| Family::cut(&small, side, 1, 0).expect("it is cut");
    let differ = TilesError::SizesDiffer { sizes: [[16, 16], [20, 20]] };
    assert_eq!(tiles::transition(&family(16), &family(20), 0), Err(differ));
}
