//! One device, many threads.

use super::common::programs::arithmetic;
use libtest_mimic::Failed;
use std::sync::Barrier;
use std::thread;
use texgraph_compiler::manifest::Value;
use texgraph_runtime::gpu::Gpu;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::Tables;

const THREADS: u32 = 8;
const PICTURES: u32 = 60;

/// A poll of one thread calls back for the others: each must still wait for its own picture, and
/// get that one. Small pictures, each with a scene of its own: what is tested is how the threads
/// meet. A reader that does not wait for its own call back fails about one run of five.
pub fn pictures_are_read_back_from_many_threads(gpu: &Gpu) -> Result<(), Failed> {
    let start = Barrier::new(THREADS as usize);
    thread::scope(|scope| {
        let workers = (0..THREADS).map(|thread| {
            let start = &start;
            scope.spawn(move || {
                start.wait();
                (0..PICTURES).try_for_each(|n| own_picture(gpu, thread * PICTURES + n))
            })
        });
        let workers: Vec<_> = workers.collect();
        workers
            .into_iter()
            .try_for_each(|worker| worker.join().map_err(|_| "a thread panicked".to_owned())?)
    })?;
    Ok(())
}

/// A picture whose threshold and time are this thread's own: its first pixel is left of the
/// threshold, its last right of it.
fn own_picture(gpu: &Gpu, number: u32) -> Result<(), String> {
    let program = arithmetic();
    let fail = |error: &dyn std::fmt::Display| format!("picture {number}: {error}");
    let mut scene = gpu.prepare(&program, &Tables::default(), 0).map_err(|error| fail(&error))?;
    let width = 16 + number % 48;
    let left = 1 + number % (width - 1);
    let mut request = Request { time: number as f32, ..Request::new([width, 3]) };
    let threshold = Value::Float(vec![left as f32 / width as f32, 0.0]);
    request.settings.set(&program.manifest, "scale", threshold).map_err(|error| fail(&error))?;
    let picture = scene.render(&request, &|_| {}).map_err(|error| fail(&error))?;
    for (x, pixel) in (0..width).zip(&picture.pixels) {
        // The third component is normal.z on the left and the time on the right.
        let expected = if x < left { 1.0 } else { number as f32 };
        if pixel[2] != expected {
            return Err(fail(&format!("pixel {x} is {pixel:?}, not {expected}")));
        }
    }
    Ok(())
}
