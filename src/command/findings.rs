//! What is known about a mesh, for readers and for programs.

use super::number::{betti, counted};
use crosscap_algorithms::certificate::{Certificate, SpecialPoint};
use crosscap_algorithms::creases::Creases;
use crosscap_algorithms::homology::Homology;
use crosscap_algorithms::pieces::{BoundaryCorners, Pieces, PiecesError};
use crosscap_core::Mesh;
use serde_json::{Map, Value, json};

/// What is known about a mesh.
#[derive(Clone, Copy)]
pub struct Findings<'a> {
    pub mesh: &'a Mesh,
    pub homology: &'a Homology,
    pub certificate: &'a Certificate,
    pub pieces: &'a Result<Pieces, PiecesError>,
    /// Not known without the points.
    pub creases: Option<&'a Creases>,
    /// Vertices that models call points.
    pub special_points: &'a [SpecialPoint],
}

impl Findings<'_> {
    /// "1586 vertices in R^3, 3256 triangles".
    pub fn size(&self) -> String {
        format!(
            "{} in R^{}, {}",
            counted(self.mesh.complex.vertices, "vertex"),
            self.mesh.vertices.dimension(),
            counted(self.mesh.complex.triangles.len(), "triangle"),
        )
    }

    /// Betti numbers and torsion in one line.
    pub fn topology(&self) -> String {
        let h = self.homology;
        let torsion = if h.torsion.is_empty() {
            "no torsion".into()
        } else {
            let factors: Vec<String> = h.torsion.iter().map(|t| format!("Z/{t}")).collect();
            format!("torsion {} in H1", factors.join(" + "))
        };
        format!(
            "{} over Q; {} over Z/2; {torsion}",
            betti(h.betti_rational),
            betti(h.betti_mod2)
        )
    }

    /// The pieces in a sentence, or why they cannot be told.
    pub fn description(&self) -> String {
        match self.pieces {
            Ok(pieces) => match self.corners() {
                Some(corners) => format!("{pieces} {}.", capitalized(&corners.to_string())),
                None => pieces.to_string(),
            },
            Err(error) => format!("not told apart: {error}"),
        }
    }

    /// Corners of the boundary, where there are any.
    fn corners(&self) -> Option<BoundaryCorners> {
        let corners = BoundaryCorners::of(self.mesh, self.special_points);
        (!corners.all().is_empty()).then_some(corners)
    }

    /// Faces, creases and corners in a sentence, where there are any.
    pub fn creased(&self) -> Option<String> {
        let creases = self.creases.filter(|c| !c.creases.is_empty())?.to_string();
        Some(format!("{}.", capitalized(&creases)))
    }

    /// Whether every piece is orientable; `None` when the pieces cannot be told.
    pub fn orientable(&self) -> Option<bool> {
        let pieces = self.pieces.as_ref().ok()?;
        Some(pieces.pieces.iter().all(|p| p.surface.orientable))
    }

    /// Everything in lines, the verdict last.
    pub fn lines(&self) -> String {
        let orientable = match self.pieces {
            Ok(pieces) => {
                let all = pieces.pieces.len();
                let no = pieces.pieces.iter();
                match no.filter(|p| !p.surface.orientable).count() {
                    0 => "yes".into(),
                    no => format!("no ({no} of {} not)", counted(all, "piece")),
                }
            }
            Err(_) => "unknown, as the pieces are".into(),
        };
        let undone = match self.pieces {
            Ok(pieces) => {
                let euler: i64 = pieces.pieces.iter().map(|p| p.euler).sum();
                match euler == self.homology.euler {
                    true => String::new(),
                    false => format!(", {euler} with the crossings undone"),
                }
            }
            Err(_) => String::new(),
        };
        let creases = self
            .creases
            .map_or_else(String::new, |creases| format!("\ncreases    {creases}"));
        format!(
            "Betti      {}; Euler characteristic {}{undone}\npieces     {}{creases}\norientable {orientable}\n{}",
            self.topology(),
            self.homology.euler,
            self.description(),
            self.certificate
        )
    }

    /// The same for programs.
    pub fn json(&self, verified: bool) -> Map<String, Value> {
        let (pieces, error) = match self.pieces {
            Ok(pieces) => (json!(pieces), Value::Null),
            Err(error) => (Value::Null, json!(error.to_string())),
        };
        let all = json!({
            "verified": verified,
            "vertices": self.mesh.complex.vertices,
            "dimension": self.mesh.vertices.dimension(),
            "triangles": self.mesh.complex.triangles.len(),
            "homology": self.homology,
            "orientable": self.orientable(),
            "description": self.pieces.as_ref().ok().map(ToString::to_string),
            "pieces": pieces,
            "pieces_error": error,
            "creases": self.creases,
            "boundary_corners": self.corners(),
            "certificate": self.certificate,
        });
        match all {
            Value::Object(map) => map,
            _ => Map::new(),
        }
    }
}

/// The same with a capital letter at its beginning.
fn capitalized(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(char::to_uppercase);
    first.into_iter().flatten().chain(letters).collect()
}

/// JSON for people to read, with a line feed at its end.
pub fn pretty(value: &Value) -> String {
    format!("{value:#}\n")
}
