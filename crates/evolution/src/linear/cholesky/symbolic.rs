//! What a factor looks like before any value is known: the order, the panels of columns, and their rows.
//!
//! ```text
//!  panel: `width` columns that share their rows          ▙        own columns, a lower triangle
//!                                                        █        rows below, sorted
//!                                                        █
//! ```

use super::ordering::nested_dissection;
use crate::linear::{CsrPattern, LinearError};
use std::sync::Arc;

/// Columns of a panel at most: wider ones are cut, so that a panel stays in the first cache.
pub(super) const WIDTH: usize = 32;

/// Rows of zeros below each panel, so that no tile of 4 × 4 needs a special case at the end.
pub(super) const PADDING: usize = 3;

const NONE: u32 = u32::MAX;

/// Columns of the factor that have the same rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Panel {
    /// The first column.
    pub first: usize,
    /// The number of columns.
    pub width: usize,
    /// Where its rows begin in [`Symbolic::rows`]; its own columns come first.
    pub rows: usize,
    /// The number of rows.
    pub height: usize,
    /// Where its values begin, column after column of `stride`.
    pub values: usize,
}

impl Panel {
    pub fn stride(&self) -> usize {
        self.height + PADDING
    }
}

/// The structure of L in P A Pᵀ = L Lᵀ.
#[derive(Debug)]
pub(super) struct Symbolic {
    pub pattern: Arc<CsrPattern>,
    /// The row of A that is eliminated at each step.
    pub order: Vec<u32>,
    pub panels: Vec<Panel>,
    /// The panel of each column.
    pub panel_of: Vec<u32>,
    pub rows: Vec<u32>,
    /// Entries of A, and where among the values they go.
    pub gather: Vec<[u32; 2]>,
    pub values: usize,
}

impl Symbolic {
    /// The structure for a symmetric pattern.
    pub fn new(pattern: &Arc<CsrPattern>) -> Result<Self, LinearError> {
        let rows = pattern.rows();
        for row in 0..rows {
            for &column in &pattern.columns()[pattern.row(row)] {
                let mirrored = pattern.entry(column as usize, row);
                mirrored.ok_or(LinearError::NoEntry {
                    row: column as usize,
                    column: row,
                })?;
            }
        }
        let order = nested_dissection(pattern);
        let parent = elimination_tree(pattern, &order, &inverse(&order));
        let post = postorder(&parent);
        let order: Vec<u32> = post.iter().map(|&step| order[step as usize]).collect();
        let place = inverse(&order);
        let parent = elimination_tree(pattern, &order, &place);
        let counts = column_counts(pattern, &order, &place, &parent);
        let supernodes = supernodes(&parent, &counts);
        let mut symbolic = Self {
            pattern: Arc::clone(pattern),
            order,
            panels: Vec::new(),
            panel_of: vec![0; rows],
            rows: Vec::new(),
            gather: Vec::with_capacity(pattern.entries() / 2 + rows),
            values: 0,
        };
        symbolic.add_panels(&supernodes, &parent, &place);
        if symbolic.values > u32::MAX as usize {
            return Err(LinearError::TooLarge(symbolic.values));
        }
        symbolic.add_gather(&place);
        Ok(symbolic)
    }

    pub fn rows_of(&self, panel: &Panel) -> &[u32] {
        &self.rows[panel.rows..panel.rows + panel.height]
    }

    /// Rows of each supernode: those of A, and those that its children pass on.
    fn add_panels(&mut self, supernodes: &[u32], parent: &[u32], place: &[u32]) {
        let count = parent.len();
        let mut mark = vec![NONE; count];
        let mut supernode_of = vec![0_u32; count];
        let ends = supernodes
            .iter()
            .skip(1)
            .map(|&s| s as usize)
            .chain([count]);
        let ranges: Vec<_> = supernodes.iter().map(|&s| s as usize).zip(ends).collect();
        for (s, &(first, end)) in ranges.iter().enumerate() {
            supernode_of[first..end].fill(s as u32);
        }
        // Where the rows below each supernode lie.
        let mut below = vec![0..0; ranges.len()];
        let mut children: Vec<Vec<u32>> = vec![Vec::new(); ranges.len()];
        for (s, &(first, end)) in ranges.iter().enumerate() {
            let start = self.rows.len();
            self.rows.extend(first as u32..end as u32);
            for child in std::mem::take(&mut children[s]) {
                for i in below[child as usize].clone() {
                    let row = self.rows[i];
                    if row as usize >= end && mark[row as usize] != s as u32 {
                        mark[row as usize] = s as u32;
                        self.rows.push(row);
                    }
                }
            }
            for column in first..end {
                let entries = self.pattern.row(self.order[column] as usize);
                for &neighbor in &self.pattern.columns()[entries] {
                    let row = place[neighbor as usize];
                    if row as usize >= end && mark[row as usize] != s as u32 {
                        mark[row as usize] = s as u32;
                        self.rows.push(row);
                    }
                }
            }
            let own = start + end - first;
            self.rows[own..].sort_unstable();
            below[s] = own..self.rows.len();
            if parent[end - 1] != NONE {
                children[supernode_of[parent[end - 1] as usize] as usize].push(s as u32);
            }
            self.cut(first, end, start);
        }
    }

    /// Panels of at most [`WIDTH`] columns.
    fn cut(&mut self, first: usize, end: usize, start: usize) {
        let pieces = (end - first).div_ceil(WIDTH);
        for piece in 0..pieces {
            let from = first + (end - first) * piece / pieces;
            let to = first + (end - first) * (piece + 1) / pieces;
            let rows = start + from - first;
            let panel = Panel {
                first: from,
                width: to - from,
                rows,
                height: self.rows.len() - rows,
                values: self.values,
            };
            self.values += panel.width * panel.stride();
            self.panel_of[from..to].fill(self.panels.len() as u32);
            self.panels.push(panel);
        }
    }

    fn add_gather(&mut self, place: &[u32]) {
        let mut local = vec![0_usize; place.len()];
        for panel in &self.panels {
            let rows = &self.rows[panel.rows..panel.rows + panel.height];
            for (i, &row) in rows.iter().enumerate() {
                local[row as usize] = i;
            }
            for k in 0..panel.width {
                let column = panel.first + k;
                let entries = self.pattern.row(self.order[column] as usize);
                for entry in entries {
                    let row = place[self.pattern.columns()[entry] as usize] as usize;
                    if row >= column {
                        let value = panel.values + k * panel.stride() + local[row];
                        self.gather.push([entry as u32, value as u32]);
                    }
                }
            }
        }
    }
}

/// Where each row stands in an order.
fn inverse(order: &[u32]) -> Vec<u32> {
    let mut place = vec![0; order.len()];
    for (step, &row) in order.iter().enumerate() {
        place[row as usize] = step as u32;
    }
    place
}

/// The earlier steps whose rows are neighbours of a step's.
fn earlier<'a>(
    pattern: &'a CsrPattern,
    order: &[u32],
    place: &'a [u32],
    step: usize,
) -> impl Iterator<Item = usize> + use<'a> {
    let neighbors = &pattern.columns()[pattern.row(order[step] as usize)];
    let places = neighbors
        .iter()
        .map(|&neighbor| place[neighbor as usize] as usize);
    places.filter(move |&earlier| earlier < step)
}

/// The first row below the diagonal of each column of L (Liu 1990), by path compression.
fn elimination_tree(pattern: &CsrPattern, order: &[u32], place: &[u32]) -> Vec<u32> {
    let mut parent = vec![NONE; order.len()];
    let mut ancestor = vec![NONE; order.len()];
    for step in 0..order.len() {
        for mut column in earlier(pattern, order, place, step) {
            while ancestor[column] != NONE && ancestor[column] != step as u32 {
                let next = ancestor[column] as usize;
                ancestor[column] = step as u32;
                column = next;
            }
            if ancestor[column] == NONE {
                ancestor[column] = step as u32;
                parent[column] = step as u32;
            }
        }
    }
    parent
}

/// Children before parents, each subtree in one piece.
fn postorder(parent: &[u32]) -> Vec<u32> {
    let mut first_child = vec![NONE; parent.len()];
    let mut sibling = vec![NONE; parent.len()];
    let mut stack = Vec::new();
    for step in (0..parent.len()).rev() {
        match parent[step] {
            NONE => stack.push(step as u32),
            up => {
                sibling[step] = first_child[up as usize];
                first_child[up as usize] = step as u32;
            }
        }
    }
    let mut order = Vec::with_capacity(parent.len());
    while let Some(&step) = stack.last() {
        match first_child[step as usize] {
            NONE => {
                order.push(step);
                stack.pop();
            }
            child => {
                first_child[step as usize] = sibling[child as usize];
                stack.push(child);
            }
        }
    }
    order
}

/// The entries below the diagonal of each column of L. Time proportional to their number.
fn column_counts(pattern: &CsrPattern, order: &[u32], place: &[u32], parent: &[u32]) -> Vec<u32> {
    let mut counts = vec![0; order.len()];
    let mut seen = vec![NONE; order.len()];
    for step in 0..order.len() {
        seen[step] = step as u32;
        for mut column in earlier(pattern, order, place, step) {
            while seen[column] != step as u32 {
                seen[column] = step as u32;
                counts[column] += 1;
                column = parent[column] as usize;
            }
        }
    }
    counts
}

/// The first columns of the supernodes: columns with the same rows, and a few more whose zeros cost less than the
/// management of another panel (relaxed amalgamation, Ashcraft and Grimes 1989).
fn supernodes(parent: &[u32], counts: &[u32]) -> Vec<u32> {
    struct Node {
        first: usize,
        end: usize,
        below: usize,
        zeros: usize,
    }
    let mut nodes: Vec<Node> = Vec::new();
    for (column, &below) in counts.iter().enumerate() {
        let mut node = Node {
            first: column,
            end: column + 1,
            below: below as usize,
            zeros: 0,
        };
        while let Some(last) = nodes.last() {
            let up = parent[last.end - 1] as usize;
            if !(node.first..node.end).contains(&up) {
                break;
            }
            let (own, width) = (last.end - last.first, node.end - last.first);
            let zeros =
                last.zeros + node.zeros + own * (node.end - node.first + node.below - last.below);
            let entries = width * (width + 1) / 2 + width * node.below;
            let tolerated = match width {
                0..=4 => 1.0,
                5..=16 => 0.4,
                17..=48 => 0.1,
                _ => 0.05,
            };
            if zeros as f64 > tolerated * entries as f64 {
                break;
            }
            node = Node {
                first: last.first,
                zeros,
                ..node
            };
            nodes.pop();
        }
        nodes.push(node);
    }
    nodes.iter().map(|node| node.first as u32).collect()
}
