//! What a page shows of the points: the points themselves, numbers to color by, places where a run failed.

use super::layout::LayoutName;
use super::number::counted;
use crosscap_algorithms::certificate::distances_to_mesh;
use crosscap_algorithms::dimension::PrincipalComponents;
use crosscap_algorithms::isomap::principal_places;
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_backends::picture::{Layout, Mark, Scene, SceneScalar};
use crosscap_core::{
    DimensionEstimator, Error, Mesh, Neighborhood, NeighborhoodOracle, PointCloud,
};

/// Points that a page shows at most, every k-th row: half a megabyte.
const SHOWN: usize = 30_000;
/// Nearest points from which the dimension is told: as many as `crosscap dimension` takes.
const NEIGHBORS: usize = 51;
/// Tolerance of the dimension: that of the command line.
const TOLERANCE: f64 = super::parameters::DIMENSION_TOLERANCE;

/// Name of the third coordinate.
pub const HEIGHT: &str = "height";

/// The third coordinates of a cloud in R^3.
pub fn heights(cloud: &PointCloud<f64>) -> Vec<f32> {
    cloud.iter().map(|p| p[2] as f32).collect()
}

/// Adds the points that a mesh was made from, in R^3, and numbers to color by: the dimension of the neighborhood, the
/// distance to the mesh. Above R^3 the vertices alone have them.
pub fn add_points(scene: &mut Scene, mesh: &Mesh, points: &PointCloud<f64>) -> Result<(), Error> {
    if points.is_empty() || points.dimension() != mesh.vertices.dimension() {
        return Ok(());
    }
    let rows = shown(points.len());
    let seen = points.select(&rows);
    let own = LayoutName::Xyz.title();
    if mesh.vertices.dimension() <= 3
        && let Some(layout) = scene.layouts.iter_mut().find(|l| l.name == own)
    {
        *layout = Layout::coordinates(own, &mesh.vertices, Some(&seen), [0, 1, 2])?;
        scene.point_rows = rows.iter().map(|&row| row as u32).collect();
    }
    let is_shown = scene.layouts.iter().any(|l| !l.points.is_empty());
    let of_points = |values: Vec<f32>| if is_shown { values } else { Vec::new() };
    for scalar in scene.scalars.iter_mut().filter(|s| s.name == HEIGHT) {
        scalar.points = of_points(heights(&seen));
    }
    let near = Near::new(points)?;
    scene.scalars.push(SceneScalar {
        name: "dimension".into(),
        vertices: mesh.point_index.iter().map(|&row| near.at(row)).collect(),
        points: of_points(rows.iter().map(|&row| near.at(row as i64)).collect()),
    });
    if is_shown {
        let away = distances_to_mesh(mesh, &seen);
        scene.scalars.push(SceneScalar {
            name: "distance to the mesh".into(),
            vertices: Vec::new(),
            points: away.into_iter().map(|d| d as f32).collect(),
        });
    }
    Ok(())
}

/// Marks rows of the input where something is wrong, with what that is, where own coordinates are shown: in R^3.
pub fn mark(
    scene: &mut Scene,
    mesh: &Mesh,
    points: &PointCloud<f64>,
    faults: &[(Vec<usize>, String)],
) -> Result<(), Error> {
    let own = LayoutName::Xyz.title();
    let Some(at) = scene.layouts.iter().position(|l| l.name == own) else {
        return Ok(());
    };
    if mesh.vertices.dimension() > 3 || points.dimension() != mesh.vertices.dimension() {
        return Ok(());
    }
    for (rows, text) in faults {
        let rows: Vec<usize> = rows.iter().copied().filter(|&r| r < points.len()).collect();
        let places = points.select(&rows);
        let placed = Layout::coordinates(own, &mesh.vertices, Some(&places), [0, 1, 2])?;
        let marks = rows.iter().zip(placed.points).map(|(row, place)| Mark {
            layout: at,
            place,
            text: format!("row {row} of the points: {text}"),
        });
        scene.marks.extend(marks);
    }
    Ok(())
}

/// A cloud by itself, colored by height or dimension: its own coordinates up to R^3, principal axes above.
pub fn cloud(title: &str, points: &PointCloud<f64>) -> Result<Scene, Error> {
    let rows = shown(points.len());
    let seen = points.select(&rows);
    let name = if points.dimension() <= 3 {
        LayoutName::Xyz
    } else {
        LayoutName::Pca
    };
    let places = match name {
        LayoutName::Pca => principal_places(&seen, 3)?.places,
        _ => seen,
    };
    let mut layout = Layout::coordinates(name.title(), &places, None, [0, 1, 2])?;
    layout.points = std::mem::take(&mut layout.places);
    let near = Near::new(points)?;
    let mut scalars = vec![SceneScalar {
        name: "dimension".into(),
        points: rows.iter().map(|&row| near.at(row as i64)).collect(),
        ..SceneScalar::default()
    }];
    if points.dimension() == 3 {
        scalars.insert(
            0,
            SceneScalar {
                name: HEIGHT.into(),
                points: heights(&places),
                ..SceneScalar::default()
            },
        );
    }
    let mut size = format!(
        "{} of R^{}",
        counted(points.len(), "point"),
        points.dimension()
    );
    if rows.len() < points.len() {
        size += &format!(", of which {} are shown", rows.len());
    }
    Ok(Scene {
        title: title.into(),
        facts: vec![("points".into(), size)],
        layouts: vec![layout],
        point_rows: rows.iter().map(|&row| row as u32).collect(),
        scalars,
        ..Scene::default()
    })
}

/// The rows that are shown: all, or evenly as many as a page holds.
fn shown(count: usize) -> Vec<usize> {
    (0..count).step_by(count.div_ceil(SHOWN).max(1)).collect()
}

/// The dimension of the neighborhoods of points.
struct Near<'a> {
    points: &'a PointCloud<f64>,
    oracle: EuclideanOracle<f64>,
    estimator: PrincipalComponents<f64>,
}

impl<'a> Near<'a> {
    fn new(points: &'a PointCloud<f64>) -> Result<Self, Error> {
        Ok(Self {
            points,
            oracle: EuclideanOracle::new(points.clone())?,
            estimator: PrincipalComponents::new(TOLERANCE)?,
        })
    }

    /// That at a row; NaN for no row, and where too few points are near.
    fn at(&self, row: i64) -> f32 {
        let Some(center) = usize::try_from(row).ok().filter(|&r| r < self.points.len()) else {
            return f32::NAN;
        };
        let mut neighbors = Vec::new();
        self.oracle.nearest(center, NEIGHBORS, &mut neighbors);
        let found = self.estimator.estimate(&Neighborhood {
            center,
            radius: f64::INFINITY,
            neighbors: &neighbors,
            metric: &self.oracle,
            cloud: Some(self.points),
        });
        found.map_or(f32::NAN, |found| found.dimension as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crosscap_algorithms::surfaces::{SampleSurface, Sampling};

    fn sphere() -> PointCloud<f64> {
        let surface = SampleSurface::find("sphere").unwrap();
        surface.sample(&Sampling::new(2000, 3)).unwrap().points
    }

    #[test]
    fn a_cloud_is_shown_with_its_numbers() {
        let points = sphere();
        let scene = cloud("sphere", &points).unwrap();
        scene.check().unwrap();
        assert_eq!(scene.layouts[0].points.len(), 2000);
        let [height, dimension] = &scene.scalars[..] else {
            panic!("{:?}", scene.scalars);
        };
        assert_eq!(height.points[7], points.point(7)[2] as f32);
        let flat = dimension.points.iter().filter(|&&d| d == 2.0).count();
        assert!(flat > 1900, "{flat}");
    }

    #[test]
    fn large_clouds_are_thinned_evenly() {
        assert_eq!(shown(5), [0, 1, 2, 3, 4]);
        let rows = shown(100_000);
        assert_eq!((rows.len(), rows[1]), (25_000, 4));
        assert_eq!(shown(0), [0_usize; 0]);
    }
}
