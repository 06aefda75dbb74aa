//! Each rival agrees with ours where it must: at low speeds, without shifts, with all bodies at rest with one another, or
//! cut finely enough.

use crate::error::Judge;
use crate::frontier::{colored, from_beta, lit, ours, proper32, proper64};
use crate::moved::{Cloths, Cut, Moved};
use crate::panorama::Panorama;
use crate::rays;
use crate::rgb::{self, ByHue, Gaussians};
use crate::shade::Eye;
use crate::single::Single;
use crate::stage::{Stage, Traffic, exposed};
use glam::DVec3;

type Picture = Vec<DVec3>;

/// The mean colour difference of a picture from ours, which has 16 wavelengths and as many samples.
fn off(stage: &Stage, samples: u32, picture: &Picture) -> f64 {
    Judge::new(ours(&stage.scene, stage, 16, samples)).errors(picture).mean
}

fn moved(stage: &Stage, eye: &Eye<'_>, cut: Cut) -> Picture {
    let cloths = Cloths::new(stage, cut);
    let moved = Moved::new(stage, &cloths);
    exposed(&stage.view, 1, |ray, cone| eye.xyz(ray, cone, moved.meet(ray).as_ref()))
}

#[test]
fn rivals_run_in_our_own_light_and_film() {
    for beta in [0.1, 0.9, 0.9999] {
        let stage = Stage::new(beta, Traffic::Crossing).unwrap();
        let eye = Eye::new(&stage);
        let judge = Judge::new(ours(&stage.scene, &stage, 16, 4));
        let errors = judge.errors(&lit(&eye, 4, |ray| rays::by_s(&stage, ray)));
        // The film is in f32.
        assert!(errors.rmse < 1e-6, "β = {beta}: {errors:?}");
    }
}

#[test]
fn near_the_origin_the_ways_of_tracing_agree() {
    for beta in [0.001, 0.9, 0.99] {
        let stage = Stage::new(beta, Traffic::Crossing).unwrap();
        let eye = Eye::new(&stage);
        let single = Single::new(&stage);
        let by_time = off(&stage, 1, &lit(&eye, 1, |ray| rays::by_time(&stage, ray)));
        let f32s = off(&stage, 1, &lit(&eye, 1, |ray| single.meet(ray)));
        let g64 = off(&stage, 1, &ours(&from_beta(&stage.scene, proper64), &stage, 16, 1));
        let g32 = off(&stage, 1, &ours(&from_beta(&stage.scene, proper32), &stage, 16, 1));
        for (name, off) in [("by time", by_time), ("f32", f32s), ("γ64", g64), ("γ32", g32)] {
            assert!(off < 0.01, "β = {beta}, {name}: {off}");
        }
    }
}

#[test]
fn moved_vertices_agree_at_low_speed_and_wherever_they_are_cut_finely() {
    let stage = Stage::new(1e-4, Traffic::Crossing).unwrap();
    let eye = Eye::new(&stage);
    for cut in [Cut::Levels(0), Cut::Levels(1)] {
        assert!(off(&stage, 1, &moved(&stage, &eye, cut)) < 0.05);
    }
    for beta in [0.5, 0.99] {
        let stage = Stage::new(beta, Traffic::Crossing).unwrap();
        let eye = Eye::new(&stage);
        let [coarse, fine] = [0.5, 0.02].map(|bent| off(&stage, 1, &moved(&stage, &eye, Cut::Bent(bent))));
        assert!(fine < 0.05 && fine < 0.5 * coarse, "β = {beta}: {coarse}, {fine}");
    }
}

#[test]
fn a_panorama_comes_nearer_the_more_texels_it_has_while_all_have_one_velocity() {
    for beta in [0.001, 0.9] {
        let stage = Stage::new(beta, Traffic::Convoy).unwrap();
        let eye = Eye::new(&stage);
        let judge = Judge::new(ours(&stage.scene, &stage, 16, 64));
        let panorama = |width: usize| {
            let panorama = Panorama::new(&eye, width, 16);
            judge.errors(&exposed(&stage.view, 16, |ray, cone| panorama.xyz(ray, cone))).mean
        };
        let (coarse, fine) = (panorama(1024), panorama(4096));
        assert!(fine < 0.8 && fine < 0.4 * coarse, "β = {beta}: {coarse}, {fine}");
    }
}

#[test]
fn shifted_rgb_is_right_where_there_is_no_shift() {
    let stage = Stage::new(1e-5, Traffic::Crossing).unwrap();
    let eye = Eye::new(&stage);
    let judge = Judge::new(ours(&stage.scene, &stage, 64, 1));
    let hue = ByHue::new(&eye, 5);
    let by_hue = judge.errors(&colored(&eye, 1, |rgb, omega| hue.xyz(rgb, omega))).mean;
    assert!(by_hue < 0.3, "{by_hue}");
    for (bells, unseen) in [(rgb::NARROW, &[][..]), (rgb::WIDE, &rgb::UNSEEN[..])] {
        let gaussians = Gaussians::new(&eye, bells, unseen);
        let by_bells = judge.errors(&colored(&eye, 1, |rgb, omega| gaussians.xyz(rgb, omega))).mean;
        assert!(by_bells < 0.3, "{by_bells}");
    }
}
