//! The certificate in lines for a reader.

use super::{
    Certificate, CoverReport, DistanceReport, Distances, EdgeReport, GeometryReport, IndexReport,
    LinkReport, QualityReport,
};
use std::fmt;

fn list<K: fmt::Display>(items: impl Iterator<Item = (K, usize)>) -> String {
    items
        .map(|(k, n)| format!("{n} {k}"))
        .collect::<Vec<_>>()
        .join(", ")
}

fn distances(f: &mut fmt::Formatter<'_>, name: &str, d: Option<&Distances>) -> fmt::Result {
    if let Some(d) = d {
        write!(
            f,
            "\n           {name}: max {:.3}, 99% {:.3}, mean {:.3} dl ({} measured)",
            d.max, d.q99, d.mean, d.count
        )?;
    }
    Ok(())
}

impl fmt::Display for Certificate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        indices(f, &self.indices)?;
        if let Some(e) = &self.edges {
            edges(f, e)?;
        }
        if let Some(l) = &self.links {
            links(f, l)?;
        }
        if let Some(g) = &self.geometry {
            geometry(f, g)?;
        }
        if let Some(c) = &self.cover {
            cover(f, c)?;
        }
        if let Some(told) = &self.faithful {
            write!(f, "\nfaithful   {told}")?;
        }
        if let Some(q) = &self.quality {
            quality(f, q)?;
        }
        if let Some(d) = &self.by_distances {
            by_distances(f, d)?;
        }
        let unchecked = self.unchecked();
        if self.by_distances.is_some() && !unchecked.is_empty() {
            let names: Vec<String> = unchecked.iter().map(ToString::to_string).collect();
            write!(
                f,
                "\nunchecked  {}: these need coordinates",
                names.join(", ")
            )?;
        }
        write!(f, "\nverdict    {}", self.verdict())
    }
}

fn indices(f: &mut fmt::Formatter<'_>, i: &IndexReport) -> fmt::Result {
    write!(
        f,
        "indices    {} vertices in R^{}, {} triangles, {} curve edges",
        i.vertices, i.dimension, i.triangles, i.curve_edges
    )
}

fn edges(f: &mut fmt::Formatter<'_>, e: &EdgeReport) -> fmt::Result {
    let by = e.by_triangles.iter();
    let counts = list(by.map(|(k, &n)| (format!("with {k}"), n)));
    write!(f, "\nedges      {}: {counts} triangles", e.edges)
}

fn links(f: &mut fmt::Formatter<'_>, l: &LinkReport) -> fmt::Result {
    let census = l.census.iter();
    let kinds = list(census.map(|(k, &n)| (format!("{k:?}").to_lowercase(), n)));
    write!(f, "\nlinks      {kinds}")
}

fn geometry(f: &mut fmt::Formatter<'_>, g: &GeometryReport) -> fmt::Result {
    write!(
        f,
        "\ngeometry   {} folds (smallest angle {:.1} degrees, {} below 45), {} stacked pairs, {} crossings",
        g.folds, g.smallest_dihedral, g.sharp_edges, g.stacked_pairs, g.crossings
    )
}

fn cover(f: &mut fmt::Formatter<'_>, c: &CoverReport) -> fmt::Result {
    write!(
        f,
        "\ncover      dl {:.4}{}, {} landmarks unused",
        c.landmark_separation,
        if c.separation_given { "" } else { " (guessed)" },
        c.unused_landmarks
    )?;
    if c.points_to_mesh.is_some() {
        write!(
            f,
            "; points {:.3} dl apart, gaps up to about {:.3} dl",
            c.point_spacing, c.point_gap
        )?;
    }
    distances(f, "points to mesh", c.points_to_mesh.as_ref())?;
    distances(f, "mesh to points", c.mesh_to_points.as_ref())?;
    distances(f, "points off planes", c.mesh_off_points.as_ref())
}

fn quality(f: &mut fmt::Formatter<'_>, q: &QualityReport) -> fmt::Result {
    let twisted = q.cells.iter().filter(|c| !c.orientable).count();
    write!(
        f,
        "\nquality    angles from {:.1} degrees (median {:.1}), edges {:.4} to {:.4} (median {:.4}), area {:.4}",
        q.min_angle.min,
        q.min_angle.median,
        q.edge_length.min,
        q.edge_length.max,
        q.edge_length.median,
        q.area
    )?;
    write!(
        f,
        "\n           {} components, {} cells, {twisted} of them not orientable",
        q.components,
        q.cells.len()
    )
}

fn by_distances(f: &mut fmt::Formatter<'_>, d: &DistanceReport) -> fmt::Result {
    write!(
        f,
        "\ndistances  {} folds (smallest angle {:.1} degrees), triangle angles from {:.1} degrees, {} landmarks unused",
        d.folds, d.smallest_dihedral, d.smallest_angle, d.unused_landmarks
    )?;
    distances(f, "points to vertices", Some(&d.points_to_vertices))
}
