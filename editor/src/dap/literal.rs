//! Values as the program writes them: literals of ARL, as trees.

/// A value.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Literal {
    /// A number, a word, a string in its quotes.
    Plain(String),
    /// `{x 1,y 2}`
    Named(Vec<(String, Literal)>),
    /// `{1,2,3}`
    Listed(Vec<Literal>),
}

/// A step from a value to a part of it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Part {
    /// A component.
    Named(String),
    /// An element, from 0.
    At(usize),
}

impl Literal {
    /// Reads what a program writes; text that is not a literal stays as it is.
    pub(super) fn parse(text: &str) -> Self {
        let mut reader = Reader { rest: text };
        reader.value()
    }

    /// The literal as it is written.
    pub(super) fn text(&self) -> String {
        let joined = |parts: Vec<String>| format!("{{{}}}", parts.join(","));
        match self {
            Literal::Plain(text) => text.clone(),
            Literal::Named(parts) => {
                joined(parts.iter().map(|(name, part)| format!("{name} {}", part.text())).collect())
            }
            Literal::Listed(parts) => joined(parts.iter().map(Literal::text).collect()),
        }
    }

    /// The value with the elements of an array of several dimensions, which are written flat, in rows.
    pub(super) fn in_rows(self, sizes: &[usize]) -> Self {
        let [_, inner @ ..] = sizes else { return self };
        let Literal::Listed(parts) = self else { return self };
        let row = inner.iter().product::<usize>().max(1);
        if inner.is_empty() {
            return Literal::Listed(parts);
        }
        Literal::Listed(parts.chunks(row).map(|row| Literal::Listed(row.to_vec()).in_rows(inner)).collect())
    }

    /// The parts with their names; a plain value has none.
    pub(super) fn parts(&self) -> Vec<(Part, &Literal)> {
        match self {
            Literal::Plain(_) => Vec::new(),
            Literal::Named(parts) => parts.iter().map(|(name, part)| (Part::Named(name.clone()), part)).collect(),
            Literal::Listed(parts) => parts.iter().enumerate().map(|(at, part)| (Part::At(at), part)).collect(),
        }
    }

    /// A part of it.
    pub(super) fn part(&self, path: &[Part]) -> Option<&Literal> {
        let [first, rest @ ..] = path else { return Some(self) };
        let inner = match (self, first) {
            (Literal::Named(parts), Part::Named(name)) => {
                &parts.iter().find(|(known, _)| known.eq_ignore_ascii_case(name))?.1
            }
            (Literal::Listed(parts), Part::At(at)) => parts.get(*at)?,
            _ => return None,
        };
        inner.part(rest)
    }

    /// The same value with another part; a component that was not set is added.
    pub(super) fn with(mut self, path: &[Part], value: Literal) -> Option<Literal> {
        let [first, rest @ ..] = path else { return Some(value) };
        match (&mut self, first) {
            (Literal::Named(parts), Part::Named(name)) => {
                match parts.iter_mut().find(|(known, _)| known.eq_ignore_ascii_case(name)) {
                    Some((_, part)) => *part = part.clone().with(rest, value)?,
                    None => parts.push((name.clone(), Literal::Named(Vec::new()).with(rest, value)?)),
                }
            }
            (Literal::Listed(parts), Part::At(at)) => {
                let part = parts.get_mut(*at)?;
                *part = part.clone().with(rest, value)?;
            }
            _ => return None,
        }
        Some(self)
    }
}

struct Reader<'a> {
    rest: &'a str,
}

impl Reader<'_> {
    fn value(&mut self) -> Literal {
        match self.rest.strip_prefix('{') {
            Some(rest) => {
                self.rest = rest;
                self.parts()
            }
            None => Literal::Plain(self.plain()),
        }
    }

    fn parts(&mut self) -> Literal {
        let (mut named, mut listed) = (Vec::new(), Vec::new());
        loop {
            if let Some(rest) = self.rest.strip_prefix('}') {
                self.rest = rest;
                break;
            }
            match self.name() {
                Some(name) => named.push((name, self.value())),
                None => listed.push(self.value()),
            }
            match self.rest.strip_prefix(',') {
                Some(rest) => self.rest = rest,
                None if self.rest.starts_with('}') => {}
                None => break,
            }
        }
        if listed.is_empty() { Literal::Named(named) } else { Literal::Listed(listed) }
    }

    /// A name with a blank after it.
    fn name(&mut self) -> Option<String> {
        let end = self.rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))?;
        let (name, rest) = self.rest.split_at(end);
        let rest = rest.strip_prefix(' ')?;
        self.rest = rest;
        Some(name.to_owned())
    }

    fn plain(&mut self) -> String {
        let (mut end, mut escaped) = (self.rest.len(), false);
        let quoted = self.rest.starts_with('"');
        for (at, c) in self.rest.char_indices() {
            let over = match (quoted, c) {
                (true, '"') => at > 0 && !escaped,
                (true, _) => false,
                (false, c) => matches!(c, ',' | '}'),
            };
            escaped = c == '\\' && !escaped;
            if over {
                end = at + usize::from(quoted);
                break;
            }
        }
        let (plain, rest) = self.rest.split_at(end);
        self.rest = rest;
        plain.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_read_is_written_the_same() {
        for text in [
            "12",
            "-0.5",
            r#""a, {b} \" c""#,
            "{x 1,y -2.5}",
            "{1,2,3}",
            r#"{"a","b,c"}"#,
            "{t_frame {x 0,y 0},stationary true}",
            "{{x 1},{x 2}}",
            "{}",
        ] {
            assert_eq!(Literal::parse(text).text(), text);
        }
    }

    #[test]
    fn parts_are_found_and_set() {
        let tool = Literal::parse("{t_frame {x 0,y 0},stationary true}");
        let path = [Part::Named("T_FRAME".into()), Part::Named("y".into())];
        assert_eq!(tool.part(&path), Some(&Literal::Plain("0".into())));
        let set = tool.with(&path, Literal::Plain("7".into())).unwrap();
        assert_eq!(set.text(), "{t_frame {x 0,y 7},stationary true}");
        let pose = Literal::parse("{x 1}").with(&[Part::Named("ej1".into())], Literal::Plain("3".into())).unwrap();
        assert_eq!(pose.text(), "{x 1,ej1 3}");
        assert_eq!(Literal::parse("{1,2}").with(&[Part::At(2)], Literal::Plain("3".into())), None);
    }

    #[test]
    fn flat_elements_become_rows() {
        let rows = Literal::parse("{1,2,3,4,5,6}").in_rows(&[2, 3]);
        assert_eq!(rows.text(), "{{1,2,3},{4,5,6}}");
        assert_eq!(Literal::parse("{1,2}").in_rows(&[2]).text(), "{1,2}");
    }
}
