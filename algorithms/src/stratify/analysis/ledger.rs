//! What became of every model: how often it was asked, refused, and won.

use crosscap_core::{Rejection, SingularityModel};
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicUsize, Ordering};

/// What became of one model in the competition for neighborhoods.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ModelCounts {
    /// The model's own name.
    pub name: String,
    /// Fits it was asked for.
    pub asked: usize,
    /// Fits that it had, and that explained the neighborhood better than all others did.
    pub won: usize,
    /// Fits that it had, and that lost to another model's, or to one sheet.
    pub lost: usize,
    /// Fits that it had, and that broke a law.
    pub broken: usize,
    /// Refused for having too few points.
    pub too_few_points: usize,
    /// Refused since the algebra has no real solution.
    pub no_real_solution: usize,
    /// Refused since the residual was above the threshold.
    pub poor_fit: usize,
    /// Refused since a simpler model fits as well.
    pub simpler_model_fits: usize,
    /// Refused since a stratum would hold too few points.
    pub empty_stratum: usize,
    /// Refused for a reason that has no name here.
    pub other: usize,
}

impl ModelCounts {
    /// The counts of all models with those of a later stage, which asked the same models in the same order, or none.
    pub fn with_later(first: &[Self], later: &[Self]) -> Vec<Self> {
        let mut all = first.to_vec();
        for (counts, more) in all.iter_mut().zip(later) {
            counts.add(more);
        }
        all
    }

    fn add(&mut self, more: &Self) {
        self.asked += more.asked;
        self.won += more.won;
        self.lost += more.lost;
        self.broken += more.broken;
        self.too_few_points += more.too_few_points;
        self.no_real_solution += more.no_real_solution;
        self.poor_fit += more.poor_fit;
        self.simpler_model_fits += more.simpler_model_fits;
        self.empty_stratum += more.empty_stratum;
        self.other += more.other;
    }
}

/// What happened to one request.
#[derive(Clone, Copy)]
enum Entry {
    Asked,
    Won,
    Lost,
    Broken,
    TooFewPoints,
    NoRealSolution,
    PoorFit,
    SimplerModelFits,
    EmptyStratum,
    Other,
}

const ENTRIES: usize = Entry::Other as usize + 1;

/// The counts of all models while many threads ask them: sums, which depend on no order.
pub(super) struct Ledger(Vec<[AtomicUsize; ENTRIES]>);

impl Ledger {
    pub(super) fn new(models: usize) -> Self {
        Self((0..models).map(|_| Default::default()).collect())
    }

    fn enter(&self, model: usize, entry: Entry) {
        self.0[model][entry as usize].fetch_add(1, Ordering::Relaxed);
    }

    pub(super) fn asked(&self, model: usize) {
        self.enter(model, Entry::Asked);
    }

    pub(super) fn refused(&self, model: usize, why: &Rejection) {
        let entry = match why {
            Rejection::TooFewPoints { .. } => Entry::TooFewPoints,
            Rejection::NoRealSolution => Entry::NoRealSolution,
            Rejection::PoorFit { .. } => Entry::PoorFit,
            Rejection::SimplerModelFits { .. } => Entry::SimplerModelFits,
            Rejection::EmptyStratum { .. } => Entry::EmptyStratum,
            _ => Entry::Other,
        };
        self.enter(model, entry);
    }

    pub(super) fn broken(&self, model: usize) {
        self.enter(model, Entry::Broken);
    }

    pub(super) fn lost(&self, model: usize) {
        self.enter(model, Entry::Lost);
    }

    pub(super) fn won(&self, model: usize) {
        self.enter(model, Entry::Won);
    }

    pub(super) fn counts(&self, models: &[Box<dyn SingularityModel>]) -> Vec<ModelCounts> {
        let own = |model: &dyn SingularityModel, all: &[AtomicUsize; ENTRIES]| {
            let count = |entry: Entry| all[entry as usize].load(Ordering::Relaxed);
            ModelCounts {
                name: model.name().into(),
                asked: count(Entry::Asked),
                won: count(Entry::Won),
                lost: count(Entry::Lost),
                broken: count(Entry::Broken),
                too_few_points: count(Entry::TooFewPoints),
                no_real_solution: count(Entry::NoRealSolution),
                poor_fit: count(Entry::PoorFit),
                simpler_model_fits: count(Entry::SimplerModelFits),
                empty_stratum: count(Entry::EmptyStratum),
                other: count(Entry::Other),
            }
        };
        let all = models.iter().zip(&self.0);
        all.map(|(model, all)| own(model.as_ref(), all)).collect()
    }
}
