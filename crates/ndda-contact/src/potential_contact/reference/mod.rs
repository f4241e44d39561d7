//! One triangle against one tetrahedron, step by step: what the kernel is compared with.

pub mod tet_pair;
