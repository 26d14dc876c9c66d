//! Strong structure: what bricks, planks and weave have and stochastic pictures lack (§1.7).
//!
//! Looked at is the autocorrelation of what is finer than a twenty-fourth of the picture: blotches of
//! any shape are alike to themselves here and there, but only what repeats has its *outlines* again. The
//! photographs of `benches/photos` whose blends fail to the eye have 0.25 to 0.7, the others up to 0.13.

use super::autocorrelation::Autocorrelation;
use super::field::Field;

/// What is this many times finer than the shorter side is outline.
const FINE: f64 = 24.0;

/// Shifts from one part in so many of the shorter side on: less is the width of a feature.
const NEAR: f64 = 16.0;

/// Features end where their autocorrelation falls below.
const END: f64 = 0.1;

/// A peak is that high at least, and rises so far above the least on the way to it.
const PEAK: f64 = 0.1;

/// Copies with so much of the highest one's height are as good.
const HIGH: f64 = 0.75;

/// The most peaks that are told.
const PEAKS: usize = 3;

/// What repeats.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Structure {
    /// The highest autocorrelation of outlines, at shifts from a sixteenth to half of the shorter side.
    pub strength: f64,
    /// The shift at which it is, in the picture's texels.
    pub shift: [i32; 2],
    /// Whether all on the way there is alike too: lines rather than copies.
    pub is_line: bool,
    /// Copies, the three that are most alike, none near another one.
    pub peaks: Vec<Peak>,
    /// The shortest shift to a copy that is nearly as high as the highest, if there are copies.
    pub period: Option<[i32; 2]>,
    /// How wide features are, in the picture's texels: twice the shift at which the autocorrelation has
    /// fallen below 0.1, in the mean of all directions.
    pub features: f64,
}

/// A place at which a picture is alike to itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// How alike, up to 1.
    pub height: f64,
    /// The shift in the picture's texels, across and down; what is found at the opposite one is the same.
    pub shift: [i32; 2],
}

impl Structure {
    /// Of fields that show one picture of that size, made smaller alike.
    pub fn of<'a>(fields: impl Iterator<Item = &'a Field>, size: [u32; 2]) -> Structure {
        let fields: Vec<&Field> = fields.collect();
        let Some(shown) = fields.first().map(|field| field.size()) else { return Structure::default() };
        let side = shown[0].min(shown[1]) as f64;
        let outlines: Vec<_> =
            fields.iter().map(|field| Autocorrelation::of(&field.fine(side / FINE).centred())).collect();
        let whole: Vec<_> = fields.iter().map(|field| Autocorrelation::of(&field.centred())).collect();
        let (Some(outlines), Some(whole)) = (Autocorrelation::mean(&outlines), Autocorrelation::mean(&whole))
        else {
            return Structure::default();
        };
        let scale = [0, 1].map(|axis| f64::from(size[axis]) / shown[axis] as f64);
        let larger =
            |shift: [i32; 2]| [0, 1].map(|axis| (f64::from(shift[axis]) * scale[axis]).round() as i32);
        let range = (side / NEAR, side / 2.0);
        let (strength, shift) = strongest(&outlines, range);
        let peaks = peaks(&outlines, range);
        let most = peaks.first().map_or(0.0, |peak| peak.height);
        let high = peaks.iter().filter(|peak| peak.height > HIGH * most);
        let period = high.map(|peak| peak.shift).min_by(|one, other| length(*one).total_cmp(&length(*other)));
        Structure {
            strength,
            shift: larger(shift),
            is_line: least_on_the_way(&outlines, shift) > strength / 2.0,
            peaks: apart(&peaks, range.0).map(|peak| Peak { shift: larger(peak.shift), ..peak }).collect(),
            period: period.map(larger),
            features: 2.0 * end(&whole, side) * scale[0].max(scale[1]),
        }
    }
}

fn length([x, y]: [i32; 2]) -> f64 {
    f64::from(x).hypot(f64::from(y))
}

/// All shifts of a range of lengths, each once of the two opposite ones.
fn shifts(of: &Autocorrelation, (near, far): (f64, f64)) -> impl Iterator<Item = [i32; 2]> {
    let [across, down] = of.reach();
    let all = (0..=down).flat_map(move |y| (-across..=across).map(move |x| [x, y]));
    all.filter(move |[x, y]| (*y > 0 || *x > 0) && (near..far).contains(&length([*x, *y])))
}

fn strongest(of: &Autocorrelation, range: (f64, f64)) -> (f64, [i32; 2]) {
    shifts(of, range).fold((0.0, [0, 0]), |(most, at), shift| {
        let height = of.at(shift);
        if height > most { (height, shift) } else { (most, at) }
    })
}

/// The least on the straight line from no shift to one.
fn least_on_the_way(of: &Autocorrelation, [x, y]: [i32; 2]) -> f64 {
    let steps = x.abs().max(y.abs()).max(1);
    let place = |side: i32, i: i32| (f64::from(side) * f64::from(i) / f64::from(steps)).round() as i32;
    (0..=steps).map(|i| of.at([place(x, i), place(y, i)])).fold(1.0, f64::min)
}

/// All copies, the most alike first.
fn peaks(of: &Autocorrelation, range: (f64, f64)) -> Vec<Peak> {
    let is_top = |[x, y]: [i32; 2]| {
        let height = of.at([x, y]);
        (-1..=1).all(|down| (-1..=1).all(|across| of.at([x + across, y + down]) <= height))
    };
    let high = shifts(of, range).filter(|shift| of.at(*shift) > PEAK && is_top(*shift));
    let found = high.map(|shift| Peak { height: of.at(shift), shift });
    let mut found: Vec<Peak> =
        found.filter(|peak| peak.height - least_on_the_way(of, peak.shift) > PEAK).collect();
    found.sort_by(|one, other| other.height.total_cmp(&one.height));
    found
}

/// The highest, none nearer to another one than that.
fn apart(peaks: &[Peak], least: f64) -> impl Iterator<Item = Peak> {
    let mut told: Vec<Peak> = Vec::new();
    for peak in peaks {
        let distance = |other: &Peak| length([0, 1].map(|axis| peak.shift[axis] - other.shift[axis]));
        if told.len() < PEAKS && told.iter().all(|other| distance(other) > least) {
            told.push(*peak);
        }
    }
    told.into_iter()
}

/// The shift at which the mean of all directions falls below the end of a feature, up to half the side.
fn end(of: &Autocorrelation, side: f64) -> f64 {
    let rings = (side / 2.0) as usize;
    let (mut sums, mut counts) = (vec![0.0; rings + 1], vec![0.0; rings + 1]);
    for shift in shifts(of, (0.0, rings as f64 + 0.5)) {
        let ring = (length(shift).round() as usize).min(rings);
        sums[ring] += of.at(shift);
        counts[ring] += 1.0;
    }
    let falls = (1..=rings).find(|ring| counts[*ring] > 0.0 && sums[*ring] / counts[*ring] < END);
    falls.unwrap_or(rings) as f64
}
