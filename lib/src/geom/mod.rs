//! Geometry that several generators share. Nothing here knows of scenes or artwork.

pub mod affine;
pub mod bend;
pub mod boolean;
pub mod catmull_rom;
pub mod crossing;
pub mod distance;
pub mod flatten;
pub mod mirror;
pub mod near;
pub mod polyline;
pub mod region;
pub mod segment;
pub mod spline;
pub mod triangulate;
pub mod warp;
