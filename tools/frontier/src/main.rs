//! The methods that others use, measured beside ours: speed against error, and where they fail.

#[cfg(test)]
mod agree;
mod case;
mod clock;
mod double;
mod edges;
mod error;
mod frontier;
mod moved;
mod panorama;
mod rays;
mod rgb;
mod shade;
mod shine;
mod single;
mod stage;
mod svg;
mod thin;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let only = std::env::args().nth(1);
    if only.as_deref() != Some("frontier") {
        edges::run(folder)?;
    }
    if only.as_deref() != Some("edges") {
        frontier::run(folder)?;
    }
    Ok(())
}
