//! Writes SVG: the few shapes that a plot needs.

use std::fmt::Write;

/// Which point of a text is at its place.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// A rectangle in px.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Area {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Area {
    pub(super) fn right(&self) -> f64 {
        self.x + self.width
    }

    pub(super) fn bottom(&self) -> f64 {
        self.y + self.height
    }
}

/// A picture that grows shape by shape. Classes are those of the style sheet in [`Picture::finish`].
#[derive(Debug, Default)]
pub(super) struct Picture {
    body: String,
}

impl Picture {
    pub(super) fn rect(&mut self, area: &Area, class: &str, fill: Option<&str>) {
        let Area { x, y, width, height } = *area;
        let fill = fill.map_or_else(String::new, |fill| format!(" fill=\"{fill}\""));
        let (x, y, width, height) = (short(x), short(y), short(width), short(height));
        self.line_of(&format!(
            "<rect class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"{fill}/>"
        ));
    }

    pub(super) fn line(&mut self, from: [f64; 2], to: [f64; 2], class: &str) {
        let [x1, y1, x2, y2] = [from[0], from[1], to[0], to[1]].map(short);
        self.line_of(&format!("<line class=\"{class}\" x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\"/>"));
    }

    /// A line through points; `None` lifts the pen.
    pub(super) fn path(&mut self, points: &[Option<[f64; 2]>], class: &str, stroke: &str) {
        let mut steps = String::new();
        let mut down = false;
        for (at, point) in points.iter().enumerate() {
            let Some([x, y]) = point else {
                down = false;
                continue;
            };
            // A single point is shown as a dot: a line of no length with round ends.
            let alone = !down && points.get(at + 1).is_none_or(Option::is_none);
            let step = if down { 'L' } else { 'M' };
            let _ = write!(steps, "{step}{} {}", short(*x), short(*y));
            if alone {
                steps.push_str("h0");
            }
            down = true;
        }
        if !steps.is_empty() {
            self.line_of(&format!("<path class=\"{class}\" stroke=\"{stroke}\" d=\"{steps}\"/>"));
        }
    }

    pub(super) fn text(&mut self, [x, y]: [f64; 2], anchor: Anchor, class: &str, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let (x, y, text) = (short(x), short(y), escaped(text));
        self.line_of(&format!("<text class=\"{class}\" x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\">{text}</text>"));
    }

    fn line_of(&mut self, element: &str) {
        self.body.push_str(element);
        self.body.push('\n');
    }

    /// The whole file, with a white background.
    pub(super) fn finish(self, width: f64, height: f64, title: &str) -> String {
        let (width, height, title) = (short(width), short(height), escaped(title));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" role=\"img\">\n<title>{title}</title>\n<style>{STYLE}</style>\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{}</svg>\n",
            self.body
        )
    }
}

const STYLE: &str = "\
    text{font:12px system-ui,'Segoe UI',Helvetica,Arial,sans-serif;fill:#3d444d}\
    .title{font-size:18px;font-weight:600;fill:#1f2328}\
    .head{font-size:13px;font-weight:600;fill:#1f2328}\
    .tick{font-size:10px;fill:#6e7781}\
    .code{font:11px ui-monospace,Menlo,Consolas,monospace}\
    .mark,.halo{font-size:10px;font-weight:600;fill:#1f2328}\
    .halo{stroke:#ffffff;stroke-width:3px;stroke-linejoin:round}\
    .band{font-size:10px;font-weight:600;fill:#ffffff}\
    .frame{fill:none;stroke:#d0d7de}\
    .grid{stroke:#eaeef2}\
    .zero{stroke:#b8c0c8}\
    .change{stroke:#d0d7de;stroke-dasharray:2 3}\
    .limit{stroke:#cf222e;stroke-dasharray:6 4}\
    .way{fill:none;stroke-width:1.8;stroke-linejoin:round;stroke-linecap:round}\
    .curve{fill:none;stroke-width:1.4;stroke-linejoin:round}";

/// A number with at most two decimals, without needless zeros.
pub(super) fn short(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            // Other control characters are not allowed in XML at all.
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_text_is_escaped() {
        assert_eq!([1.0, 1.256, -0.001, 10.5, 100.0].map(short), ["1", "1.26", "0", "10.5", "100"]);
        let mut picture = Picture::default();
        picture.text([1.0, 2.0], Anchor::Middle, "code", "a < b && c\u{7}");
        let text = picture.finish(10.0, 10.0, "x & y");
        assert!(text.contains("a &lt; b &amp;&amp; c </text>") && text.contains("x &amp; y"));
    }

    #[test]
    fn paths_lift_the_pen() {
        let mut picture = Picture::default();
        picture.path(&[Some([0.0, 0.0]), Some([1.0, 2.0]), None, Some([3.0, 3.0])], "way", "#000");
        assert!(picture.body.contains("d=\"M0 0L1 2M3 3h0\""), "{}", picture.body);
        picture.path(&[None], "way", "#000");
        assert_eq!(picture.body.lines().count(), 1);
    }
}
