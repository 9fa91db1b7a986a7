//! One star: the triangles around a landmark inside the chart of one of its cells.

use super::front::Front;
use super::rule::circumradius;
use crosscap_core::{CellNeighborhood, ChartTriangle, Error, Landmark, Scalar};
use robust::{Coord, orient2d};

/// A neighborhood laid out in the plane with the triangles that are already in it.
pub(super) struct Patch<'a> {
    members: &'a [Landmark],
    /// Distances of the members, row after row.
    distances: Vec<f64>,
    places: Vec<[f64; 2]>,
    triangles: Vec<ChartTriangle>,
    boxes: Vec<[f64; 4]>,
    /// Curve edges between members, as positions.
    walls: Vec<(usize, usize)>,
}

/// Sign of the area of a triangle of the chart, exact.
pub(super) fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> i8 {
    let coord = |p: [f64; 2]| Coord { x: p[0], y: p[1] };
    let d = orient2d(coord(a), coord(b), coord(c));
    i8::from(d > 0.0) - i8::from(d < 0.0)
}

fn bounds(places: &[[f64; 2]; 3]) -> [f64; 4] {
    let mut b = [
        f64::INFINITY,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NEG_INFINITY,
    ];
    for p in places {
        b[0] = b[0].min(p[0]);
        b[1] = b[1].min(p[1]);
        b[2] = b[2].max(p[0]);
        b[3] = b[3].max(p[1]);
    }
    b
}

impl<'a> Patch<'a> {
    /// Lays out the members that are still in play.
    pub(super) fn new<S: Scalar>(
        front: &mut Front<'_, S>,
        near: &'a CellNeighborhood,
        kept: &'a mut Vec<Landmark>,
    ) -> Result<Self, Error> {
        kept.clear();
        kept.extend(
            near.members()
                .iter()
                .copied()
                .filter(|&m| !front.dropped[m]),
        );
        let members: &'a [Landmark] = kept;
        let k = members.len();
        front.locate(members);
        // Neighborhoods keep the distances of all their pairs.
        let mut distances = vec![f64::INFINITY; k * k + 1];
        for (i, &m) in members.iter().enumerate() {
            distances[i * k + i] = 0.0;
            for (other, d) in front.input.distances().row(m) {
                // Those that are not members go to the end: a branch would be guessed wrong too often.
                let at = front.position(other).map_or(k * k, |j| i * k + j);
                distances[at] = d.as_f64();
            }
        }
        distances.truncate(k * k);
        let chart = front.parts.chart.chart(k, &distances, 2)?;
        let places: Vec<[f64; 2]> = chart
            .coordinates
            .chunks_exact(2)
            .map(|c| [c[0], c[1]])
            .collect();
        let mut patch = Self {
            members,
            distances,
            places,
            triangles: Vec::new(),
            boxes: Vec::new(),
            walls: Vec::new(),
        };
        for (i, &m) in members.iter().enumerate() {
            for &t in &front.incident[m] {
                let corners = front.triangles[t];
                // Each triangle once: from the corner that comes first in the chart.
                let at = corners.map(|c| front.position(c));
                if at.iter().all(|a| a.is_some_and(|a| a >= i)) {
                    patch.push(at.map(|a| a.unwrap_or(0)));
                }
            }
            for &(other, _) in &front.curve[m] {
                if let Some(j) = front.position(other).filter(|&j| j > i) {
                    patch.walls.push((i, j));
                }
            }
        }
        Ok(patch)
    }

    /// Distance of two members.
    fn distance(&self, a: usize, b: usize) -> f64 {
        self.distances[a * self.members.len() + b]
    }

    fn push(&mut self, at: [usize; 3]) {
        let triangle = self.triangle(at);
        self.boxes.push(bounds(&triangle.places));
        self.triangles.push(triangle);
    }

    fn triangle(&self, at: [usize; 3]) -> ChartTriangle {
        ChartTriangle {
            corners: at.map(|a| self.members[a]),
            places: at.map(|a| self.places[a]),
        }
    }

    /// Other corners of the triangles of the chart on the edge of members `a`, `b`.
    fn across(&self, a: Landmark, b: Landmark) -> impl Iterator<Item = Landmark> + '_ {
        self.triangles.iter().filter_map(move |t| {
            let on = t.corners.contains(&a) && t.corners.contains(&b);
            on.then(|| t.corners.iter().copied().find(|&c| c != a && c != b))
                .flatten()
        })
    }

    /// Closes the star of the center (member 0). `false` when no admissible triangle is left
    /// for a dangling edge.
    pub(super) fn close<S: Scalar>(&mut self, front: &mut Front<'_, S>) -> bool {
        loop {
            match self.dangling(front) {
                None => return true,
                Some((x, beyond)) => {
                    let Some(w) = self.apex(front, x, beyond) else {
                        return false;
                    };
                    self.push([0, x, w]);
                    front.add([self.members[0], self.members[x], self.members[w]]);
                }
            }
        }
    }

    /// The shortest edge at the center that lacks a triangle, as the position of its other end and
    /// that of the corner of the triangle that it has.
    fn dangling<S: Scalar>(&self, front: &Front<'_, S>) -> Option<(usize, Option<usize>)> {
        let center = self.members[0];
        let mut ends: Vec<Landmark> = self
            .triangles
            .iter()
            .filter(|t| t.corners.contains(&center))
            .flat_map(|t| t.corners)
            .chain(
                self.walls
                    .iter()
                    .filter(|w| w.0 == 0)
                    .map(|w| self.members[w.1]),
            )
            .filter(|&c| c != center)
            .collect();
        ends.sort_unstable();
        ends.dedup();
        let on_curve = front.input.strata()[center] < 2;
        if ends.is_empty() {
            // A curve that this cell does not touch asks for nothing; a point inside of it does.
            let lone = front.curve[center].iter().all(|c| c.1 == 0);
            if on_curve && !(lone && front.input.strata()[center] == 0) {
                return None;
            }
            // A fresh star starts from the nearest member that can be joined.
            return (1..self.members.len())
                .filter(|&x| self.joinable(front, 0, x))
                .min_by(|&a, &b| {
                    let d = |x: usize| self.distance(0, x);
                    d(a).total_cmp(&d(b)).then(a.cmp(&b))
                })
                .map(|x| (x, None));
        }
        let mut best: Option<(f64, usize, Option<usize>)> = None;
        for end in ends {
            let has: Vec<Landmark> = self.across(center, end).collect();
            // A triangle of an ordinary edge counts even where the chart does not show it.
            let closed = match front.cells(center, end) {
                Some(_) => !has.is_empty(),
                None => front.count(center, end) >= 2,
            };
            if closed {
                continue;
            }
            let x = front.position(end)?;
            let length = self.distance(0, x);
            if best.is_none_or(|b| length < b.0) {
                best = Some((length, x, has.first().and_then(|&c| front.position(c))));
            }
        }
        best.map(|(_, x, beyond)| (x, beyond))
    }

    /// The best admissible corner of a triangle on the edge from the center to `x`, on the
    /// side away from `beyond`.
    fn apex<S: Scalar>(
        &self,
        front: &Front<'_, S>,
        x: usize,
        beyond: Option<usize>,
    ) -> Option<usize> {
        let (p, q) = (self.places[0], self.places[x]);
        let taken = beyond.map(|b| turn(p, q, self.places[b]));
        let edge = self.distance(0, x);
        let mut candidates: Vec<(f64, usize)> = (1..self.members.len())
            .filter(|&w| w != x)
            .filter_map(|w| {
                let side = turn(p, q, self.places[w]);
                if side == 0 || taken == Some(side) {
                    return None;
                }
                let (a, b) = (self.distance(0, w), self.distance(x, w));
                let rank = front.parts.rule.rank(edge, a, b);
                let fits = circumradius(edge, a, b) <= front.parts.largest_circumradius;
                (rank.is_finite() && fits).then_some((rank, w))
            })
            .collect();
        candidates.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        candidates
            .into_iter()
            .map(|(_, w)| w)
            .find(|&w| self.admissible(front, x, w))
    }

    /// Whether the edge of members `a`, `b` could be part of another triangle of this chart.
    fn joinable<S: Scalar>(&self, front: &Front<'_, S>, a: usize, b: usize) -> bool {
        let (u, v) = (self.members[a], self.members[b]);
        let rules = front.parts.rules;
        let total = front.count(u, v);
        match front.cells(u, v) {
            // Beyond the end of a curve of two cells a chart shows both.
            Some(cells) => {
                let other = cells != 2 && self.across(u, v).next().is_some();
                !rules.edge_counts || total < cells as usize && !other
            }
            None => {
                (!rules.edge_counts || total < 2)
                    && (!rules.shortcuts || !front.shortcut(u, v))
                    && self.walls.iter().all(|&(c, d)| !self.crosses(a, b, c, d))
            }
        }
    }

    /// Whether two segments between members cross properly or one end of the second lies on
    /// the first.
    fn crosses(&self, a: usize, b: usize, c: usize, d: usize) -> bool {
        if a == c || a == d || b == c || b == d {
            return false;
        }
        let [p, q, r, s] = [a, b, c, d].map(|k| self.places[k]);
        turn(p, q, r) * turn(p, q, s) <= 0 && turn(r, s, p) * turn(r, s, q) <= 0
    }

    fn admissible<S: Scalar>(&self, front: &Front<'_, S>, x: usize, w: usize) -> bool {
        if !self.joinable(front, 0, w) || !self.joinable(front, x, w) {
            return false;
        }
        let at = [0, x, w];
        let mut corners = at.map(|a| self.members[a]);
        corners.sort_unstable();
        if front.holds(corners) {
            return false;
        }
        let places = at.map(|a| self.places[a]);
        let way = turn(places[0], places[1], places[2]);
        let b = bounds(&places);
        for (k, &p) in self.places.iter().enumerate() {
            // An edge of a curve that ends inside makes the triangle incompatible by any rules.
            if !front.parts.rules.empty && !self.walls.iter().any(|w| w.0 == k || w.1 == k) {
                continue;
            }
            if at.contains(&k) || p[0] < b[0] || p[0] > b[2] || p[1] < b[1] || p[1] > b[3] {
                continue;
            }
            let inside = (0..3).all(|i| turn(places[i], places[(i + 1) % 3], p) * way >= 0);
            if inside {
                return false;
            }
        }
        let triangle = self.triangle(at);
        self.triangles.iter().zip(&self.boxes).all(|(t, c)| {
            let apart = c[0] > b[2] || c[2] < b[0] || c[1] > b[3] || c[3] < b[1];
            apart || front.parts.test.compatible(&triangle, t)
        })
    }
}
