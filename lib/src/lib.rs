//! The generators of Rinceau.
//!
//! A generator is a pure function from a [`Scene`](rinceau_format::Scene) and its parameters
//! to an [`Artwork`](rinceau_format::Artwork): same scene, parameters and seed, same bytes.
//!
//! | generator | from |
//! |---|---|
//! | [`arrange`] | Ijiri, Mech, Igarashi, Miller: *An example-based procedural system for element arrangement*, 2008 |
//! | [`grow`] | Wong, Zongker, Salesin: *Computer-generated floral ornament*, 1998 |
//! | [`pack`] | Saputra, Kaplan, Asente, Mech: *FLOWPAK: Flow-based ornamental element packing*, 2017 |
//! | [`recurse`] | Carlson, Woodbury: *Hands-on exploration of recursive forms*, 1990 |
//! | [`vine`] | Xu, Mould: *Magnetic curves*, 2009, and an article that adds clip art |

pub mod arrange;
mod faults;
pub mod field;
pub mod generate;
pub mod geom;
pub mod grow;
mod ink;
pub mod pack;
pub mod palette;
pub mod params;
pub mod progress;
pub mod quality;
pub mod recurse;
pub mod rng;
pub mod shapes;
pub mod tack;
pub mod vine;

pub use faults::faults;
pub use generate::{GENERATORS, Generator, generate};
pub use params::{ParamSpec, Values};
pub use progress::{Deadline, Progress};
pub use rinceau_format::Error;
pub use rng::Rng;
