//! `inspect`: verdicts on made-up pictures, the sheet, and files that are no pictures.

use crate::workshop::{Run, Workshop, command, png_size};
use image::{DynamicImage, ImageFormat, RgbImage};
use serde_json::Value;
use std::io::Cursor;

/// Texels along a side of the pictures here.
const SIDE: u32 = 128;

/// Numbers without order, 0 to 255.
fn chance(x: u32, y: u32) -> u32 {
    let mut bits = x.wrapping_mul(0x9e37_79b9) ^ y.wrapping_mul(0x85eb_ca6b);
    for shift in [15, 13, 16] {
        bits = (bits ^ (bits >> shift)).wrapping_mul(0x2c1b_3c6d);
    }
    bits >> 24
}

/// Calm noise: grains around a middle grey.
fn noise(x: u32, y: u32) -> u32 {
    100 + chance(x, y) / 4
}

/// Rows of bricks with light joints, 32 by 16 texels.
fn bricks(x: u32, y: u32) -> u32 {
    let along = x + y / 16 % 2 * 16;
    if y % 16 < 2 || along % 32 < 2 { 200 } else { 80 + chance(x, y) / 16 }
}

/// Noise that gets lighter from left to right.
fn rising(x: u32, y: u32) -> u32 {
    x + chance(x, y) / 4
}

fn png(picture: DynamicImage) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, ImageFormat::Png).expect("the picture is encoded");
    bytes.into_inner()
}

fn picture(size: [u32; 2], code: fn(u32, u32) -> u32) -> Vec<u8> {
    let pixels = RgbImage::from_fn(size[0], size[1], |x, y| image::Rgb([code(x, y) as u8; 3]));
    png(pixels.into())
}

fn shop() -> Workshop {
    let shop = Workshop::new(&[]);
    shop.write("noise.png", picture([SIDE; 2], noise));
    shop.write("bricks.png", picture([SIDE; 2], bricks));
    shop.write("rising.png", picture([SIDE; 2], rising));
    shop
}

fn inspect(shop: &Workshop, arguments: &str) -> Run {
    shop.run(&["inspect"].into_iter().chain(arguments.split_whitespace()).collect::<Vec<_>>())
}

fn report(shop: &Workshop, arguments: &str) -> Value {
    let run = inspect(shop, &format!("{arguments} --format json"));
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{run:#?}");
    serde_json::from_str(&run.out).expect("JSON")
}

fn number(report: &Value, path: &str) -> f64 {
    report.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("no {path} in {report:#}"))
}

#[test]
fn noise_suits() {
    let found = report(&shop(), "noise.png");
    assert_eq!(found["verdict"], "suits", "{found:#}");
    assert!(number(&found, "/autocorrelation/most") < 0.1, "{found:#}");
    assert!(number(&found, "/distance/histogram") < number(&found, "/distance/linear"), "{found:#}");
    assert_eq!(found["advice"].as_array().map(Vec::len), Some(0));
}

#[test]
fn bricks_are_refused_with_their_period() {
    let shop = shop();
    let run = inspect(&shop, "bricks.png");
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{run:#?}");
    insta::assert_snapshot!("inspect_bricks", run.out);
    let found = report(&shop, "bricks.png");
    assert_eq!(found["verdict"], "does_not_suit");
    assert_eq!(found["says"], "does not suit: it repeats every 16 texels across and 16 down");
}

#[test]
fn a_gradient_has_a_wrap_step_across_and_uneven_light() {
    let found = report(&shop(), "rising.png");
    assert!(number(&found, "/wrap_step/0") > 1.6 && number(&found, "/wrap_step/1") < 1.6, "{found:#}");
    assert_eq!(found["verdict"], "doubtful", "{found:#}");
    let says = found["says"].as_str().expect("a sentence");
    assert!(says.contains("wider than hexagons of 64") && says.contains("lighter than others"), "{says}");
}

#[test]
fn the_sheet_is_written_and_threads_make_no_difference() {
    let shop = shop();
    let on = |threads: &str| {
        let arguments = ["inspect", "bricks.png", "-o", "sheet.png"];
        let run = command(&shop.path("")).args(arguments).env("RAYON_NUM_THREADS", threads).output();
        (run.expect("it runs").stdout, shop.read("sheet.png"))
    };
    let (one, three) = (on("1"), on("3"));
    assert!(one == three);
    assert_eq!(png_size(&one.1), [1032, 1032]);
    // The first panel is the picture repeated, the last is not.
    let sheet = image::load_from_memory(&one.1).expect("a PNG").into_rgb8();
    let rows = |left: u32, top: u32| {
        let light =
            |y: u32| (0..512).map(|x| u32::from(sheet.get_pixel(left + x, top + y)[1])).sum::<u32>() / 512;
        (0..512).map(light).fold((255, 0), |(least, most), light| (least.min(light), most.max(light)))
    };
    let ((dark, light), (blended_dark, blended_light)) = (rows(0, 0), rows(520, 520));
    assert!(light - dark > 2 * (blended_light - blended_dark), "joints no longer run across");
}

#[test]
fn any_picture_is_looked_at() {
    let shop = Workshop::new(&[]);
    shop.write("dot.png", picture([1, 1], noise));
    shop.write("line.png", picture([1, 70], noise));
    shop.write("wide.png", picture([150, 70], noise));
    let deep = image::ImageBuffer::from_fn(80, 70, |x, y| image::Luma([(chance(x, y) * 257) as u16]));
    shop.write("deep.png", png(DynamicImage::ImageLuma16(deep)));
    let clear =
        image::RgbaImage::from_fn(70, 70, |x, y| image::Rgba([noise(x, y) as u8, 90, 60, (120 + x) as u8]));
    shop.write("clear.png", png(clear.into()));
    shop.write("nothing.png", png(image::RgbaImage::new(80, 80).into()));
    for (arguments, verdict) in [
        ("dot.png", "doubtful"),
        ("line.png --channels 1", "doubtful"),
        ("wide.png", "suits"),
        ("deep.png --encoding linear", "suits"),
        ("deep.png --channels 1 --tile 0.25", "suits"),
        ("clear.png", "suits"),
        ("nothing.png", "suits"),
    ] {
        let found = report(&shop, arguments);
        assert!(found["verdict"] == verdict, "{arguments}: {found:#}");
    }
    assert!(inspect(&shop, "dot.png").out.contains("fewer than 64 texels a side tell little"));
}

#[test]
fn what_is_no_picture_is_refused() {
    let shop = shop();
    shop.write("sheet.png", "old");
    shop.write("text.png", "this is no picture");
    shop.write("huge.png", picture([9000, 1], noise));
    let cases = [
        ("gone.png", "there is no file `gone.png`"),
        ("noize.png", "is `noise.png` meant?"),
        ("text.png", "error[E0505]: `text.png` can't be read as a picture"),
        ("text.png --message-format short", "text.png:1:1: error[E0505]"),
        ("huge.png", "error[E0511]: a texture of `huge.png` would have 9000×1 texels"),
        (".", "error"),
    ];
    for (arguments, part) in cases {
        inspect(&shop, &format!("{arguments} -o sheet.png")).fails(1, part);
    }
    for (arguments, part) in [
        ("noise.png --channels 2", "colours have 3 channels and grey pictures 1"),
        ("noise.png --tile 0", "a hexagon is up to 1 picture high"),
        ("noise.png --tile nan", "no finite number"),
        ("noise.png -o sheet.jpg", "must end in `.png`"),
    ] {
        inspect(&shop, arguments).fails(2, part);
    }
    assert_eq!(shop.text("sheet.png"), "old");
}
