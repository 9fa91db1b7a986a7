use super::*;
use crate::Neighbor;
use crate::laws::StraightLine;
use crate::laws::reference::{Scan, sort};
use crate::laws::twins::{each_is_caught, quick};

#[derive(Clone, Copy, PartialEq)]
enum Fault {
    None,
    Buffer,
    Inclusive,
    Centerless,
    Unsorted,
    LargerIndex,
    Forgetful,
    Rounded,
    WideAtPlaces,
    InclusiveIndices,
    KeptIndices,
    NearAtRim,
}

struct Twin(Scan<StraightLine<f64>>, Fault);

impl NeighborhoodOracle for Twin {
    type Scalar = f64;
    fn len(&self) -> usize {
        self.0.len()
    }
    fn within(&self, center: usize, radius: f64, out: &mut Vec<Neighbor<f64>>) {
        let mut answer = vec![];
        let wide = if self.1 == Fault::Inclusive {
            radius.next_up()
        } else {
            radius
        };
        self.0.within(center, wide, &mut answer);
        match self.1 {
            Fault::Centerless => answer.retain(|n| n.index != center),
            Fault::Unsorted => answer.sort_by_key(|n| n.index),
            Fault::Forgetful if answer.len() > 3 => {
                answer.pop();
            }
            Fault::Rounded => {
                answer
                    .iter_mut()
                    .for_each(|n| n.distance = f64::from(n.distance as f32));
            }
            _ => {}
        }
        if self.1 != Fault::Buffer {
            out.clear();
        }
        out.extend(answer);
    }
    fn nearest(&self, center: usize, count: usize, out: &mut Vec<Neighbor<f64>>) {
        if self.1 == Fault::LargerIndex {
            self.0.nearest(center, usize::MAX, out);
            out.sort_by(|a, b| {
                a.distance
                    .total_cmp(&b.distance)
                    .then(b.index.cmp(&a.index))
            });
            out.truncate(count);
            sort(out);
        } else {
            self.0.nearest(center, count, out);
        }
    }
    fn indices_within(&self, center: usize, radius: f64, out: &mut Vec<u32>) {
        if self.1 != Fault::KeptIndices {
            out.clear();
        }
        let mut near = vec![];
        let wide = if self.1 == Fault::InclusiveIndices {
            radius.next_up()
        } else {
            radius
        };
        self.within(center, wide, &mut near);
        out.extend(near.iter().rev().map(|n| n.index as u32));
    }
    fn is_near(&self, place: &[f64], radius: f64) -> bool {
        let d = |k: usize| crate::squared_distance(place, self.0.0.0.point(k)).sqrt();
        let wide = self.1 == Fault::NearAtRim;
        (0..self.len()).any(|k| d(k) < radius || wide && d(k) <= radius)
    }
    fn within_of(&self, place: &[f64], radius: f64, out: &mut Vec<Neighbor<f64>>) -> bool {
        out.clear();
        for index in 0..self.len() {
            let distance = crate::squared_distance(place, self.0.0.0.point(index)).sqrt();
            if distance < radius || self.1 == Fault::WideAtPlaces && distance == radius {
                out.push(Neighbor { index, distance });
            }
        }
        sort(out);
        true
    }
}

fn put(fault: Fault) -> Result<(), Failures> {
    oracle(&quick(), |cloud| {
        let metric = StraightLine(cloud.clone());
        (metric.clone(), Twin(Scan(metric), fault))
    })
}

#[test]
fn every_fault_is_caught_by_its_law() {
    let faults: &[(Fault, &Law)] = &[
        (Fault::Buffer, &BUFFER),
        (Fault::Inclusive, &STRICTNESS),
        (Fault::Centerless, &STRICTNESS),
        (Fault::Unsorted, &ORDER),
        (Fault::LargerIndex, &TIES),
        (Fault::Forgetful, &BRUTE_FORCE),
        (Fault::Rounded, &BRUTE_FORCE),
        (Fault::WideAtPlaces, &PLACES),
        (Fault::InclusiveIndices, &INDICES),
        (Fault::KeptIndices, &INDICES),
        (Fault::NearAtRim, &NEARNESS),
    ];
    each_is_caught(put, Fault::None, faults);
}
