//! One test a law, for the listing of a test runner.

/// Writes a module of tests, one a law, that put an implementation through the laws of its trait.
///
/// The right side is a function of the [law kit](crate::laws) with its arguments but for the first, the settings. Each
/// test is named after its law, so that a runner lists them, runs one alone (`cargo test
/// my_metric::symmetry`) and reports all that fail. Two options may follow: `settings: EXPRESSION` in place
/// of the default, and `expected: [("law", "reason"), ...]` for laws that are known not to hold; a law that is
/// marked so and holds fails its test. Names of the module that the macro stands in can be used.
///
/// ```
/// # use crosscap_core::laws::{StraightLine as MyMetric, Settings};
/// crosscap_core::law_tests! {
///     mod my_metric = metric(|cloud| MyMetric(cloud.clone()));
///     mod my_metric_thoroughly = metric(|cloud| MyMetric(cloud.clone())),
///         settings: Settings { cases: 2000, ..Settings::default() };
/// }
/// # fn main() {}
/// ```
///
/// prints, among others, `test my_metric::triangle_inequality ... ok`.
#[macro_export]
macro_rules! law_tests {
    ($(
        $(#[$attribute:meta])*
        mod $module:ident = $kit:ident($($input:expr),+ $(,)?)
        $(, settings: $settings:expr)?
        $(, expected: $expected:expr)?;
    )+) => {$(
        $(#[$attribute])*
        #[cfg(test)]
        mod $module {
            #[allow(unused_imports)]
            use super::*;

            // Once a module: what stands for the implementation is compiled once and not for every law.
            fn put(law: &'static str) {
                let mut settings = $crate::law_tests!(@settings $($settings)?);
                $(settings.expected = ($expected).into();)?
                settings.only = Some(law);
                if let Err(failures) = $crate::laws::$kit(&settings, $($input),+) {
                    panic!("{failures}");
                }
            }

            $crate::law_tests!(@laws $kit @tests);
        }
    )+};
    (@settings) => { $crate::laws::Settings::default() };
    (@settings $settings:expr) => { $settings };
    (@tests $($test:ident $law:literal),+) => {$(
        #[test]
        fn $test() {
            put($law)
        }
    )+};
    (@names $($test:ident $law:literal),+) => { [$((stringify!($test), $law)),+] };
    (@laws metric $($then:tt)+) => {
        $crate::law_tests! { $($then)+
            never_nan "never NaN",
            identity "identity",
            symmetry "symmetry",
            triangle_inequality "triangle inequality",
            many_at_once "many at once",
            places "places" }
    };
    (@laws oracle $($then:tt)+) => {
        $crate::law_tests! { $($then)+
            buffer "buffer",
            strictness "strictness",
            order "order",
            ties "ties",
            equals_brute_force "equals brute force",
            places "places",
            indices "indices",
            nearness "nearness" }
    };
    (@laws estimator $($then:tt)+) => {
        $crate::law_tests! { $($then)+
            answer "answer",
            rounded "rounded",
            motion "motion",
            scale "scale",
            embedding "embedding",
            order "order",
            variances "variances",
            batch "batch" }
    };
    (@laws model $($then:tt)+) => {
        $crate::law_tests! { $($then)+
            partition "partition",
            motion "motion",
            order "order",
            fitted_rows "fitted rows",
            about "about",
            exact_data "exact data",
            noise "noise",
            cells "cells",
            truth "truth" }
    };
    (@laws chart $($then:tt)+) => {
        $crate::law_tests! { $($then)+
            finite "finite",
            refusal "refusal",
            flat_data "flat data",
            distortion "distortion",
            motion "motion" }
    };
    (@laws selector $($then:tt)+) => {
        $crate::law_tests! { $($then)+
            refusal "refusal",
            subset "subset",
            separation "separation",
            covering "covering",
            reproducible "reproducible" }
    };
    (@laws compatibility $($then:tt)+) => {
        $crate::law_tests! { $($then)+
            symmetry "symmetry",
            motion "motion",
            scale "scale",
            reference "reference",
            agreement "agreement" }
    };
    (@laws triangulator $($then:tt)+) => {
        $crate::law_tests! { $($then)+
            answer "answer",
            reproducible "reproducible",
            scale "scale",
            told "told" }
    };
    (@laws rule $($then:tt)+) => {
        $crate::law_tests! { $($then)+
            symmetry "symmetry",
            scale "scale",
            degenerate "degenerate" }
    };
}

#[cfg(test)]
mod tests {
    use crate::laws::{Law, all};

    /// The laws are written out in the macro, which cannot read them off the kit.
    #[test]
    fn every_law_of_a_trait_has_a_test() {
        let check = |subject: &str, listed: &[(&str, &str)]| {
            let of = |law: &&&Law| law.subject == subject;
            let laws: Vec<&str> = all().iter().filter(of).map(|l| l.name).collect();
            let names: Vec<&str> = listed.iter().map(|l| l.1).collect();
            assert_eq!(names, laws, "{subject}");
            for (test, law) in listed {
                assert_eq!(*test, law.to_lowercase().replace(' ', "_"), "{subject}");
            }
        };
        check("MetricSpace", &law_tests!(@laws metric @names));
        check("NeighborhoodOracle", &law_tests!(@laws oracle @names));
        check("DimensionEstimator", &law_tests!(@laws estimator @names));
        check("SingularityModel", &law_tests!(@laws model @names));
        check("LocalChart", &law_tests!(@laws chart @names));
        check("LandmarkSelector", &law_tests!(@laws selector @names));
        check("CompatibilityTest", &law_tests!(@laws compatibility @names));
        check("Triangulator", &law_tests!(@laws triangulator @names));
        check("TriangleRule", &law_tests!(@laws rule @names));
    }

    law_tests! {
        mod straight_line = metric(|cloud| crate::laws::StraightLine(cloud.clone()));
        mod squares = metric(|cloud| Squared(cloud.clone())), expected: [("triangle inequality", "squares of distances")];
    }

    struct Squared(crate::PointCloud<f64>);

    impl crate::MetricSpace for Squared {
        type Scalar = f64;
        fn len(&self) -> usize {
            self.0.len()
        }
        fn distance(&self, a: usize, b: usize) -> f64 {
            self.0.squared_distance(a, b)
        }
        fn name(&self) -> &str {
            "squared"
        }
    }
}
