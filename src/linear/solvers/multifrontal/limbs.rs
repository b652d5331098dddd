//! The elimination forest, cut into branches that do not depend on each other, and the trunks they stand on.
//! Section 5 of docs/theory.md, Branches.

/// Where more than this part of all work is below, there is trunk: enough branches for a few threads, short trunks.
const SHARE: usize = 8;

/// Least work of a branch, in entries of L: where there is less, a thread costs more than it gains.
const LEAST: usize = 50_000;

/// A branch or a trunk.
#[derive(Debug, Default, Clone, PartialEq)]
pub struct Limb {
    /// Supernodes of the forest, increasing.
    pub supernodes: Vec<usize>,
    /// The trunk that a branch stands on, if it is not whole trees: number among the limbs.
    pub trunk: Option<usize>,
}

/// A forest of supernodes, children before their parents.
struct Forest<'a> {
    parents: &'a [Option<usize>],
    /// Work in the subtree of every supernode.
    work: Vec<usize>,
    /// Root of the tree of every supernode.
    trees: Vec<usize>,
    /// Most work of a branch.
    most: usize,
}

/// Cuts a forest, given by the parent and the work of every supernode: limbs, and how many of them are
/// branches; these come first. Supernodes below which there is much work are the trunk of their tree; what
/// remains of a tree, or small trees next to each other, are put together to branches.
pub fn cut(parents: &[Option<usize>], work: &[usize]) -> (Vec<Limb>, usize) {
    let forest = Forest::new(parents, work);
    let (mut limb_of, trees) = forest.branches();
    let branches = trees.len();
    let is_base = |&s: &usize| parents[s].is_none() && forest.is_trunk(s);
    let bases: Vec<usize> = (0..parents.len()).filter(is_base).collect();
    let trunk_of = |tree: usize| branches + bases.partition_point(|&base| base < tree);
    for s in (0..parents.len()).filter(|&s| forest.is_trunk(s)) {
        limb_of[s] = trunk_of(forest.trees[s]);
    }
    let mut limbs = vec![Limb::default(); branches + bases.len()];
    for (limb, tree) in limbs.iter_mut().zip(trees) {
        limb.trunk = tree.map(trunk_of);
    }
    for (s, limb) in limb_of.into_iter().enumerate() {
        limbs[limb].supernodes.push(s);
    }
    (limbs, branches)
}

impl<'a> Forest<'a> {
    fn new(parents: &'a [Option<usize>], work: &[usize]) -> Self {
        let most = LEAST.max(work.iter().sum::<usize>() / SHARE);
        let (mut work, mut trees) = (work.to_vec(), Vec::from_iter(0..parents.len()));
        for (s, parent) in parents.iter().enumerate() {
            parent.iter().for_each(|&parent| work[parent] += work[s]);
        }
        for (s, parent) in parents.iter().enumerate().rev() {
            parent.iter().for_each(|&parent| trees[s] = trees[parent]);
        }
        Forest {
            parents,
            work,
            trees,
            most,
        }
    }

    fn is_trunk(&self, s: usize) -> bool {
        self.work[s] > self.most
    }

    /// The tree of a supernode, if it has a trunk.
    fn tree_with_trunk(&self, s: usize) -> Option<usize> {
        Some(self.trees[s]).filter(|&tree| self.is_trunk(tree))
    }

    /// Branch of every supernode that is not in a trunk, and of every branch the tree that it is a part of.
    fn branches(&self) -> (Vec<usize>, Vec<Option<usize>>) {
        let n = self.parents.len();
        let (mut branch_of, mut trees, mut work) = (vec![0; n], Vec::new(), 0);
        let is_in_subtree = |s: usize| self.parents[s].is_some_and(|parent| !self.is_trunk(parent));
        for s in (0..n).filter(|&s| !self.is_trunk(s) && !is_in_subtree(s)) {
            let tree = self.tree_with_trunk(s);
            if work + self.work[s] > self.most || trees.last() != Some(&tree) {
                trees.push(tree);
                work = 0;
            }
            work += self.work[s];
            branch_of[s] = trees.len() - 1;
        }
        for s in (0..n).rev().filter(|&s| is_in_subtree(s)) {
            self.parents[s]
                .iter()
                .for_each(|&parent| branch_of[s] = branch_of[parent]);
        }
        (branch_of, trees)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limb(supernodes: &[usize], trunk: Option<usize>) -> Limb {
        Limb {
            supernodes: supernodes.to_vec(),
            trunk,
        }
    }

    #[test]
    fn a_tree_is_cut_below_its_trunk() {
        // 6 stands on 2 and 5, 2 on 0 and 1, 5 on 3 and 4
        let parents = [2, 2, 6, 5, 5, 6].map(Some);
        let parents = [&parents[..], &[None]].concat();
        let work = [50, 45, 10, 10, 10, 5, 5].map(|share| share * LEAST / 50);
        let expected = [
            limb(&[0], Some(3)),
            limb(&[1], Some(3)),
            limb(&[3, 4, 5], Some(3)),
            limb(&[2, 6], None),
        ];
        let (limbs, branches) = cut(&parents, &work);
        assert_eq!((limbs.as_slice(), branches), (&expected[..], 3));
    }

    #[test]
    fn small_trees_are_put_together_and_large_ones_have_trunks_of_their_own() {
        let parents = [None, None, Some(4), Some(4), None, None];
        let work = [LEAST / 2, LEAST / 2, LEAST, LEAST, 1, LEAST];
        let (limbs, branches) = cut(&parents, &work);
        let expected = [
            limb(&[0, 1], None),
            limb(&[2], Some(4)),
            limb(&[3], Some(4)),
            limb(&[5], None),
            limb(&[4], None),
        ];
        assert_eq!((limbs.as_slice(), branches), (&expected[..], 4));
    }

    #[test]
    fn little_work_is_one_branch() {
        let (limbs, branches) = cut(&[Some(2), None, None], &[1, 2, 3]);
        assert_eq!((limbs, branches), (vec![limb(&[0, 1, 2], None)], 1));
        assert_eq!(cut(&[], &[]), (Vec::new(), 0));
    }
}
