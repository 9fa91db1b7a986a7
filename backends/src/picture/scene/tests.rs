use super::*;
use crosscap_core::CurveEdge;

#[test]
fn a_complex_becomes_a_scene_with_its_curves() {
    let complex = Complex::new(
        4,
        vec![[0, 1, 2]],
        vec![
            CurveEdge::new(0, 1, 1),
            CurveEdge::new(1, 2, 4),
            CurveEdge::new(2, 3, 0),
            CurveEdge::new(0, 2, 2),
        ],
    )
    .unwrap();
    let cloud = PointCloud::new(2, vec![0.0; 8]).unwrap();
    let layout = Layout::coordinates("flat", &cloud, None, [0, 1, 2]).unwrap();
    let scene = Scene::new("", &complex, vec![layout]);
    scene.check().unwrap();
    let kinds: Vec<CurveKind> = scene.curves.iter().map(|c| c.kind).collect();
    assert_eq!(
        kinds,
        [CurveKind::Double, CurveKind::Boundary, CurveKind::Bare]
    );
}

#[test]
fn far_and_huge_coordinates_keep_their_shape() {
    for (offset, unit) in [(1e9, 1.0), (0.0, 1e300), (0.0, 1e-300)] {
        let row = |x: f64, y: f64| [offset + x * unit, offset + y * unit];
        let rows = [row(-1.0, 0.0), row(1.0, 0.0), row(0.0, 0.5)].concat();
        let cloud = PointCloud::new(2, rows).unwrap();
        let layout = Layout::coordinates("", &cloud, Some(&cloud), [0, 1, 7]).unwrap();
        assert_eq!(layout.places, layout.points);
        for (p, q) in
            layout
                .places
                .iter()
                .zip([[-1.0, -0.25, 0.0], [1.0, -0.25, 0.0], [0.0, 0.25, 0.0]])
        {
            for (a, b) in p.iter().zip(q) {
                assert!((a - b).abs() < 1e-6, "{p:?} {q:?}");
            }
        }
    }
}

#[test]
fn refuses_what_does_not_fit_together() {
    let good = Scene {
        layouts: vec![Layout {
            name: "a".into(),
            places: vec![[0.0; 3]; 3],
            points: vec![],
        }],
        triangles: vec![[0, 1, 2]],
        triangle_piece: vec![0],
        piece_names: vec!["one".into()],
        curves: vec![Curve {
            kind: CurveKind::Double,
            edges: vec![[0, 1]],
        }],
        ..Scene::default()
    };
    good.check().unwrap();
    let spoilt: [fn(&mut Scene); 12] = [
        |s| s.layouts.clear(),
        |s| s.layouts[0].places[1][2] = f32::NAN,
        |s| s.layouts[0].points.push([f32::INFINITY, 0.0, 0.0]),
        |s| s.triangles[0][2] = 3,
        |s| s.curves[0].edges[0][0] = 9,
        |s| s.triangle_piece[0] = 1,
        |s| s.triangle_piece.clear(),
        |s| s.vertex_rows = vec![0; 2],
        |s| s.point_rows = vec![0; 3],
        |s| {
            s.scalars.push(SceneScalar {
                vertices: vec![0.0; 4],
                ..SceneScalar::default()
            })
        },
        |s| {
            s.marks.push(Mark {
                layout: 1,
                place: [0.0; 3],
                text: String::new(),
            })
        },
        |s| {
            s.layouts.push(Layout {
                name: "b".into(),
                places: vec![],
                points: vec![],
            })
        },
    ];
    for spoil in spoilt {
        let mut scene = good.clone();
        spoil(&mut scene);
        assert!(scene.check().is_err());
    }
}
