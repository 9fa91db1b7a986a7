//! Isomap over the edges of a mesh, from landmarks.

use super::geodesic::{EdgeGraph, Search};
use super::principal::{descending, fix_signs};
use super::{Embedding, check_dimension};
use crosscap_core::{Error, Mesh, PointCloud};
use nalgebra::{DMatrix, SymmetricEigen};

/// How [`isomap_places`] works.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IsomapOptions {
    /// Number of vertices from which distances along the mesh are computed, shared among the
    /// components by size. Time grows in proportion, memory too (8 bytes times this times the
    /// vertices); beyond some hundred the picture does not change. At least 1; every component
    /// gets at least `dimension + 1` when it has that many vertices.
    pub landmarks: usize,
}

impl Default for IsomapOptions {
    fn default() -> Self {
        Self { landmarks: 300 }
    }
}

/// Room left between components, as a share of the largest one.
const GAP: f64 = 0.08;

/// Lays a mesh out in `dimension` coordinates so that straight-line distances of the places
/// come as near as possible to distances along the mesh (Isomap, Tenenbaum, de Silva, Langford
/// 2000; from landmarks, de Silva & Tenenbaum 2003).
///
/// Distances are shortest ways over the mesh's own edges (of triangles and of curves), as long
/// as they are in R^N. Landmarks are chosen by max-min: each next one is the vertex furthest
/// from those before. Classical multidimensional scaling of the landmarks comes next, then
/// every vertex is put in by its distances from them, then principal axes with fixed signs.
/// Components are laid out one by one and set side by side, largest first, in rows along the
/// first two axes; a vertex without an edge is a component. The same mesh gives the same picture.
///
/// # Errors
/// [`Error::Parameter`] when `dimension` or `options.landmarks` is 0; [`Error::NotFinite`] when
/// a sum of edge lengths leaves the range of `f64`.
///
/// # Complexity
/// O(L e log v + L^3 + L v) for L landmarks, e edges, v vertices: about a second at L = 300, v = 15,000.
///
/// ```
/// use crosscap_algorithms::isomap::{IsomapOptions, isomap_places};
/// use crosscap_core::{Complex, CurveEdge, Mesh, PointCloud};
/// // A path bent by a right angle is straight again, 2 long.
/// let bent = PointCloud::new(2, vec![0.0, 0.0, 1.0, 0.0, 1.0, 1.0]).unwrap();
/// let path = vec![CurveEdge::new(0, 1, 0), CurveEdge::new(1, 2, 0)];
/// let mesh = Mesh::new(Complex::new(3, vec![], path).unwrap(), bent, vec![-1; 3]).unwrap();
/// let e = isomap_places(&mesh, 3, &IsomapOptions::default()).unwrap();
/// assert!((e.places.squared_distance(0, 2).sqrt() - 2.0).abs() < 1e-12);
/// ```
pub fn isomap_places(
    mesh: &Mesh,
    dimension: usize,
    options: &IsomapOptions,
) -> Result<Embedding, Error> {
    check_dimension(dimension)?;
    if options.landmarks == 0 {
        return Err(Error::Parameter {
            name: "landmarks",
            value: "0".into(),
            expected: "at least 1 (some hundred for a good picture)".into(),
        });
    }
    let count = mesh.complex.vertices;
    // Lengths are squared below: coordinates near 1e200 have to come down first.
    let largest = mesh
        .vertices
        .coordinates()
        .iter()
        .fold(0.0_f64, |m, c| m.max(c.abs()));
    let scale = if largest > 0.0 { largest } else { 1.0 };
    let graph = EdgeGraph::of(mesh, scale);
    let components = graph.components();
    let mut places = vec![0.0; count * dimension];
    let mut boxes = Vec::with_capacity(components.len());
    let mut fit = Correlation::default();
    let mut work = Work {
        distances: vec![0.0; count],
        search: Search::default(),
    };
    for component in &components {
        let share = (options.landmarks * component.len()).div_ceil(count);
        let landmarks = share.max(dimension + 1).min(component.len());
        let mut own = lay_out(&graph, component, landmarks, dimension, &mut work, &mut fit);
        boxes.push(center_box(&mut own, dimension));
        for (place, &v) in own.chunks_exact(dimension).zip(component) {
            places[v as usize * dimension..][..dimension].copy_from_slice(place);
        }
    }
    if components.len() > 1 {
        for (offset, component) in side_by_side(&boxes).iter().zip(&components) {
            for &v in component {
                let place = &mut places[v as usize * dimension..][..dimension];
                for (c, o) in place.iter_mut().zip(offset) {
                    *c += o;
                }
            }
        }
    }
    for c in &mut places {
        *c *= scale;
    }
    Ok(Embedding {
        places: PointCloud::new(dimension, places)?,
        residual_variance: fit.residual(),
        components: components.len(),
    })
}

/// Buffers that all components share.
struct Work {
    distances: Vec<f64>,
    search: Search,
}

/// Places of one component in row order of its vertices, its mean at the origin.
fn lay_out(
    graph: &EdgeGraph,
    component: &[u32],
    landmarks: usize,
    dimension: usize,
    work: &mut Work,
    fit: &mut Correlation,
) -> Vec<f64> {
    let size = component.len();
    if size == 1 {
        return vec![0.0; dimension];
    }
    let (chosen, rows) = max_min(graph, component, landmarks, work);
    let count = chosen.len();
    // Classical scaling: minus half of the squared distances, centered in rows and columns.
    let squared = DMatrix::from_fn(count, count, |i, j| {
        let d = (rows[i * size + chosen[j]] + rows[j * size + chosen[i]]) / 2.0;
        d * d
    });
    let means: Vec<f64> = (0..count).map(|i| squared.row(i).mean()).collect();
    let mean = squared.mean();
    let gram = DMatrix::from_fn(count, count, |i, j| {
        -0.5 * (squared[(i, j)] - means[i] - means[j] + mean)
    });
    let eigen = SymmetricEigen::new(gram);
    let order = descending(eigen.eigenvalues.as_slice());
    let floor = eigen.eigenvalues[order[0]].max(0.0) * 1e-12;
    // Each vertex from its distances to the landmarks: half the pseudo-inverse of the landmark
    // coordinates applied to the difference from the mean squared distances.
    let mut places = vec![0.0; size * dimension];
    for (axis, &at) in order.iter().take(dimension).enumerate() {
        let value = eigen.eigenvalues[at];
        if value <= floor {
            break;
        }
        let vector = eigen.eigenvectors.column(at);
        for i in 0..count {
            let weight = -0.5 * vector[i] / value.sqrt();
            let row = &rows[i * size..(i + 1) * size];
            for (place, d) in places.chunks_exact_mut(dimension).zip(row) {
                place[axis] += weight * (d * d - means[i]);
            }
        }
    }
    turn_to_axes(&mut places, dimension);
    for (i, row) in rows.chunks_exact(size).enumerate() {
        let from = &places[chosen[i] * dimension..][..dimension];
        for (place, &d) in places.chunks_exact(dimension).zip(row) {
            fit.add(d, crosscap_core::squared_distance(from, place).sqrt());
        }
    }
    places
}

/// Landmarks of a component by max-min, as positions in `component`, and their distances
/// from all its vertices in row order. Starts from the vertex furthest from the first one.
fn max_min(
    graph: &EdgeGraph,
    component: &[u32],
    landmarks: usize,
    work: &mut Work,
) -> (Vec<usize>, Vec<f64>) {
    let size = component.len();
    let furthest = |d: &[f64]| {
        let mut best = 0;
        for (k, &value) in d.iter().enumerate() {
            if value > d[best] {
                best = k;
            }
        }
        best
    };
    graph.distances_from(component[0], &mut work.distances, &mut work.search);
    let start: Vec<f64> = component
        .iter()
        .map(|&v| work.distances[v as usize])
        .collect();
    let mut next = furthest(&start);
    let mut nearest = vec![f64::INFINITY; size];
    let mut chosen = Vec::with_capacity(landmarks);
    let mut rows = Vec::with_capacity(landmarks * size);
    while chosen.len() < landmarks {
        graph.distances_from(component[next], &mut work.distances, &mut work.search);
        chosen.push(next);
        for (near, &v) in nearest.iter_mut().zip(component) {
            let d = work.distances[v as usize];
            rows.push(d);
            *near = near.min(d);
        }
        next = furthest(&nearest);
        // All that is left coincides with a landmark.
        if nearest[next] == 0.0 {
            break;
        }
    }
    (chosen, rows)
}

/// Centers places at their mean and turns them to their principal axes with fixed signs.
fn turn_to_axes(places: &mut [f64], dimension: usize) {
    let mut rows = DMatrix::from_row_slice(places.len() / dimension, dimension, places);
    for mut column in rows.column_iter_mut() {
        let mean = column.mean();
        column.add_scalar_mut(-mean);
    }
    let eigen = SymmetricEigen::new(rows.transpose() * &rows);
    for (axis, at) in descending(eigen.eigenvalues.as_slice())
        .into_iter()
        .enumerate()
    {
        let along = &rows * eigen.eigenvectors.column(at);
        for (place, &c) in places.chunks_exact_mut(dimension).zip(along.iter()) {
            place[axis] = c;
        }
    }
    fix_signs(places, dimension);
}

/// The extents of a component along the first two axes, relative to its mean: lower ends, then widths.
fn center_box(places: &mut [f64], dimension: usize) -> [f64; 4] {
    let mut out = [0.0; 4];
    for axis in 0..dimension.min(2) {
        let column = || places.iter().skip(axis).step_by(dimension).copied();
        let low = column().fold(f64::INFINITY, f64::min);
        out[axis] = low;
        out[axis + 2] = column().fold(f64::NEG_INFINITY, f64::max) - low;
    }
    out
}

/// Offsets along the first two axes that set boxes side by side in rows, largest first. With
/// one axis only there is one row, since all heights are 0.
fn side_by_side(boxes: &[[f64; 4]]) -> Vec<[f64; 2]> {
    let size = |b: &[f64; 4]| b[2].max(b[3]);
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_by(|&a, &b| size(&boxes[b]).total_cmp(&size(&boxes[a])).then(a.cmp(&b)));
    let largest = size(&boxes[order[0]]);
    let gap = if largest > 0.0 { largest * GAP } else { 1.0 };
    let flat = boxes.iter().all(|b| b[3] == 0.0);
    let area: f64 = boxes.iter().map(|b| (b[2] + gap) * (b[3] + gap)).sum();
    // A row somewhat longer than a square would have, so that two equal parts stand side by side.
    let limit = if flat && boxes.len() < 64 {
        f64::INFINITY
    } else {
        (1.6 * area).sqrt().max(2.0 * boxes[order[0]][2] + gap)
    };
    let mut offsets = vec![[0.0; 2]; boxes.len()];
    let (mut x, mut y, mut height) = (0.0, 0.0, 0.0_f64);
    for &k in &order {
        let [low_x, low_y, width, tall] = boxes[k];
        if x > 0.0 && x + width > limit {
            x = 0.0;
            y += height + gap;
            height = 0.0;
        }
        offsets[k] = [x - low_x, y - low_y];
        x += width + gap;
        height = height.max(tall);
    }
    offsets
}

/// Correlation of two series, term by term.
#[derive(Default)]
struct Correlation {
    count: f64,
    x: f64,
    y: f64,
    xx: f64,
    yy: f64,
    xy: f64,
}

impl Correlation {
    fn add(&mut self, x: f64, y: f64) {
        self.count += 1.0;
        self.x += x;
        self.y += y;
        self.xx += x * x;
        self.yy += y * y;
        self.xy += x * y;
    }

    /// 1 - r^2; 0 when the first series does not vary.
    fn residual(&self) -> f64 {
        if self.count == 0.0 {
            return 0.0;
        }
        let vx = self.xx - self.x * self.x / self.count;
        let vy = self.yy - self.y * self.y / self.count;
        let c = self.xy - self.x * self.y / self.count;
        if vx <= 0.0 {
            0.0
        } else if vy <= 0.0 {
            1.0
        } else {
            (1.0 - c * c / (vx * vy)).clamp(0.0, 1.0)
        }
    }
}

#[cfg(test)]
mod tests;
