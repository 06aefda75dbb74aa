//! From a developed picture to its files, and back from those that are there.

use super::{Print, layers};
use crate::error::Error;
use crate::output::{self, Picture8, Picture16, ReadPng};
use crate::plan::{Picture, Plan};
use std::collections::BTreeMap;
use std::path::Path;

/// Writes all files of an exposure, the PNG last: where that is, all are.
pub(super) fn write(plan: &Plan, print: &Print) -> Result<(), Error> {
    let (width, height) = (print.negative.width, print.negative.height);
    let (rgb, text) = (&print.rgb, &print.text);
    for picture in plan.outputs.pictures() {
        let path = plan.picture(print.exposure.index, picture);
        match picture {
            Picture::Exr => {
                if let Some(wanted) = &plan.outputs.exr {
                    output::write_exr(&path, layers::measured(plan, wanted, print))?;
                }
            }
            Picture::Bmp => output::write_bmp(&path, &Picture8 { width, height, rgb, text })?,
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
        Picture::Png => output::png_texts(path),
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
        && plan.outputs.pictures().into_iter().all(|picture| {
            let path = plan.picture(index, picture);
            match picture {
                Picture::Png => true,
                Picture::Bmp => output::read_bmp(&path, size).is_ok_and(|rgb| rgb == png.rgb),
                Picture::Exr => {
                    let form = plan.outputs.exr.as_ref().map(|wanted| layers::form(plan, wanted));
                    form.is_some_and(|form| output::check_exr(&path, &form).is_ok())
                }
            }
        })
}
