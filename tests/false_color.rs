//! Numbers as colours, and back by the legend.

use terrell::output::{Scale, false_color, height_with_legend};

const WIDTH: usize = 640;

/// The colours of the bar of a legend, from its lowest end.
fn bar(picture: &[u8], rows: usize) -> Vec<[u8; 3]> {
    let row = rows + 18;
    let pixel = |column: usize| std::array::from_fn(|i| picture[3 * (row * WIDTH + column) + i]);
    (10..WIDTH - 10).map(pixel).collect()
}

#[test]
fn values_can_be_read_by_the_legend() {
    let values: Vec<f64> = (0..2 * WIDTH).map(|i| libm::exp((i as f64 / 640.0 - 1.0) * 1.5)).collect();
    let ratios = Scale::of_ratios(values.iter().copied());
    assert_eq!(ratios, Scale::Ratio { most: 5.0 });
    let times = Scale::of_seconds(values.iter().copied());
    let Scale::Seconds { from, to, .. } = times else { panic!("{times:?}") };
    assert!(from <= 0.23 && to >= 4.3, "{times:?}");
    let read: [(Scale, &dyn Fn(f64) -> f64); 2] = [
        (ratios, &|part| libm::exp((2.0 * part - 1.0) * libm::log(5.0))),
        (times, &|part| from + part * (to - from)),
    ];
    for (scale, value_of) in read {
        let all: Vec<Option<f64>> = values.iter().copied().map(Some).collect();
        let picture = false_color(&all, WIDTH, &scale);
        assert_eq!(picture.len(), 3 * WIDTH * height_with_legend(WIDTH as u32, 2) as usize);
        let bar = bar(&picture, 2);
        for (number, value) in values.iter().enumerate() {
            let pixel: [u8; 3] = std::array::from_fn(|i| picture[3 * number + i]);
            let off = |color: &[u8; 3]| (0..3).map(|i| pixel[i].abs_diff(color[i])).max();
            let nearest = bar.iter().enumerate().min_by_key(|(_, color)| off(color)).unwrap();
            let read = (nearest.0 as f64 + 0.5) / bar.len() as f64;
            let held = scale.part(*value);
            assert!((read - held).abs() < 0.01, "{value}: read {}", value_of(read));
            assert!((value_of(held) - value.clamp(value_of(0.0), value_of(1.0))).abs() < 1e-9 * value);
        }
    }
}

#[test]
fn light_that_is_not_shifted_is_grey_and_shifts_are_told_apart() {
    let scale = Scale::Ratio { most: 3.0 };
    let [r, g, b] = scale.color(scale.part(1.0));
    assert!(r == g && g == b);
    let [r, _, b] = scale.color(scale.part(0.7));
    assert!(r > b);
    let [r, _, b] = scale.color(scale.part(1.4));
    assert!(b > r);
    assert_eq!(scale.color(scale.part(1e9)), scale.color(1.0));
    assert_eq!(scale.color(scale.part(f64::NAN)), scale.color(0.0));
}

#[test]
fn later_is_lighter() {
    let scale = Scale::of_seconds([0.0, 1.0]);
    let light = |part: usize| {
        let [r, g, b] = scale.color(part as f64 / 200.0).map(f64::from);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    };
    assert!((1..=200).all(|part| light(part) >= light(part - 1)));
    assert!(light(200) > light(0) + 150.0);
}

#[test]
fn scales_hold_nearly_all_and_begin_and_end_at_round_numbers() {
    for (first, last) in [(0.0, 1.0), (-3.7, 9.2), (1e9, 1e9 + 5.0), (-2e-9, 4e-9), (5.0, 5.0), (0.0, 0.0)] {
        let scale = Scale::of_seconds((0..=100).map(|i| first + (last - first) * f64::from(i) / 100.0));
        let Scale::Seconds { from, to, step } = scale else { panic!("{scale:?}") };
        assert!(from < to && step > 0.0 && (to - from) / step < 8.5, "{scale:?}");
        let slack = 0.03 * (last - first) + 1e-9 * last.abs();
        assert!(from <= first + slack && to >= last - slack, "{scale:?}");
        let digits = libm::log10(step) - libm::log10(step).floor();
        assert!([1.0, 2.0, 5.0, 10.0].iter().any(|d| (digits - libm::log10(*d)).abs() < 1e-9), "{step}");
    }
    assert_eq!(Scale::of_ratios([]), Scale::Ratio { most: 1.02 });
    assert_eq!(Scale::of_ratios([0.4, 1.0, f64::INFINITY]), Scale::Ratio { most: 3.0 });
    assert_eq!(Scale::of_ratios([1e5]), Scale::Ratio { most: 1e5 });
}

#[test]
fn the_smallest_pictures_have_legends_too() {
    for width in [1, 2, 7, 20] {
        let picture = false_color(&vec![None; width], width, &Scale::of_ratios([2.0]));
        assert_eq!(picture.len(), 3 * width * height_with_legend(width as u32, 1) as usize);
    }
}
