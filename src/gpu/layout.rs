//! Where the particles and pairs of each scene lie on a device, and who belongs to whom.

use super::stage::{GROUP, HEAD, Of, Places, columns};
use crate::engine::elsewhere::{Measured, StepFunctions};
use std::ops::Range;

/// What does not change about a scene while it is stepped.
#[derive(Debug, Clone)]
pub struct Shape {
    /// Its particles.
    pub particles: u32,
    /// What is measured at each step.
    pub measured: Vec<Measured>,
}

/// A scene among others.
#[derive(Debug, Clone)]
pub struct Own {
    /// Its first particle.
    pub first: u32,
    /// Its first pair.
    pub first_pair: u32,
    /// Pairs for which there is room.
    pub room: u32,
    /// The two particles of each pair, as the scene numbers them.
    pub pairs: Vec<[u32; 2]>,
    /// Its sums among all.
    pub sums: Range<usize>,
    /// See [`Shape`].
    pub shape: Shape,
}

/// All scenes one after the other, each from the beginning of a group on.
#[derive(Debug, Clone, Default)]
pub struct Layout {
    /// See [`Own`].
    pub scenes: Vec<Own>,
}

/// Room for `pairs` and some more, which later searches may find.
pub fn room(pairs: usize) -> u32 {
    ((pairs + pairs / 4) as u32).next_multiple_of(GROUP).max(GROUP)
}

impl Layout {
    /// Of scenes of these shapes with room for as many pairs.
    pub fn new(scenes: impl IntoIterator<Item = (Shape, u32)>) -> Self {
        let (mut first, mut first_pair, mut sums) = (0, 0, 0);
        let own = |(shape, room): (Shape, u32)| {
            let measured = shape.measured.len();
            let own = Own { first, first_pair, room, pairs: Vec::new(), sums: sums..sums + measured, shape };
            first += own.shape.particles.next_multiple_of(GROUP);
            first_pair += room;
            sums += measured;
            own
        };
        Self { scenes: scenes.into_iter().map(own).collect() }
    }

    /// Length of the columns of particles.
    pub fn slots(&self) -> u64 {
        self.scenes.last().map_or(0, |own| u64::from(own.first + own.shape.particles.next_multiple_of(GROUP)))
    }

    /// Length of the columns of pairs.
    pub fn pair_slots(&self) -> u64 {
        self.scenes.last().map_or(0, |own| u64::from(own.first_pair + own.room))
    }

    /// Groups of particles, or of pairs.
    pub fn groups(&self, of: Of) -> u32 {
        let length = match of {
            Of::Particles => self.slots(),
            Of::Pairs => self.pair_slots(),
        };
        (length / u64::from(GROUP)) as u32
    }

    /// Sums that are measured at each step.
    pub fn sums(&self) -> usize {
        self.scenes.last().map_or(0, |own| own.sums.end)
    }

    /// Most numbers that [`Self::lists`] has.
    pub fn lists_length(&self) -> u64 {
        let measured =
            self.scenes.iter().flat_map(|own| &own.shape.measured).map(|sum| sum.particles.len()).sum::<usize>();
        let scenes = 2 * self.scenes.len() + 4 * self.sums().max(1) + measured + HEAD.len() + 1;
        2 * self.slots() + 5 * self.pair_slots() + scenes as u64
    }

    /// Who belongs to whom, in whole numbers, as [`HEAD`] tells. The sides of a particle are twice a pair that it is in, and one
    /// more where it is the second of it; those of one particle are in the order of pairs.
    pub fn lists(&self, places: &Places) -> Vec<u32> {
        let (slots, pair_slots) = (self.slots() as usize, self.pair_slots() as usize);
        let mut lists = vec![0; HEAD.len()];
        let mut head = [0; HEAD.len()];
        let mut note = |name: &str, number: usize| {
            let place = HEAD.iter().position(|own| *own == name).expect("a name of the head");
            head[place] = number as u32;
        };
        note("slots", slots);
        note("stride", pair_slots);
        note("groups", slots / GROUP as usize);
        note("pair_groups", pair_slots / GROUP as usize);
        note("sums", self.sums());
        let scenes = || (0..).zip(&self.scenes);
        note("scene_of_group", lists.len());
        for (s, own) in scenes() {
            lists.extend(std::iter::repeat_n(s, own.shape.particles.div_ceil(GROUP) as usize));
        }
        note("ends_of_scenes", lists.len());
        lists.extend(self.scenes.iter().map(|own| own.first + own.shape.particles));
        note("scene_of_pairs", lists.len());
        for (s, own) in scenes() {
            lists.extend(std::iter::repeat_n(s, (own.room / GROUP) as usize));
        }
        note("ends_of_pairs", lists.len());
        lists.extend(self.scenes.iter().map(|own| own.first_pair + own.pairs.len() as u32));

        let mut at = lists.len();
        note("sum_places", at);
        lists.resize(at + 4 * self.sums().max(1), 0);
        for (s, own) in scenes() {
            for sum in &own.shape.measured {
                let first = lists.len() as u32;
                lists.extend(sum.particles.iter().map(|p| own.first + p));
                let numbers = [s, places.columns[sum.number], first, lists.len() as u32];
                lists[at..at + 4].copy_from_slice(&numbers);
                at += 4;
            }
        }

        let starts = lists.len();
        let ends = starts + slots + 1;
        let sides = ends + 2 * pair_slots;
        note("starts", starts);
        note("pair_places", ends);
        let pairs = || {
            self.scenes.iter().flat_map(|own| {
                (own.first_pair..).zip(&own.pairs).map(|(pair, both)| (pair, both.map(|p| own.first + p)))
            })
        };
        lists.resize(sides + 2 * pairs().count(), 0);
        // Counting sort by particle.
        for (_, both) in pairs() {
            both.into_iter().for_each(|p| lists[starts + p as usize + 1] += 1);
        }
        lists[starts] = sides as u32;
        for slot in starts..starts + slots {
            lists[slot + 1] += lists[slot];
        }
        let mut next = lists[starts..starts + slots].to_vec();
        for (pair, both) in pairs() {
            for (second, p) in (0..).zip(both) {
                lists[next[p as usize] as usize] = 2 * pair + second;
                next[p as usize] += 1;
                lists[ends + (2 * pair + second) as usize] = p;
            }
        }
        lists[..HEAD.len()].copy_from_slice(&head);
        lists
    }
}

/// Places of all numbers, those that never change first, and how many columns of particles and of pairs those are.
pub fn places(functions: &StepFunctions, names: &[String]) -> (Places, [u64; 2]) {
    let all: Vec<_> = functions
        .in_order()
        .into_iter()
        .flat_map(|(of, function)| columns(function, of, |name| names.iter().any(|known| known == name)))
        .collect();
    let mut places = Places {
        step: (0..).zip(names).map(|(place, name)| (name.clone(), place)).collect(),
        before_pairs: functions.particles.len(),
        stages: functions.in_order().len(),
        ..Default::default()
    };
    let changes = |of: Of, name: &str| all.iter().any(|(own, put, other)| *put && *own == of && *other == name);
    let mut add = |wanted: bool| {
        for (of, _, name) in all.iter().filter(|(of, _, name)| changes(*of, name) == wanted) {
            let columns = match of {
                Of::Particles => &mut places.columns,
                Of::Pairs => &mut places.pair_columns,
            };
            let next = columns.len() as u32;
            columns.entry((*name).to_owned()).or_insert(next);
        }
        [places.columns.len(), places.pair_columns.len()].map(|count| count as u64)
    };
    let constant = add(false);
    add(true);
    (places, constant)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(pairs: [&[[u32; 2]]; 2]) -> Layout {
        let shape = |particles, measured: &[u32]| Shape {
            particles,
            measured: vec![Measured { number: "axial", particles: measured.to_vec() }],
        };
        let mut layout = Layout::new([(shape(70, &[3, 5]), room(1)), (shape(10, &[9]), room(3))]);
        layout.scenes.iter_mut().zip(pairs).for_each(|(own, pairs)| own.pairs = pairs.to_vec());
        layout
    }

    #[test]
    fn every_particle_finds_its_sides_in_the_order_of_pairs() {
        let layout = layout([&[[0, 69], [1, 69]], &[[2, 4], [4, 7]]]);
        let places = Places { columns: [("axial".to_owned(), 6)].into(), ..Default::default() };
        let lists = layout.lists(&places);
        assert!(lists.len() as u64 <= layout.lists_length());
        let head = |name: &str| lists[HEAD.iter().position(|own| *own == name).unwrap()] as usize;
        assert_eq!((head("slots"), head("groups"), head("stride"), head("pair_groups")), (192, 3, 128, 2));
        let sides = |p: usize| {
            let at = head("starts") + p;
            lists[lists[at] as usize..lists[at + 1] as usize].to_vec()
        };
        // The second scene begins at particle 128 and at pair 64.
        assert_eq!((sides(0), sides(1), sides(2)), (vec![0], vec![2], vec![]));
        assert_eq!((sides(69), sides(128 + 4)), (vec![1, 3], vec![2 * 64 + 1, 2 * 65]));
        assert_eq!(lists[head("pair_places") + 2 * 65..][..2], [132, 135]);
        assert_eq!(lists[head("scene_of_group")..][..3], [0, 0, 1]);
        assert_eq!(lists[head("ends_of_scenes")..][..2], [70, 138]);
        assert_eq!(lists[head("ends_of_pairs")..][..2], [2, 66]);
        let sum = |k: usize| lists[head("sum_places") + 4 * k..][..4].to_vec();
        let [scene, column, first, end] = sum(1)[..] else { panic!("four numbers") };
        assert_eq!((scene, column, &lists[first as usize..end as usize]), (1, 6, &[137][..]));
    }
}
