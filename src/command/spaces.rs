//! Metrics and neighborhoods as the command line has them.

use super::number::positive;
use clap::Args;
use crosscap::{MetricName, Neighborhoods, Spaces};
use crosscap_backends::geodesic::EdgeRule;

/// What metrics other than the Euclidean one are made with.
#[derive(Args, Debug, Default)]
pub struct GraphArguments {
    /// Join points nearer than this in the graph of geodesic distances, unit of the data: three spacings or more
    #[arg(long, hide_short_help = true, value_name = "E", value_parser = positive, conflicts_with = "graph_k")]
    pub graph_eps: Option<f64>,

    /// Join every point to so many nearest ones in the graph of geodesic distances [default: 30]
    #[arg(long, hide_short_help = true, value_name = "K", value_parser = clap::value_parser!(u32).range(1..))]
    pub graph_k: Option<u32>,

    /// Join points of one sheet alone in that graph, as tangent planes tell sheets apart: for sharp creases
    #[arg(long, hide_short_help = true)]
    pub graph_sheets: bool,

    /// Take lengths in geodesic charts from the tangent planes at both ends where the surface is smooth: paths are some percent too long
    #[arg(long, hide_short_help = true)]
    pub tri_planes: bool,

    /// How far apart the lifted metric holds two sheets that cross at a right angle, unit of the data
    /// [default: 2 eps]
    #[arg(long, hide_short_help = true, value_name = "L", value_parser = positive)]
    pub lift: Option<f64>,
}

impl GraphArguments {
    /// The rule of the graph, where one is given.
    pub fn rule(&self) -> Option<EdgeRule> {
        match (self.graph_eps, self.graph_k) {
            (Some(radius), _) => Some(EdgeRule::Within(radius)),
            (None, Some(count)) => Some(EdgeRule::Nearest(count as usize)),
            (None, None) => None,
        }
    }

    /// The usual choice with these.
    pub fn spaces(&self) -> Spaces {
        let usual = Spaces::default();
        Spaces {
            graph: self.rule().unwrap_or(usual.graph),
            sheets: self.graph_sheets,
            planes: self.tri_planes,
            lift: self.lift,
            ..usual
        }
    }
}

#[derive(Args, Debug, Default)]
#[command(next_help_heading = "Metrics")]
pub struct SpaceArguments {
    /// Distances of the analysis: euclidean, geodesic, conformal or lifted
    ///
    /// Decides on neighborhoods, landmarks and cells. geodesic: shortest paths through a graph of neighbors. conformal:
    /// the same in the spacing of the points, for closed surfaces sampled unevenly. lifted:
    /// position and tangent plane together, which takes crossing sheets apart: the mesh is that of the surface before
    /// it was made to cross itself.
    /// [default: euclidean]
    #[arg(long, hide_short_help = true, value_name = "NAME")]
    pub metric: Option<MetricName>,

    /// Distances of the charts: euclidean, geodesic, conformal or lifted [default: those of the analysis]
    #[arg(
        long,
        hide_short_help = true,
        visible_alias = "triangulation-metric",
        value_name = "NAME"
    )]
    pub tri_metric: Option<MetricName>,

    #[command(flatten)]
    pub graph: GraphArguments,

    /// Size of the neighborhoods of the analysis: radius (eps everywhere), k-nearest:K (as far as the K nearest other
    /// points) or adaptive:K (from that up to eps, as large as they look flat) [default: radius]
    #[arg(long, hide_short_help = true, value_name = "POLICY")]
    pub neighborhoods: Option<Neighborhoods>,
}

impl SpaceArguments {
    /// Options that nothing asks about in a run with these metrics, each with what would ask it.
    pub fn without_effect(&self) -> Vec<String> {
        let analysis = self.metric.unwrap_or_default();
        let charts = self.tri_metric.unwrap_or(analysis);
        let asked_by =
            |metrics: &[MetricName]| metrics.contains(&analysis) || metrics.contains(&charts);
        let graph = &self.graph;
        let along: &[MetricName] = &[MetricName::Geodesic, MetricName::Conformal];
        let given = [
            ("--graph-eps", graph.graph_eps.is_some(), along),
            ("--graph-k", graph.graph_k.is_some(), along),
            ("--graph-sheets", graph.graph_sheets, &along[..1]),
            ("--tri-planes", graph.tri_planes, &along[..1]),
            ("--lift", graph.lift.is_some(), &[MetricName::Lifted]),
        ];
        let idle = given
            .iter()
            .filter(|(_, given, metrics)| *given && !asked_by(metrics));
        let told = idle.map(|(name, _, metrics)| {
            let names: Vec<String> = metrics.iter().map(ToString::to_string).collect();
            format!(
                "{name} has no effect here: it is for --metric or --tri-metric {}",
                names.join(" or ")
            )
        });
        told.collect()
    }
}
