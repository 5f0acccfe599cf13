//! Films, decoded again.

use image::RgbImage;
use openh264::decoder::Decoder;
use openh264::formats::YUVSource;
use shiguredo_mp4::bitstream::h264::{LengthSize, length_prefixed_to_annexb};
use shiguredo_mp4::boxes::SampleEntry;
use shiguredo_mp4::demux::{Input, Mp4FileDemuxer};
use std::path::Path;

/// What a player shows, picture by picture, each with its time (ms).
pub fn decoded_film(file: &Path) -> Vec<(RgbImage, u128)> {
    let bytes = std::fs::read(file).unwrap();
    let mut film = Mp4FileDemuxer::new();
    while film.required_input().is_some() {
        film.handle_input(Input { position: 0, data: &bytes });
    }
    assert_eq!(film.tracks().unwrap().len(), 1);
    let mut decoder = Decoder::new().unwrap();
    let mut shown = Vec::new();
    while let Some(sample) = film.next_sample().unwrap() {
        let mut stream = Vec::new();
        if let Some(SampleEntry::Avc1(entry)) = sample.sample_entry {
            let sets = entry.avcc_box.sps_list.iter().chain(&entry.avcc_box.pps_list);
            sets.for_each(|set| stream.extend([&[0, 0, 0, 1], &set[..]].concat()));
        }
        let data = &bytes[sample.data_offset as usize..][..sample.data_size];
        stream.extend(length_prefixed_to_annexb(data, LengthSize::FourBytes).unwrap());
        let picture = decoder.decode(&stream).unwrap().expect("each sample is a picture");
        let (width, height) = picture.dimensions();
        let mut pixels = vec![0; picture.rgb8_len()];
        picture.write_rgb8(&mut pixels);
        shown.push((RgbImage::from_raw(width as u32, height as u32, pixels).unwrap(), u128::from(sample.duration)));
    }
    shown
}

/// Mean difference over channels and pixels.
pub fn mean_difference(seen: &RgbImage, picture: &RgbImage) -> f64 {
    let all = seen.as_raw().iter().zip(picture.as_raw()).map(|(a, b)| f64::from(a.abs_diff(*b)));
    all.sum::<f64>() / picture.as_raw().len() as f64
}
