//! The subcommand `flatten`.

use super::check::{complain_of, openable};
use crate::cli::args::FlattenArgs;
use crate::cli::error::CliError;
use crate::cli::exit::Exit;
use crate::cli::file::write_file;
use crate::cli::terminal::{coloured, complain, print};
use crate::diagnostics::{Diagnostics, Sources};
use crate::flat_deck::{flat_deck, reads_as};
use crate::output::check_names;
use crate::prepare::prepare;
use crate::reader;

/// Writes a deck as one flat deck, after a test that this reads as the same model. What `check` rejects
/// is rejected.
pub(in crate::cli) fn flatten(args: &FlattenArgs) -> Result<Exit, CliError> {
    openable(&args.deck.path)?;
    let mut sources = Sources::new();
    let mut d = Diagnostics::with_strictness(args.deck.strictness());
    let model = reader::read_model(&args.deck.path, &mut sources, &mut d);
    // the flat deck has the nodes where the deck has them
    let sound = model.filter(|model| prepare(model.clone(), &mut d).is_some());
    let Some(model) = sound else {
        complain_of(&d.render(&sources, coloured()));
        return Ok(Exit::Rejected);
    };
    check_names(&model)?;
    let text = flat_deck(&model);
    if !reads_as(&text, &model) {
        complain(
            "error: this deck cannot be written as a flat deck that reads as the same model: in a step with \
             AMPLITUDE=RAMP a load on a face ramps while another there, in the same direction, follows an amplitude",
        );
        return Ok(Exit::Rejected);
    }
    match &args.output {
        Some(path) => write_file(path, &text, args.overwrite)?,
        None => print(&[text.trim_end().to_owned()])?,
    }
    Ok(Exit::Finished)
}
