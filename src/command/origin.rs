//! How a mesh was made, as its file tells.

use crosscap::MetricName;
use crosscap::auto::Measuring;
use crosscap_algorithms::certificate::{CertificateOptions, SpecialPoint};
use serde_json::Value;

/// What a mesh tells of how it was made, in so far as its certificate depends on it. A mesh from elsewhere tells nothing.
#[derive(Clone, Debug, Default)]
pub struct Origin {
    /// Separation of the landmarks, unit of the data.
    pub dl: Option<f64>,
    /// Radius of the neighborhoods, unit of the data.
    pub eps: Option<f64>,
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
            special_points,
            metric: metric
                .and_then(|name| name.parse().ok())
                .unwrap_or_default(),
            prepared: prepared.unwrap_or(metadata.get("dl").is_none()),
        })
    }

    /// What its certificate is to go by, where the separation is `dl` if that is given.
    pub fn certificate(&self, dl: Option<f64>, closed: bool) -> CertificateOptions<'_> {
        CertificateOptions {
            special_points: &self.special_points,
            landmark_separation: dl.or(self.dl),
            closed,
            faithful: self.metric != MetricName::Lifted,
            ..CertificateOptions::default()
        }
    }

    /// How it is held against points, where `dl` and `prepare` are as given.
    pub fn measuring(&self, dl: Option<f64>, prepare: Option<bool>) -> Measuring {
        Measuring {
            prepare: prepare.unwrap_or(self.prepared),
            metric: dl.is_none().then_some(self.metric),
            threads: 0,
        }
    }
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
        let told = json!({ "dl": 0.2, "spaces": { "metric": "conformal" } });
        let origin = Origin::of(&told).unwrap();
        assert_eq!(
            origin.certificate(None, false).landmark_separation,
            Some(0.2)
        );
        assert_eq!(
            origin.certificate(Some(0.3), false).landmark_separation,
            Some(0.3)
        );
        assert_eq!(
            origin.measuring(None, None).metric,
            Some(MetricName::Conformal)
        );
        assert_eq!(origin.measuring(Some(0.3), None).metric, None);
        assert!(
            !origin.measuring(None, None).prepare && origin.measuring(None, Some(true)).prepare
        );
    }

    #[test]
    fn special_points_that_cannot_be_read_are_told() {
        let error = Origin::of(&json!({ "special_points": [7] })).unwrap_err();
        assert!(error.starts_with("its special points"), "{error}");
    }
}
