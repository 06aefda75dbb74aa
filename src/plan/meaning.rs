//! What a manifest says without meaning it: a film in which nothing is to be seen, or a lamp whose light no eye sees.
//!
//! Small pictures are looked at until something is seen, mostly in the first of them: only for a film that stays dark are many
//! looked at.

use super::Plan;
use crate::error::Report;
use crate::lamp::Lamp;
use crate::manifest::{Light, Manifest, View as Aim};
use crate::observer::View;
use crate::scene::Scene;
use crate::spacetime::{FourVector, Rest, SightRay};
use crate::spectrum::{Line, Wavelengths};
use crate::trace::{Lit, SeenLine};
use glam::DVec2;
use rayon::prelude::*;

/// Columns of the small pictures, and the most that are looked at.
const COLUMNS: u32 = 48;
const MOST: usize = 200;

/// The most bodies that are looked for one by one: those that may be too small for small pictures.
const SOUGHT: usize = 64;

/// Where an eye sees, nm.
const SEEN_NM: (f64, f64) = (380.0, 780.0);

/// Where an eye sees best, nm.
const BEST_NM: f64 = 550.0;

/// Warns of what will not be seen.
pub fn check(manifest: &Manifest, scene: &Scene, plan: &Plan, report: &mut Report) {
    let dark = report.warnings.iter().any(|warning| warning.what.starts_with("nothing shines"));
    let unseen = check_lamps(manifest, scene, plan, report);
    if manifest.bodies.is_empty() {
        return;
    }
    let mut all = Seen::default();
    let mut looked = 0;
    for view in small(scene, plan) {
        all = all.and(look(scene, &view, plan));
        looked += 1;
        if all.body && all.light {
            return;
        }
    }
    let of = plan.exposures.len();
    let any = match (looked, of) {
        (_, 1) => "in the picture".to_owned(),
        (looked, of) if looked == of || plan.still => format!("in any of {of} pictures"),
        (looked, of) => format!("in any of {looked} pictures, of {of}, that were looked at"),
    };
    let name = manifest.bodies[0].known_as();
    let place = manifest.observer.place.clone();
    if !all.body {
        let hint = match manifest.observer.view {
            Aim::LookAt(_) => "a wider `field_of_view`, another place, or another time".to_owned(),
            Aim::Direction(_) => format!("look_at: {name}"),
        };
        report.warn(place, format!("the observer sees no body {any}"), hint);
    } else if let (Some(body), false) = (all.within.filter(|_| !all.light), dark) {
        let name = manifest.bodies.get(body as usize).map_or("a body", |body| body.known_as());
        let what = format!("the observer is inside `{name}`, and sees no light {any}");
        report.warn(place, what, "another place: `at: 0 0 5 m`");
    } else if !all.light && !dark && !unseen {
        let what = format!("bodies are seen, but no light comes from them that an eye could see {any}");
        report.warn(place, what, "light from all sides shows them: ambient: { luminance: 20 cd/m2 }");
    }
}

/// What has been seen.
#[derive(Debug, Clone, Copy, Default)]
struct Seen {
    body: bool,
    light: bool,
    // The body of which nothing but the inside is seen.
    within: Option<u32>,
    // Whether anything has been looked at.
    looked: bool,
}

impl Seen {
    fn and(self, other: Self) -> Self {
        if !(self.looked && other.looked) {
            return if self.looked { self } else { other };
        }
        Self {
            body: self.body || other.body,
            light: self.light || other.light,
            within: self.within.filter(|body| other.within == Some(*body)),
            looked: true,
        }
    }
}

/// Small views of the film, in an order in which all of it is soon looked at.
fn small<'s>(scene: &'s Scene, plan: &'s Plan) -> impl Iterator<Item = View> + 's {
    let size = plan.sampling.within(COLUMNS);
    let count = if plan.still { 1 } else { plan.exposures.len() };
    let mut order: Vec<usize> = (0..count).step_by(count.div_ceil(MOST)).collect();
    order.sort_by_key(|index| (index + 1).reverse_bits());
    order
        .into_iter()
        .flat_map(move |index| scene.observer.views(plan.exposures[index].tau, size.width, size.height))
}

/// The sight rays of a small picture, and those to bodies that may lie between them.
fn rays(scene: &Scene, view: &View, plan: &Plan) -> Vec<SightRay> {
    let size = plan.sampling.within(COLUMNS);
    let columns = 0..size.width;
    let pixels = columns.flat_map(|column| (0..size.height).map(move |row| (column, row)));
    let centre = |(column, row): (u32, u32)| DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
    let edge = DVec2::new(f64::from(size.width), f64::from(size.height));
    let placed =
        scene.world.frames.iter().flat_map(|rest| rest.placed.iter().map(move |placed| (rest, placed)));
    let towards = placed.take(SOUGHT).filter_map(|(rest, placed)| {
        let bounds = placed.bounds()?;
        let way = 0.5 * (bounds.lo + bounds.hi) - (rest.rest_from_lab * view.tetrad.event).x;
        let light = FourVector::<Rest>::new(way.length(), -way);
        let pixel = view.pixel_of(rest.rest_from_lab.boost().inverse().light(light))?;
        (pixel.cmpge(DVec2::ZERO).all() && pixel.cmple(edge).all()).then_some(pixel)
    });
    let shown = pixels.map(centre).chain(towards).filter(|pixel| view.shows(*pixel));
    shown.map(|pixel| view.ray(pixel)).collect()
}

/// What is seen in a small picture.
fn look(scene: &Scene, view: &View, plan: &Plan) -> Seen {
    let lit = scene.lit().seen_from(view.tetrad.event);
    let wavelengths = Wavelengths::<8>::new();
    let seen = |ray: &SightRay| {
        let hit = lit.world.nearest(ray);
        let light = lit.seen(ray, &wavelengths);
        Seen {
            body: hit.is_some(),
            light: (wavelengths.xyz(&light.radiance) + light.lines).y > 0.0,
            within: hit.filter(|hit| !hit.spot(ray).outside).map(|hit| hit.placed.body),
            looked: true,
        }
    };
    rays(scene, view, plan).par_iter().map(seen).reduce(Seen::default, Seen::and)
}

/// What has arrived of a lamp's lines.
#[derive(Debug, Clone, Copy)]
struct Arrived {
    from_nm: f64,
    to_nm: f64,
    seen: bool,
}

/// Warns of lamps of nothing but lines of which all that arrives is out of sight; whether there are any.
fn check_lamps(manifest: &Manifest, scene: &Scene, plan: &Plan, report: &mut Report) -> bool {
    // Those of files come first.
    let first = scene.lamps.len().saturating_sub(manifest.lights.len());
    let lamps: Vec<_> = (manifest.lights.iter().zip(&scene.lamps[first..]))
        .filter(|(_, lamp)| lamp.light.iter().all(|(_, source)| source.is_of_lines()))
        .collect();
    if lamps.is_empty() {
        return false;
    }
    let mut arrived: Vec<Option<Arrived>> = vec![None; lamps.len()];
    for view in small(scene, plan) {
        let lit = scene.lit().seen_from(view.tetrad.event);
        let rays = rays(scene, &view, plan);
        let lines: Vec<Vec<(usize, f64)>> = rays.par_iter().map(|ray| arriving(&lit, ray, &lamps)).collect();
        for (lamp, nm) in lines.into_iter().flatten() {
            let seen = (SEEN_NM.0..=SEEN_NM.1).contains(&nm);
            let own = arrived[lamp].get_or_insert(Arrived { from_nm: nm, to_nm: nm, seen });
            *own = Arrived { from_nm: own.from_nm.min(nm), to_nm: own.to_nm.max(nm), seen: own.seen || seen };
        }
        if arrived.iter().all(|own| own.is_some_and(|own| own.seen)) {
            return false;
        }
    }
    let mut unseen = false;
    for ((light, lamp), arrived) in lamps.iter().zip(arrived) {
        let Some(Arrived { from_nm, to_nm, seen: false }) = arrived else { continue };
        let strongest = lamp.light.iter().flat_map(|(_, source)| source.lines());
        let Some(line) = strongest.max_by(|a, b| a.power.total_cmp(&b.power)) else { continue };
        unseen = true;
        let where_seen = if to_nm - from_nm < 1.0 {
            format!("at {from_nm:.0} nm")
        } else {
            format!("at {from_nm:.0} to {to_nm:.0} nm")
        };
        let what = format!(
            "this lamp's light of {:.0} nm is seen {where_seen}, where no eye sees anything",
            line.wavelength_nm
        );
        let instead = line.wavelength_nm * BEST_NM / (from_nm * to_nm).sqrt();
        let hint = format!("line: {instead:.0} nm would be seen, or effects: {{ doppler: off }}");
        report.warn(light.place.clone(), what, hint);
    }
    unseen
}

/// The lines of lamps that arrive along a ray: which lamp's, and at what wavelength.
fn arriving(lit: &Lit<'_>, ray: &SightRay, lamps: &[(&Light, &Lamp)]) -> Vec<(usize, f64)> {
    let is_of = |lamp: &Lamp, line: *const Line| {
        lamp.light.iter().flat_map(|(_, source)| source.lines()).any(|own| std::ptr::eq(own, line))
    };
    let lines = lit.lines_along(ray).into_iter().filter(|line| line.power > 0.0);
    let known = |line: SeenLine| {
        let lamp = lamps.iter().position(|(_, lamp)| is_of(lamp, line.of))?;
        Some((lamp, line.wavelength_nm))
    };
    lines.filter_map(known).collect()
}
