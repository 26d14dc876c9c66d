//! What the figures must show, and whether they do.

use crate::row::{OnGpu, Row};
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

const TARGETS: [Target; 4] = [
    Target {
        says: "PSNR is at least that by hand less 0.05 dB, at every zoom",
        margin: |row| Some(gpu(row)?.ours.off.psnr - gpu(row)?.by_hand.off.psnr + AS_GOOD),
        unit: "dB",
    },
    Target {
        says: "at borders, 8 to 256 pixels a cell, PSNR is 6 dB above naive",
        margin: |row| Some(gpu(row)?.ours.off.border_psnr? - gpu(row)?.naive.off.border_psnr? - BETTER),
        unit: "dB",
    },
    Target {
        says: "at 64 cells a pixel the mean colour is within 1/255",
        margin: |row| far(row).then(|| DRIFT - row.cpu.off.drift),
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

fn far(row: &Row) -> bool {
    row.case.pixels < FAR
}

/// Each target with how many rows meet it, the least margin, and every row that misses it.
pub fn verdicts(rows: &[Row]) -> String {
    TARGETS.iter().map(|target| verdict(target, rows)).collect()
}

fn verdict(target: &Target, rows: &[Row]) -> String {
    let margins: Vec<(&Row, f64)> =
        rows.iter().filter_map(|row| Some((row, (target.margin)(row)?))).collect();
    let missed: Vec<&(&Row, f64)> = margins.iter().filter(|(_, margin)| *margin < 0.0).collect();
    let least = margins.iter().map(|(_, margin)| *margin).fold(f64::INFINITY, f64::min);
    let mut text = format!(
        "{}: {} of {} rows, least margin {least:+.2} {}\n",
        target.says,
        margins.len() - missed.len(),
        margins.len(),
        target.unit
    );
    for (row, margin) in missed {
        let (view, zoom) = (row.case.view.name(), pixels(row.case.pixels));
        text += &format!("  missed: {}, {view}, {zoom}: {margin:+.2} {}\n", row.graph, target.unit);
    }
    text
}
