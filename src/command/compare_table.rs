//! A comparison that was made, and the files it is written as.

use super::compare_plot::{Lane, STYLE, escaped, svg, word};
use super::findings::pretty;
use super::number::betti;
use crosscap::comparison::{ComparedRun, Comparison, RunState};
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::collections::BTreeMap;
use std::fmt::Write;

/// A comparison that was made, with what it was made from.
#[derive(Serialize, Deserialize)]
pub(super) struct Table {
    pub(super) crosscap: String,
    /// Name of the file, without folder and extension.
    pub(super) title: String,
    pub(super) points: usize,
    pub(super) dimension: usize,
    pub(super) comparison: Comparison,
    pub(super) dl: f64,
    pub(super) dt: f64,
    pub(super) seed: u64,
    pub(super) surface: bool,
    pub(super) method: String,
    /// Edges of the graph of geodesic distances, in words.
    pub(super) graph: String,
    /// Weight of the lifted metric, in words.
    pub(super) lift: String,
    /// By metric, the first and the last radius of every interval in which it works.
    pub(super) works: BTreeMap<String, Vec<[f64; 2]>>,
    pub(super) runs: Vec<ComparedRun>,
}

impl Table {
    pub(super) fn lanes(&self) -> Vec<Lane<'_>> {
        (self.runs.chunks(self.comparison.radii.len()))
            .map(|runs| Lane {
                name: runs[0].metric.to_string(),
                runs,
            })
            .collect()
    }

    /// What was compared, in lines of name and value.
    fn facts(&self) -> Vec<(&'static str, String)> {
        let mut facts = vec![
            ("points", format!("{} in R^{}", self.points, self.dimension)),
            ("landmark separation dl", self.dl.to_string()),
            (
                "eps is the radius of",
                match self.comparison.analysis_eps {
                    _ if self.surface => "the charts (no curve is looked for)".into(),
                    Some(eps) => format!("the charts (neighborhoods: {eps})"),
                    None => "neighborhoods and charts".into(),
                },
            ),
            ("method", self.method.clone()),
            ("geodesic graph", self.graph.clone()),
            ("lifted weight", self.lift.clone()),
            ("seed", self.seed.to_string()),
        ];
        if let Some(known) = self.comparison.betti {
            facts.push(("known Betti numbers", betti(known)));
        }
        facts
    }

    /// The page: the plot, what was compared, every run.
    pub(super) fn page(&self, lanes: &[Lane<'_>]) -> String {
        let title = escaped(&self.title);
        let mut out = format!(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
             content=\"width=device-width\">\n<title>{title}: metrics compared</title>\n<style>{PAGE}{STYLE}</style>\n\
             </head>\n<body>\n<h1>{title}: metrics compared</h1>\n<ul>\n"
        );
        // Writing to a string cannot fail.
        for lane in lanes {
            let (name, told) = (escaped(&lane.name), lane.told());
            let _ = writeln!(out, "<li><b>{name}</b> works {told}</li>");
        }
        let _ = writeln!(
            out,
            "</ul>\n<div class=\"wide\">{}</div>",
            svg(lanes, false)
        );
        out.push_str("<table class=\"facts\">\n");
        for (name, value) in self.facts() {
            let _ = writeln!(out, "<tr><th>{name}</th><td>{}</td></tr>", escaped(&value));
        }
        out.push_str(HEAD);
        for (k, run) in self.runs.iter().enumerate() {
            out.push_str(&row(run, k / self.comparison.radii.len() % 3));
        }
        out.push_str("</table></div>\n</body>\n</html>\n");
        out
    }

    pub(super) fn csv(&self, times: bool) -> String {
        let mut out = String::from(
            "metric,eps,state,b0,b1,b2,b0_mod_2,b1_mod_2,b2_mod_2,vertices,triangles,distortion_mean,distortion_max",
        );
        out.push_str(if times {
            ",seconds,reason\n"
        } else {
            ",reason\n"
        });
        let three = |b: Option<[usize; 3]>| match b {
            Some([a, b, c]) => format!("{a},{b},{c}"),
            None => ",,".into(),
        };
        let count = |c: Option<usize>| c.map_or(String::new(), |c| c.to_string());
        let share = |s: Option<f64>| s.map_or(String::new(), |s| format!("{s:.6}"));
        for run in &self.runs {
            let state = match run.state {
                RunState::Verified => "verified",
                RunState::OtherBetti => "other-betti",
                RunState::Refused => "refused",
                RunState::Failed => "failed",
            };
            let _ = write!(
                out,
                "{},{},{state},{},{},{},{},{},{}",
                run.metric,
                run.eps,
                three(run.betti),
                three(run.betti_mod_2),
                count(run.vertices),
                count(run.triangles),
                share(run.distortion.map(|d| d.mean)),
                share(run.distortion.map(|d| d.max)),
            );
            if times {
                let seconds = run.seconds.map_or(String::new(), |s| format!("{s:.3}"));
                let _ = write!(out, ",{seconds}");
            }
            let reason = run.reason.as_deref().unwrap_or("").replace('"', "\"\"");
            let _ = writeln!(out, ",\"{reason}\"");
        }
        out
    }

    pub(super) fn json(&self, times: bool) -> String {
        let mut all = json!(self);
        if !times && let Some(runs) = all["runs"].as_array_mut() {
            for run in runs.iter_mut().filter_map(|run| run.as_object_mut()) {
                run.remove("seconds");
            }
        }
        pretty(&all)
    }
}

/// A run as a row of the page, in the color of its lane.
fn row(run: &ComparedRun, color: usize) -> String {
    let numbers = |b: Option<[usize; 3]>| b.map_or(String::new(), betti);
    let percent =
        |share: Option<f64>| share.map_or(String::new(), |s| format!("{:.2} %", 100.0 * s));
    format!(
        "<tr><td class=\"m{color}\">{}</td><td>{}</td><td class=\"{}\">{}</td><td>{}</td><td>{}</td><td>{}</td>\
         <td>{}</td><td>{}</td><td>{}</td><td class=\"reason\">{}</td></tr>\n",
        run.metric,
        run.eps,
        if run.works() { "works" } else { "not" },
        word(run.state),
        numbers(run.betti),
        numbers(run.betti_mod_2),
        run.vertices.map_or(String::new(), |v| v.to_string()),
        percent(run.distortion.map(|d| d.mean)),
        percent(run.distortion.map(|d| d.max)),
        run.seconds.map_or(String::new(), |s| format!("{s:.1}")),
        escaped(run.reason.as_deref().unwrap_or("")),
    )
}

const PAGE: &str = "\
:root{color-scheme:light dark}\
body{font:14px/1.5 system-ui,sans-serif;max-width:960px;margin:24px auto;padding:0 16px;background:#fff;color:#1c1e22}\
h1{font-size:20px}.wide{overflow-x:auto}svg{max-width:100%;height:auto}\
table{border-collapse:collapse;font-size:13px;margin:14px 0}\
th,td{text-align:left;vertical-align:top;padding:3px 12px 3px 0;border-bottom:1px solid #8a909a55}\
th{font-weight:600}.facts th{font-weight:400;opacity:.75}.works{font-weight:600}.not,.reason{opacity:.8}\
.reason{min-width:260px}\
@media (prefers-color-scheme:dark){body{background:#17191d;color:#e8eaee}}";

/// End of the facts and head of the table of runs.
const HEAD: &str = "</table>\n<div class=\"wide\"><table>\n<tr><th>metric</th><th>eps</th><th>mesh</th>\
<th>Betti numbers over Q</th><th>over Z/2</th><th>vertices</th><th>charts lose, mean</th><th>at most</th>\
<th>seconds</th><th>reason</th></tr>\n";
