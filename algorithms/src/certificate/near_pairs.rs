//! Pairs of triangles that meet where they should not.

use super::crossing::Places;
use super::distance::{separated, triangle_triangle};
use super::geometry_report::GeometryReport;
use super::incidence::Incidence;
use super::limits::Limits;
use super::links::SpecialPoint;
use super::pinched::{Pinched, parted};
use super::stacked::Planes;
use super::triangle::corners;
use super::{Place, Violation, ViolationKind};
use crosscap_core::{LinkKind, Mesh};

/// Pairs to look at, per triangle, before a mesh is called entangled.
const PAIRS_PER_TRIANGLE: usize = 3000;

/// Looks at pairs of near triangles, one after another.
pub(super) struct Pairs<'m> {
    mesh: &'m Mesh,
    incidence: &'m Incidence,
    limits: &'m Limits,
    planes: Planes<'m>,
    /// The vertices in exact arithmetic, up to three dimensions.
    exact: Option<Places>,
    /// Vertices at which triangles may lie as they do nowhere else.
    is_special: Vec<bool>,
    pinched: Vec<Pinched>,
    small: f64,
    contact: f64,
    apart: f64,
    /// Triangles farther from each other than this are no pair.
    pub(super) reach: f64,
    budget: usize,
    seen: usize,
    stacked: Vec<Place>,
    crossing: Vec<Place>,
}

impl<'m> Pairs<'m> {
    /// No pair yet; edges are usually as long as the two lengths say.
    pub(super) fn new(
        mesh: &'m Mesh,
        incidence: &'m Incidence,
        limits: &'m Limits,
        [small, large]: [f64; 2],
        special: &[SpecialPoint],
    ) -> Self {
        let mut is_special = vec![false; mesh.complex.vertices];
        let unlike_a_curve = |s: &&SpecialPoint| !LinkKind::GENERIC.contains(&s.link.kind());
        for s in special.iter().filter(unlike_a_curve) {
            if let Some(flag) = is_special.get_mut(s.vertex as usize) {
                *flag = true;
            }
        }
        let pinches = special.iter().filter(|s| s.link.kind() == LinkKind::Pinch);
        let exact = mesh.vertices.dimension() <= 3;
        Self {
            mesh,
            incidence,
            limits,
            planes: Planes::new(mesh),
            exact: exact.then(|| Places::new(mesh.vertices.iter())),
            is_special,
            pinched: pinches
                .map(|s| Pinched::new(mesh, incidence, s.vertex))
                .collect(),
            small,
            contact: limits.contact * small,
            apart: limits.stacked_offset * large,
            reach: 1.15 * large,
            budget: PAIRS_PER_TRIANGLE * mesh.complex.triangles.len() + 100_000,
            seen: 0,
            stacked: Vec::new(),
            crossing: Vec::new(),
        }
    }

    /// Looks at a pair whose boxes are `away` (squared) from each other; `false` where that was the last one.
    pub(super) fn look(&mut self, s: u32, t: u32, away: f64) -> bool {
        self.seen += 1;
        if self.seen > self.budget {
            return false;
        }
        let triangles = &self.mesh.complex.triangles;
        let (a, b) = (triangles[s as usize], triangles[t as usize]);
        let mut shared = None;
        let mut common = 0;
        for v in a {
            if b.contains(&v) {
                common += 1;
                shared = Some(v);
            }
        }
        if common >= 2 {
            return true;
        }
        let touch = if self.exact.is_some() {
            0.0
        } else {
            self.contact
        };
        if away <= touch * touch && self.meet([s, t], common) {
            self.crossing.push(Place::Triangles([s, t]));
        }
        let near =
            away <= self.apart * self.apart || self.planes.centroids_within(s, t, self.reach);
        if near && self.lie_on_each_other([s, t], shared) {
            self.stacked.push(Place::Triangles([s, t]));
        }
        true
    }

    /// Whether two triangles with so many common corners meet in more than these.
    fn meet(&self, [s, t]: [u32; 2], common: usize) -> bool {
        let triangles = &self.mesh.complex.triangles;
        match &self.exact {
            Some(places) => places.meet(triangles[s as usize], triangles[t as usize]),
            None => {
                common == 0 && {
                    let (p, q) = (corners(self.mesh, s), corners(self.mesh, t));
                    !separated(p, q, self.contact)
                        && triangle_triangle(p, q) <= self.contact * self.contact
                }
            }
        }
    }

    /// Whether two triangles with at most one common corner are on top of each other, where nothing explains it.
    fn lie_on_each_other(&self, [s, t]: [u32; 2], shared: Option<u32>) -> bool {
        let depth = self.limits.stacked_depth * self.small;
        !shared.is_some_and(|v| self.is_special[v as usize])
            && (self.planes).stacked(s, t, self.limits.stacked_angle, depth, self.apart)
            && !shared.is_some_and(|v| parted(self.mesh, self.incidence, v, [s, t]))
            && !self.pinched.iter().any(|p| p.parts([s, t]))
    }

    /// Enters what was found.
    pub(super) fn tell(self, report: &mut GeometryReport) {
        report.pairs = self.seen;
        report.stacked_pairs = self.stacked.len();
        report.crossings = self.crossing.len();
        let kind = match self.exact {
            Some(_) => ViolationKind::SelfIntersection,
            None => ViolationKind::NearCrossing,
        };
        let at = |p: Place| super::coordinates(self.mesh, p);
        let stacked = Violation::at(ViolationKind::Stacked, self.stacked, at);
        let crossing = Violation::at(kind, self.crossing, at);
        report
            .violations
            .extend(stacked.into_iter().chain(crossing));
        if self.seen > self.budget {
            report.violations.push(Violation::whole(
                ViolationKind::Entangled,
                format!("more than {} pairs of near triangles", self.budget),
            ));
        }
    }
}
