//! A reconstruction whose memory is limited: foretold, and made in tiles where the whole cloud does not fit.

use super::bytes::shown;
use super::failure::Failure;
use super::needs::{Needs, Work};
use super::number::counted;
use super::points::PointArguments;
use super::repeat;
use super::terminal::complain;
use crosscap::auto::{Auto, Input};
use crosscap::pipeline::{Outcome, Parameters, Pipeline};
use crosscap::{Method, Pinned, Refusal};
use crosscap_algorithms::tiles::{TileId, Tiling};
use crosscap_backends::files::PointRows;
use crosscap_backends::parallel::Threads;
use crosscap_backends::tiles::TilesOnDisk;
use crosscap_core::{Error, PointCloud, Table};
use serde_json::{Value, json};
use std::path::Path;

/// Points that landmarks are counted from, and that cuts between tiles are chosen from.
const SAMPLED: usize = 50_000;
/// A tile with fewer points of the sample is not cut: how many the halves have could not be told.
const LEAST_SAMPLED: usize = 50;

/// Points that stay in their file, and what a run with them takes.
pub struct Limited {
    rows: PointRows,
    sample: PointCloud<f64>,
    scalar: &'static str,
    needs: Needs,
    /// Lengths as they are given, or about as they would be chosen.
    lengths: [f64; 2],
    limit: u64,
    in_memory: u64,
}

/// How a cloud is cut so that it fits.
struct Plan {
    tiling: Tiling,
    threads: usize,
    bytes: u64,
}

impl Limited {
    /// Opens a file, and tells what a run takes.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a file that cannot be read some rows at a time.
    pub fn open(
        path: &Path,
        choice: &PointArguments,
        pinned: &Pinned,
        limit: u64,
    ) -> Result<Self, Failure> {
        let is_array = path
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("npy"));
        if !is_array || !choice.is_plain() {
            return Err(Failure::usage(format!(
                "{}: --memory-limit is for points that can be read some rows at a time: an .npy file that is taken as it is, without \
                 --array, --columns, --transpose, --atoms, --align (numpy.save(\"points.npy\", array) writes one)",
                path.display()
            )));
        }
        let rows = PointRows::open(path)?;
        let file = rows.sample(SAMPLED)?;
        let scalar = file.points.scalar_name();
        let sample = file.points.into_f64();
        let lengths = lengths(&sample, rows.len(), pinned)?;
        let needs = Needs::of(&sample, rows.len(), lengths[1], pinned)?;
        let in_memory = needs.in_memory(Work::of(pinned));
        let limited = Self {
            rows,
            sample,
            scalar,
            needs,
            lengths,
            limit,
            in_memory,
        };
        if !limited.fits() {
            // Whoever reads all points says so himself.
            for remark in &file.remarks {
                complain(format!("{}: {remark}", path.display()));
            }
        }
        complain(limited.foretold());
        Ok(limited)
    }

    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Name of the type that the numbers are stored in.
    pub fn scalar_name(&self) -> &'static str {
        self.scalar
    }

    /// Whether the run in memory keeps below the limit.
    pub fn fits(&self) -> bool {
        self.in_memory <= self.limit
    }

    /// Whether a search for other parameters does, too.
    pub fn leaves_room_for_a_search(&self) -> bool {
        self.needs.in_memory(Work::Everything) <= self.limit
    }

    fn foretold(&self) -> String {
        format!(
            "{}: in memory a run with these {} of R^{} takes up to {}, {} the limit of {}",
            self.rows.path().display(),
            counted(self.len(), "point"),
            self.rows.dimension(),
            shown(self.in_memory),
            if self.fits() { "within" } else { "more than" },
            shown(self.limit)
        )
    }

    /// The same reconstruction in tiles.
    ///
    /// # Errors
    /// [`Failure::Usage`] for what tiles cannot be asked about, or where these, too, take more than the limit; those of the run.
    pub fn reconstruct(
        &self,
        pinned: &Pinned,
        scratch: &Path,
        make: impl FnOnce(Parameters) -> Result<Pipeline, Error>,
    ) -> Result<Result<Outcome, Box<Refusal>>, Failure> {
        let parameters = self.parameters(pinned)?;
        let mut pipeline = make(parameters)?;
        pipeline
            .takes_tiles()
            .map_err(|why| self.not_in_tiles(&why.to_string(), pinned))?;
        let plan = self.plan(&pipeline)?;
        let threads = Threads::new(plan.threads)?;
        complain(format!(
            "in {} on {} it takes up to {}",
            counted(plan.tiling.bounds().len(), "tile"),
            counted(plan.threads, "thread"),
            shown(plan.bytes)
        ));
        let (halo, seed) = (pipeline.tile_halo(), pipeline.parameters().seed);
        let tiles = TilesOnDisk::new(&self.rows, plan.tiling, halo, seed, scratch, &threads)?;
        Ok(match pipeline.reconstruct_tiles(&tiles) {
            Ok(outcome) if outcome.is_verified() => Ok(outcome),
            Err(error) if error.is_input() || error == Error::Interrupted => {
                return Err(error.into());
            }
            refused => Err(Box::new(Refusal::of(refused, None, None))),
        })
    }

    /// The parameters of a run in tiles, all of them given.
    fn parameters(&self, pinned: &Pinned) -> Result<Parameters, Failure> {
        let why = if pinned.complete().is_none() {
            "--eps and --dl are not both given, and the search for them looks at all points together"
        } else if pinned.prepare == Some(true) {
            "--prepare yes looks at all points together"
        } else {
            let [eps, dl] = self.lengths;
            return Ok(pinned.parameters(eps, dl));
        };
        Err(self.not_in_tiles(why, pinned))
    }

    /// Why a run is made neither in memory nor in tiles, and what to do.
    fn not_in_tiles(&self, why: &str, pinned: &Pinned) -> Failure {
        let [eps, dl] = self.lengths;
        let chosen = Parameters {
            seed: pinned.seed.unwrap_or_default(),
            surface: pinned.surface == Some(true),
            models: pinned.parameters(eps, dl).models,
            ..Parameters::new(eps, dl)
        };
        let bare = Pinned {
            seed: pinned.seed,
            threads: pinned.threads,
            eps: pinned.eps,
            dl: pinned.dl,
            surface: pinned.surface,
            models: pinned.models.clone(),
            method: Some(Method::Cells),
            ..Pinned::default()
        };
        // What else is given would have to be taken back, so that only the usual run can be told as a whole.
        let command = match *pinned == bare {
            true => format!("`{}`", repeat::command(pinned, &chosen, false)),
            false => format!(
                "--eps {eps} --dl {dl} and no other choice but --models, and --surface where no crossings are"
            ),
        };
        let chosen = match pinned.complete() {
            Some(_) => String::new(),
            None => format!(" (lengths from {} of the points)", self.sample.len()),
        };
        Failure::usage(format!(
            "{}: not in tiles: {why}; in tiles: {command}{chosen}; else --memory-limit {} or more, or \
             fewer points",
            self.rows.path().display(),
            enough(self.in_memory)
        ))
    }

    /// The fewest tiles with which a run keeps below the limit, on as many threads as that leaves room for.
    fn plan(&self, pipeline: &Pipeline) -> Result<Plan, Failure> {
        let wanted = Threads::new(pipeline.parameters().threads.unwrap_or(0))?.count();
        let halo = pipeline.tile_halo();
        let most = (self.sample.len() / LEAST_SAMPLED).max(1);
        let excerpt = self.needs.excerpt(&self.sample, pipeline)?;
        let tilings: Vec<(Tiling, usize)> = std::iter::successors(Some(1), |count| Some(2 * count))
            .take_while(|&count| count <= most)
            .map(|count| {
                let tiling = Tiling::new(&self.sample, count);
                let largest = self.largest(&tiling, halo);
                (tiling, largest)
            })
            .collect();
        let mut least = u64::MAX;
        for threads in std::iter::successors(Some(wanted), |&n| (n > 1).then_some(n / 2)) {
            for (tiling, largest) in &tilings {
                let bytes = self
                    .needs
                    .in_tiles(tiling.bounds().len(), *largest, threads, excerpt);
                least = least.min(bytes);
                if bytes <= self.limit && tiling.bounds().len() >= threads {
                    let tiling = tiling.clone();
                    return Ok(Plan {
                        tiling,
                        threads,
                        bytes,
                    });
                }
            }
        }
        Err(Failure::usage(format!(
            "{}: in tiles, too, this run takes up to {}, more than the limit of {}: --memory-limit {} or more, or a larger --dl (halo {halo}, \
             about {} landmarks)",
            self.rows.path().display(),
            shown(least),
            shown(self.limit),
            enough(least.min(self.in_memory)),
            self.needs.landmarks()
        )))
    }

    /// About how many points the largest tile has.
    fn largest(&self, tiling: &Tiling, halo: f64) -> usize {
        let mut counts: Table<TileId, usize> = Table::filled(tiling.bounds().len(), 0);
        for place in self.sample.iter() {
            tiling.near(place, halo, |tile| counts[tile] += 1);
        }
        let largest = counts.iter().max().copied().unwrap_or(0);
        (largest as u128 * self.len() as u128 / self.sample.len() as u128) as usize
    }

    /// What was foretold, for the report.
    pub fn told(&self) -> Value {
        json!({ "limit": self.limit, "in_memory": self.in_memory, "landmarks": self.needs.landmarks() })
    }
}

/// A limit that leaves room for so much, as it is typed.
fn enough(bytes: u64) -> String {
    shown(bytes + bytes / 16).replace(' ', "")
}

/// eps and dl as they are given; what is not about as the density of a sample says: that of all points is as many times higher as
/// there are more of them.
fn lengths(sample: &PointCloud<f64>, points: usize, pinned: &Pinned) -> Result<[f64; 2], Failure> {
    if let Some(lengths) = pinned.complete() {
        return Ok(lengths);
    }
    let chosen = Auto::new(Pinned::default())
        .choose(Input::Points(sample))?
        .parameters;
    let nearer = (sample.len() as f64 / points as f64).sqrt();
    let short = |length: f64| format!("{length:.2e}").parse().unwrap_or(length);
    let usual = short(chosen.eps * nearer);
    let eps = pinned
        .eps
        .unwrap_or(pinned.dl.map_or(usual, |dl| usual.max(2.0 * dl)));
    Ok([eps, pinned.dl.unwrap_or(short(eps / 2.0))])
}
