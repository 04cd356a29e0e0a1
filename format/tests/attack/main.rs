//! Hostile drawings: each ends quickly, with a scene or with a sentence that has a remedy.

mod bytes;
mod clones;
mod entities;
mod floods;
mod limits;
mod meaning;
mod numbers;
mod styles;
#[path = "../support/mod.rs"]
mod support;

use rinceau_format::{Document, Error, Limits, Scene, Selection};
use std::time::Duration;

/// Everything the crate does with a drawing, within a second on the 2 MB stack of a test.
/// A drawing is read in a second; tests are built without most optimizations, on machines that are busy.
const LONGEST: Duration = Duration::from_secs(4);

fn read(bytes: impl Into<Vec<u8>>) -> Result<Scene, Error> {
    read_within(bytes.into(), Limits::default(), LONGEST)
}

fn read_within(bytes: Vec<u8>, limits: Limits, most: Duration) -> Result<Scene, Error> {
    let start = thread_time();
    let scene = Document::with_limits(bytes, limits).and_then(|document| {
        let scene = document.scene(&Selection::default())?;
        let _ = document.layers()?;
        assert_finite(&scene);
        Ok(scene)
    });
    let took = thread_time() - start;
    assert!(took < most, "took {took:?}");
    if let Err(error) = &scene {
        let text = error.to_string();
        assert!(text.contains(". [") && text.len() < 2000, "no sentence: {text}");
    }
    scene
}

/// Time this thread has worked: a busy machine must not fail a test. Where the system does
/// not tell, time since some moment.
fn thread_time() -> Duration {
    static START: std::sync::OnceLock<std::time::Instant> = std::sync::OnceLock::new();
    let worked = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let worked = worked.and_then(|text| text.split(' ').next()?.parse().ok()).map(Duration::from_nanos);
    worked.unwrap_or_else(|| START.get_or_init(std::time::Instant::now).elapsed())
}

fn code(bytes: impl Into<Vec<u8>>) -> &'static str {
    read(bytes).map_or_else(|error| error.code(), |_| "read")
}

fn assert_finite(scene: &Scene) {
    let paths = scene.containers.iter().flat_map(|c| c.outlines.iter().map(|o| &o.path));
    let guides = [&scene.guides, &scene.fixed_spines, &scene.stems, &scene.boundaries];
    let guides = guides.into_iter().flatten().map(|guide| &guide.path);
    let sprays = scene.sprays.iter().map(|spray| &spray.path);
    assert!(paths.chain(guides).chain(sprays).all(|path| path.is_finite()), "a path is not finite");
    let parts = scene.elements.iter().flat_map(|e| &e.template.parts);
    for part in parts.chain(scene.fixed.iter().flat_map(|fixed| &fixed.parts)) {
        assert!(part.path.is_finite() && part.transform.is_finite(), "a part is not finite");
        assert!(!part.style.css().contains("inf") && !part.style.css().contains("NaN"));
    }
    assert!(scene.seeds.iter().all(|seed| seed.at.is_finite()));
    assert!(scene.sprays.iter().all(|spray| spray.width.is_finite()));
    assert!(scene.view.is_finite() && scene.view.width() > 0.0 && scene.view.height() > 0.0);
    assert!(scene.px_per_unit.is_finite() && scene.px_per_unit > 0.0);
}
