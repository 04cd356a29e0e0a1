//! Directions of flow inside a region, and the streamlines that follow them.

mod depth;
pub mod direction;
mod level;
mod near;
mod seeds;
pub mod streamline;

pub use direction::DirectionField;
pub use streamline::{BOUNDARY_BONUS, LineKind, Streamline, StreamlineParams, Tracer};
