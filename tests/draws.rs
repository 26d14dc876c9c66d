//! Statistics of what the library draws for cells: by the hash, and by walks through a permutation
//! table σ of which a coordinate has two digits (size 256) or one (65,536). All draws are those of the
//! CPU renderer, which is what the GPU draws.

use texgraph_compiler::{Library, Options, compile, diagnostic::render};
use texgraph_runtime::cpu;
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::load;

/// Sides of a field in cells.
const SQUARE: [usize; 2] = [4096, 4096];
/// Cells after which a walk may repeat.
const PERIOD: usize = 65_536;
/// Of a field that holds whole periods, and all digits of the other axis.
const LONG: [usize; 2] = [256, PERIOD];
/// Cells that are drawn at once.
const PICTURE: usize = 1 << 20;
/// Patterns, unless a test says otherwise.
const COUNT: usize = 16;
/// The normal deviate that is passed with a probability of 10⁻⁴.
const RARE: f64 = 3.719;

/// A number for each cell from the first on, row by row, which a texture gives for its place in cells.
fn drawn(text: &str, first: [i32; 2], [width, height]: [usize; 2]) -> Vec<u32> {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("main.tex");
    std::fs::write(&file, text).expect("it is written");
    let project = Project::new(&file, true);
    let library = Library::standard().expect("the library parses");
    let compiled = compile(&library, project.main(), &project, &Options::default());
    let compiled = compiled.unwrap_or_else(|f| panic!("{}", render::human(&f.sources, &f.diagnostics)));
    let mut program = compiled.program;
    let tables = load(&mut program, &project).expect("tables need no file");
    let rows = (PICTURE / width).min(height);
    let strips = (0..height).step_by(rows).flat_map(|row| {
        let [left, top] = [f64::from(first[0]), f64::from(first[1]) + row as f64];
        let region = [left, top, left + width as f64, top + rows as f64];
        let request = Request { region, ..Request::new([width as u32, rows as u32]) };
        let picture = cpu::render(&program, &tables, &request, &|_| {}).expect("it is drawn");
        picture.pixels.into_iter().map(|pixel| pixel[0] as u32)
    });
    strips.collect()
}

/// How often each number below `kinds` stands there.
fn frequencies(numbers: impl IntoIterator<Item = usize>, kinds: usize) -> Vec<u64> {
    let mut found = vec![0; kinds];
    for number in numbers {
        found[number] += 1;
    }
    found
}

/// The normal deviate of a chi-square of so many degrees of freedom (Wilson & Hilferty 1931).
fn deviate(chi_square: f64, freedom: usize) -> f64 {
    let spread = 2.0 / (9.0 * freedom as f64);
    ((chi_square / freedom as f64).cbrt() - (1.0 - spread)) / spread.sqrt()
}

/// The chi-square of frequencies that should be equal.
fn from_equal(found: &[u64]) -> f64 {
    let equal = found.iter().sum::<u64>() as f64 / found.len() as f64;
    found.iter().map(|n| (*n as f64 - equal).powi(2) / equal).sum()
}

/// What a table of pairs, `COUNT` by `COUNT`, says of the dependence of its two sides.
struct Dependence {
    chi_square: f64,
    cramers_v: f64,
    correlation: f64,
}

fn dependence(pairs: &[u64]) -> Dependence {
    let total = pairs.iter().sum::<u64>() as f64;
    let sum = |of: &dyn Fn(usize) -> f64| (0..COUNT).map(of).sum::<f64>();
    let row = |i: usize| sum(&|j| pairs[i * COUNT + j] as f64);
    let column = |j: usize| sum(&|i| pairs[i * COUNT + j] as f64);
    let (rows, columns): (Vec<f64>, Vec<f64>) = (0..COUNT).map(|i| (row(i), column(i))).unzip();
    let chi_square = sum(&|i| {
        sum(&|j| {
            let expected = rows[i] * columns[j] / total;
            (pairs[i * COUNT + j] as f64 - expected).powi(2) / expected
        })
    });
    let mean = |sides: &[f64]| sum(&|i| i as f64 * sides[i]) / total;
    let (x, y) = (mean(&rows), mean(&columns));
    let variance = |sides: &[f64], mean: f64| sum(&|i| (i as f64 - mean).powi(2) * sides[i]);
    let product = sum(&|i| sum(&|j| (i as f64 - x) * (j as f64 - y) * pairs[i * COUNT + j] as f64));
    Dependence {
        chi_square,
        cramers_v: (chi_square / total / (COUNT - 1) as f64).sqrt(),
        correlation: product / (variance(&rows, x) * variance(&columns, y)).sqrt(),
    }
}

/// 20 streams of the hash, five in one number: each draws all patterns equally often, and any two
/// streams are independent.
#[test]
fn the_hash_draws_all_equally_and_streams_are_independent() {
    for first in (0..20).step_by(5) {
        let draw = |stream: usize| {
            format!(
                "{} * virtual_index(ifloor(uv), 16, stream: {})",
                16_usize.pow(stream as u32),
                first + stream
            )
        };
        let draws = (0..5).map(draw).collect::<Vec<_>>().join(" + ");
        let field =
            drawn(&format!("texture t(uv: vec2) -> (index: int) {{ index = {draws} }}"), [0, 0], SQUARE);
        let of = |number: u32, stream: u32| (number >> (4 * stream)) as usize % COUNT;
        for one in 0..5 {
            let found = frequencies(field.iter().map(|number| of(*number, one)), COUNT);
            let off = deviate(from_equal(&found), COUNT - 1);
            assert!(off < RARE, "stream {}: {off:.2} deviations, {found:?}", first as u32 + one);
            for two in 0..one {
                let pairs = field.iter().map(|number| COUNT * of(*number, one) + of(*number, two));
                let found = dependence(&frequencies(pairs, COUNT * COUNT));
                let off = deviate(found.chi_square, (COUNT - 1).pow(2));
                assert!(off < RARE, "streams {} and {}: {off:.2}", first as u32 + one, first as u32 + two);
            }
        }
    }
}

/// A permutation table.
#[derive(Clone, Copy)]
struct Sigma {
    size: u32,
    seed: u32,
}

/// Of which each coordinate has two digits below the default period.
const TWO_DIGITS: Sigma = Sigma { size: 256, seed: 1 };
/// Of which it has one.
const ONE_DIGIT: Sigma = Sigma { size: 65_536, seed: 1 };

/// A field that walks through σ draw for `uv`, or for `uv.yx`.
fn walked(Sigma { size, seed }: Sigma, field: [usize; 2], place: &str, stream: u32) -> Vec<u32> {
    let text = format!(
        "let sigma = permutation({size}, seed: {seed})\n\
         texture t(uv: vec2) -> (index: int) {{\n\
         index = virtual_index(ifloor({place}), {COUNT}, sigma: sigma, stream: {stream})\n}}"
    );
    drawn(&text, [0, 0], field)
}

/// The pairs of cells that are so far apart.
fn apart(field: &[u32], [width, height]: [usize; 2], [right, down]: [i32; 2]) -> Vec<u64> {
    let (right, down) = (right as isize, down as usize);
    let columns = (-right).max(0) as usize..width - right.max(0) as usize;
    let cells = (0..height - down).flat_map(|y| columns.clone().map(move |x| (x, y)));
    let pair = |(x, y): (usize, usize)| {
        let there = ((y + down) * width + x).wrapping_add_signed(right);
        field[y * width + x] as usize * COUNT + field[there] as usize
    };
    frequencies(cells.map(pair), COUNT * COUNT)
}

/// Over whole periods along rows, columns and diagonals.
fn leaves_no_trace_nearby(sigma: Sigma, size: [usize; 2]) {
    let (mut most_r, mut most_v) = (0.0_f64, 0.0_f64);
    for (place, directions) in [("uv", [[0, 1], [1, 1]]), ("uv.yx", [[0, 1], [-1, 1]])] {
        let field = walked(sigma, size, place, 0);
        let found = frequencies(field.iter().map(|number| *number as usize), COUNT);
        assert_eq!(found, [field.len() as u64 / COUNT as u64; COUNT], "not equally often");
        for ([right, down], lag) in directions.iter().flat_map(|d| (1..=8).map(move |lag| (d, lag))) {
            let found = dependence(&apart(&field, size, [lag * right, lag * down]));
            let (r, v) = (found.correlation.abs(), found.cramers_v);
            (most_r, most_v) = (most_r.max(r), most_v.max(v));
        }
    }
    println!("{} numbers, seed {}: at most |r| {most_r:.5}, V {most_v:.5}", sigma.size, sigma.seed);
    assert!(most_r < 0.01 && most_v < 0.1, "seed {}: r {most_r}, V {most_v}", sigma.seed);
}

#[test]
fn walks_of_two_digits_draw_all_equally_and_leave_no_trace_nearby() {
    for seed in 1..=20 {
        leaves_no_trace_nearby(Sigma { seed, ..TWO_DIGITS }, LONG);
    }
}

#[test]
fn walks_of_one_digit_draw_all_equally_and_leave_no_trace_nearby() {
    for seed in 1..=20 {
        leaves_no_trace_nearby(Sigma { seed, ..ONE_DIGIT }, [64, PERIOD]);
    }
}

/// The length of the longest part that a line both begins and ends with, itself apart.
fn longest_border(line: &[u32]) -> usize {
    let mut borders = vec![0; line.len()];
    for end in 1..line.len() {
        let mut length: usize = borders[end - 1];
        while length > 0 && line[length] != line[end] {
            length = borders[length - 1];
        }
        borders[end] = if line[length] == line[end] { length + 1 } else { 0 };
    }
    borders.last().copied().unwrap_or(0)
}

/// No shift of up to N - 64 cells lays a row, column or diagonal of a period on itself.
#[test]
fn no_line_of_a_walk_repeats() {
    const LINES: usize = 128;
    // Each column of a field is a line of the plane.
    let places = ["uv", "uv.yx", "vec2(uv.x + uv.y, uv.y)", "vec2(uv.x - uv.y, uv.y)"];
    for sigma in [TWO_DIGITS, ONE_DIGIT] {
        let fields = places.map(|place| walked(sigma, [LINES, PERIOD], place, 0));
        let lines = fields.iter().flat_map(|field| (0..LINES).map(|x| field[x..].iter().step_by(LINES)));
        let longest = lines.map(|line| longest_border(&line.copied().collect::<Vec<_>>())).max();
        println!("{} numbers: the longest border has {longest:?} cells", sigma.size);
        assert!(longest.is_some_and(|longest| longest < 64), "{} numbers: {longest:?}", sigma.size);
    }
}

/// Any two of 20 streams, in cells from all over the plane.
#[test]
fn all_pairs_of_twenty_streams_are_independent() {
    let table = |size| (format!("let sigma = permutation({size}, seed: 1)\n"), ", sigma: sigma");
    let hashed = (String::new(), "");
    for (name, (table, sigma)) in [("hash", hashed), ("256", table(256)), ("65,536", table(PERIOD))] {
        let streams: Vec<Vec<usize>> =
            (0..4).flat_map(|fives| five_streams(&table, sigma, 5 * fives)).collect();
        let pairs = (0..streams.len()).flat_map(|two| (0..two).map(move |one| (one, two)));
        let offs = pairs.map(|(one, two)| {
            let pairs = streams[one].iter().zip(&streams[two]).map(|(a, b)| COUNT * a + b);
            let found = dependence(&frequencies(pairs, COUNT * COUNT));
            (deviate(found.chi_square, (COUNT - 1).pow(2)), one, two)
        });
        let offs: Vec<_> = offs.collect();
        let (off, one, two) = offs.iter().copied().max_by(|a, b| a.0.total_cmp(&b.0)).expect("some");
        println!("{name}: of {} pairs {one} and {two} depend most, {off:.2} deviations", offs.len());
        assert!(offs.len() == 190 && off < RARE, "{name}: streams {one} and {two}: {off:.2}");
    }
}

/// What five streams from one on draw in a million cells of the plane.
fn five_streams(table: &str, sigma: &str, first: usize) -> Vec<Vec<usize>> {
    let draw = |stream: u32| {
        let stream_number = first + stream as usize;
        format!("{} * virtual_index(cell, {COUNT}, stream: {stream_number}{sigma})", COUNT.pow(stream))
    };
    let draws: Vec<String> = (0..5).map(draw).collect();
    let text = format!(
        "{table}texture t(uv: vec2) -> (index: int) {{\n\
         let cell = ifloor(hash(ifloor(uv), seed: 77).xy * {PERIOD}.0)\n\
         index = {}\n}}",
        draws.join(" + ")
    );
    let field = drawn(&text, [0, 0], [1024, 1024]);
    let of = |stream: u32| field.iter().map(|number| *number as usize / COUNT.pow(stream) % COUNT).collect();
    (0..5).map(of).collect()
}

/// Three streams of `virtual_index` and the first of `virtual_random`.
#[test]
fn streams_of_a_walk_are_independent() {
    let mut fields: Vec<Vec<u32>> = (0..3).map(|stream| walked(TWO_DIGITS, SQUARE, "uv", stream)).collect();
    let random = "let sigma = permutation(256, seed: 1)\n\
                  texture t(uv: vec2) -> (index: int) {\n\
                  index = int(virtual_random(ifloor(uv), sigma: sigma).x * 16.0)\n}";
    fields.push(drawn(random, [0, 0], SQUARE));
    for (one, two) in (0..4).flat_map(|two| (0..two).map(move |one| (one, two))) {
        let pairs = fields[one].iter().zip(&fields[two]).map(|(a, b)| COUNT * *a as usize + *b as usize);
        let found = dependence(&frequencies(pairs, COUNT * COUNT));
        let off = deviate(found.chi_square, (COUNT - 1).pow(2));
        println!(
            "streams {one} and {two}: {off:.2} deviations, V {:.5}, r {:.5}",
            found.cramers_v, found.correlation
        );
        assert!(off < RARE, "streams {one} and {two}: {off:.2}");
    }
}

/// A count that does not divide the size of σ: over a whole period every pattern is drawn equally
/// often, but for one cell; and so it is in cells from all over a longer one.
#[test]
fn any_count_is_drawn_without_bias() {
    let text = |size: u32, count: usize, cell: &str, period: u32| {
        format!(
            "let sigma = permutation({size}, seed: 5)\n\
             texture t(uv: vec2) -> (index: int) {{\n\
             index = virtual_index({cell}, {count}, sigma: sigma, period: {period})\n}}"
        )
    };
    for count in [3, 5, 7, 10, 100] {
        let whole = drawn(&text(8, count, "ifloor(uv)", 64), [-64, 128], [64, 64]);
        let found = frequencies(whole.iter().map(|index| *index as usize), count);
        let (least, most) = (found.iter().min(), found.iter().max());
        assert!(most.zip(least).is_some_and(|(most, least)| most - least <= 1), "{count}: {found:?}");
    }
    let anywhere = "ifloor(hash(ifloor(uv)).xy * 65536.0)";
    let spread = drawn(&text(256, 10, anywhere, 65_536), [0, 0], SQUARE);
    let found = frequencies(spread.iter().map(|index| *index as usize), 10);
    let off = deviate(from_equal(&found), 9);
    println!("10 patterns of 256: {off:.2} deviations");
    assert!(off < RARE, "{found:?}");
}

/// Tiles that lie next to each other agree on the colour of their edge, and all are drawn equally often.
#[test]
fn wang_tiles_fit_and_are_drawn_equally() {
    for colours in 2..=4 {
        let text = format!(
            "texture t(uv: vec2) -> (index: int) {{ index = wang(ifloor(uv), {colours}, stream: 7) }}"
        );
        let [width, height] = [1024, 1024];
        let field = drawn(&text, [-300, 5_000], [width, height]);
        let edge = |cell: usize, edge: u32| field[cell] / (colours as u32).pow(edge) % colours as u32;
        for cell in (0..height - 1).flat_map(|y| (0..width - 1).map(move |x| y * width + x)) {
            let (right, below) = (edge(cell, 2), edge(cell, 3));
            assert!(right == edge(cell + 1, 0) && below == edge(cell + width, 1), "{colours}: cell {cell}");
        }
        let kinds = usize::pow(colours, 4);
        let found = frequencies(field.iter().map(|index| *index as usize), kinds);
        // Neighbours share edges, so their numbers are not independent: only the means must be.
        let equal = field.len() as f64 / kinds as f64;
        let worst = found.iter().map(|n| (*n as f64 - equal).abs() / equal.sqrt()).fold(0.0, f64::max);
        println!("{colours} colours: {worst:.2} deviations");
        assert!(worst < 5.0, "{colours}: {found:?}");
    }
}
