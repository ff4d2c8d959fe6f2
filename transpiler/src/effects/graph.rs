//! Finds functions that call each other in cycles.

/// The strongly connected components of a call graph (Tarjan), callees before their callers; `calls[f]` lists what `f`
/// calls. Not recursive, so that long call chains do no harm.
pub(crate) fn components(calls: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut search = Search {
        calls,
        index: vec![None; calls.len()],
        low: vec![0; calls.len()],
        open: vec![false; calls.len()],
        stack: Vec::new(),
        next: 0,
        found: Vec::new(),
    };
    for start in 0..calls.len() {
        if search.index.get(start) == Some(&None) {
            search.visit(start);
        }
    }
    search.found
}

struct Search<'a> {
    calls: &'a [Vec<usize>],
    index: Vec<Option<usize>>,
    low: Vec<usize>,
    open: Vec<bool>,
    stack: Vec<usize>,
    next: usize,
    found: Vec<Vec<usize>>,
}

#[expect(clippy::indexing_slicing, reason = "all vectors have one entry a function, and callees are functions")]
impl Search<'_> {
    fn visit(&mut self, start: usize) {
        let mut path = vec![(start, 0)];
        self.enter(start);
        while let Some((node, edge)) = path.pop() {
            let Some(callee) = self.calls[node].get(edge).copied() else {
                self.leave(node);
                if let Some((caller, _)) = path.last() {
                    self.low[*caller] = self.low[*caller].min(self.low[node]);
                }
                continue;
            };
            path.push((node, edge + 1));
            match self.index[callee] {
                None => {
                    self.enter(callee);
                    path.push((callee, 0));
                }
                Some(index) if self.open[callee] => self.low[node] = self.low[node].min(index),
                Some(_) => {}
            }
        }
    }

    fn enter(&mut self, node: usize) {
        self.index[node] = Some(self.next);
        self.low[node] = self.next;
        self.next += 1;
        self.stack.push(node);
        self.open[node] = true;
    }

    fn leave(&mut self, node: usize) {
        if self.index[node] != Some(self.low[node]) {
            return;
        }
        let mut component = Vec::new();
        while let Some(member) = self.stack.pop() {
            self.open[member] = false;
            component.push(member);
            if member == node {
                break;
            }
        }
        component.sort_unstable();
        self.found.push(component);
    }
}

#[cfg(test)]
mod tests {
    use super::components;

    #[test]
    fn callees_come_first_and_circles_together() {
        let calls = [vec![1], vec![2, 3], vec![1], vec![], vec![4, 0]];
        assert_eq!(components(&calls), [vec![3], vec![1, 2], vec![0], vec![4]]);
    }

    #[test]
    fn a_long_chain_needs_no_stack() {
        let calls: Vec<Vec<usize>> = (0..200_000).map(|at| if at == 0 { vec![] } else { vec![at - 1] }).collect();
        assert_eq!(components(&calls).len(), 200_000);
    }
}
