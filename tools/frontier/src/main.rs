//! The methods that others use, measured beside ours: speed against error, and where they fail; and what our plan saves.

#[cfg(test)]
mod agree;
mod case;
mod clock;
mod double;
mod edges;
mod error;
mod frontier;
mod moved;
mod needs;
mod panorama;
mod rays;
mod rgb;
mod shade;
mod shine;
mod single;
mod stage;
mod svg;
mod thin;
mod tolerance;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let only = std::env::args().nth(1);
    let wanted = |name: &str| only.as_deref().is_none_or(|only| only == name);
    if only.as_deref() == Some("tolerance") {
        let arguments: Vec<String> = std::env::args().skip(2).collect();
        return tolerance::run(&arguments);
    }
    if wanted("edges") {
        edges::run(folder)?;
    }
    if wanted("needs") {
        needs::run(folder)?;
    }
    if wanted("frontier") {
        frontier::run(folder)?;
    }
    Ok(())
}
