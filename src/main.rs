use crosscap_algorithms::chart::ClassicalScaling;
use crosscap_algorithms::dimension::PrincipalComponents;
use crosscap_algorithms::execute::*;
use crosscap_algorithms::landmarks::RandomGreedy;
use crosscap_algorithms::singularity::TwoPlanes;
use crosscap_algorithms::stratify::*;
use crosscap_algorithms::triangulate::*;
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_core::*;
use ndarray::{Array1, Array2};
struct Pool;
impl Execute for Pool {
    fn ranges(&self, count: usize, job: &(dyn Fn(std::ops::Range<usize>) + Sync)) {
        use rayon::prelude::*;
        (0..count).into_par_iter().for_each(|i| job(i..i + 1));
    }
}
struct Lp;
impl CompatibilityTest for Lp {
    fn meeting(&self, a: &ChartTriangle, b: &ChartTriangle) -> Meeting {
        use robust::{Coord, orient2d};
        let t = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| orient2d(Coord { x: p[0], y: p[1] }, Coord { x: q[0], y: q[1] }, Coord { x: r[0], y: r[1] });
        for (x, y) in [(a, b), (b, a)] {
            let w = t(x.places[0], x.places[1], x.places[2]).signum();
            for i in 0..3 {
                let (p, q) = (x.places[i], x.places[(i + 1) % 3]);
                let (cp, cq) = (x.corners[i], x.corners[(i + 1) % 3]);
                let ok = (0..3).all(|k| {
                    if y.corners[k] == cp || y.corners[k] == cq { return true; }
                    t(p, q, y.places[k]) * w < 0.0
                });
                if ok { return Meeting::CommonFace; }
            }
        }
        // separation through a shared vertex: a line through the shared corner
        Meeting::Overlap
    }
    fn name(&self) -> &str { "x" }
}
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let get = |k: &str| a.iter().position(|x| x == k).map(|i| a[i + 1].clone());
    let num = |k: &str| get(k).map(|x| x.parse::<f64>().unwrap());
    let t0 = std::time::Instant::now();
    let arr: Array2<f64> = ndarray_npy::read_npy(&a[2]).unwrap();
    let dim = arr.ncols();
    let cloud = PointCloud::new(dim, arr.into_raw_vec_and_offset().0).unwrap();
    let oracle = EuclideanOracle::new(cloud.clone()).unwrap();
    let boundary: Vec<usize> = get("--boundary").map(|f| { let b: Array1<i64> = ndarray_npy::read_npy(f).unwrap(); b.iter().map(|&x| x as usize).collect() }).unwrap_or_default();
    let dl = num("--dl").unwrap();
    let eps = num("--eps").unwrap();
    let estimator = PrincipalComponents::new(num("--dt").unwrap_or(0.05)).unwrap();
    let mut tp = TwoPlanes::new(num("--dp").unwrap_or(eps), num("--ep").unwrap_or(eps)).unwrap();
    tp.curved = !a.contains(&"--flat".into());
    let models: Vec<Box<dyn SingularityModel>> = vec![Box::new(tp)];
    let analyzer = Analyzer { cloud: &cloud, metric: &oracle, oracle: &oracle, estimator: &estimator, models: &models, execute: &Pool };
    let an = analyzer.analyze(&AnalysisOptions { eps, surface: a.contains(&"--surface".into()), boundary });
    let mut an = match an { Ok(x) => x, Err(e) => { eprintln!("{e}"); std::process::exit(1) } };
    let roles = |r: Role| an.roles.iter().filter(|&&x| x == r).count();
    eprintln!("analysis {:?} k={:.0} cand {} curve {} boundary {} corner {} unexpl {}", t0.elapsed(), an.mean_neighbors, an.candidates, roles(Role::Curve), roles(Role::Boundary), roles(Role::Corner), an.unexplained.len());
    let st = stratify(&analyzer, &mut an, None, &RandomGreedy::new(), &StratifyOptions { dl, tri_eps: num("--tri-eps").unwrap_or(3.0 * dl), seed: num("--seed").unwrap_or(0.) as u64 }).unwrap();
    { let mut h = std::collections::BTreeMap::new(); for i in 0..an.roles.len() { if an.roles[i] == Role::Curve { *h.entry((an.radii[i] * 1000.) as i64).or_insert(0) += 1; } } eprintln!("radii {h:?}"); }
    eprintln!("strat {:?} {:?}", t0.elapsed(), st.counts);
    if let Some(f) = get("--dump") {
        let pl: Vec<Vec<f64>> = st.rows.iter().map(|&r| an.places.point(r).to_vec()).collect();
        let curve: Vec<(usize, Vec<f64>)> = (0..an.roles.len()).filter(|&i| an.roles[i] != Role::Regular).map(|i| (i, an.places.point(i).to_vec())).collect();
        serde_json::to_writer(std::fs::File::create(f).unwrap(), &serde_json::json!({"rows": st.rows, "places": pl, "edges": st.waist.curve_edges.iter().map(|e| e.ends).collect::<Vec<_>>(), "hoods": st.waist.neighborhoods.iter().map(|x| &x.members).collect::<Vec<_>>(), "curve": curve, "strata": st.waist.strata})).unwrap();
    }
    let mut deg = vec![0; st.rows.len()];
    for e in &st.waist.curve_edges { for v in e.ends { deg[v as usize] += 1; } }
    for v in 0..st.counts.curve_landmarks { if deg[v] != 2 { eprintln!("curve landmark {v} degree {} at {:?}", deg[v], an.places.point(st.rows[v])); } }
    let large: Box<dyn TriangleRule> = if a.contains(&"--circ".into()) { Box::new(MinimumCircumradius) } else { Box::new(LargestAngle) };
    let tri = Triangulator { chart: &ClassicalScaling, test: &crosscap_algorithms::predicate::PlanarPredicate, rule: large.as_ref(), largest_circumradius: num("--maxr").unwrap_or(4.0) * dl, repair: !a.contains(&"--norepair".into()) };
    let out = tri.triangulate(&st.waist).unwrap();
    eprintln!("tri {:?} {:?} incomplete {:?}", t0.elapsed(), out.counts, out.incomplete.len());
    for i in &out.incomplete { eprintln!("  incomplete {} stratum {} at {:?}", i.landmark, st.waist.strata[i.landmark as usize], an.places.point(st.rows[i.landmark as usize])); }
    // drop isolated
    let c = &out.complex;
    let mut used = vec![false; c.vertices];
    for t in &c.triangles { for &v in t { used[v as usize] = true; } }
    let mut map = vec![0i64; c.vertices]; let mut verts = Vec::new(); let mut k = 0;
    for v in 0..c.vertices { if used[v] { map[v] = k; k += 1; verts.extend_from_slice(an.places.point(st.rows[v])); } }
    let mut w = ndarray_npy::NpzWriter::new(std::fs::File::create(get("-o").unwrap()).unwrap());
    w.add_array("vertices", &Array2::from_shape_vec((k as usize, dim), verts).unwrap()).unwrap();
    w.add_array("triangles", &Array2::from_shape_vec((c.triangles.len(), 3), c.triangles.iter().flatten().map(|&v| map[v as usize]).collect::<Vec<i64>>()).unwrap()).unwrap();
    for (name, f) in [("singular_edges", 4u8), ("boundary_edges", 1)] {
        let e: Vec<i64> = c.curve_edges.iter().filter(|e| e.cells == f && e.ends.iter().all(|&v| used[v as usize])).flat_map(|e| e.ends).map(|v| map[v as usize]).collect();
        w.add_array(name, &Array2::from_shape_vec((e.len() / 2, 2), e).unwrap()).unwrap();
    }
    w.finish().unwrap();
}
