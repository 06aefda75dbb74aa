//! From RGB to luma and chroma, as films have them.

use openh264::formats::YUVSource;

/// A picture as an encoder wants it: full luma, halved chroma, 8 bits, BT.709 limited range.
#[derive(Debug, Clone)]
pub(super) struct Planes {
    width: usize,
    height: usize,
    luma: Vec<u8>,
    blue: Vec<u8>,
    red: Vec<u8>,
}

// ITU-R BT.709-6, items 3.2 to 3.4, for 8 bits limited range, times 2^16: Y' = 16 + 219 (0.2126 R' + 0.7152 G' +
// 0.0722 B'), Cb = 128 + 224 (B' - Y')/1.8556, Cr = 128 + 224 (R' - Y')/1.5748 with R' from 0 to 1. The sums
// are kept exact: white is 235, and grey has no colour.
const LUMA: [i32; 3] = [11966, 40254, 4064];
const BLUE: [i32; 3] = [-6596, -22188, 28784];
const RED: [i32; 3] = [28784, -26145, -2639];

impl Planes {
    /// Black planes for pictures of this size; odd sizes are made even.
    pub(super) fn new(width: usize, height: usize) -> Self {
        let (width, height) = (width.next_multiple_of(2), height.next_multiple_of(2));
        Self {
            width,
            height,
            luma: vec![16; width * height],
            blue: vec![128; width * height / 4],
            red: vec![128; width * height / 4],
        }
    }

    /// Takes in a picture of `3 * width * height` bytes, repeating its right and lower edge where the planes are
    /// larger.
    ///
    /// Chroma is sited as H.264 has it where nothing is said (figure E-1, type 0) and as decoders therefore assume: on
    /// the left luma sample, between two rows. So it is averaged with weights 1 2 1 across and 1 1 down.
    pub(super) fn take(&mut self, rgb: &[u8], width: usize, height: usize) {
        let mut sums = vec![[0_i32; 3]; self.width];
        for pair in 0..self.height / 2 {
            sums.fill([0; 3]);
            for row in [2 * pair, 2 * pair + 1] {
                let from = row.min(height - 1) * width * 3;
                let (pixels, _) = rgb[from..from + width * 3].as_chunks::<3>();
                let line = &mut self.luma[row * self.width..][..self.width];
                take_row(pixels, line, &mut sums);
            }
            let line = pair * self.width / 2..(pair + 1) * self.width / 2;
            average(&sums, &mut self.blue[line.clone()], &mut self.red[line]);
        }
    }
}

fn take_row(pixels: &[[u8; 3]], luma: &mut [u8], sums: &mut [[i32; 3]]) {
    for ((pixel, luma), sum) in pixels.iter().zip(&mut *luma).zip(&mut *sums) {
        let pixel = pixel.map(i32::from);
        *luma = (16 + ((dot(LUMA, pixel) + (1 << 15)) >> 16)) as u8;
        *sum = [sum[0] + pixel[0], sum[1] + pixel[1], sum[2] + pixel[2]];
    }
    if pixels.len() < luma.len() {
        let last = pixels.len();
        luma[last] = luma[last - 1];
        sums[last] = sums[last - 1];
    }
}

/// `sums` are of two rows; with the weights across that is eight pixels to a chroma sample.
fn average(sums: &[[i32; 3]], blue: &mut [u8], red: &mut [u8]) {
    for (i, (blue, red)) in blue.iter_mut().zip(red).enumerate() {
        let (left, here, right) = (sums[(2 * i).saturating_sub(1)], sums[2 * i], sums[2 * i + 1]);
        let sum = [0, 1, 2].map(|c| left[c] + 2 * here[c] + right[c]);
        *blue = (128 + ((dot(BLUE, sum) + (1 << 18)) >> 19)) as u8;
        *red = (128 + ((dot(RED, sum) + (1 << 18)) >> 19)) as u8;
    }
}

fn dot(a: [i32; 3], b: [i32; 3]) -> i32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl YUVSource for Planes {
    fn dimensions(&self) -> (usize, usize) {
        (self.width, self.height)
    }

    fn strides(&self) -> (usize, usize, usize) {
        (self.width, self.width / 2, self.width / 2)
    }

    fn y(&self) -> &[u8] {
        &self.luma
    }

    fn u(&self) -> &[u8] {
        &self.blue
    }

    fn v(&self) -> &[u8] {
        &self.red
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The definition, in floating point.
    fn by_definition(rgb: [u8; 3]) -> [f64; 3] {
        let [r, g, b] = rgb.map(|v| f64::from(v) / 255.0);
        let y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
        [16.0 + 219.0 * y, 128.0 + 224.0 * (b - y) / 1.8556, 128.0 + 224.0 * (r - y) / 1.5748]
    }

    fn flat(rgb: [u8; 3]) -> [u8; 3] {
        let mut planes = Planes::new(2, 2);
        planes.take(&[rgb; 4].concat(), 2, 2);
        [planes.luma[0], planes.blue[0], planes.red[0]]
    }

    #[test]
    fn every_colour_is_within_six_tenths_of_its_definition() {
        for code in 0..16_u32.pow(3) {
            let rgb = [code % 16 * 17, code / 16 % 16 * 17, code / 256 * 17].map(|v| v as u8);
            for (integer, exact) in flat(rgb).into_iter().zip(by_definition(rgb)) {
                assert!((f64::from(integer) - exact).abs() < 0.6, "{rgb:?}: {integer} for {exact}");
            }
        }
    }

    #[test]
    fn greys_have_no_colour_and_white_and_black_are_at_the_ends() {
        for grey in 0..=255 {
            assert_eq!(flat([grey; 3])[1..], [128, 128]);
        }
        assert_eq!((flat([0; 3])[0], flat([255; 3])[0]), (16, 235));
    }

    #[test]
    fn an_odd_edge_is_repeated() {
        let (blue, green) = ([0, 0, 255], [0, 255, 0]);
        let rgb = [[blue, blue, green], [blue, blue, green], [green, green, green]].as_flattened().concat();
        let mut planes = Planes::new(3, 3);
        planes.take(&rgb, 3, 3);
        let [y, cb, cr] = flat(green);
        assert_eq!((planes.width, planes.height), (4, 4));
        assert_eq!(planes.luma[3], y);
        assert_eq!(planes.luma[12..], [y; 4]);
        assert_eq!((planes.blue[3], planes.red[3]), (cb, cr));
    }

    #[test]
    fn a_chroma_sample_lies_on_the_left_pixel_of_its_pair() {
        let mut row = [[0, 0, 0]; 6];
        row[2] = [255, 0, 0];
        let mut planes = Planes::new(6, 2);
        planes.take(&[row, row].as_flattened().concat(), 6, 2);
        let excess: Vec<i32> = planes.red.iter().map(|v| i32::from(*v) - 128).collect();
        assert_eq!(excess, [0, 56, 0], "half of the weight is on the pixel itself");
        row[2] = [0; 3];
        row[3] = [255, 0, 0];
        planes.take(&[row, row].as_flattened().concat(), 6, 2);
        let excess: Vec<i32> = planes.red.iter().map(|v| i32::from(*v) - 128).collect();
        assert_eq!(excess, [0, 28, 28], "a pixel in between is shared");
    }
}
