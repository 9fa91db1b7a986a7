use super::*;
use crate::picture::{CurveKind, Layout, gallery};
use proptest::prelude::*;

fn decode(bytes: &[u8]) -> (usize, usize, Vec<[u8; 3]>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
        .read_info()
        .unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    let pixels = pixels.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
    (info.width as usize, info.height as usize, pixels)
}

fn count(pixels: &[[u8; 3]], like: impl Fn(i32, i32, i32) -> bool) -> usize {
    pixels
        .iter()
        .filter(|p| like(p[0].into(), p[1].into(), p[2].into()))
        .count()
}

const RED: fn(i32, i32, i32) -> bool = |r, g, b| r > g + 50 && r > b + 50;
const GREEN: fn(i32, i32, i32) -> bool = |r, g, b| g > r + 40 && g > b + 15;
const BLACK: fn(i32, i32, i32) -> bool = |r, g, b| r < 24 && g < 24 && b < 24;

#[test]
fn two_pieces_and_their_double_curve_are_seen() {
    let scene = gallery::two_spheres(4);
    let lined = StillOptions {
        outlines: false,
        ..StillOptions::default()
    };
    let image = still(&scene, 240, 180, &lined).unwrap();
    let (width, height, pixels) = decode(&image);
    assert_eq!((width, height, pixels.len()), (240, 180, 240 * 180));
    assert!(count(&pixels, RED) > 4000, "{}", count(&pixels, RED));
    assert!(count(&pixels, GREEN) > 4000, "{}", count(&pixels, GREEN));
    assert!(count(&pixels, BLACK) > 50, "{}", count(&pixels, BLACK));
    // Nothing touches the border.
    let border =
        |k: usize| k.is_multiple_of(240) || k % 240 == 239 || !(240..240 * 179).contains(&k);
    assert!(
        (0..pixels.len())
            .filter(|k| border(*k))
            .all(|k| pixels[k] == [255; 3])
    );
    // Without the curves no black is left, without a piece no color of it.
    let mut bare = scene.clone();
    bare.curves.clear();
    let options = StillOptions {
        without_pieces: vec![1],
        ..lined
    };
    let (_, _, pixels) = decode(&still(&bare, 240, 180, &options).unwrap());
    assert_eq!(count(&pixels, BLACK) + count(&pixels, GREEN), 0);
    assert!(count(&pixels, RED) > 4000);
}

#[test]
fn the_nearer_piece_hides_the_other() {
    let scene = gallery::two_spheres(4);
    let from = |x: f64| {
        let options = StillOptions {
            direction: Some([x, 0.0, 0.0]),
            ..StillOptions::default()
        };
        decode(&still(&scene, 100, 100, &options).unwrap()).2[50 * 100 + 50]
    };
    let [r, g, b] = from(1.0).map(i32::from);
    assert!(RED(r, g, b), "{r} {g} {b}");
    let [r, g, b] = from(-1.0).map(i32::from);
    assert!(GREEN(r, g, b), "{r} {g} {b}");
}

#[test]
fn a_cut_opens_and_glass_shows_both() {
    let scene = gallery::two_spheres(4);
    let middle = |options: StillOptions| {
        let options = StillOptions {
            direction: Some([1.0, 0.0, 0.0]),
            ..options
        };
        decode(&still(&scene, 100, 100, &options).unwrap()).2[50 * 100 + 50].map(i32::from)
    };
    // The first third of the extent along x belongs to the green sphere alone.
    let [r, g, b] = middle(StillOptions {
        cut: Some(Cut {
            direction: None,
            keep: 0.3,
        }),
        ..StillOptions::default()
    });
    assert!(GREEN(r, g, b), "{r} {g} {b}");
    let opaque = middle(StillOptions::default());
    let glass = middle(StillOptions {
        opacity: 0.4,
        ..StillOptions::default()
    });
    assert!(glass[1] > opaque[1] + 15, "{glass:?} {opaque:?}");
}

#[test]
fn the_same_scene_gives_the_same_bytes_on_any_number_of_threads() {
    let scene = gallery::two_spheres(3);
    for options in [
        StillOptions::default(),
        StillOptions {
            opacity: 0.5,
            edges: true,
            points: true,
            ..StillOptions::default()
        },
    ] {
        let many = still(&scene, 131, 97, &options).unwrap();
        let one = rayon::ThreadPoolBuilder::new()
            .num_threads(1)
            .build()
            .unwrap()
            .install(|| still(&scene, 131, 97, &options).unwrap());
        assert_eq!(many, one);
    }
}

fn loose(places: Vec<[f32; 3]>, points: Vec<[f32; 3]>) -> Scene {
    Scene {
        layouts: vec![Layout {
            name: String::new(),
            places,
            points,
        }],
        ..Scene::default()
    }
}

#[test]
fn degenerate_scenes_are_drawn() {
    let far = f32::MAX;
    let mut flat = loose(vec![[2.0; 3]; 3], vec![]);
    flat.triangles = vec![[0, 1, 2], [0, 0, 0]];
    flat.triangle_piece = vec![0, 0];
    flat.piece_names = vec!["point".into()];
    let mut huge = flat.clone();
    huge.layouts[0].places = vec![[far, far, far], [-far, far, 0.0], [0.0, -far, -far]];
    for scene in [
        loose(vec![], vec![]),
        loose(vec![[1.0, 2.0, 3.0]], vec![]),
        loose(vec![], vec![[1.0, 2.0, 3.0]]),
        loose(
            vec![[0.0; 3], [1.0; 3]],
            vec![[far, 0.0, 0.0], [0.0, 0.0, -far]],
        ),
        flat,
        huge,
    ] {
        for (width, height) in [(1, 1), (3, 200), (64, 48)] {
            let image = still(&scene, width, height, &StillOptions::default()).unwrap();
            assert_eq!(decode(&image).2.len(), width * height);
        }
    }
    // One point is seen.
    let image = still(
        &loose(vec![[7.0; 3]], vec![]),
        60,
        60,
        &StillOptions::default(),
    );
    assert!(count(&decode(&image.unwrap()).2, RED) > 3);
}

#[test]
fn refuses_options_out_of_range() {
    let scene = gallery::two_spheres(1);
    let wrong: [fn(&mut StillOptions); 9] = [
        |o| o.layout = 7,
        |o| o.supersampling = 0,
        |o| o.opacity = 0.0,
        |o| o.opacity = f64::NAN,
        |o| o.curve_width = Some(f64::INFINITY),
        |o| o.direction = Some([0.0; 3]),
        |o| o.up = Some([f64::NAN, 0.0, 1.0]),
        |o| {
            o.cut = Some(Cut {
                direction: None,
                keep: 1.5,
            })
        },
        |o| {
            o.cut = Some(Cut {
                direction: Some([0.0; 3]),
                keep: 0.5,
            })
        },
    ];
    for spoil in wrong {
        let mut options = StillOptions::default();
        spoil(&mut options);
        assert!(still(&scene, 10, 10, &options).is_err(), "{options:?}");
    }
    for (width, height) in [(0, 10), (10, 0), (20_000, 10)] {
        assert!(still(&scene, width, height, &StillOptions::default()).is_err());
    }
    let bad = loose(vec![[f32::NAN; 3]], vec![]);
    assert!(still(&bad, 10, 10, &StillOptions::default()).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn any_triangles_are_drawn(
        places in prop::collection::vec(prop::array::uniform3(
            prop_oneof![-1.0..1.0f32, Just(0.0), prop::num::f32::NORMAL]), 3..12),
        corners in prop::collection::vec(prop::array::uniform3(0usize..100), 0..20),
        direction in prop::option::of(prop::array::uniform3(0.1..1.0f64)),
        keep in prop::option::of(0.0..=1.0f64),
        opacity in 0.1..=1.0f64,
    ) {
        let n = places.len();
        let mut scene = loose(places, vec![]);
        scene.triangles = corners.iter().map(|t| t.map(|v| (v % n) as u32)).collect();
        scene.triangle_piece = vec![0; corners.len()];
        scene.piece_names = vec!["p".into()];
        scene.curves = vec![super::super::Curve {
            kind: CurveKind::Boundary,
            edges: scene.edges(),
        }];
        let options = StillOptions {
            direction,
            opacity,
            edges: true,
            supersampling: 2,
            cut: keep.map(|keep| Cut { direction: None, keep }),
            ..StillOptions::default()
        };
        let image = still(&scene, 40, 30, &options).unwrap();
        prop_assert_eq!(decode(&image).2.len(), 1200);
    }
}
