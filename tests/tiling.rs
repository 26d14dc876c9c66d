//! Textures with a period: what the compiler proves to tile does, bit by bit where numbers are exact,
//! on the CPU; what it refuses does not, and the culprit is named.

use std::collections::HashMap;
use std::path::Path;
use texgraph_compiler::{Library, Options, Program, compile, diagnostic::render};
use texgraph_runtime::cpu;
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::load;

/// Pixels of a picture's side: the steps between them, and the periods, are exact.
const SIDE: u32 = 64;

/// Right programs: the period as written, and what is between the clause and the end.
const TILES: &[(&str, &str, &str)] = &[
    ("1", "height = fract(uv.x * 4.0) + fract(uv.y * 3.0)", ""),
    ("1", "height = sin(uv.x * 1turn) * cos(uv.y * 3turn) + tan(uv.x * 0.5turn) * 0.001", ""),
    ("vec2(2, 1)", "height = fract(uv.x * 0.5) + fract(uv.y)", ""),
    ("0.5", "height = fract(uv.x * 4.0) + uv.y % 0.5", ""),
    ("vec2(1, 0)", "height = fract(uv.x) + uv.y", ""),
    ("1", "let c = ifloor(uv * 8.0) height = hash(c % 8).x", ""),
    ("1", "let c = ifloor(uv * vec2(8.0, 4.0)) height = hash(c % ivec2(8, 2), seed: 3).x", ""),
    ("1", "let (c, at) = tile_map(uv, 8) height = at.x + hash(c % 4).y", ""),
    (
        "1",
        "let (c, at) = tile_map(uv, cells) height = at.x + hash(c % cells).y",
        "param cells: int = 4 in 1..=64",
    ),
    ("1", "height = noisy(uv * 8.0, 8)", NOISY),
    ("1", "height = noisy(uv * 8.0, 0) * 0.0 + noisy(uv * 4.0, 4)", NOISY),
    ("1", "height = noisy(uv * cells, cells)", PARAM_NOISY),
    ("1", "height = octaves(uv * 4.0, 4)", NOISY),
    ("1", "height = octaves(turned * (uv * 2.0), 2)", NOISY),
    ("2", "height = noisy(quarter(0.25turn) * (uv * 4.0), 8)", NOISY),
    ("1", "height = min(fract(uv.x), fract(uv.y + 0.25))", ""),
    ("1", "let a = uv.x * 2.0 let b = uv.x * 2.0 + fract(uv.y) height = max(a, b) - a", ""),
    ("1", "height = if fract(uv.x) < 0.5 { fract(uv.y) } else { fract(uv.y * 2.0) }", ""),
    (
        "1",
        "let p = if fract(uv.x * 2.0) < 0.5 { uv } else { uv.yx * 2.0 } height = fract(p.x) + fract(p.y)",
        "",
    ),
    ("1", "let c = ifloor(uv * 4.0) height = float((c.x * c.y) % 2) + float((c.x + c.y) % 2)", ""),
    ("1", "let c = ifloor(uv * 4.0) let q = 1.0 + floor(hash(c % 4).x * 3.0) height = fract(uv.x * q)", ""),
    ("1", "let row = ifloor(uv.y * 8.0) height = fract(uv.x * 4.0 + 0.5 * float(row % 2))", ""),
    ("1", "let c = ifloor(uv * 16.0) height = hash((c / 4) % 4).x", ""),
    ("1", "let c = ifloor(uv * 16.0) height = float(bits(c.x, 0, 3) + bits(c.y, 1, 3))", ""),
    ("1", "height = dx(uv.x * 3.0) * 8.0 + footprint(uv)", ""),
    ("0.1", "height = fract(uv.x * 10.0) + fract(uv.y * 20.0)", ""),
    ("1.0 / 3.0", "height = fract(uv.x * 3.0) + sin(uv.y * 6turn)", ""),
    ("period * 0.5", "height = fract(uv.x * 2.0) + fract(uv.y * 4.0)", "let period = 1"),
    ("1", "height = near(uv * 4.0)", NEAR),
    ("1", "height = mix(uv.x, uv.x + fract(uv.y), fract(uv.x * 2.0)) - uv.x", ""),
    ("1", "height = distance(uv, floor(uv) + hash(ifloor(uv) % 1).xy)", ""),
    ("1", "height = fract(now * 0.3 + uv.x) + hash(ivec2(instance, 1)).x", TIMED),
    (
        "1",
        "height = table[ifloor(uv.x * 4.0) % 4] + table[ifloor(uv.y * 2.0) % 2]",
        "let table = [0.1, 0.5, 0.7, 0.9]",
    ),
    ("1", "height = float(map.at(ifloor(uv * 6.0)))", "let map = indices([[0, 1, 2], [3, 4, 5]])"),
    ("1", "height = baked.sample(uv * 3.0).r", BAKED),
    ("2", "height = mirrored.sample(uv).r", BAKED),
    ("1", "let s = baked.size height = baked.texel(ifloor(uv * s) % s).r", BAKED),
    ("1", "height = long(uv * 2.0)", LONG),
    ("1", "height = deep(uv * 8.0)", DEEP),
    ("1", "height = float(fold (n = ifloor(uv.x * 4.0) % 4) for i in 0..9 while n > 1 { n = n - 1 })", ""),
    (
        "1",
        "let n = ifloor(fract(uv.x) * 3.0) height = fold (s = 0.0) for i in 0..n max 4 { s = s + fract(uv.y * float(i)) }",
        "",
    ),
    ("1", "let a = if uv.x + 1.0 > uv.x { 1.0 } else { 0.0 } height = a * fract(uv.y)", ""),
    ("1", "height = clamp(uv.x * 2.0, uv.x * 2.0 - fract(uv.y), uv.x * 2.0 + 0.25) - 2.0 * uv.x", ""),
];

/// The library's nodes with a period: how they are called, of `p`, which is 4 by 4 cells in a period.
const NODES: &[&str] = &[
    "noise(p, period: ivec2(4))",
    "value_noise(p, seed: 3, period: ivec2(4))",
    "simplex(p, period: ivec2(4))",
    "gabor(p, period: ivec2(4))",
    "fbm(p, period: ivec2(4))",
    "fbm(p, octaves: 3, lacunarity: 3.0, period: ivec2(4))",
    "turbulence(p, period: ivec2(4))",
    "billow(p, period: ivec2(4))",
    "ridged(p, octaves: octaves, period: ivec2(4))",
    "noise(warp(p, amount: 0.3, period: ivec2(4)), period: ivec2(4))",
    "curl(p, period: ivec2(4)).x",
    "noise(vec3(p, 0.5), period: ivec3(4, 4, 0))",
    "voronoi(p, period: ivec2(4)).edge",
    "voronoi(p, per_cell: 2, metric: manhattan, search: near, period: ivec2(4)).f2",
    "voronoi(p, jitter: jitter, period: ivec2(4)).random.x",
    "worley(p, period: ivec2(4))",
    "clouds(p, cover: 0.4, period: ivec2(4)).density",
    "bomb(p, |at, rnd| spot(at), period: ivec2(4)).r",
    "bomb(p, |at, rnd| spot(at), per_cell: 2, rotation: vec2(0.0, 1turn), density: |q| 0.5 + 0.5 * noise(q, period: ivec2(4)), phase: jitter, period: ivec2(4)).r",
    "oversampled(p, |q| vec4(noise(q, period: ivec2(4)))).r",
];

/// Wrong programs: the period, the text, the items, and what the first error names.
const BREAKS: &[(&str, &str, &str, &str)] = &[
    ("1", "height = uv.x", "", "`height` does not tile along `u`"),
    ("1", "height = fract(uv.x * 2.5)", "", "`fract` keeps `height` from tiling along `u`"),
    ("1", "height = fract(uv.x) * fract(uv.y * 0.5)", "", "`fract` keeps `height` from tiling along `v`"),
    ("1", "height = sin(uv.x * 3.0)", "", "`sin` keeps"),
    ("1", "height = tan(uv.y * 0.25turn)", "", "`tan` keeps"),
    ("1", "height = hash(ifloor(uv * 8.0)).x", "", "`hash` keeps `height` from tiling along `u` and `v`"),
    ("1", "height = hash(ifloor(uv * 8.0) % 3).x", "", "`%` keeps"),
    ("1", "height = hash(ifloor(uv * 8.5) % 8).x", "", "`ifloor` keeps"),
    ("1", "height = length(uv)", "", "`length` keeps"),
    ("1", "height = uv.x * uv.y", "", "`*` keeps"),
    ("1", "height = noise(uv * 8.0)", "", "`noise` keeps"),
    ("1", "height = noisy(uv * 8.0, 0)", NOISY, "`hash` keeps"),
    ("1", "height = noisy(uv * 8.0, 3)", NOISY, "`%` keeps"),
    ("1", "height = noisy(uv * 8.0, cells)", PARAM_NOISY, "`%` keeps"),
    ("1", "height = octaves(quarter(0.1turn) * (uv * 4.0), 4)", NOISY, "`ifloor` keeps"),
    ("1", "height = if uv.x < 0.5 { 0.0 } else { 1.0 }", "", "`<` keeps"),
    ("1", "height = min(fract(uv.x), uv.y)", "", "`min` keeps `height` from tiling along `v`"),
    ("1", "height = float(int(uv.x * 4.0 - 2.0) % 4)", "", "`int` keeps"),
    ("1", "height = fract(uv.x * (1.0 + fract(uv.y)))", "", "`*` keeps"),
    ("1", "let p = if fract(uv.x) < 0.3 { uv.x } else { uv.x * 1.414 } height = fract(p)", "", "`if` keeps"),
    ("1", "height = float((ifloor(uv.x * 7.0) * 747796405) % 7)", "", "`*` keeps"),
    ("1", "height = clamped.sample(uv).r", BAKED, "`sample` keeps"),
    ("1", "height = mirrored.sample(uv).r", BAKED, "`sample` keeps"),
    ("1", "height = baked.sample(uv * 1.5).r", BAKED, "`sample` keeps"),
    ("1", "height = baked.texel(ifloor(uv * 8.0)).r", BAKED, "keeps"),
    (
        "1",
        "height = float(map.at(ifloor(uv * 5.0)))",
        "let map = indices([[0, 1, 2], [3, 4, 5]])",
        "`at` keeps",
    ),
    ("1", "height = table[ifloor(uv.x * 4.0)]", "let table = [0.1, 0.5, 0.7, 0.9]", "`[]` keeps"),
    ("1", "height = long(uv * 2.5)", LONG, "keeps"),
    (
        "1",
        "height = fold (s = 0.0) for i in 0..ifloor(uv.x * 4.0) max 4 { s = s + 0.25 }",
        "",
        "`fold` keeps",
    ),
    ("1", "height = fold (s = 0.0) for i in 0..4 while s < uv.x { s = s + 0.25 }", "", "`<` keeps"),
    ("1", "height = dx(uv.x * uv.x) * 64.0", "", "`*` keeps"),
    ("1", "height = float((ifloor(uv.x * 7.0) + 2147483645) % 7)", "", "`+` keeps"),
    (
        "1",
        "height = if scale * 1000000.0 + 0.001 > scale * 1000000.0 { 0.0 } else { uv.x }",
        "param scale: float = 2.5",
        "`height` does not",
    ),
    ("vec2(0, 1)", "height = fract(uv.x * 1.3) + fract(uv.y * 1.3)", "", "from tiling along `v`"),
    ("1", "height = fract(uv.x * scale)", "param scale: float = 2.5", "`fract` keeps"),
    ("1", "height = fract(uv.x * 1000.0005)", "", "`fract` keeps"),
    ("1", "height = fract(uv.x * 0.0000001) * 10000000.0", "", "`fract` keeps"),
];

/// A noise of cells whose numbers wrap, where a period is given.
const NOISY: &str = "
node noisy(p: vec2, period: int) -> (value: float) {
    let cell = ifloor(p)
    let at   = fract(p)
    value = fold (sum = 0.0) for o in ivec2(0)..=ivec2(1) {
        let place   = cell + o
        let wrapped = if period == 0 { place } else { place % period }
        let weight  = 1.0 - abs(o - at)
        sum = sum + hash(wrapped).x * weight.x * weight.y
    }
}
node octaves(p: vec2, period: int) -> (value: float) {
    let all = fold (sum = 0.0, place = p, wrap = period, height = 1.0) for i in 0..4 {
        sum    = sum + noisy(place, wrap) * height
        place  = place * 2.0
        wrap   = wrap * 2
        height = height * 0.5
    }
    value = all.sum
}
node quarter(angle: float) -> (m: mat2) {
    m = mat2(vec2(cos(angle), sin(angle)), vec2(-sin(angle), cos(angle)))
}
let turned = mat2(vec2(1.0, 2.0), vec2(-2.0, 1.0))
";
const PARAM_NOISY: &str = "
param cells: int = 5 in 1..=64
node noisy(p: vec2, period: int) -> (value: float) {
    let cell = ifloor(p)
    let wrapped = if period > 0 { cell % period } else { cell }
    value = hash(wrapped).x + fract(p.y)
}
";
const NEAR: &str = "
node near(p: vec2) -> (distance: float) {
    let cell = ifloor(p)
    distance = fold (best = 8.0) for o in ivec2(-1)..=ivec2(1) {
        let middle = hash((cell + o) % 4).xy + cell + o
        best       = min(best, distance(p, middle))
    }
}
";
const TIMED: &str = "let now = 2.0 let instance = 3";
const BAKED: &str = "
let baked    = bake(|at| at.x * at.x + at.y, size: 8)
let mirrored = bake(|at| at.x * at.x + at.y, size: 8, wrap: mirror)
let clamped  = bake(|at| at.x * at.x + at.y, size: 8, wrap: clamp)
";
const DEEP: &str = "
node deep(p: vec2) -> (value: float) {
    value = fold (a = 0.0) for i in 0..12 {
        a = a + fold (b = 0.0) for j in 0..30 {
            b = b + fold (c = 0.0) for k in 0..30 {
                c = c + hash((ifloor(p) + ivec2(i + j, k)) % 8).x * 0.001
            }
        }
    }
}
";
const LONG: &str = "
node long(p: vec2) -> (value: float) {
    let all = fold (sum = 0.0, place = p) for i in 0..300 {
        sum   = sum + hash(ifloor(place) % 2).x * 0.01
        place = place + vec2(1.0, 0.5) * fract(p.x)
    }
    value = all.sum
}
";

fn source(period: Option<&str>, body: &str, items: &str) -> String {
    let clause = period.map_or(String::new(), |period| format!(" tiles {period}"));
    format!("{items}\ntexture t(uv: vec2) -> (height: float){clause} {{ {body} }}\n")
}

fn compiled(library: &Library, text: &str) -> Result<Program, String> {
    let files = HashMap::from([("t.tex".to_owned(), text.to_owned())]);
    let compiled = compile(library, "t.tex", &files, &Options::default());
    compiled.map(|compiled| compiled.program).map_err(|e| render::human(&e.sources, &e.diagnostics))
}

/// The picture whose left upper corner is there.
fn picture(program: &mut Program, [x, y]: [f64; 2]) -> Vec<f32> {
    let project = Project::new(Path::new("nowhere/t.tex"), false);
    let tables = load(program, &project).expect("loads");
    let request = Request { region: [x, y, x + 2.0, y + 2.0], ..Request::new([SIDE, SIDE]) };
    let picture = cpu::render(program, &tables, &request, &|_| {}).expect("renders");
    picture.pixels.iter().map(|pixel| pixel[0]).collect()
}

/// Of how many pixels a picture differs from the one a move farther, by more than rounding.
fn differing(program: &mut Program, from: [f64; 2], by: [f64; 2], bound: f32) -> usize {
    let here = picture(program, from);
    let there = picture(program, [from[0] + by[0], from[1] + by[1]]);
    here.iter().zip(&there).filter(|(a, b)| (**a - **b).abs() > bound).count()
}

/// The period that a program has been proved to have.
fn moves(period: [f32; 2]) -> Vec<[f64; 2]> {
    let [x, y] = period.map(f64::from);
    [[x, 0.0], [0.0, y], [-x, 0.0], [x, -2.0 * y]].into_iter().filter(|by| *by != [0.0, 0.0]).collect()
}

/// What is wrong with each of some programs, all of it in one go.
fn report(wrong: Vec<String>) {
    assert!(wrong.is_empty(), "{} programs:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn what_is_proved_to_tile_does() {
    let library = Library::standard().expect("the library parses");
    let mut wrong = Vec::new();
    for (period, body, items) in TILES {
        let text = source(Some(period), body, items);
        let mut program = match compiled(&library, &text) {
            Ok(program) => program,
            Err(errors) => {
                wrong.push(format!("{text}{errors}"));
                continue;
            }
        };
        let period = program.manifest.tiles.expect("the manifest says so");
        let is_exact = period.iter().all(|length| (length * 8.0).fract() == 0.0);
        // Where the period is no sum of halves, a pixel may lie on the other side of a step.
        let most = if is_exact { 0 } else { (SIDE * SIDE / 16) as usize };
        for by in moves(period) {
            for from in [[-1.25, -0.75], [0.0, 0.0], [3.5, 1.0]] {
                let count = differing(&mut program, from, by, 1e-4);
                if count > most {
                    wrong.push(format!("{text}{count} pixels from {from:?} by {by:?}"));
                }
            }
        }
    }
    report(wrong);
}

const USED: &str = "
param octaves: int = 4 in 1..=8
param jitter: float = 0.5 in 0.0..=1.0
node spot(at: vec2) -> (color: color) { color = vec4(smoothstep(0.5, 0.3, length(at))) }
";

#[test]
fn nodes_with_a_period_tile() {
    let library = Library::standard().expect("the library parses");
    let mut wrong = Vec::new();
    for node in NODES {
        let text = source(Some("1"), &format!("let p = uv * 4.0 height = {node}"), USED);
        match compiled(&library, &text) {
            Ok(mut program) => {
                for by in moves([1.0, 1.0]) {
                    let count = differing(&mut program, [-1.25, 0.5], by, 1e-4);
                    if count > 0 {
                        wrong.push(format!("{node}: {count} pixels by {by:?}"));
                    }
                }
            }
            Err(errors) => wrong.push(errors),
        }
        let other = text.replace("uv * 4.0", "uv * 3.0");
        if compiled(&library, &other).is_ok() {
            wrong.push(format!("{node}: tiles with 3 cells in a period"));
        }
    }
    report(wrong);
}

#[test]
fn what_is_refused_does_not_tile() {
    let library = Library::standard().expect("the library parses");
    let mut wrong = Vec::new();
    for (period, body, items, named) in BREAKS {
        let text = source(Some(period), body, items);
        let Err(errors) = compiled(&library, &text) else {
            wrong.push(format!("{text}is accepted"));
            continue;
        };
        if !errors.contains("E0806") || !errors.contains(named) {
            wrong.push(format!("{text}{errors}"));
            continue;
        }
        let mut program = compiled(&library, &source(None, body, items)).expect("right but for the clause");
        assert_eq!(program.manifest.tiles, None);
        let along = [("`u`", [1.0, 0.0]), ("`v`", [0.0, 1.0])];
        let line = errors.lines().find(|line| line.contains("E0806")).unwrap_or_default();
        for (_, by) in along.into_iter().filter(|(axis, _)| line.contains(axis)) {
            if differing(&mut program, [-1.25, -0.75], by, 1e-7) == 0 {
                wrong.push(format!("{text}tiles all the same along {by:?}\n{errors}"));
            }
        }
    }
    report(wrong);
}

/// Programs made at random of what repeats often. Waves and slopes are raised, and long loops forget:
/// where rounding decides on which side of a step a number lies, nothing repeats for sure.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, sides: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) % sides
    }

    fn one_of<'a>(&mut self, all: &[&'a str]) -> &'a str {
        all[self.roll(all.len() as u64) as usize]
    }

    /// A form with its holes filled: `F` a float, `I` an int, `B` a truth, `K` a number.
    fn fill(&mut self, form: &str, depth: u32) -> String {
        let mut text = String::new();
        for letter in form.chars() {
            match letter {
                'F' => text.push_str(&self.float(depth - 1)),
                'I' => text.push_str(&self.int(depth - 1)),
                'B' => text.push_str(&self.truth(depth - 1)),
                'K' => text.push_str(self.one_of(&["1", "2", "3", "4", "8"])),
                other => text.push(other),
            }
        }
        text
    }

    fn float(&mut self, depth: u32) -> String {
        if depth == 0 {
            return self.one_of(&["uv.x", "uv.y", "uv.x", "uv.y", "0.5", "2.0", "scale"]).to_owned();
        }
        let form = self.one_of(&[
            "(F + F)",
            "(F - F)",
            "(F * F)",
            "(F * K.0)",
            "(F * K.0)",
            "fract(F)",
            "fract(F)",
            "fract(F * K.0)",
            "(sin(F * 1turn) + 0.3)",
            "(cos(F * K.0 * 1turn) + 0.3)",
            "(F % K.0)",
            "floor(F)",
            "abs(F)",
            "min(F, F)",
            "max(F, F)",
            "mix(F, F, F)",
            "clamp(F, F, F)",
            "(if B { F } else { F })",
            "(if B { F } else { F })",
            "float(I)",
            "float(I)",
            "hash(ivec2(I, I)).x",
            "hash(ivec2(I, I) % K).y",
            "hash(ivec2(I, I) % K, seed: I % K).y",
            "length(vec2(F, F))",
            "distance(vec2(F, F), vec2(F, F))",
            "dot(vec2(F, K.0), vec2(K.0, F))",
            "baked.sample(vec2(F, F)).r",
            "baked.sample(vec2(F, F)).r",
            "mirrored.sample(vec2(F, F)).r",
            "(dx(F) * 7.3 + 0.1)",
            "step(F, F)",
            "(F / K.0)",
            "smoothstep(F, F, F)",
            "vec2(F, F)[I]",
            "(F / scale)",
            "part(F, I)",
            "part(F * K.0, K)",
            "(fold (s = 0.0, p = F) for i in 0..3 { s = s + fract(p) p = p * 2.0 }).s",
            "(fold (s = F) for i in 0..I max 4 { s = s + F })",
            "(fold (s = F) for i in 0..200 { s = fract(s * 0.5 + F) })",
        ]);
        self.fill(form, depth)
    }

    fn int(&mut self, depth: u32) -> String {
        if depth == 0 {
            return self
                .one_of(&["1", "2", "3", "count", "ifloor(uv.x * 4.0)", "ifloor(uv.y * 2.0)"])
                .to_owned();
        }
        let form = self.one_of(&[
            "ifloor(F)",
            "ifloor(F * K.0)",
            "(I + I)",
            "(I - I)",
            "(I * K)",
            "(I * I)",
            "(I % K)",
            "(I % K)",
            "(I / K)",
            "(if B { I } else { I })",
            "bits(I, 0, 2)",
            "min(I, I)",
            "int(F)",
            "abs(I)",
            "(I % count)",
            "table[I]",
            "map.at(ivec2(I, I))",
            "(I * count)",
            "int(floor(F))",
        ]);
        self.fill(form, depth)
    }

    fn truth(&mut self, depth: u32) -> String {
        if depth == 0 {
            return self
                .one_of(&["count > 2", "uv.x < uv.y", "fract(uv.x) < 0.5", "fract(uv.y) < 0.25"])
                .to_owned();
        }
        let form = self.one_of(&["F < F", "F >= F", "I == I", "I != I", "I <= I", "(B && B)", "(B || B)"]);
        self.fill(form, depth)
    }
}

const RANDOM: &str = "
param scale: float = 1.5 in 0.5..=4.0
param count: int = 3 in 1..=8
let baked    = bake(|at| at.x * at.x + at.y, size: 8)
let mirrored = bake(|at| at.x * at.x + at.y, size: 8, wrap: mirror)
let map      = indices([[0, 1, 2], [3, 4, 5]])
let table    = [1, 5, 7, 9]
node part(x: float, n: int) -> (y: float) {
    let wrapped = if n > 0 { ifloor(x) % n } else { ifloor(x) }
    y = hash(wrapped).x + fract(x)
}
";

#[test]
fn random_textures_that_are_proved_to_tile_do() {
    let library = Library::standard().expect("the library parses");
    let mut dice = Dice(0x2545_F491_4F6C_DD1D);
    let (mut proved, mut refused, mut refused_for_nothing, mut wrong) = (0, 0, 0, Vec::new());
    for _ in 0..programs() {
        let body = format!("height = {}", dice.float(4));
        if !body.contains("uv") {
            continue;
        }
        let text = source(Some("1"), &body, RANDOM);
        let (mut program, is_proved) = match compiled(&library, &text) {
            Ok(program) => (program, true),
            Err(errors) if errors.contains("E0806") => {
                (compiled(&library, &source(None, &body, RANDOM)).expect("right but for the clause"), false)
            }
            Err(_) => continue,
        };
        let differ = |program: &mut Program, from, by| {
            let pixels = differing(program, from, by, 1e-2);
            pixels > (SIDE * SIDE / 25) as usize
        };
        let breaks = [[1.0, 0.0], [0.0, 1.0]].into_iter().any(|by| {
            // Where nothing is exact, and where many floats are.
            differ(&mut program, [-1.123_456_7, 0.345_678_9], by) || differ(&mut program, [-1.0, -1.0], by)
        });
        match (is_proved, breaks) {
            (true, true) => wrong.push(format!("{body} is proved, and does not tile")),
            (true, false) => proved += 1,
            (false, true) => refused += 1,
            (false, false) => refused_for_nothing += 1,
        }
    }
    println!("{proved} proved, {refused} refused, {refused_for_nothing} refused that seem to tile");
    report(wrong);
    assert!(proved > 30 && refused > 30, "{proved} proved, {refused} refused: too few to tell");
}

/// How many programs are made; `TEXGRAPH_TILING` asks for more.
fn programs() -> u32 {
    std::env::var("TEXGRAPH_TILING").ok().and_then(|count| count.parse().ok()).unwrap_or(400)
}
