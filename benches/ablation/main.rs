//! What each of the numbers that decide the method is good for: every one taken out, halved and doubled, and how
//! many surfaces still come out right.
//!
//! ```text
//! cargo bench --bench ablation                       # all numbers, all clouds, one seed
//! cargo bench --bench ablation -- --seeds 3
//! cargo bench --bench ablation -- --small            # the clouds of fewer than 30,000 points
//! cargo bench --bench ablation -- --large            # the others
//! cargo bench --bench ablation -- --out              # every number taken out only
//! cargo bench --bench ablation -- shrink bridge      # the numbers whose name holds one of these words
//! ```
//!
//! A run is a success when its mesh is verified and has the Betti numbers of the surface over Q and over Z/2. The
//! clouds are the paper's nine surfaces with the paper's parameters, a dozen others, and seven with curves that end or
//! a cone point. One thread: the table is the same for any machine.

mod clouds;
mod numbers;

use clouds::Cloud;
use crosscap_algorithms::stratify::Tuning;
use numbers::NUMBERS;
use std::error::Error;
use std::fmt::Write;

/// Clouds of at least as many points are the large ones.
const LARGE: usize = 30_000;

/// What failed of what succeeds with the numbers that the program has, in words.
fn told(clouds: &[Cloud], usual: &[bool], tuning: &Tuning) -> String {
    let mut lost = Vec::new();
    let mut right = 0;
    for (cloud, &before) in clouds.iter().zip(usual) {
        let now = cloud.succeeds(tuning);
        right += usize::from(now);
        if before && !now {
            lost.push(format!("−{}", cloud.name));
        }
        if now && !before {
            lost.push(format!("+{}", cloud.name));
        }
    }
    let mut text = right.to_string();
    if !lost.is_empty() {
        // Writing to a string cannot fail.
        let _ = write!(text, " ({})", lost.join(", "));
    }
    text
}

/// What is asked for on the command line.
#[derive(Default)]
struct Request {
    seeds: u64,
    small: bool,
    large: bool,
    out: bool,
    words: Vec<String>,
}

impl Request {
    fn read() -> Result<Self, Box<dyn Error>> {
        let mut request = Self {
            seeds: 1,
            ..Self::default()
        };
        let mut words = std::env::args().skip(1);
        while let Some(word) = words.next() {
            match word.as_str() {
                "--bench" => {}
                "--small" => request.small = true,
                "--large" => request.large = true,
                "--out" => request.out = true,
                "--seeds" => {
                    request.seeds = words.next().ok_or("--seeds needs a number")?.parse()?;
                }
                option if option.starts_with('-') => {
                    return Err(format!("no option {option}").into());
                }
                _ => request.words.push(word),
            }
        }
        Ok(request)
    }

    fn clouds(&self) -> Result<Vec<Cloud>, Box<dyn Error>> {
        let mut clouds = Vec::new();
        for seed in 0..self.seeds {
            clouds.extend(clouds::all(seed)?);
        }
        clouds.retain(|cloud| match cloud.points.len() < LARGE {
            true => !self.large,
            false => !self.small,
        });
        Ok(clouds)
    }

    fn wants(&self, number: &str) -> bool {
        self.words.is_empty() || self.words.iter().any(|word| number.contains(word.as_str()))
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let request = Request::read()?;
    let clouds = request.clouds()?;
    let usual: Vec<bool> = (clouds.iter())
        .map(|cloud| cloud.succeeds(&Tuning::MEASURED))
        .collect();
    let right = usual.iter().filter(|&&good| good).count();
    println!("{right} of {} clouds come out right", clouds.len());
    for (cloud, _) in clouds.iter().zip(&usual).filter(|(_, good)| !**good) {
        println!("not right as it is: {}", cloud.name);
    }
    println!("\n| number | value | taken out | half | double |\n| --- | ---: | --- | --- | --- |");
    for number in NUMBERS.iter().filter(|number| request.wants(number.name)) {
        if request.out && number.out.is_none() {
            continue;
        }
        let with = |tuning: Tuning| told(&clouds, &usual, &tuning);
        let out = number
            .out
            .map_or("·".into(), |value| with(number.at(value)));
        let [half, double] = [0.5, 2.0].map(|factor| match request.out {
            true => "·".into(),
            false => with(number.times(factor)),
        });
        println!(
            "| `{}` | {} | {out} | {half} | {double} |",
            number.name,
            number.value()
        );
    }
    Ok(())
}
