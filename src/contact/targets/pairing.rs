//! Pairing: the contact targets of all slave nodes at an iterate, from the candidates of the
//! search and the pairs of the pass before. Section 10 of docs/theory.md, Sites.

use super::slave_node::Look;
use super::target_selection::Site;
use crate::contact::geometry::{ContactSurfaces, position};
use crate::contact::search::Search;

/// Which slave node meets which segment, or which vertex.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairSite {
    /// Place of the slave node among all slave nodes of all contacts.
    pub slot: usize,
    /// Segment in its contact, or vertex.
    pub site: Site,
    /// Nodes: slave s, segment ends a and b, and c, the end of the next segment behind a vertex;
    /// without vertex it is b again.
    pub nodes: [usize; 4],
    /// Coefficient of friction mu.
    pub friction: f64,
}

impl PairSite {
    /// What tells pairs of an increment apart: slot and segment.
    pub fn key(&self) -> [usize; 2] {
        [self.slot, self.site.segment]
    }
}

/// How far beyond its ends (in its lengths) a segment is kept that a node has just left to no other.
const SLIDING_OFF: f64 = 0.1;
/// How far beyond its ends (in its lengths) a segment is kept when the passes have settled.
const WAVERING: f64 = 1e-3;

/// Pairs that the slots had in the pass before.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Pairing {
    /// Sites, increasing by slot; empty before the first pass.
    pub sites: Vec<PairSite>,
    /// Whether sites are kept even where others hold the node now: passes that go to and fro across
    /// a vertex come to rest with it.
    pub settled: bool,
}

/// The pairs of all contacts between the displacements `u0` of the start of an increment and `u` of
/// an iterate, which the search covers.
///
/// A node that has just left its segment by a little and finds no other keeps it: whether it has
/// slid off is decided by the end of the increment, not by one of its passes.
pub fn find_pairs(search: &Search, u0: &[f64], u: &[f64], before: &Pairing) -> Vec<PairSite> {
    let x = search.coordinates();
    let positions =
        |u: &[f64]| -> Vec<[f64; 2]> { (0..x.len()).map(|n| position(x, u, n)).collect() };
    let (start, now) = (positions(u0), positions(u));
    let mut pairs: Vec<PairSite> = Vec::new();
    let mut old = before.sites.as_slice();
    let mut slot = 0;
    for territory in search.territories() {
        let surfaces = territory.surfaces();
        for slave in 0..surfaces.slaves.len() {
            let look = Look {
                surfaces,
                start: &start,
                now: &now,
                slave,
            };
            let (own, rest) = old.split_at(old.partition_point(|site| site.slot <= slot));
            old = rest;
            let found = look.sites(territory.candidates(slave));
            let sites = with_kept(&look, found, own, before.settled);
            pairs.extend(
                sites
                    .iter()
                    .map(|&site| pair_site(surfaces, slot, slave, site)),
            );
            slot += 1;
        }
    }
    without_twins(pairs)
}

/// Sites of a slot, of which some of the pass before are kept.
fn with_kept(look: &Look, found: Vec<Site>, before: &[PairSite], settled: bool) -> Vec<Site> {
    if before.is_empty() || (!settled && !found.is_empty()) {
        return found;
    }
    let mut sites: Vec<Site> = before.iter().map(|pair| pair.site).collect();
    let beyond = if settled { WAVERING } else { SLIDING_OFF };
    sites.retain(|site| look.is_over(site, beyond));
    let kept = sites.len();
    for site in found {
        if !sites[..kept].iter().any(|old| look.same_face(old, &site)) {
            sites.push(site);
        }
    }
    sites.sort_by_key(|site| site.segment);
    sites
}

fn pair_site(surfaces: &ContactSurfaces, slot: usize, slave: usize, site: Site) -> PairSite {
    let [a, b] = surfaces.segments[site.segment];
    let c = site.vertex.map_or(b, |v| surfaces.segments[v.next][1]);
    PairSite {
        slot,
        site,
        nodes: [surfaces.slaves[slave], a, b, c],
        friction: surfaces.friction,
    }
}

/// Two nodes that are each other's vertex are one pair.
fn without_twins(mut pairs: Vec<PairSite>) -> Vec<PairSite> {
    let vertices: Vec<[usize; 2]> = pairs
        .iter()
        .filter(|pair| pair.site.vertex.is_some())
        .map(|pair| [pair.nodes[0], pair.nodes[2]])
        .collect();
    pairs.retain(|pair| {
        let [s, _, v, _] = pair.nodes;
        pair.site.vertex.is_none() || s < v || !vertices.contains(&[v, s])
    });
    pairs
}
