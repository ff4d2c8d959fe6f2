//! The links of a URDF as a tree, each with the joints after it. Each query takes time by the tree's size, however deep
//! it is.

use std::collections::HashMap;

use urdf_rs::{Joint, JointType, Link, Robot};

use super::place::Transform;

/// The links and joints of a robot: one link is the root, and one joint leads to each other one.
#[derive(Debug)]
pub struct Tree<'a> {
    robot: &'a Robot,
    /// The indices of links in the robot, by their names.
    links: HashMap<&'a str, usize>,
    root: usize,
    /// For each link the joints after it, in the order of the file, by their indices in the robot.
    behind: Vec<Vec<usize>>,
    /// For each joint, whether it or one after it moves.
    moves: Vec<bool>,
}

impl<'a> Tree<'a> {
    /// The tree of a robot.
    ///
    /// # Errors
    /// What keeps its links from being a tree.
    pub fn of(robot: &'a Robot) -> Result<Self, String> {
        let mut links = HashMap::with_capacity(robot.links.len());
        for (at, link) in robot.links.iter().enumerate() {
            if links.insert(link.name.as_str(), at).is_some() {
                return Err(format!("two links have the name `{}`", link.name));
            }
        }
        let (mut behind, mut leads) = (vec![Vec::new(); robot.links.len()], vec![None; robot.links.len()]);
        for (at, joint) in robot.joints.iter().enumerate() {
            let place = |name: &str| {
                let missing = || format!("the joint `{}` names the link `{name}`, which is not there", joint.name);
                links.get(name).copied().ok_or_else(missing)
            };
            let (parent, child) = (place(&joint.parent.link)?, place(&joint.child.link)?);
            if let Some(behind) = behind.get_mut(parent) {
                behind.push(at);
            }
            if let Some(other) = leads.get_mut(child).and_then(|leads: &mut Option<usize>| leads.replace(at)) {
                let other = robot.joints.get(other).map_or("", |other| &other.name);
                let (link, joint) = (&joint.child.link, &joint.name);
                return Err(format!("two joints lead to the link `{link}`: `{other}` and `{joint}`"));
            }
        }
        let root = root(robot, &leads)?;
        let mut tree = Self { robot, links, root, behind, moves: vec![false; robot.joints.len()] };
        tree.look_at_moves()?;
        Ok(tree)
    }

    /// The robot.
    pub(super) fn robot(&self) -> &'a Robot {
        self.robot
    }

    /// The link that no joint leads to.
    pub fn root(&self) -> &'a str {
        self.robot.links.get(self.root).map_or("", |link| &link.name)
    }

    /// A link by its name.
    pub fn link(&self, name: &str) -> Option<&'a Link> {
        self.robot.links.get(*self.links.get(name)?)
    }

    /// The joints after a link that move, or that a moving joint comes after.
    pub(super) fn moving_behind(&self, link: &str) -> Vec<&'a Joint> {
        let is_one = |at: &&usize| self.moves.get(**at).copied().unwrap_or(false);
        self.numbers_behind(link).iter().filter(is_one).filter_map(|at| self.robot.joints.get(*at)).collect()
    }

    /// A link, and the links after it with joints at 0, each with its place. The joints `moving` are not crossed.
    pub fn fixed_to(&self, link: &'a str, moving: &[&str]) -> Vec<(&'a str, Transform)> {
        let mut found: Vec<(&str, Transform)> = vec![(link, Transform::ORIGIN)];
        let mut at = 0;
        while let Some((link, place)) = found.get(at).copied() {
            at += 1;
            let joints = self.numbers_behind(link).iter().filter_map(|at| self.robot.joints.get(*at));
            for joint in joints.filter(|joint| !moving.contains(&joint.name.as_str())) {
                let own = Transform::of_urdf(joint.origin.xyz.0, joint.origin.rpy.0);
                found.push((&joint.child.link, place.then(&own)));
            }
        }
        found
    }

    fn numbers_behind(&self, link: &str) -> &[usize] {
        self.links.get(link).and_then(|link| self.behind.get(*link)).map_or(&[], Vec::as_slice)
    }

    /// Goes from the root to the last joints, and back.
    fn look_at_moves(&mut self) -> Result<(), String> {
        let child = |joint: usize| Some(*self.links.get(self.robot.joints.get(joint)?.child.link.as_str())?);
        let mut order: Vec<usize> = self.behind.get(self.root).cloned().unwrap_or_default();
        let mut at = 0;
        while let Some(joint) = order.get(at).copied() {
            at += 1;
            order.extend(child(joint).and_then(|link| self.behind.get(link)).into_iter().flatten());
        }
        if order.len() < self.robot.joints.len() {
            return Err("some of its joints form a loop".to_owned());
        }
        for joint in order.into_iter().rev() {
            let behind = child(joint).and_then(|link| self.behind.get(link)).into_iter().flatten();
            let any = behind.filter_map(|behind| self.moves.get(*behind)).any(|moves| *moves);
            let own = self.robot.joints.get(joint).is_some_and(moves_itself);
            if let Some(moves) = self.moves.get_mut(joint) {
                *moves = any || own;
            }
        }
        Ok(())
    }
}

fn moves_itself(joint: &Joint) -> bool {
    joint.joint_type != JointType::Fixed && joint.mimic.is_none()
}

/// The link that no joint leads to.
fn root(robot: &Robot, leads: &[Option<usize>]) -> Result<usize, String> {
    let mut roots = leads.iter().enumerate().filter(|(_, leads)| leads.is_none()).map(|(at, _)| at);
    let Some(root) = roots.next() else {
        return Err("no link is the base: the joints form a loop".to_owned());
    };
    let name = |at: usize| robot.links.get(at).map_or("", |link| &link.name);
    match roots.next() {
        None => Ok(root),
        Some(second) => Err(format!("two links have no parent joint: `{}` and `{}`", name(root), name(second))),
    }
}

#[cfg(test)]
mod tests {
    use super::super::chain::parse;
    use super::super::{Chain, robot_file};
    use super::*;

    fn urdf(links: &str, joints: &[[&str; 3]]) -> String {
        let links: String = links.split(' ').map(|name| format!("<link name=\"{name}\"/>")).collect();
        let joint = |[name, parent, child]: &[&str; 3]| {
            format!(
                "<joint name=\"{name}\" type=\"fixed\"><parent link=\"{parent}\"/><child link=\"{child}\"/></joint>"
            )
        };
        format!("<robot name=\"a\">{links}{}</robot>", joints.iter().map(joint).collect::<String>())
    }

    #[test]
    fn links_that_are_no_tree_are_refused() {
        for (text, words) in [
            (urdf("a b c", &[["j", "a", "b"]]), "two links have no parent joint: `a` and `c`"),
            (urdf("a b", &[["j", "a", "b"], ["k", "b", "a"]]), "no link is the base"),
            (urdf("a b c", &[["j", "b", "c"], ["k", "c", "b"]]), "some of its joints form a loop"),
            (urdf("a b c", &[["j", "a", "c"], ["k", "b", "c"]]), "two joints lead to the link `c`: `j` and `k`"),
            (urdf("a b", &[["j", "a", "c"]]), "the joint `j` names the link `c`, which is not there"),
            (urdf("a a", &[["j", "a", "a"]]), "two links have the name `a`"),
        ] {
            let robot = parse(&text).unwrap();
            let problem = Tree::of(&robot).expect_err(words);
            assert!(problem.contains(words), "{problem}");
        }
    }

    #[test]
    fn long_chains_cost_by_their_length() {
        const LINKS: usize = 20_000;
        let joint = |kind: &str, at: usize| {
            format!(
                "<link name=\"l{at}\"/><joint name=\"j{at}\" type=\"{kind}\"><origin xyz=\"0 0 0.001\"/><parent link=\"l{}\"/>\
                 <child link=\"l{at}\"/><limit lower=\"0\" upper=\"1\" effort=\"1\" velocity=\"1\"/></joint>",
                at - 1
            )
        };
        let chain = |kind: &str| {
            let joints: String = (1..=LINKS).map(|at| joint(kind, at)).collect();
            format!("<robot name=\"a\"><link name=\"l0\"/>{joints}</robot>")
        };
        let text = chain("fixed");
        let robot = parse(&text).unwrap();
        let tree = Tree::of(&robot).unwrap();
        let all = tree.fixed_to(tree.root(), &[]);
        let (last, place) = all.last().copied().unwrap();
        assert_eq!((all.len(), last), (LINKS + 1, "l20000"));
        assert!((place.at[2] - 20.0).abs() < 1e-6);
        assert!(Chain::of(&tree).unwrap().joints.is_empty());
        let problem = robot_file(&chain("revolute"), "a.urdf").unwrap_err();
        assert!(problem.contains("has 20000 moving joints (j1, j2, "), "{problem}");
        assert!(problem.len() < 300, "{problem}");
    }
}
