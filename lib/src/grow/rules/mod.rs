//! Rule files and the machine that runs them (000 3.2, 4.2, Appendix A).
//!
//! A file in the paper's spelling is translated to the embedded language rhai piece by piece
//! (`translate`), one in the plain spelling is rhai already; both see the same elements, points
//! and questions (`values`, `queries`). A rule reaches no file, clock or network: the language
//! has none, `eval` and modules are off, and chance comes from the run's seed alone.

mod engine;
mod file;
mod lexer;
mod queries;
mod translate;
mod values;

pub(super) use engine::{Applied, Rules, Shared, State};
pub use file::Look;
pub use lexer::RuleText;
pub(super) use queries::corners;
