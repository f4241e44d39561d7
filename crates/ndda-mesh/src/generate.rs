//! Structured generators.
