//! Random scenes, and what must hold between a run and its twins: turned, moved, renumbered, scaled, interrupted runs and runs
//! on other numbers of threads are the same run, and a label tells the truth.
//!
//! `NDDA_CASES=500 cargo test --test metamorphic rotated` runs 500 seeds of one relation, `NDDA_SEED=17` seed 17 alone, `NDDA_FIRST=500`
//! those from 500 on (from 1000000 on contacts have a `restitution` below 1), and `NDDA_WITH="contact_at: End()"` those whose scenes have these words. The scene of a seed that fails is written to `target/metamorphic`.

mod boosted;
mod families;
mod generator;
mod label;
mod laws;
mod mirrored;
mod motion;
mod random;
mod ranks;
mod renumbered;
mod reordered;
mod resumed;
mod rotated;
mod rows;
mod scaled;
mod search;
mod shapes;
mod shifted;
mod split;
mod table;
mod threads;
mod transform;
