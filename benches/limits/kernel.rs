//! The kernel against its operations times the rate of the processor's arithmetic.

use std::hint::black_box;

use ndda_contact::integration::{GROUP, GroupMoments, RegionGroup, region_moments};
use ndda_contact::integration::{Region, element_regions};
use pulp::Arch;

use crate::machine::{Clock, Rates};
use crate::{header, row, twin};

#[path = "../../crates/ndda-contact/benches/cases/mod.rs"]
mod cases;

use cases::{Hits, Rejects, hit, random_pairs};

/// Operations of λ at the three corners over the four faces: three differences, three products, two sums, and one
/// product with the inverse height.
pub const REJECT_OPERATIONS: f64 = 3.0 * 4.0 * 9.0;
/// Candidates of [`Rejects`].
const REJECTS: f64 = 1024.0;
/// Groups of regions that are integrated again and again: few enough for the first-level cache, as in a step, where one
/// group is filled and integrated at a time.
const GROUPS: usize = 4;
/// How often, so that the clock does not count.
const AGAIN: usize = 64;

/// Prints the table.
pub fn table(clock: &Clock, rates: &Rates) {
    header(
        "kernel",
        &[
            "what",
            "operations",
            "ns",
            "GFLOP/s",
            "of the rate with rounded sums",
            "of the rate with fused ones",
        ],
    );
    let say = |what: String, operations: f64, ns: f64| {
        let rate = operations / ns;
        let share = |most: f64| format!("{:.0} %", 100.0 * rate / most);
        let cells = [what, format!("{operations:.0}"), format!("{ns:.2}"), format!("{rate:.2}")];
        row("kernel", &[cells.to_vec(), vec![share(rates.separate), share(rates.fused)]].concat());
    };
    for cuts in 0..=4 {
        let alike: Vec<Region> = [regions_of_hits(0.0), regions_of_hits(0.97)]
            .concat()
            .into_iter()
            .filter(|r| r.cuts().len() == cuts)
            .collect();
        let groups = groups(&alike);
        if groups.is_empty() {
            continue;
        }
        let (operations, same_bits) = operations(&alike, &groups);
        let bits = if same_bits { "" } else { ", whose last bits its twin does not have" };
        let few = &groups[..groups.len().min(GROUPS)];
        let ns = least_of_groups(clock, few) / (AGAIN * GROUP * few.len()) as f64;
        let plural = if cuts == 1 { "" } else { "s" };
        say(format!("a region with {cuts} cut{plural}{bits}"), operations, ns);
    }
    for (name, out, mut hits) in [("deep", 0.0, Hits::deep()), ("shallow", 0.97, Hits::shallow())] {
        let operations: u64 = regions_of_hits(out).iter().map(|region| twin::moments(region).1).sum();
        let count = hits.count() as f64;
        let ns = clock.least_ns(|| _ = black_box(hits.integrate())) / count;
        say(format!("a {name} hit, with finding and placing its regions"), operations as f64 / count, ns);
    }
    let rejects = Rejects::new();
    let ns = clock.least_ns(|| _ = black_box(black_box(&rejects).look())) / REJECTS;
    say("a candidate that is rejected".into(), REJECT_OPERATIONS, ns);
}

/// Regions of the random pairs, as deep as they are or moved out.
fn regions_of_hits(out: f64) -> Vec<Region> {
    let mut regions = Vec::new();
    for (lambda, slopes, _) in random_pairs().iter().filter_map(|[a, b]| hit(a, b, out)) {
        element_regions(&lambda, &slopes, |_, region| regions.push(*region));
    }
    regions
}

/// Full groups of regions with equally many cuts.
fn groups(regions: &[Region]) -> Vec<RegionGroup> {
    regions.chunks_exact(GROUP).map(group).collect()
}

fn group(regions: &[Region]) -> RegionGroup {
    let mut group =
        RegionGroup { cuts: regions[0].cuts().len(), len: regions.len(), ..RegionGroup::default() };
    for (lane, region) in regions.iter().enumerate() {
        (0..3).for_each(|a| group.phi[a][lane] = region.phi[a]);
        group.slope[lane] = region.slope;
        for (k, cut) in region.cuts().iter().enumerate() {
            (0..3).for_each(|a| group.fields[k][a][lane] = cut.field[a]);
            group.bounds[k][lane] = cut.bound;
        }
    }
    group
}

/// Operations of a region, and whether kernel and twin give the same bits; both give the same to rounding.
fn operations(regions: &[Region], groups: &[RegionGroup]) -> (f64, bool) {
    let (mut operations, mut same) = (0, true);
    let mut found = GroupMoments::default();
    for (group, regions) in groups.iter().zip(regions.chunks_exact(GROUP)) {
        region_moments(Arch::new(), group, &mut found);
        for (lane, region) in regions.iter().enumerate().filter(|(lane, _)| found.doubtful[*lane] == 0.0) {
            let (expected, counted) = twin::moments(region);
            operations = operations.max(counted);
            let all = found.pressure.iter().chain(&found.slope).chain([&found.area]);
            for (x, y) in all.map(|row| row[lane]).zip(expected) {
                assert!((x - y).abs() <= 1e-12 * (1.0 + region.slope), "{x} of the kernel, {y} of its twin");
                same &= x.to_bits() == y.to_bits();
            }
        }
    }
    (operations as f64, same)
}

/// Least time for all groups, again and again [ns].
fn least_of_groups(clock: &Clock, groups: &[RegionGroup]) -> f64 {
    let (arch, mut moments) = (Arch::new(), GroupMoments::default());
    clock.least_ns(|| {
        for group in (0..AGAIN).flat_map(|_| groups) {
            region_moments(arch, black_box(group), &mut moments);
            black_box(&mut moments);
        }
    })
}
