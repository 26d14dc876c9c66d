//! What the figures must show, and whether they do.

use crate::row::{Drawn, OnGpu, Row};
use crate::table::pixels;

/// How much worse than by hand, in dB, is no worse.
const AS_GOOD: f64 = 0.05;
/// How much better than without gradients borders are, in dB.
const BETTER: f64 = 6.0;
/// How far the mean may drift, in 1/255.
const DRIFT: f64 = 1.0;
/// The zoom of 64 cells a pixel.
const FAR: f64 = 1.0 / 60.0;

/// A target: what it says, and what each row has to say about it.
struct Target {
    says: &'static str,
    /// The row's margin, negative where it misses; none where it is not asked.
    margin: fn(&Row) -> Option<f64>,
    unit: &'static str,
}

const TARGETS: [Target; 5] = [
    Target {
        says: "PSNR is at least that by hand less 0.05 dB, at every zoom, as this adapter draws both",
        margin: |row| Some(gpu(row)?.ours.off.psnr - gpu(row)?.by_hand.off.psnr + AS_GOOD),
        unit: "dB",
    },
    Target {
        says: "the same, by hand with the levels worked out where ours works them out",
        margin: |row| Some(gpu(row)?.ours.off.psnr - alike(gpu(row)?).off.psnr + AS_GOOD),
        unit: "dB",
    },
    Target {
        says: "at borders, 8 to 256 pixels a cell, PSNR is 6 dB above naive",
        margin: |row| Some(gpu(row)?.ours.off.border_psnr? - gpu(row)?.naive.off.border_psnr? - BETTER),
        unit: "dB",
    },
    Target {
        says: "at 64 cells a pixel the mean colour is within 1/255",
        margin: |row| far(row).then_some(DRIFT - row.cpu.off.drift),
        unit: "/255",
    },
    Target {
        // Errors that do not depend on each other add as squares: 3 dB below it is another as large.
        says: "at 64 cells a pixel the error beyond the reference's own is no greater than that",
        margin: |row| far(row).then(|| row.cpu.off.psnr - row.own + 10.0 * 2.0_f64.log10()),
        unit: "dB",
    },
];

fn gpu(row: &Row) -> Option<&OnGpu> {
    row.gpu.as_ref()
}

/// By hand, and as to levels as ours.
fn alike(gpu: &OnGpu) -> &Drawn {
    if gpu.by_gradient { &gpu.by_hand } else { &gpu.at_its_level }
}

fn far(row: &Row) -> bool {
    row.case.pixels < FAR
}

/// How one target fares.
struct Verdict<'a> {
    target: &'a Target,
    asked: usize,
    /// The margin of each row that misses it.
    missed: Vec<(&'a Row, f64)>,
    least: f64,
}

fn verdicts(rows: &[Row]) -> impl Iterator<Item = Verdict<'_>> {
    TARGETS.iter().map(move |target| {
        let margins: Vec<(&Row, f64)> =
            rows.iter().filter_map(|row| Some((row, (target.margin)(row)?))).collect();
        let least = margins.iter().map(|(_, margin)| *margin).fold(f64::INFINITY, f64::min);
        let asked = margins.len();
        let missed = margins.into_iter().filter(|(_, margin)| *margin < 0.0).collect();
        Verdict { target, asked, missed, least }
    })
}

/// Each target with how many rows meet it, the least margin, and every row that misses it.
pub fn list(rows: &[Row]) -> String {
    let mut text = String::new();
    for Verdict { target, asked, missed, least } in verdicts(rows) {
        let met = asked - missed.len();
        text +=
            &format!("{}: {met} of {asked} rows, least margin {least:+.2} {}\n", target.says, target.unit);
        for (row, margin) in missed {
            let (view, zoom) = (row.case.view.name(), pixels(row.case.pixels));
            text += &format!("  missed: {}, {view}, {zoom}: {margin:+.2} {}\n", row.graph, target.unit);
        }
    }
    text
}

/// The same in Markdown, without the rows.
pub fn table(rows: &[Row]) -> String {
    let head = "| what | met by | least margin |\n| --- | --- | --- |\n".to_owned();
    verdicts(rows).fold(head, |text, Verdict { target, asked, missed, least }| {
        let met = asked - missed.len();
        text + &format!("| {} | {met} of {asked} rows | {least:+.2} {} |\n", target.says, target.unit)
    })
}
