//! The subcommand `flatten`.

use std::fs::File;
use std::io::Write;
use std::path::Path;

use super::check::{complain_of, openable};
use crate::cli::args::FlattenArgs;
use crate::cli::error::CliError;
use crate::cli::exit::Exit;
use crate::cli::terminal::{coloured, complain, print};
use crate::diagnostics::{Diagnostics, Sources};
use crate::flat_deck::{flat_deck, reads_as};
use crate::reader;

/// Writes a deck as one flat deck, after a test that this reads as the same model.
pub(in crate::cli) fn flatten(args: &FlattenArgs) -> Result<Exit, CliError> {
    openable(&args.deck.path)?;
    let mut sources = Sources::new();
    let mut d = Diagnostics::with_strictness(args.deck.strictness());
    let model = reader::read_model(&args.deck.path, &mut sources, &mut d);
    let Some(model) = model else {
        complain_of(&d.render(&sources, coloured()));
        return Ok(Exit::Rejected);
    };
    let text = flat_deck(&model);
    if !reads_as(&text, &model) {
        complain(
            "error: this deck cannot be written as a flat deck that reads as the same model: in a step with \
             AMPLITUDE=RAMP a load on a face ramps while another there, in the same direction, follows an amplitude",
        );
        return Ok(Exit::Rejected);
    }
    match &args.output {
        Some(path) => write_new(path, &text)?,
        None => print(&[text.trim_end().to_owned()])?,
    }
    Ok(Exit::Finished)
}

/// Writes a file that does not exist yet.
fn write_new(path: &Path, text: &str) -> Result<(), CliError> {
    let written = File::create_new(path).and_then(|mut file| file.write_all(text.as_bytes()));
    written.map_err(|source| CliError::File {
        path: path.to_owned(),
        source,
    })
}
