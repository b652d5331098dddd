//! Explanations of the keyword, parameter, field or name at a place.

use super::cards::{Card, fields_of, is_first_row, spot};
use super::document::Spot;
use super::symbols::Occurrence;
use super::workspace::{Place, Workspace};
use lsp_types::Range;

/// Explanation of a place, and the range of characters to which the explanation belongs.
pub(super) fn hover(workspace: &Workspace, place: &Place) -> Option<(String, Range)> {
    let document = workspace.document(&place.view, place.file)?;
    let of_name = place
        .occurrence()
        .map(|one| (about(workspace, place, one), one.spot));
    let card = place.view.cards.at(place.file, place.line);
    let of_card = card.and_then(|card| match card.head.last < place.line {
        true => of_row(workspace, place, card),
        false => of_head(place, card),
    });
    let (text, spot) = match (of_name, of_card) {
        (Some((name, spot)), Some((text, _))) => (format!("{name}\n\n{text}"), spot),
        (Some(found), None) | (None, Some(found)) => found,
        (None, None) => return None,
    };
    Some((text.trim_end().to_owned(), document.range(spot)))
}

/// Kind of the object that a name means, the lines that define the object, and the number of its uses.
fn about(workspace: &Workspace, place: &Place, one: &Occurrence) -> String {
    let symbols = &place.view.symbols;
    let what = one.symbol.what.name();
    if !one.is_known {
        return format!("{what} {}: not defined", one.typed);
    }
    let of = || symbols.of(&one.symbol);
    let uses = of().filter(|one| !one.defines).count();
    let lines = of().filter(|one| one.defines).filter_map(|one| {
        let document = workspace.document(&place.view, one.file)?;
        let path = &place.view.cards.files.get(one.file)?.path;
        let name = path.file_name()?.to_string_lossy().into_owned();
        let line = document.line(one.spot.line);
        Some(format!("{name}:{}: {}", one.spot.line + 1, line.trim()))
    });
    let lines: Vec<String> = lines.take(5).collect();
    let times = if uses == 1 { "place" } else { "places" };
    format!(
        "{what} {}, used in {uses} {times}\n{}",
        one.typed,
        lines.join("\n")
    )
}

fn of_head(place: &Place, card: &Card) -> Option<(String, Spot)> {
    let keyword = card.head.keyword?;
    let holds =
        |spot: &Spot| spot.line == place.line && (spot.start..=spot.end).contains(&place.column);
    if holds(&card.head.spot) {
        return Some((keyword.explanation(), card.head.spot));
    }
    let piece = card.head.pieces.iter().find(|piece| holds(&piece.spot))?;
    let text = piece.parameter?.explanation();
    Some((format!("*{}\n{text}", keyword.name), piece.spot))
}

fn of_row(workspace: &Workspace, place: &Place, card: &Card) -> Option<(String, Spot)> {
    let document = workspace.document(&place.view, place.file)?;
    let text = document.line(place.line);
    let is_first = is_first_row(document, card, place.line);
    let fields = fields_of(card, &text, is_first);
    let known = fields
        .iter()
        .map(|(field, known)| (spot(place.line, *field), known));
    let mut known = known.filter(|(spot, _)| (spot.start..=spot.end).contains(&place.column));
    let (spot, field) = known.next()?;
    let field = (*field)?;
    let dimension = field.holds.dimension().map(|d| format!(" ({d})"));
    let dimension = dimension.unwrap_or_default();
    Some((
        format!("*{}: {}{dimension}", card.head.name(), field.name),
        spot,
    ))
}
