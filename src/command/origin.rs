//! How a mesh was made, as its file tells.

use crosscap::MetricName;
use crosscap::auto::Measuring;
use crosscap_algorithms::certificate::{CertificateOptions, Limits, SpecialPoint};
use serde_json::Value;

/// What a mesh tells of how it was made, in so far as its certificate depends on it. A mesh from elsewhere tells nothing.
#[derive(Clone, Debug, Default)]
pub struct Origin {
    /// Separation of the landmarks, unit of the data.
    pub dl: Option<f64>,
    /// Radius of the neighborhoods, unit of the data.
    pub eps: Option<f64>,
    /// Width of the narrowest hole that the surface was said to have, in spacings of the points.
    pub least_hole: Option<f64>,
    /// Vertices that have the link of a singular point, as a model declared them.
    pub special_points: Vec<SpecialPoint>,
    /// The metric that the landmarks followed; straight lines where that is not told.
    pub metric: MetricName,
    /// Whether something was done about outliers and noise. Of a mesh from elsewhere that is not known, and it is judged as
    /// that of a run without parameters.
    pub prepared: bool,
}

impl Origin {
    /// Reads what was written beside a mesh.
    ///
    /// # Errors
    /// A sentence about special points that cannot be read: without them a pinch point would count as a fault.
    pub fn of(metadata: &Value) -> Result<Self, String> {
        let length = |name: &str| {
            let told = metadata.get(name).and_then(Value::as_f64);
            told.filter(|&length| length > 0.0)
        };
        let special_points = match metadata.get("special_points") {
            None => Vec::new(),
            Some(all) => serde_json::from_value(all.clone()).map_err(|error| {
                format!("its special points, vertices with the link that each must have, cannot be read: {error}")
            })?,
        };
        let metric = metadata.pointer("/spaces/metric").and_then(Value::as_str);
        let prepared = metadata.get("prepared").and_then(Value::as_bool);
        Ok(Self {
            dl: length("dl"),
            eps: length("eps"),
            least_hole: length("least_hole"),
            special_points,
            metric: metric
                .and_then(|name| name.parse().ok())
                .unwrap_or_default(),
            prepared: prepared.unwrap_or(metadata.get("dl").is_none()),
        })
    }

    /// What its certificate is to go by.
    pub fn certificate(&self, asked: &Asked) -> CertificateOptions<'_> {
        let least_hole = asked.least_hole.or(self.least_hole);
        CertificateOptions {
            special_points: &self.special_points,
            landmark_separation: asked.dl.or(self.dl),
            closed: asked.closed,
            faithful: self.metric != MetricName::Lifted,
            limits: Limits {
                least_hole: least_hole.unwrap_or(0.0),
                ..Limits::default()
            },
            ..CertificateOptions::default()
        }
    }

    /// How it is held against points.
    pub fn measuring(&self, asked: &Asked) -> Measuring {
        Measuring {
            prepare: asked.prepare.unwrap_or(self.prepared),
            metric: asked.dl.is_none().then_some(self.metric),
            threads: 0,
        }
    }
}

/// What whoever asks about a mesh knows; it goes before what the mesh tells.
#[derive(Clone, Copy, Debug, Default)]
pub struct Asked {
    /// Separation of the landmarks, unit of the data.
    pub dl: Option<f64>,
    /// Whether the surface is known to have no boundary.
    pub closed: bool,
    /// Whether outliers are left out and noise is allowed for.
    pub prepare: Option<bool>,
    /// Width of the narrowest hole that the surface may have, in spacings of the points.
    pub least_hole: Option<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_mesh_from_elsewhere_is_judged_as_that_of_a_run_without_parameters() {
        let elsewhere = Origin::of(&Value::Null).unwrap();
        assert!(
            elsewhere.prepared && elsewhere.dl.is_none() && elsewhere.special_points.is_empty()
        );
        let own = Origin::of(&json!({ "dl": 0.2, "eps": 0.0 })).unwrap();
        assert!(!own.prepared && own.dl == Some(0.2) && own.eps.is_none());
        assert!(
            Origin::of(&json!({ "dl": 0.2, "prepared": true }))
                .unwrap()
                .prepared
        );
    }

    #[test]
    fn what_is_given_goes_before_what_the_mesh_tells() {
        let told = json!({ "dl": 0.2, "least_hole": 4.0, "spaces": { "metric": "conformal" } });
        let origin = Origin::of(&told).unwrap();
        let (nothing, all) = (
            Asked::default(),
            Asked {
                dl: Some(0.3),
                closed: true,
                prepare: Some(true),
                least_hole: Some(5.0),
            },
        );
        let (own, given) = (origin.certificate(&nothing), origin.certificate(&all));
        assert_eq!(
            [own.landmark_separation, given.landmark_separation],
            [Some(0.2), Some(0.3)]
        );
        assert_eq!([own.limits.least_hole, given.limits.least_hole], [4.0, 5.0]);
        assert!(!own.closed && given.closed);
        let (own, given) = (origin.measuring(&nothing), origin.measuring(&all));
        assert_eq!(
            [own.metric, given.metric],
            [Some(MetricName::Conformal), None]
        );
        assert!(!own.prepare && given.prepare);
    }

    #[test]
    fn special_points_that_cannot_be_read_are_told() {
        let error = Origin::of(&json!({ "special_points": [7] })).unwrap_err();
        assert!(error.starts_with("its special points"), "{error}");
    }
}
