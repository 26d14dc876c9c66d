//! How far a render is that draws several pictures: the share of their pixels.

/// Tells shares from 0 to 1 over several pictures, one after the other.
pub struct Progress<'a> {
    tell: &'a (dyn Fn(f32) + Sync),
    total: f64,
    done: f64,
}

impl<'a> Progress<'a> {
    /// Over pictures of these sizes.
    pub fn new(tell: &'a (dyn Fn(f32) + Sync), sizes: impl Iterator<Item = [u32; 2]>) -> Progress<'a> {
        Progress { tell, total: sizes.map(pixels).sum(), done: 0.0 }
    }

    /// What tells of the next picture, from its own shares.
    pub fn next(&mut self, size: [u32; 2]) -> impl Fn(f32) + Sync + use<'a> {
        let (tell, total, before, own) = (self.tell, self.total, self.done, pixels(size));
        self.done += own;
        move |share| tell(((before + own * f64::from(share)) / total) as f32)
    }
}

fn pixels([width, height]: [u32; 2]) -> f64 {
    f64::from(width) * f64::from(height)
}

#[cfg(test)]
mod tests {
    use super::Progress;
    use std::sync::Mutex;

    #[test]
    fn pictures_count_by_their_pixels() {
        let heard = Mutex::new(Vec::new());
        let tell = |share| heard.lock().expect("no panic").push(share);
        let sizes = [[2, 1], [3, 2]];
        let mut progress = Progress::new(&tell, sizes.into_iter());
        for size in sizes {
            let own = progress.next(size);
            own(0.5);
            own(1.0);
        }
        assert_eq!(heard.into_inner().expect("no panic"), [0.125, 0.25, 0.625, 1.0]);
    }
}
