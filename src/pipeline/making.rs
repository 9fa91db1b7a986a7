//! From waists to a mesh with a verdict, and again with more landmarks where that is what it lacks.

use super::mesh::{Located, at_input_row, mesh_of, special_points};
use super::progress::Progress;
use super::{Parts, Stage};
use crosscap_algorithms::certificate::{Certificate, SpecialPoint, ViolationKind};
use crosscap_algorithms::homology::{Homology, homology};
use crosscap_algorithms::pieces::{Pieces, PiecesError, pieces};
use crosscap_algorithms::stratify::Stratification;
use crosscap_core::{Complex, Error, LocalChart, Mesh, Row, Triangulation};

/// A waist and what was made of it.
pub(super) struct Triangulated {
    pub(super) waist: Stratification<f64>,
    pub(super) triangulation: Triangulation,
    /// Rows of the landmarks that were added.
    pub(super) added: Vec<Row>,
}

/// A mesh and what is known of it.
pub(super) struct Judged {
    pub(super) mesh: Mesh,
    pub(super) special_points: Vec<SpecialPoint>,
    pub(super) homology: Homology,
    pub(super) pieces: Result<Pieces, PiecesError>,
    pub(super) certificate: Certificate,
}

impl Judged {
    /// Whether the verdict is that points are far from the mesh.
    pub(super) fn leaves_points_behind(&self) -> bool {
        let mut violations = self.certificate.violations();
        violations.any(|violation| violation.kind == ViolationKind::UncoveredPoints)
    }

    /// How many places the verdict complains about.
    fn complaints(&self) -> usize {
        self.certificate.violations().map(|v| v.count).sum()
    }
}

/// Makes meshes of one cloud: what asks for points is left to whoever holds them.
pub(super) trait Maker {
    /// What works on waists.
    fn parts(&self) -> &Parts;

    /// Lays neighborhoods out.
    fn chart(&self) -> &dyn LocalChart;

    /// The rows that landmarks stand for.
    fn rows(&self) -> &dyn Located;

    /// The waist with the rows `extra` as landmarks too, looked over.
    fn waist(&self, extra: &[Row]) -> Result<Stratification<f64>, Error>;

    /// Rows that should be landmarks as well, where triangles stray from the points.
    fn rows_where_astray(
        &self,
        waist: &Stratification<f64>,
        complex: &Complex,
    ) -> Result<Vec<Row>, Error>;

    /// Rows that should be landmarks as well, as a mesh leaves them behind.
    fn rows_left_behind(&self, made: &Triangulated, mesh: &Mesh) -> Result<Vec<Row>, Error>;

    /// The verdict on a mesh.
    fn certify(
        &self,
        mesh: &Mesh,
        special_points: &[SpecialPoint],
        made: &Triangulated,
    ) -> Result<Certificate, Error>;

    /// A mesh with its verdict. Where the verdict is that points are left behind, some of them become landmarks and the
    /// mesh is made again. Of all that are made that with the fewest places to complain about counts.
    ///
    /// # Errors
    /// Those of the waist and of the triangulator.
    fn mesh(&self, progress: &mut Progress<'_>) -> Result<(Triangulated, Judged), Error> {
        let mut made = self.triangulated(Vec::new(), progress)?;
        let mut judged = self.judged(&made, progress)?;
        let mut behind = self.behind(&made, &judged)?;
        let mut added = made.added.clone();
        for _ in 0..self.parts().tuning.refinement.mends {
            if behind.is_empty() {
                break;
            }
            added.append(&mut behind);
            progress.enter(Stage::Landmarks);
            let again = self.triangulated(added, progress)?;
            let verdict = self.judged(&again, progress)?;
            behind = self.behind(&again, &verdict)?;
            added = again.added.clone();
            if verdict.complaints() < judged.complaints() {
                (made, judged) = (again, verdict);
            }
        }
        Ok((made, judged))
    }

    /// Triangulates a waist with the landmarks `extra`, and others with more of them where triangles stray from
    /// the points.
    fn triangulated(
        &self,
        mut extra: Vec<Row>,
        progress: &mut Progress<'_>,
    ) -> Result<Triangulated, Error> {
        let parts = self.parts();
        let mut round = 0;
        loop {
            let waist = self.waist(&extra)?;
            progress.enter(Stage::Triangulation);
            let triangulation = parts
                .triangulated(&waist.waist, self.chart())
                .map_err(|error| at_input_row(error, &waist.rows, self.rows()))?;
            let mut added = Vec::new();
            if round < parts.tuning.refinement.rounds && parts.takes_more(&waist, &triangulation) {
                added = self.rows_where_astray(&waist, &triangulation.complex)?;
            }
            if added.is_empty() {
                return Ok(Triangulated {
                    waist,
                    triangulation,
                    added: extra,
                });
            }
            extra.extend(added);
            round += 1;
            progress.enter(Stage::Landmarks);
        }
    }

    /// Rows that should be landmarks as well, where the verdict on a mesh is that points are far from it.
    fn behind(&self, made: &Triangulated, judged: &Judged) -> Result<Vec<Row>, Error> {
        if judged.leaves_points_behind()
            && self.parts().takes_more(&made.waist, &made.triangulation)
        {
            return self.rows_left_behind(made, &judged.mesh);
        }
        Ok(Vec::new())
    }

    /// The mesh of a triangulation, its homology and pieces, and the verdict.
    fn judged(&self, made: &Triangulated, progress: &mut Progress<'_>) -> Result<Judged, Error> {
        progress.enter(Stage::Homology);
        let mesh = mesh_of(&made.triangulation.complex, &made.waist, self.rows())?;
        let homology = homology(&mesh.complex)?;
        let pieces = pieces(&mesh);
        progress.enter(Stage::Certificate);
        let special_points = special_points(&mesh, &made.waist, self.rows());
        Ok(Judged {
            certificate: self.certify(&mesh, &special_points, made)?,
            special_points,
            mesh,
            homology,
            pieces,
        })
    }
}

impl Parts {
    /// Whether more landmarks may help: what cannot be triangulated is not mended by them.
    fn takes_more(&self, waist: &Stratification<f64>, triangulation: &Triangulation) -> bool {
        let open = triangulation.incomplete.len() as f64;
        open <= self.tuning.refinement.open_share * waist.rows.len() as f64
    }
}
