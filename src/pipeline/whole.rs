//! Meshes of a cloud that is in memory as a whole.

use super::Parts;
use super::making::{Maker, Triangulated};
use super::mesh::{AllRows, Located};
use super::prepared::Prepared;
use crate::spaces::MetricName;
use crosscap_algorithms::certificate::{
    Certificate, CertificateOptions, SpecialPoint, certify, certify_by_distances, distances_to_mesh,
};
use crosscap_algorithms::stratify::{Refinement, Stratification, WaistProducer};
use crosscap_core::{Complex, Error, LocalChart, Mesh, Row};

/// What meshes of one cloud are made from.
pub(super) struct Whole<'m> {
    pub(super) parts: &'m Parts,
    pub(super) prepared: &'m Prepared<'m>,
    pub(super) producer: &'m dyn WaistProducer<f64>,
    pub(super) chart: &'m dyn LocalChart,
    /// Where vertices are drawn: the places of the points, those on curves moved onto them.
    pub(super) rows: AllRows<'m>,
}

impl Maker for Whole<'_> {
    fn parts(&self) -> &Parts {
        self.parts
    }

    fn chart(&self) -> &dyn LocalChart {
        self.chart
    }

    fn rows(&self) -> &dyn Located {
        &self.rows
    }

    fn waist(&self, extra: &[Row]) -> Result<Stratification<f64>, Error> {
        let waist = self.producer.waist(extra)?;
        waist.check(self.parts.stratifier.name(), self.prepared.rows.cloud.len())?;
        Ok(waist)
    }

    fn rows_where_astray(
        &self,
        waist: &Stratification<f64>,
        complex: &Complex,
    ) -> Result<Vec<Row>, Error> {
        let may_add = |row| self.producer.may_add(row);
        Ok(self.refinement(waist, &may_add).rows_where_astray(complex))
    }

    fn rows_left_behind(&self, made: &Triangulated, mesh: &Mesh) -> Result<Vec<Row>, Error> {
        let heights = distances_to_mesh(mesh, &self.prepared.engines.cloud);
        let may_add = |row| self.producer.may_add(row);
        let refinement = self.refinement(&made.waist, &may_add);
        Ok(refinement.rows_left_behind(&heights))
    }

    fn certify(
        &self,
        mesh: &Mesh,
        special_points: &[SpecialPoint],
        made: &Triangulated,
    ) -> Result<Certificate, Error> {
        let Self {
            parts, prepared, ..
        } = self;
        let dropped = made.triangulation.dropped.iter();
        let dropped = dropped.map(|&k| made.waist.rows[k]);
        let options = CertificateOptions {
            points: Some(&prepared.engines.cloud),
            landmark_separation: Some(parts.parameters.dl),
            separation_scale: prepared.engines.scale(),
            unused_landmarks: &prepared.rows.in_input(dropped),
            special_points,
            closed: parts.is_closed(),
            faithful: parts.parameters.spaces.metric != MetricName::Lifted,
            limits: parts.limits(),
            ..CertificateOptions::default()
        };
        Ok(match &prepared.given {
            None => prepared.rows.named(certify(mesh, &options)),
            Some(space) => certify_by_distances(mesh, space.metric(), space.oracle(), &options),
        })
    }
}

impl Whole<'_> {
    fn refinement<'r>(
        &'r self,
        waist: &'r Stratification<f64>,
        may_add: &'r dyn Fn(Row) -> bool,
    ) -> Refinement<'r, f64> {
        Refinement {
            near: &self.prepared.engines.euclidean,
            places: self.producer.places(),
            may_add,
            rows: &waist.rows,
            dl: self.parts.parameters.dl,
            scale: self.prepared.engines.scale(),
            tuning: &self.parts.tuning.refinement,
        }
    }
}
