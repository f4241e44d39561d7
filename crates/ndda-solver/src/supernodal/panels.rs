//! The factor as the two sweeps of a solve read it, once each and from one end to the other.
//!
//! With the columns s of a panel and the rows b below them, L = [L_ss; L_bs]. Kept is P = [L_ss⁻¹; −L_bs L_ss⁻¹], of
//! which one product is all that a panel asks for in each sweep:
//! forward, x_s ← L_ss⁻¹ x_s and x_b ← x_b − L_bs L_ss⁻¹ x_s; backward, x_s ← Pᵀ [x_s; x_b].
//! P is cut into tiles of eight rows by eight columns, of which those above the diagonal are left out.
//!
//! The sums are taken in one order on every processor, and in the same one for eight right-hand sides as for one.

use crate::linear_solver::{EIGHT, Eight};

/// Columns of the factor that are kept together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Panel {
    /// Its first column.
    pub first: usize,
    /// How many columns it has.
    pub width: usize,
    /// Where its rows begin in [`Panels::row`], by eights.
    pub rows: usize,
    /// How many eights of rows it has, its columns first among them.
    pub height: usize,
}

/// The factor.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Panels {
    /// Size of the matrix.
    pub unknowns: usize,
    /// The panels, from the first column to the last.
    pub panels: Vec<Panel>,
    /// Rows of the panels; one that stands in for none is `unknowns`.
    pub row: Vec<[u32; EIGHT]>,
    /// The tiles, column by column of tiles, panel after panel.
    pub tiles: Vec<Eight>,
}

impl Panel {
    /// Tile columns: how many columns each has, and how many tiles.
    pub fn groups(self) -> impl Iterator<Item = (usize, usize)> {
        (0..self.width.div_ceil(EIGHT)).map(move |g| (EIGHT.min(self.width - EIGHT * g), self.height - g))
    }

    /// How many [`Eight`] it takes.
    pub fn len(self) -> usize {
        self.groups().map(|(columns, tiles)| columns * tiles).sum()
    }
}

/// Calls a function with the number of columns as a constant.
macro_rules! by_columns {
    ($columns:expr, $function:ident ( $($argument:expr),* )) => {
        match $columns {
            1 => $function::<1>($($argument),*),
            2 => $function::<2>($($argument),*),
            3 => $function::<3>($($argument),*),
            4 => $function::<4>($($argument),*),
            5 => $function::<5>($($argument),*),
            6 => $function::<6>($($argument),*),
            7 => $function::<7>($($argument),*),
            _ => $function::<8>($($argument),*),
        }
    };
}

impl Panels {
    /// Most eights of rows that a panel has.
    pub fn most_height(&self) -> usize {
        self.panels.iter().map(|panel| panel.height).max().unwrap_or(0)
    }

    /// x ← (L Lᵀ)⁻¹ x; `x` has one number more than there are unknowns, and that is 0.
    #[inline(always)]
    pub fn solve(&self, x: &mut [f64], local: &mut [Eight]) {
        let mut tiles = self.tiles.as_slice();
        for panel in &self.panels {
            let (own, rest) = tiles.split_at(panel.len());
            tiles = rest;
            self.forward(panel, own, x, &mut local[..panel.height]);
        }
        let mut tiles = self.tiles.as_slice();
        for panel in self.panels.iter().rev() {
            let (rest, own) = tiles.split_at(tiles.len() - panel.len());
            tiles = rest;
            self.backward(panel, own, x, &mut local[..panel.height]);
        }
    }

    #[inline(always)]
    fn forward(&self, panel: &Panel, mut tiles: &[Eight], x: &mut [f64], local: &mut [Eight]) {
        local.fill(Eight::default());
        let own = &mut x[panel.first..panel.first + panel.width];
        for (g, (columns, height)) in panel.groups().enumerate() {
            let (group, rest) = tiles.split_at(columns * height);
            tiles = rest;
            by_columns!(columns, add_tiles(group, &own[EIGHT * g..], &mut local[g..]));
        }
        own.fill(0.0);
        for (rows, local) in self.row[panel.rows..].iter().zip(&*local) {
            for (&row, value) in rows.iter().zip(local.0) {
                x[row as usize] += value;
            }
        }
    }

    #[inline(always)]
    fn backward(&self, panel: &Panel, mut tiles: &[Eight], x: &mut [f64], local: &mut [Eight]) {
        for (rows, local) in self.row[panel.rows..].iter().zip(&mut *local) {
            *local = Eight(rows.map(|row| x[row as usize]));
        }
        let own = &mut x[panel.first..panel.first + panel.width];
        for (g, (columns, height)) in panel.groups().enumerate() {
            let (group, rest) = tiles.split_at(columns * height);
            tiles = rest;
            by_columns!(columns, tiles_times(group, &local[g..], &mut own[EIGHT * g..]));
        }
    }

    /// [`solve`](Self::solve) for eight right-hand sides, each as if it were alone; `local` is of eight times the size.
    #[inline(always)]
    pub fn solve_eight(&self, x: &mut [Eight], local: &mut [[Eight; EIGHT]]) {
        let mut tiles = self.tiles.as_slice();
        for panel in &self.panels {
            let (own, rest) = tiles.split_at(panel.len());
            tiles = rest;
            self.forward_eight(panel, own, x, &mut local[..panel.height]);
        }
        let mut tiles = self.tiles.as_slice();
        for panel in self.panels.iter().rev() {
            let (rest, own) = tiles.split_at(tiles.len() - panel.len());
            tiles = rest;
            self.backward_eight(panel, own, x, &mut local[..panel.height]);
        }
    }

    #[inline(always)]
    fn forward_eight(
        &self,
        panel: &Panel,
        mut tiles: &[Eight],
        x: &mut [Eight],
        local: &mut [[Eight; EIGHT]],
    ) {
        local.fill(Default::default());
        let own = &mut x[panel.first..panel.first + panel.width];
        for (g, (columns, height)) in panel.groups().enumerate() {
            let (group, rest) = tiles.split_at(columns * height);
            tiles = rest;
            by_columns!(columns, add_tiles_eight(group, &own[EIGHT * g..], &mut local[g..]));
        }
        own.fill(Eight::default());
        for (rows, local) in self.row[panel.rows..].iter().zip(&*local) {
            for (&row, value) in rows.iter().zip(local) {
                add(&mut x[row as usize], value);
            }
        }
    }

    #[inline(always)]
    fn backward_eight(
        &self,
        panel: &Panel,
        mut tiles: &[Eight],
        x: &mut [Eight],
        local: &mut [[Eight; EIGHT]],
    ) {
        for (rows, local) in self.row[panel.rows..].iter().zip(&mut *local) {
            *local = rows.map(|row| x[row as usize]);
        }
        let own = &mut x[panel.first..panel.first + panel.width];
        for (g, (columns, height)) in panel.groups().enumerate() {
            let (group, rest) = tiles.split_at(columns * height);
            tiles = rest;
            by_columns!(columns, tiles_times_eight(group, &local[g..], &mut own[EIGHT * g..]));
        }
    }
}

/// a ← a + b.
#[inline(always)]
fn add(a: &mut Eight, b: &Eight) {
    a.0.iter_mut().zip(&b.0).for_each(|(a, b)| *a += b);
}

/// The sum of eight numbers, or of as many rows of eight, in one order.
#[inline(always)]
fn sum(values: [Eight; EIGHT]) -> Eight {
    let plus = |a: Eight, b: Eight| {
        let mut c = a;
        add(&mut c, &b);
        c
    };
    let [a, b, c, d, e, f, g, h] = values;
    plus(plus(plus(a, e), plus(c, g)), plus(plus(b, f), plus(d, h)))
}

/// out ← out + tiles x, for one column of tiles.
#[inline(always)]
fn add_tiles<const C: usize>(tiles: &[Eight], x: &[f64], out: &mut [Eight]) {
    let x: [f64; C] = std::array::from_fn(|c| x[c]);
    for (tile, out) in tiles.as_chunks::<C>().0.iter().zip(out) {
        let mut sum = out.0;
        for c in 0..C {
            for r in 0..EIGHT {
                sum[r] += tile[c].0[r] * x[c];
            }
        }
        out.0 = sum;
    }
}

/// out ← tilesᵀ x, for one column of tiles.
#[inline(always)]
fn tiles_times<const C: usize>(tiles: &[Eight], x: &[Eight], out: &mut [f64]) {
    let mut sums = [[0.0; EIGHT]; C];
    for (tile, x) in tiles.as_chunks::<C>().0.iter().zip(x) {
        for c in 0..C {
            for r in 0..EIGHT {
                sums[c][r] += tile[c].0[r] * x.0[r];
            }
        }
    }
    for (out, s) in out.iter_mut().zip(sums) {
        *out = ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
    }
}

/// [`add_tiles`] for eight right-hand sides.
#[inline(always)]
fn add_tiles_eight<const C: usize>(tiles: &[Eight], x: &[Eight], out: &mut [[Eight; EIGHT]]) {
    let x: [Eight; C] = std::array::from_fn(|c| x[c]);
    for (tile, out) in tiles.as_chunks::<C>().0.iter().zip(out) {
        for r in 0..EIGHT {
            let mut sum = out[r].0;
            for c in 0..C {
                for lane in 0..EIGHT {
                    sum[lane] += tile[c].0[r] * x[c].0[lane];
                }
            }
            out[r].0 = sum;
        }
    }
}

/// [`tiles_times`] for eight right-hand sides.
#[inline(always)]
fn tiles_times_eight<const C: usize>(tiles: &[Eight], x: &[[Eight; EIGHT]], out: &mut [Eight]) {
    for (c, out) in out.iter_mut().enumerate().take(C) {
        let mut sums = [[0.0; EIGHT]; EIGHT];
        for (tile, x) in tiles.as_chunks::<C>().0.iter().zip(x) {
            let tile = &tile[c].0;
            for r in 0..EIGHT {
                for lane in 0..EIGHT {
                    sums[r][lane] += tile[r] * x[r].0[lane];
                }
            }
        }
        *out = sum(sums.map(Eight));
    }
}
