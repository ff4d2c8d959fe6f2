//! Decides which statements of a block become parts.

use crate::emit::Sizes;

/// A piece of a block.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum BlockPiece {
    /// The group with this number, unchanged.
    Group(usize),
    /// A part.
    Part(Vec<BlockPiece>),
}

impl BlockPiece {
    /// Counts the groups of a piece from another one on.
    pub(super) fn shift(&mut self, from: usize) {
        match self {
            Self::Group(number) => *number += from,
            Self::Part(pieces) => pieces.iter_mut().for_each(|piece| piece.shift(from)),
        }
    }
}

/// The number of pieces that become a part of parts in a block that is still too heavy.
const PIECES: usize = 32;

/// The pieces of a block whose groups have these weights; `stays`: the last group is in no part.
pub(super) fn plan(weights: &[usize], stays: bool, sizes: Sizes) -> Vec<BlockPiece> {
    let all = || (0..weights.len()).map(BlockPiece::Group);
    if weights.iter().sum::<usize>() <= sizes.awaits {
        return all().collect();
    }
    let movable = weights.len() - usize::from(stays);
    // The code before the first wait, mostly declarations, stays where a reader looks for it.
    let first = weights.iter().position(|weight| *weight > 0).unwrap_or(0).min(movable);
    let mut pieces: Vec<BlockPiece> = all().take(first).collect();
    let middle: Vec<BlockPiece> = all().take(movable).skip(first).collect();
    pieces.extend(pack(middle, weights, sizes.awaits_of_a_part, sizes.least_awaits));
    while weight_of(&pieces, weights) > sizes.awaits {
        let before = pieces.len();
        pieces = pieces.chunks(PIECES).flat_map(|chunk| bundle(chunk.to_vec(), weights)).collect();
        if pieces.len() >= before {
            break;
        }
    }
    pieces.extend(all().skip(movable));
    pieces
}

/// Puts pieces into parts with a weight of at most `most`; parts lighter than `least` are not formed.
fn pack(pieces: Vec<BlockPiece>, weights: &[usize], most: usize, least: usize) -> Vec<BlockPiece> {
    let mut out = Vec::new();
    let mut open: Vec<BlockPiece> = Vec::new();
    let mut weight = 0;
    let mut close = |open: &mut Vec<BlockPiece>, weight: &mut usize| {
        let part = std::mem::take(open);
        if std::mem::take(weight) >= least { out.push(BlockPiece::Part(part)) } else { out.extend(part) }
    };
    for piece in pieces {
        let own = weight_of(std::slice::from_ref(&piece), weights);
        if weight + own > most && !open.is_empty() {
            close(&mut open, &mut weight);
        }
        weight += own;
        open.push(piece);
    }
    if !open.is_empty() {
        close(&mut open, &mut weight);
    }
    out
}

/// Turns several pieces into a part if more than one of them waits.
fn bundle(pieces: Vec<BlockPiece>, weights: &[usize]) -> Vec<BlockPiece> {
    let parts = pieces.iter().filter(|piece| matches!(piece, BlockPiece::Part(_))).count();
    if parts > 1 && weight_of(&pieces, weights) > 1 { vec![BlockPiece::Part(pieces)] } else { pieces }
}

/// The number of `.await`s left in the code around the parts.
pub(super) fn weight_of(pieces: &[BlockPiece], weights: &[usize]) -> usize {
    let weight = |piece: &BlockPiece| match piece {
        BlockPiece::Group(number) => weights.get(*number).copied().unwrap_or(0),
        BlockPiece::Part(_) => 1,
    };
    pieces.iter().map(weight).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZES: Sizes = Sizes {
        table: 8,
        rows_of_a_kind: 4,
        awaits: 6,
        awaits_of_a_part: 4,
        least_awaits: 2,
        awaits_of_a_program: 256,
        uses_of_a_template: 4,
        variables: 64,
    };

    /// `0 (1 2) 3`
    fn shown(pieces: &[BlockPiece]) -> String {
        let one = |piece: &BlockPiece| match piece {
            BlockPiece::Group(number) => number.to_string(),
            BlockPiece::Part(pieces) => format!("({})", shown(pieces)),
        };
        pieces.iter().map(one).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn light_blocks_are_left_alone() {
        assert_eq!(shown(&plan(&[1, 2, 3], false, SIZES)), "0 1 2");
        assert_eq!(shown(&plan(&[], false, SIZES)), "");
    }

    #[test]
    fn heavy_blocks_are_cut() {
        assert_eq!(shown(&plan(&[0, 2, 2, 0, 2, 2, 0, 1], false, SIZES)), "0 (1 2 3) (4 5 6) 7");
        assert_eq!(shown(&plan(&[3, 3, 3], true, SIZES)), "(0) (1) 2");
        assert_eq!(shown(&plan(&[9], true, SIZES)), "0");
        assert_eq!(shown(&plan(&[0, 9], false, SIZES)), "0 (1)");
    }

    #[test]
    fn very_heavy_blocks_have_parts_of_parts_and_no_group_is_lost() {
        let weights = vec![2; 5000];
        let pieces = plan(&weights, true, SIZES);
        assert!(weight_of(&pieces, &weights) <= SIZES.awaits, "{}", weight_of(&pieces, &weights));
        let numbers = shown(&pieces).replace(['(', ')'], "");
        assert_eq!(numbers, (0..5000).map(|number| number.to_string()).collect::<Vec<_>>().join(" "));
    }
}
