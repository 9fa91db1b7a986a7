//! The plot of a comparison: which metric works at which radius, and how much its charts lose.
//!
//! Written by hand rather than by a plotting library because the drawing takes its colors from the
//! reader's theme, and has a hint on every mark.

use super::number::betti;
use crosscap::comparison::{ComparedRun, RunState, intervals};
use std::fmt::Write;

/// Colors of text, lines and marks, light and dark: to be put into a style element.
pub const STYLE: &str = "\
.plot text{font:13px system-ui,sans-serif;fill:#1c1e22}\
.plot .faint{fill:#5c626c}\
.plot .axis{stroke:#8a909a;stroke-width:1;fill:none}\
.plot .grid{stroke:#8a909a;stroke-opacity:.25;stroke-width:1}\
.plot .back{fill:#ffffff}\
.plot .hole{fill:#ffffff}\
.m0{color:#c8472b}.m1{color:#13805c}.m2{color:#2f6fb5}\
.plot .mark{stroke:currentColor;stroke-width:2.2;fill:none}\
.plot .full{fill:currentColor;stroke:none}\
.plot .span{fill:currentColor;fill-opacity:.22;stroke:none}\
.plot .line{stroke:currentColor;stroke-width:2;fill:none}\
@media (prefers-color-scheme:dark){\
.plot text{fill:#e8eaee}.plot .faint{fill:#a3aab5}\
.plot .back,.plot .hole{fill:#17191d}\
.m0{color:#ff8f70}.m1{color:#4fcaa0}.m2{color:#7db4ee}}";

const WIDTH: f64 = 860.0;
const LEFT: f64 = 118.0;
const RIGHT: f64 = 24.0;
const TOP: f64 = 34.0;
const LANE: f64 = 44.0;
const GAP: f64 = 78.0;
const PANEL: f64 = 150.0;
const MARK: f64 = 7.0;

/// What one metric did, by radius.
pub struct Lane<'a> {
    pub name: String,
    pub runs: &'a [ComparedRun],
}

impl Lane<'_> {
    /// The radii between which the metric works, first and last.
    pub fn intervals(&self) -> Vec<[f64; 2]> {
        let radii: Vec<f64> = self.runs.iter().map(|r| r.eps).collect();
        let works: Vec<bool> = self.runs.iter().map(ComparedRun::works).collect();
        intervals(&radii, &works)
    }

    /// The same in words, behind "works".
    pub fn told(&self) -> String {
        let parts: Vec<String> = (self.intervals().iter())
            .map(|[a, b]| {
                if a == b {
                    format!("{a}")
                } else {
                    format!("{a} to {b}")
                }
            })
            .collect();
        if parts.is_empty() {
            "at no eps that was tried".into()
        } else {
            format!("at eps {}", parts.join(", "))
        }
    }
}

/// A short word for how a run ended.
pub fn word(state: RunState) -> &'static str {
    match state {
        RunState::Verified => "verified",
        RunState::OtherBetti => "verified, other Betti numbers",
        RunState::Refused => "refused",
        RunState::Failed => "no mesh",
    }
}

/// Text that is safe inside of an element or an attribute.
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            _ => out.push(c),
        }
    }
    out
}

/// From a radius to its place on the axis.
struct Axis {
    low: f64,
    high: f64,
}

impl Axis {
    /// An axis that holds the radii of all lanes, which are those of the first.
    fn of(lanes: &[Lane<'_>]) -> Self {
        let runs = lanes.first().map_or(&[][..], |lane| lane.runs);
        let (low, high) = match (runs.first(), runs.last()) {
            (Some(a), Some(b)) if a.eps < b.eps => (a.eps, b.eps),
            (Some(a), _) => (0.5 * a.eps, 1.5 * a.eps),
            _ => (0.0, 1.0),
        };
        Self { low, high }
    }

    fn place(&self, eps: f64) -> f64 {
        let pad = 0.03 * (self.high - self.low);
        let share = (eps - self.low + pad) / (self.high - self.low + 2.0 * pad);
        LEFT + share * (WIDTH - LEFT - RIGHT)
    }
}

/// The drawing, as an SVG element. `alone` makes it a file of its own, with its style.
pub fn svg(lanes: &[Lane<'_>], alone: bool) -> String {
    let axis = Axis::of(lanes);
    let lanes_end = TOP + LANE * lanes.len() as f64;
    let panel_top = lanes_end + GAP;
    let height = panel_top + PANEL + 74.0;
    let mut out = String::new();
    head(&mut out, height, alone);
    grid(&mut out, &axis, lanes_end, panel_top);
    for (k, lane) in lanes.iter().enumerate() {
        draw_lane(&mut out, lane, k, &axis);
    }
    // Writing to a string cannot fail.
    let _ = writeln!(
        out,
        "<text class=\"faint\" x=\"{LEFT}\" y=\"{:.1}\">\u{25cf} verified  \u{25b2} verified with other Betti numbers  \
         \u{25cb} a mesh that is refused  \u{2715} no mesh</text>",
        lanes_end + 40.0
    );
    panel(&mut out, lanes, &axis, panel_top);
    let _ = write!(
        out,
        "<text class=\"faint\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">radius eps, unit of the data</text>\n</svg>",
        (LEFT + WIDTH - RIGHT) / 2.0,
        panel_top + PANEL + 40.0
    );
    out
}

/// The element's beginning, and the title.
fn head(out: &mut String, height: f64, alone: bool) {
    let namespace = if alone {
        " xmlns=\"http://www.w3.org/2000/svg\""
    } else {
        ""
    };
    let _ = writeln!(
        out,
        "<svg{namespace} class=\"plot\" viewBox=\"0 0 {WIDTH} {height:.0}\" width=\"{WIDTH}\" height=\"{height:.0}\" \
         role=\"img\" aria-label=\"Which metric works at which radius\">"
    );
    if alone {
        let _ = writeln!(
            out,
            "<style>{STYLE}</style>\n<rect class=\"back\" width=\"{WIDTH}\" height=\"{height:.0}\"/>"
        );
    }
    let _ = writeln!(
        out,
        "<text x=\"{LEFT}\" y=\"20\">Which metric works at which radius</text>"
    );
}

/// Lines and numbers at round radii, through lanes and panel.
fn grid(out: &mut String, axis: &Axis, lanes_end: f64, panel_top: f64) {
    for tick in ticks(axis.low, axis.high, 12) {
        let at = axis.place(tick);
        let _ = writeln!(
            out,
            "<path class=\"grid\" d=\"M{at:.1} {TOP}V{lanes_end:.1}M{at:.1} {panel_top:.1}V{:.1}\"/>",
            panel_top + PANEL
        );
        for base in [lanes_end, panel_top + PANEL] {
            let _ = writeln!(
                out,
                "<text class=\"faint\" x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{tick}</text>",
                base + 18.0
            );
        }
    }
}

/// One metric: its name, where it works, a mark for every run.
fn draw_lane(out: &mut String, lane: &Lane<'_>, k: usize, axis: &Axis) {
    let y = TOP + LANE * (k as f64 + 0.5);
    let class = k % 3;
    let _ = writeln!(
        out,
        "<g class=\"m{class}\"><path class=\"axis\" d=\"M{LEFT} {y:.1}H{:.1}\"/>\n<text x=\"{:.1}\" y=\"{:.1}\" \
         text-anchor=\"end\">{}</text>",
        WIDTH - RIGHT,
        LEFT - 12.0,
        y + 4.5,
        escaped(&lane.name)
    );
    for [from, to] in lane.intervals() {
        let (from, to) = (axis.place(from), axis.place(to));
        let _ = writeln!(
            out,
            "<rect class=\"span\" x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\" rx=\"12\"/>",
            from - 12.0,
            y - 13.0,
            to - from + 24.0,
            26.0
        );
    }
    for run in lane.runs {
        let mark = mark(run.state, axis.place(run.eps), y);
        let hint = hint(&lane.name, run);
        let _ = writeln!(out, "<g>{mark}<title>{hint}</title></g>");
    }
    out.push_str("</g>\n");
}

/// What a reader sees who points at a run.
fn hint(name: &str, run: &ComparedRun) -> String {
    let numbers = run
        .betti
        .map_or(String::new(), |b| format!(", Betti numbers {}", betti(b)));
    let reason = run
        .reason
        .as_deref()
        .map_or(String::new(), |r| format!(": {r}"));
    escaped(&format!(
        "{name} at {}: {}{numbers}{reason}",
        run.eps,
        word(run.state)
    ))
}

/// The mark of how a run ended, around a place.
fn mark(state: RunState, x: f64, y: f64) -> String {
    let (a, b, c, d) = (x - MARK, x + MARK, y - MARK, y + MARK);
    match state {
        RunState::Verified => {
            format!("<circle class=\"full\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{MARK}\"/>")
        }
        RunState::OtherBetti => {
            format!("<path class=\"full\" d=\"M{x:.1} {c:.1}L{b:.1} {d:.1}H{a:.1}Z\"/>")
        }
        RunState::Refused => format!(
            "<circle class=\"hole\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{MARK}\"/><circle class=\"mark\" \
             cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{MARK}\"/>"
        ),
        RunState::Failed => format!(
            "<path class=\"mark\" d=\"M{a:.1} {c:.1}L{b:.1} {d:.1}M{a:.1} {d:.1}L{b:.1} {c:.1}\"/>"
        ),
    }
}

/// Mean distortion of the charts over the radius.
fn panel(out: &mut String, lanes: &[Lane<'_>], axis: &Axis, top: f64) {
    let shares = lanes
        .iter()
        .flat_map(|l| l.runs)
        .filter_map(|r| r.distortion);
    let most = shares.map(|d| d.mean).fold(0.0, f64::max).max(1e-6);
    let marks = ticks(0.0, most, 4);
    let ceiling = marks.last().map_or(most, |&last| most.max(last)) * 1.05;
    let y = |share: f64| top + PANEL * (1.0 - share / ceiling);
    let _ = writeln!(
        out,
        "<text x=\"{LEFT}\" y=\"{:.1}\">Share of the squared distances that charts lose, mean</text>",
        top - 10.0
    );
    for &mark in &marks {
        let at = y(mark);
        let percent = format!("{:.6}", 100.0 * mark);
        let percent = percent.trim_end_matches('0').trim_end_matches('.');
        let _ = writeln!(
            out,
            "<path class=\"grid\" d=\"M{LEFT} {at:.1}H{:.1}\"/><text class=\"faint\" x=\"{:.1}\" y=\"{:.1}\" \
             text-anchor=\"end\">{percent} %</text>",
            WIDTH - RIGHT,
            LEFT - 8.0,
            at + 4.5
        );
    }
    for (k, lane) in lanes.iter().enumerate() {
        let class = k % 3;
        let places: Vec<(f64, f64)> = (lane.runs.iter())
            .filter_map(|r| Some((axis.place(r.eps), y(r.distortion?.mean))))
            .collect();
        let mut path = String::new();
        for (i, (a, b)) in places.iter().enumerate() {
            let _ = write!(path, "{}{a:.1} {b:.1}", if i == 0 { "M" } else { "L" });
        }
        let _ = writeln!(
            out,
            "<g class=\"m{class}\"><path class=\"line\" d=\"{path}\"/>"
        );
        for (a, b) in &places {
            let _ = writeln!(
                out,
                "<circle class=\"full\" cx=\"{a:.1}\" cy=\"{b:.1}\" r=\"3\"/>"
            );
        }
        let _ = writeln!(
            out,
            "<text style=\"fill:currentColor\" x=\"{:.1}\" y=\"{:.1}\">{}</text></g>",
            LEFT + 10.0,
            top + 16.0 + 17.0 * k as f64,
            escaped(&lane.name)
        );
    }
}

/// Round numbers from `low` to `high`, at most `most` of them.
fn ticks(low: f64, high: f64, most: usize) -> Vec<f64> {
    let rough = (high - low) / most as f64;
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0]
        .map(|s| s * power)
        .into_iter()
        .find(|s| *s >= rough * (1.0 - 1e-9))
        .unwrap_or(10.0 * power);
    let from = (low / step - 1e-9).ceil() as i64;
    let to = (high / step + 1e-9).floor() as i64;
    // As many digits as the step has: 0.6000000000000001 is 0.6.
    let digits = (1.0 - step.log10().floor()).clamp(0.0, 12.0) as i32;
    let scale = 10f64.powi(digits);
    (from..=to)
        .map(|k| (k as f64 * step * scale).round() / scale)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round() {
        assert_eq!(
            ticks(0.6, 2.2, 8),
            [0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.2]
        );
        assert_eq!(ticks(0.0, 0.0123, 4), [0.0, 0.005, 0.01]);
    }

    #[test]
    fn what_comes_from_errors_is_no_markup() {
        assert_eq!(escaped("a < b & \"c\""), "a &lt; b &amp; &quot;c&quot;");
    }
}
