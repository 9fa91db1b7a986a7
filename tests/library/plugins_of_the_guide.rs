//! The metric, the oracle, the estimator and the singularity model that the guide prints: they pass the law kit, and run together.

#[path = "../../examples/custom_estimator.rs"]
#[allow(dead_code)]
mod custom_estimator;
#[path = "../../examples/custom_metric.rs"]
#[allow(dead_code)]
mod custom_metric;
#[path = "../../examples/custom_model.rs"]
#[allow(dead_code)]
mod custom_model;
#[path = "../../examples/custom_oracle.rs"]
#[allow(dead_code)]
mod custom_oracle;

use crosscap::pipeline::PluginNames;
use crosscap::prelude::*;
use crosscap_core::laws::{self, Instances, Settings, StraightLine, instances};
use custom_estimator::TrimmedComponents;
use custom_metric::PeriodicBox;
use custom_model::AlternatingPlanes;
use custom_oracle::SortedAxis;

/// An estimator that leaves no point out, and a model with the tolerances of some parameters.
fn of_the_guide(parameters: &Parameters) -> (TrimmedComponents, AlternatingPlanes) {
    let &Parameters { dt, dp, ep, .. } = parameters;
    (
        TrimmedComponents { dt, trim: 0.0 },
        AlternatingPlanes { dp, ep },
    )
}

/// Metric, oracle, estimator and model as the guide prints them.
#[test]
fn plug_ins_of_the_guide_pass_the_kit() {
    let settings = Settings {
        cases: 16,
        ..Settings::default()
    };
    let side = 2.5;
    laws::metric(&settings, |cloud| {
        let cloud = cloud.clone();
        PeriodicBox { cloud, side }
    })
    .unwrap();
    laws::oracle(&settings, |cloud| {
        (StraightLine(cloud.clone()), SortedAxis::new(cloud.clone()))
    })
    .unwrap();
    let (estimator, model) = of_the_guide(&Parameters::new(0.5, 0.3));
    laws::estimator(&settings, &estimator).unwrap();
    laws::model(&settings, &model, &Instances::new(&instances::two_planes)).unwrap();
}

/// The same four together, over two spheres in a box that they do not reach around.
fn made_of_the_guide(cloud: &PointCloud<f64>, parameters: Parameters) -> Result<Pipeline, Error> {
    let (estimator, model) = of_the_guide(&parameters);
    let metric = PeriodicBox {
        cloud: cloud.clone(),
        side: 10.0,
    };
    Ok(Pipeline::new(parameters)?
        .analysis_metric(Box::new(metric))
        .oracle(Box::new(SortedAxis::new(cloud.clone())))
        .estimator(Box::new(estimator))
        .models(vec![Box::new(model)]))
}

#[test]
fn plug_ins_of_the_guide_run_in_pipeline_and_comparison_and_both_name_them() {
    // The model fits planes: in a ball of 0.25 the spheres leave theirs by 0.03.
    let surface = SampleSurface::find("two_spheres").unwrap();
    let cloud = surface.sample(&Sampling::new(11_000, 2)).unwrap().points;
    let lengths = Parameters {
        dp: 0.04,
        ep: 0.04,
        ..Parameters::new(0.25, 0.15)
    };
    let named = |names: &PluginNames| {
        let three = [&names.metric, &names.oracle, &names.chart_metric];
        assert_eq!(three, ["periodic", "sorted-axis", "periodic"]);
        assert_eq!(names.estimator.as_deref(), Some("trimmed-pca"));
    };

    let mut pipeline = made_of_the_guide(&cloud, lengths.clone()).unwrap();
    let outcome = pipeline.reconstruct(&cloud).unwrap();
    assert!(outcome.is_verified(), "{}", outcome.certificate);
    assert_eq!(outcome.homology.betti_rational, [1, 0, 3]);
    named(&outcome.report.plugins);
    let [model] = &outcome.report.models[..] else {
        panic!("{:?}", outcome.report.models);
    };
    assert_eq!(model.name, "alternating-planes");
    assert!(model.won > 0, "{model:?}");

    let contenders = [Contender::pipeline("of the guide", made_of_the_guide)];
    let charts = 3.0 * lengths.dl;
    let comparison = Comparison {
        analysis_eps: Some(lengths.eps),
        dp: Some(lengths.dp),
        ep: Some(lengths.ep),
        betti: Some([1, 0, 3]),
        ..Comparison::new([charts])
    };
    let runs = compare(&cloud, &lengths, &contenders, &comparison, &|| ()).unwrap();
    let [run] = &runs[..] else {
        panic!("{runs:?}");
    };
    assert!(run.works(), "{run:?}");
    assert_eq!(run.metric, "of the guide");
    named(run.plugins.as_ref().unwrap());
    assert_eq!(run.models, ["alternating-planes"]);
}
