//! `tiles`: sheets of photographs, what is said of their edges, and refusals that leave the old file.

use crate::workshop::{Run, Workshop, examples, png_size};

/// A folder with a photograph of 512 texels a side.
fn shop() -> Workshop {
    let shop = Workshop::new(&[]);
    let photo = std::fs::read(examples().join("tiles/source/grass_grey.png")).expect("the photograph");
    shop.write("lawn.png", photo);
    shop
}

fn tiles(shop: &Workshop, arguments: &str) -> Run {
    let arguments = ["tiles"].into_iter().chain(arguments.split_whitespace());
    shop.run(&arguments.collect::<Vec<_>>())
}

#[test]
fn a_photograph_becomes_a_sheet_that_fits() {
    let shop = shop();
    let run = tiles(&shop, "make lawn.png --grid 3x2 --size 32 -o grass.png");
    assert!(run.is_silent(), "{run:#?}");
    assert_eq!(png_size(&shop.read("grass.png")), [96, 64]);
    let run = tiles(&shop, "check grass.png --grid 3x2 --max 0");
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{run:#?}");
    let first = shop.read("grass.png");
    assert!(tiles(&shop, "make lawn.png --grid 3x2 --size 32 --seed 0 -o grass.png").is_silent());
    assert_eq!(shop.read("grass.png"), first);
    assert!(tiles(&shop, "make lawn.png --grid 3x2 --size 32 --seed 1 -o grass.png").is_silent());
    assert_ne!(shop.read("grass.png"), first);
}

#[test]
fn two_families_get_their_transitions() {
    let shop = shop();
    for name in ["a", "b"] {
        let seed = if name == "a" { 3 } else { 4 };
        assert!(tiles(&shop, &format!("make lawn.png --size 24 --seed {seed} -o {name}.png")).is_silent());
    }
    let run = tiles(&shop, "transition a.png b.png --grid 4x4 -o shore.png");
    assert!(run.is_silent(), "{run:#?}");
    assert_eq!(tiles(&shop, "check shore.png --families 2 --max 0").code, 0);
    let run = tiles(&shop, "check shore.png --max 0");
    run.fails(1, "error: facing edges of `shore.png` differ by");
    let run = tiles(&shop, "transition lawn.png --border --size 24 -o edge.png");
    assert!(run.is_silent(), "{run:#?}");
    assert_eq!(shop.read("edge.png")[25], 4, "grey with alpha");
    assert_eq!(tiles(&shop, "check edge.png --families 2 --max 0").code, 0);
    tiles(&shop, "transition a.png edge.png --grid 5x5 -o no.png")
        .fails(1, "error: `a.png`: a grid of 5×5 does not divide 96×96 texels");
    tiles(&shop, "transition a.png -o no.png").fails(2, "<SECOND>");
    tiles(&shop, "transition a.png b.png --border -o no.png").fails(2, "cannot be used with");
    assert!(!shop.names().contains(&"no.png".to_owned()));
}

#[test]
fn the_table_names_the_worst_pairs() {
    let shop = Workshop::new(&[]);
    assert!(tiles(&shop, "layout --size 32 -o sheet.png").is_silent());
    let run = tiles(&shop, "check sheet.png --families 2");
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{run:#?}");
    assert_eq!(run.out.lines().count(), 4, "no pair is named where all fit: {run:#?}");
    let run = tiles(&shop, "check sheet.png --max 85");
    run.fails(1, "error: facing edges of `sheet.png` differ by 86 levels, 85 are allowed\n");
    insta::assert_snapshot!("tiles_check", run.out);
    assert_eq!(tiles(&shop, "check sheet.png --max 86").code, 0);
}

#[test]
fn figures_for_programs_are_json() {
    let shop = Workshop::new(&[]);
    assert!(tiles(&shop, "layout --size 32 -o sheet.png").is_silent());
    let run = tiles(&shop, "check sheet.png --format json --max 9 --message-format json");
    assert!(run.code == 1 && run.err.starts_with("{\"message\":\"facing edges"), "{run:#?}");
    let report: serde_json::Value = serde_json::from_str(&run.out).expect("JSON");
    let at = |path: &str| report.pointer(path).unwrap_or_else(|| panic!("no {path} in {report:#}")).clone();
    assert_eq!((at("/tiles"), at("/pairs"), at("/size/0")), (16.into(), 512.into(), 32.into()));
    assert_eq!((at("/facing/max"), at("/worst/0/apart/max")), (86.into(), 86.into()));
    assert_eq!((at("/worst/0/first"), at("/worst/0/side")), (0.into(), "bottom".into()));
    assert_eq!(at("/worst").as_array().map(Vec::len), Some(5));
}

#[test]
fn empty_sheets_have_all_corner_codes() {
    let shop = Workshop::new(&[]);
    for (families, side) in [(1, 20), (2, 80), (3, 180), (4, 320)] {
        let run = tiles(&shop, &format!("layout --families {families} --size 20 -o sheet.png"));
        assert!(run.is_silent(), "{run:#?}");
        assert_eq!(png_size(&shop.read("sheet.png")), [side, side]);
    }
    let old = shop.read("sheet.png");
    let run = tiles(&shop, "layout --families 5 -o sheet.png");
    run.fails(2, "5 families have 625 corner codes, and a sheet has 256 tiles at most");
    assert!(run.err.contains("--border"), "{run:#?}");
    tiles(&shop, "layout --families 0 -o sheet.png").fails(2, "0 families");
    assert_eq!(shop.read("sheet.png"), old);
}

#[test]
fn what_is_no_photograph_is_refused() {
    let shop = shop();
    shop.write("sheet.png", "old");
    shop.write("text.png", "this is no picture");
    let cases = [
        ("make gone.png -o sheet.png", "there is no file `gone.png`"),
        ("make lawm.png -o sheet.png", "is `lawn.png` meant?"),
        ("make text.png -o sheet.png", "error[E0505]: `text.png` can't be read as a picture"),
        ("make text.png -o sheet.png --message-format short", "text.png:1:1: error[E0505]"),
        ("make . -o sheet.png", "error"),
        (
            "make lawn.png --size 500 -o sheet.png",
            "tiles of 500 need 564×564: take a larger one, or a --size of at most 448",
        ),
        ("transition lawn.png gone.png --size 32 -o sheet.png", "there is no file `gone.png`"),
        ("check text.png", "error[E0505]"),
        ("check lawn.png --grid 5x4", "a grid of 5×4 does not divide 512×512 texels"),
        ("check lawn.png --families 3", "3 families have 81 corner codes, but a grid of 4×4 has 16 tiles"),
    ];
    for (arguments, part) in cases {
        tiles(&shop, arguments).fails(1, part);
    }
    assert_eq!(shop.text("sheet.png"), "old");
    assert_eq!(shop.names(), ["lawn.png", "sheet.png", "text.png"]);
}

#[test]
fn wrong_usage() {
    let shop = shop();
    let cases = [
        ("make lawn.png --grid 0x0 -o sheet.png", "a grid has 1 or more columns and rows, not `0`"),
        ("make lawn.png --grid 4 -o sheet.png", "write columns and rows as 4x4"),
        ("make lawn.png --grid 99999999999x1 -o sheet.png", "not `99999999999`"),
        ("make lawn.png --grid 17x16 -o sheet.png", "a sheet has 1 to 256 tiles; 17×16 are 272"),
        ("make lawn.png --size 15 -o sheet.png", "a tile has 16 to 1024 texels a side, not 15"),
        ("make lawn.png --size 1024 --grid 16x16 -o sheet.png", "take fewer or smaller ones"),
        ("make lawn.png --seed=-1 -o sheet.png", "seed"),
        ("make lawn.png -o sheet.jpg", "must end in `.png`"),
        ("make lawn.png", "-o <OUT.png>"),
        ("check lawn.png --max 256", "max"),
        ("paint lawn.png", "paint"),
        ("", "Usage: texgraph tiles"),
    ];
    for (arguments, part) in cases {
        tiles(&shop, arguments).fails(2, part);
    }
    tiles(&shop, "make lawn.png -o no/such/sheet.png").fails(3, "there is no folder `no/such`");
    assert_eq!(shop.names(), ["lawn.png"]);
}

#[test]
fn every_subcommand_shows_an_example() {
    for name in ["make", "transition", "layout", "check"] {
        let run = Workshop::new(&[]).run(&["tiles", name, "--help"]);
        assert_eq!((run.code, run.err.as_str()), (0, ""));
        assert!(
            run.out.contains("Example") && run.out.contains(&format!("texgraph tiles {name} ")),
            "{}",
            run.out
        );
        assert!(run.out.lines().all(|line| line.chars().count() <= 100), "{}", run.out);
    }
}
