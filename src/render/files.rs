//! From a developed picture to its files, and back from those that are there.

use super::scales::Scales;
use super::{Print, layers};
use crate::error::Error;
use crate::output::{self, Picture8, Picture16, ReadPng};
use crate::plan::{Picture, Plan};
use std::collections::BTreeMap;
use std::path::Path;

/// Writes all files of an exposure, the PNG last: where that is, all are.
pub(super) fn write(plan: &Plan, print: &Print, scales: Option<&Scales>) -> Result<(), Error> {
    let (width, height) = (print.negative.width, print.negative.height);
    let (rgb, text) = (&print.rgb, &print.text);
    for picture in plan.outputs.pictures.iter().copied() {
        let path = plan.picture(print.exposure.index, picture);
        match picture {
            Picture::Exr => {
                if let Some(wanted) = &plan.outputs.exr {
                    output::write_exr(&path, layers::measured(plan, wanted, print))?;
                }
            }
            Picture::Bmp => output::write_bmp(&path, &Picture8 { width, height, rgb, text })?,
            Picture::Doppler | Picture::EmissionTime => {
                if let Some(scales) = scales {
                    let scale =
                        if picture == Picture::Doppler { scales.doppler } else { scales.emission_time };
                    let values = layers::shown(plan, print, picture);
                    let rgb = &output::false_color(&values, width as usize, &scale);
                    let height = output::height_with_legend(width, height);
                    output::write_png(&path, &Picture8 { width, height, rgb, text })?;
                }
            }
            Picture::Png => match &print.fine {
                Some(rgb) => output::write_png16(&path, &Picture16 { width, height, rgb, text })?,
                None => output::write_png(&path, &Picture8 { width, height, rgb, text })?,
            },
        }
    }
    Ok(())
}

/// The texts in a picture that was written here.
pub(super) fn texts(path: &Path, picture: Picture) -> BTreeMap<String, String> {
    match picture {
        Picture::Exr => output::exr_texts(path),
        Picture::Bmp => BTreeMap::new(),
        Picture::Png | Picture::Doppler | Picture::EmissionTime => output::png_texts(path),
    }
}

/// The finished picture of an exposure that is there.
pub(super) fn read(plan: &Plan, index: usize) -> Result<Vec<u8>, Error> {
    read_png(plan, index).map(|png| png.rgb)
}

fn read_png(plan: &Plan, index: usize) -> Result<ReadPng, Error> {
    let size = (plan.sampling.width, plan.sampling.height);
    output::read_png(&plan.picture(index, Picture::Png), size)
}

/// Whether all files of an exposure can be read and are of the kind that is wanted. (Who made them is told by their texts.)
pub(super) fn are_whole(plan: &Plan, index: usize) -> bool {
    let Ok(png) = read_png(plan, index) else { return false };
    let size = (plan.sampling.width, plan.sampling.height);
    png.sixteen == plan.outputs.sixteen
        && plan.outputs.pictures.iter().copied().all(|picture| {
            let path = plan.picture(index, picture);
            match picture {
                Picture::Png => true,
                Picture::Doppler | Picture::EmissionTime => {
                    let size = (size.0, output::height_with_legend(size.0, size.1));
                    output::read_png(&path, size).is_ok_and(|png| !png.sixteen)
                }
                Picture::Bmp => output::read_bmp(&path, size).is_ok_and(|rgb| rgb == png.rgb),
                Picture::Exr => {
                    let form = plan.outputs.exr.as_ref().map(|wanted| layers::form(plan, wanted));
                    form.is_some_and(|form| output::check_exr(&path, &form).is_ok())
                }
            }
        })
}
