//! Corners of the boundary, by the angles of the triangles there.

use crate::certificate::SpecialPoint;
use crosscap_core::{LinkKind, Mesh};
use serde::Serialize;
use std::fmt;

/// A vertex at which the boundary of a surface has a corner.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CornerVertex {
    /// The vertex.
    pub vertex: u32,
    /// Angle of the surface there, in degrees: 90 at a corner of a square, 270 at a corner that goes inward.
    pub angle: f64,
}

/// The corners of the boundary of a mesh. `Display` says how many there are.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(transparent)]
pub struct BoundaryCorners(Vec<CornerVertex>);

impl BoundaryCorners {
    /// Those of the special points of a mesh whose link is an arc, with their angles. O(t) for each of them, of t triangles.
    pub fn of(mesh: &Mesh, special: &[SpecialPoint]) -> Self {
        let arcs = special.iter().filter(|p| p.link.kind() == LinkKind::Arc);
        let vertices = arcs.map(|p| p.vertex);
        let inside = vertices.filter(|&v| (v as usize) < mesh.complex.vertices);
        let corner = |vertex| CornerVertex {
            vertex,
            angle: angle_at(mesh, vertex),
        };
        Self(inside.map(corner).collect())
    }

    /// All of them.
    pub fn all(&self) -> &[CornerVertex] {
        &self.0
    }
}

/// Sum of the angles of the triangles at a vertex, in degrees; the law of cosines.
fn angle_at(mesh: &Mesh, vertex: u32) -> f64 {
    let square = |a: u32, b: u32| mesh.vertices.squared_distance(a as usize, b as usize);
    let at = mesh
        .complex
        .triangles
        .iter()
        .filter(|t| t.contains(&vertex));
    let angles = at.filter_map(|t| {
        let mut others = t.iter().copied().filter(|&v| v != vertex);
        let (a, b) = (others.next()?, others.next()?);
        let [p, q, r] = [square(vertex, a), square(vertex, b), square(a, b)];
        Some(
            ((p + q - r) / (2.0 * (p * q).sqrt()))
                .clamp(-1.0, 1.0)
                .acos(),
        )
    });
    angles.sum::<f64>().to_degrees()
}

impl fmt::Display for BoundaryCorners {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let angles = || self.0.iter().map(|c| c.angle.round());
        let least = angles().fold(f64::INFINITY, f64::min);
        let most = angles().fold(0.0, f64::max);
        let degrees = match least == most {
            true => format!("{least}"),
            false => format!("{least} to {most}"),
        };
        match self.0.len() {
            0 => f.write_str("no corner in the boundary"),
            1 => write!(f, "one corner in the boundary ({degrees} degrees)"),
            many => {
                let number = super::description::number(many);
                write!(f, "{number} corners in the boundary ({degrees} degrees)")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crosscap_core::{Complex, Link, PointCloud};

    #[test]
    fn angles_of_an_l() {
        // Three unit squares about the origin, in six triangles.
        let places = [
            [0, 0],
            [1, 0],
            [1, 1],
            [0, 1],
            [-1, 1],
            [-1, 0],
            [-1, -1],
            [0, -1],
        ];
        let places = places.iter().flatten().map(|&x| f64::from(x)).collect();
        let fan = (1..7).map(|k| [0, k, k + 1]).collect();
        let complex = Complex::new(8, fan, vec![]).unwrap();
        let mesh = Mesh::new(complex, PointCloud::new(2, places).unwrap(), vec![-1; 8]).unwrap();
        let special = |link: Link| SpecialPoint { vertex: 0, link };
        let arc = special(LinkKind::Arc.link().unwrap());
        let one = BoundaryCorners::of(&mesh, std::slice::from_ref(&arc));
        assert_eq!(one.to_string(), "one corner in the boundary (270 degrees)");
        let tip = SpecialPoint {
            vertex: 2,
            ..arc.clone()
        };
        let all = [arc, special(Link::circle()), tip];
        let two = BoundaryCorners::of(&mesh, &all);
        assert_eq!(
            two.to_string(),
            "two corners in the boundary (90 to 270 degrees)"
        );
        assert_eq!(two.all()[1].vertex, 2);
    }
}
