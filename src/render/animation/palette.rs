//! One palette for a whole sequence of pictures.

use color_quant::NeuQuant;
use image::RgbImage;

/// The index that means "as before". The palette's colours have the indices below it.
pub(super) const TRANSPARENT: u8 = 255;
/// Bits of a colour channel that are told apart: 2^18 bins in all.
const BITS: u32 = 6;
/// How many of the commonest colours get exactly their own: grounds, lines and letters, where a difference would show
/// as an edge.
const EXACT: usize = 24;
/// NeuQuant learns from every nth sample; it wants at least 500 of them.
const LEARN_EVERY: i32 = 3;

/// How often which colour occurs.
pub(super) struct Census {
    bins: Vec<Bin>,
    size: [u32; 2],
}

#[derive(Clone, Copy, Default)]
struct Bin {
    count: u64,
    sum: [u64; 3],
}

impl Bin {
    fn mean(&self) -> [u8; 3] {
        self.sum.map(|sum| (sum as f64 / self.count.max(1) as f64).round() as u8)
    }
}

fn bin_of([r, g, b]: [u8; 3]) -> usize {
    let part = |c: u8| usize::from(c >> (8 - BITS));
    (part(r) << (2 * BITS)) | (part(g) << BITS) | part(b)
}

impl Census {
    pub fn new() -> Self {
        Self { bins: vec![Bin::default(); 1 << (3 * BITS)], size: [0; 2] }
    }

    /// Counts the pixels of a picture.
    pub fn count(&mut self, picture: &RgbImage) {
        self.size = picture.dimensions().into();
        for pixel in picture.pixels() {
            let bin = &mut self.bins[bin_of(pixel.0)];
            bin.count += 1;
            bin.sum.iter_mut().zip(pixel.0).for_each(|(sum, c)| *sum += u64::from(c));
        }
    }

    /// Width and height of the pictures (px).
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The colours that serve all pictures best.
    pub fn palette(&self) -> Palette {
        let mut common: Vec<&Bin> = self.bins.iter().filter(|bin| bin.count > 0).collect();
        common.sort_by_key(|bin| std::cmp::Reverse(bin.count));
        let mut colours = learn(&common);
        for bin in common.iter().take(EXACT).rev() {
            let exact = bin.mean();
            let replaced = nearest(&colours, exact);
            colours[replaced] = exact;
        }
        let index = |bin: &Bin| if bin.count > 0 { nearest(&colours, bin.mean()) as u8 } else { 0 };
        Palette { index: self.bins.iter().map(index).collect(), colours }
    }
}

/// NeuQuant (Dekker 1994) on the colours that occur. The cube root of how often keeps the ground, which is most of every
/// picture, from taking the palette for itself, and leaves something for the colour bar and the marks of ruptures.
fn learn(common: &[&Bin]) -> Vec<[u8; 3]> {
    let mut samples = Vec::new();
    for bin in common {
        let [r, g, b] = bin.mean();
        let times = (bin.count as f64).cbrt().ceil() as usize;
        samples.extend([r, g, b, u8::MAX].repeat(times));
    }
    // Too few samples make it learn nothing at all.
    while samples.len() < 4 * 20_000 {
        samples.extend_from_within(..);
    }
    let learnt = NeuQuant::new(LEARN_EVERY, usize::from(TRANSPARENT), &samples);
    learnt.color_map_rgb().as_chunks().0.to_vec()
}

/// Number of the colour nearest to this one.
fn nearest(colours: &[[u8; 3]], to: [u8; 3]) -> usize {
    let distance = |c: &[u8; 3]| -> i32 { (0..3).map(|k| (i32::from(c[k]) - i32::from(to[k])).pow(2)).sum() };
    (0..colours.len()).min_by_key(|i| distance(&colours[*i])).unwrap_or(0)
}

/// At most 255 colours, and which one stands for which bin.
pub(super) struct Palette {
    colours: Vec<[u8; 3]>,
    index: Vec<u8>,
}

impl Palette {
    /// 256 colours as bytes, the last for [`TRANSPARENT`].
    pub fn rgb(&self) -> &[u8] {
        self.colours.as_flattened()
    }

    /// The picture as indices. Every picture must have been counted.
    pub fn indices(&self, picture: &RgbImage) -> Vec<u8> {
        picture.pixels().map(|pixel| self.index[bin_of(pixel.0)]).collect()
    }
}
