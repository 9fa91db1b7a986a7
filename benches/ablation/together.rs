//! Which numbers can be taken out at the same time.
//!
//! One number taken out alone says little where two conditions refuse the same fits: each goes without a trace, both do not.

use crate::clouds::Cloud;
use crate::numbers::Number;
use crosscap_algorithms::stratify::Tuning;

/// Takes numbers out, as many as leave every cloud right that is right as it is.
pub struct Together<'a> {
    clouds: Vec<&'a Cloud>,
    out: Vec<&'a Number>,
    /// Numbers that stay, each with the cloud that is lost without it and those that are out.
    pub stay: Vec<(&'a Number, &'a Cloud)>,
    pub runs: usize,
}

impl<'a> Together<'a> {
    /// The clouds are those that are right with all numbers.
    pub fn new(clouds: Vec<&'a Cloud>) -> Self {
        Self {
            clouds,
            out: Vec::new(),
            stay: Vec::new(),
            runs: 0,
        }
    }

    /// The numbers that are out.
    pub fn out(&self) -> &[&'a Number] {
        &self.out
    }

    /// Takes these out if all of them can go with those that are out already; else one half of them after the other.
    pub fn take(&mut self, numbers: &[&'a Number]) {
        if numbers.is_empty() {
            return;
        }
        match (self.lost(numbers), numbers) {
            (None, _) => self.out.extend(numbers),
            (Some(cloud), [number]) => {
                println!("{} stays: {} is lost without it", number.name, cloud.name);
                self.stay.push((number, cloud));
            }
            (Some(_), _) => {
                let (first, second) = numbers.split_at(numbers.len() / 2);
                self.take(first);
                self.take(second);
            }
        }
    }

    /// The first cloud that is lost without these numbers. It is asked first the next time: what breaks one set often breaks
    /// its halves.
    fn lost(&mut self, numbers: &[&'a Number]) -> Option<&'a Cloud> {
        let mut tuning = Tuning::MEASURED;
        for number in self.out.iter().chain(numbers) {
            number.take_out(&mut tuning);
        }
        let runs = &mut self.runs;
        let at = self.clouds.iter().position(|cloud| {
            *runs += 1;
            !cloud.succeeds(&tuning)
        })?;
        let cloud = self.clouds.remove(at);
        self.clouds.insert(0, cloud);
        Some(cloud)
    }
}
