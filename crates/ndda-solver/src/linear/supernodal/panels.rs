//! The factor as the two sweeps of a solve read it, once each and from one end to the other.
//!
//! With the columns s of a panel and the rows b below them, L = [L_ss; L_bs]. Kept is P = [L_ss⁻¹; −L_bs L_ss⁻¹], of
//! which one product is all that a panel requires in each sweep:
//! forward, x_s ← L_ss⁻¹ x_s and x_b ← x_b − L_bs L_ss⁻¹ x_s; backward, x_s ← Pᵀ [x_s; x_b].
//! P is cut into tiles of eight rows by eight columns, of which those above the diagonal are left out.
//!
//! The sums are taken in one order on every processor, and in the same one for eight right-hand sides as for one.

use pulp::Simd;

use crate::linear::linear_solver::{Eight, MULTI};

/// Columns of the factor that are kept together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Panel {
    /// Its first column.
    pub first: usize,
    /// How many columns it has.
    pub width: usize,
    /// Where its rows begin in [`Panels::row`], by eights.
    pub rows: usize,
    /// How many eights of rows it has, its columns first among them.
    pub height: usize,
    /// Where its tiles begin in [`Panels::tiles`].
    pub tiles: usize,
}

/// The factor.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Panels {
    /// Size of the matrix.
    pub unknowns: usize,
    /// The panels, from the first column to the last.
    pub panels: Vec<Panel>,
    /// Rows of the panels; one that stands in for none is `unknowns`.
    pub row: Vec<[u32; MULTI]>,
    /// The tiles, column by column of tiles, panel after panel.
    pub tiles: Vec<Eight>,
}

impl Panel {
    /// Tile columns: how many columns each has, and how many tiles.
    pub(super) fn groups(self) -> impl Iterator<Item = (usize, usize)> {
        (0..self.width.div_ceil(MULTI)).map(move |g| (MULTI.min(self.width - MULTI * g), self.height - g))
    }

    /// How many [`Eight`] it takes.
    pub(super) fn len(self) -> usize {
        self.groups().map(|(columns, tiles)| columns * tiles).sum()
    }
}

/// Calls a function with the number of columns as a constant.
macro_rules! by_columns {
    ($columns:expr, $function:ident :: <$simd:ident> ( $($argument:expr),* )) => {
        match $columns {
            1 => $function::<$simd, 1>($($argument),*),
            2 => $function::<$simd, 2>($($argument),*),
            3 => $function::<$simd, 3>($($argument),*),
            4 => $function::<$simd, 4>($($argument),*),
            5 => $function::<$simd, 5>($($argument),*),
            6 => $function::<$simd, 6>($($argument),*),
            7 => $function::<$simd, 7>($($argument),*),
            _ => $function::<$simd, 8>($($argument),*),
        }
    };
}

impl Panels {
    /// Most eights of rows that a panel has.
    pub(super) fn most_height(&self) -> usize {
        self.panels.iter().map(|panel| panel.height).max().unwrap_or(0)
    }

    /// The columns of tiles of a panel: number, how many columns it has, its tiles.
    #[inline(always)]
    fn groups(&self, panel: &Panel) -> impl Iterator<Item = (usize, usize, &[Eight])> {
        let mut tiles = &self.tiles[panel.tiles..];
        panel.groups().enumerate().map(move |(g, (columns, height))| {
            let (group, rest) = tiles.split_at(columns * height);
            tiles = rest;
            (g, columns, group)
        })
    }

    /// x ← (L Lᵀ)⁻¹ x; `x` has one number more than there are unknowns, and that is 0.
    #[inline(always)]
    pub(super) fn solve<S: Simd>(&self, simd: S, x: &mut [f64], local: &mut [Eight]) {
        for panel in &self.panels {
            self.forward(simd, panel, x, &mut local[..panel.height]);
        }
        for panel in self.panels.iter().rev() {
            self.backward(simd, panel, x, &mut local[..panel.height]);
        }
    }

    #[inline(always)]
    fn forward<S: Simd>(&self, simd: S, panel: &Panel, x: &mut [f64], local: &mut [Eight]) {
        local.fill(Eight::default());
        let own = &mut x[panel.first..panel.first + panel.width];
        for (g, columns, group) in self.groups(panel) {
            by_columns!(columns, add_tiles::<S>(simd, group, &own[MULTI * g..], &mut local[g..]));
        }
        own.fill(0.0);
        for (rows, local) in self.row[panel.rows..].iter().zip(&*local) {
            for (&row, value) in rows.iter().zip(local.0) {
                x[row as usize] += value;
            }
        }
    }

    #[inline(always)]
    fn backward<S: Simd>(&self, simd: S, panel: &Panel, x: &mut [f64], local: &mut [Eight]) {
        for (rows, local) in self.row[panel.rows..].iter().zip(&mut *local) {
            *local = Eight(rows.map(|row| x[row as usize]));
        }
        let own = &mut x[panel.first..panel.first + panel.width];
        for (g, columns, group) in self.groups(panel) {
            by_columns!(columns, tiles_times::<S>(simd, group, &local[g..], &mut own[MULTI * g..]));
        }
    }

    /// [`solve`](Self::solve) for eight right-hand sides, each as if it were alone; `local` is of eight times the size.
    #[inline(always)]
    pub(super) fn solve_multi<S: Simd>(&self, simd: S, x: &mut [Eight], local: &mut [[Eight; MULTI]]) {
        for panel in &self.panels {
            self.forward_multi(simd, panel, x, &mut local[..panel.height]);
        }
        for panel in self.panels.iter().rev() {
            self.backward_multi(simd, panel, x, &mut local[..panel.height]);
        }
    }

    #[inline(always)]
    fn forward_multi<S: Simd>(&self, simd: S, panel: &Panel, x: &mut [Eight], local: &mut [[Eight; MULTI]]) {
        local.fill(Default::default());
        let own = &mut x[panel.first..panel.first + panel.width];
        for (g, columns, group) in self.groups(panel) {
            by_columns!(columns, add_tiles_multi::<S>(simd, group, &own[MULTI * g..], &mut local[g..]));
        }
        own.fill(Eight::default());
        for (rows, local) in self.row[panel.rows..].iter().zip(&*local) {
            for (&row, value) in rows.iter().zip(local) {
                add(&mut x[row as usize], value);
            }
        }
    }

    #[inline(always)]
    fn backward_multi<S: Simd>(&self, simd: S, panel: &Panel, x: &mut [Eight], local: &mut [[Eight; MULTI]]) {
        for (rows, local) in self.row[panel.rows..].iter().zip(&mut *local) {
            *local = rows.map(|row| x[row as usize]);
        }
        let own = &mut x[panel.first..panel.first + panel.width];
        for (g, columns, group) in self.groups(panel) {
            by_columns!(columns, tiles_times_multi::<S>(simd, group, &local[g..], &mut own[MULTI * g..]));
        }
    }
}

/// a ← a + b.
#[inline(always)]
fn add(a: &mut Eight, b: &Eight) {
    a.0.iter_mut().zip(&b.0).for_each(|(a, b)| *a += b);
}

/// out ← out + tiles x, for one column of tiles.
#[inline(always)]
fn add_tiles<S: Simd, const C: usize>(simd: S, tiles: &[Eight], x: &[f64], out: &mut [Eight]) {
    let mut own = [simd.splat_f64s(0.0); C];
    for c in 0..C {
        own[c] = simd.splat_f64s(x[c]);
    }
    for (tile, out) in tiles.as_chunks::<C>().0.iter().zip(out) {
        for (v, out) in S::as_mut_simd_f64s(&mut out.0).0.iter_mut().enumerate() {
            let mut sum = *out;
            for c in 0..C {
                sum = simd.add_f64s(sum, simd.mul_f64s(S::as_simd_f64s(&tile[c].0).0[v], own[c]));
            }
            *out = sum;
        }
    }
}

/// out ← tilesᵀ x, for one column of tiles.
#[inline(always)]
fn tiles_times<S: Simd, const C: usize>(simd: S, tiles: &[Eight], x: &[Eight], out: &mut [f64]) {
    // As many of the eight as the vectors of a line are used.
    let mut sums = [[simd.splat_f64s(0.0); MULTI]; C];
    for (tile, x) in tiles.as_chunks::<C>().0.iter().zip(x) {
        for (v, &x) in S::as_simd_f64s(&x.0).0.iter().enumerate() {
            for c in 0..C {
                let product = simd.mul_f64s(S::as_simd_f64s(&tile[c].0).0[v], x);
                sums[c][v] = simd.add_f64s(sums[c][v], product);
            }
        }
    }
    for c in 0..C {
        let mut line = Eight::default();
        for (line, sum) in S::as_mut_simd_f64s(&mut line.0).0.iter_mut().zip(&sums[c]) {
            *line = *sum;
        }
        let s = line.0;
        out[c] = ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
    }
}

/// [`add_tiles`] for eight right-hand sides.
#[inline(always)]
fn add_tiles_multi<S: Simd, const C: usize>(
    simd: S,
    tiles: &[Eight],
    x: &[Eight],
    out: &mut [[Eight; MULTI]],
) {
    for v in 0..MULTI / S::F64_LANES {
        let mut own = [simd.splat_f64s(0.0); C];
        for c in 0..C {
            own[c] = S::as_simd_f64s(&x[c].0).0[v];
        }
        for (tile, out) in tiles.as_chunks::<C>().0.iter().zip(&mut *out) {
            for r in 0..MULTI {
                let out = &mut S::as_mut_simd_f64s(&mut out[r].0).0[v];
                let mut sum = *out;
                for c in 0..C {
                    sum = simd.add_f64s(sum, simd.mul_f64s(simd.splat_f64s(tile[c].0[r]), own[c]));
                }
                *out = sum;
            }
        }
    }
}

/// [`tiles_times`] for eight right-hand sides.
#[inline(always)]
fn tiles_times_multi<S: Simd, const C: usize>(
    simd: S,
    tiles: &[Eight],
    x: &[[Eight; MULTI]],
    out: &mut [Eight],
) {
    for v in 0..MULTI / S::F64_LANES {
        for c in (0..C - C % 2).step_by(2) {
            let sums = columns_times::<S, C, 2>(simd, tiles, x, c, v);
            S::as_mut_simd_f64s(&mut out[c].0).0[v] = sums[0];
            S::as_mut_simd_f64s(&mut out[c + 1].0).0[v] = sums[1];
        }
        if C % 2 == 1 {
            let [sum] = columns_times::<S, C, 1>(simd, tiles, x, C - 1, v);
            S::as_mut_simd_f64s(&mut out[C - 1].0).0[v] = sum;
        }
    }
}

/// N columns of tilesᵀ x from `first` on, for the v-th of the vectors that eight right-hand sides make.
#[inline(always)]
fn columns_times<S: Simd, const C: usize, const N: usize>(
    simd: S,
    tiles: &[Eight],
    x: &[[Eight; MULTI]],
    first: usize,
    v: usize,
) -> [S::f64s; N] {
    let mut sums = [[simd.splat_f64s(0.0); MULTI]; N];
    for (tile, x) in tiles.as_chunks::<C>().0.iter().zip(x) {
        for r in 0..MULTI {
            let x = S::as_simd_f64s(&x[r].0).0[v];
            for k in 0..N {
                let entry = simd.splat_f64s(tile[first + k].0[r]);
                sums[k][r] = simd.add_f64s(sums[k][r], simd.mul_f64s(entry, x));
            }
        }
    }
    let mut out = [simd.splat_f64s(0.0); N];
    for (out, s) in out.iter_mut().zip(&sums) {
        let (even, odd) = (simd.add_f64s(s[0], s[4]), simd.add_f64s(s[1], s[5]));
        let even = simd.add_f64s(even, simd.add_f64s(s[2], s[6]));
        *out = simd.add_f64s(even, simd.add_f64s(odd, simd.add_f64s(s[3], s[7])));
    }
    out
}
