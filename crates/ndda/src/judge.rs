//! How good a run is: closed forms, verdicts on invariants, the label, and the summary that says it all.

mod bolts;
pub mod reasons;
pub mod reference;
pub mod summary;
pub mod table;
pub mod verdict;
pub mod words;
