//! The outline of a file: parts, instances, the assembly, steps, materials and interactions with the cards in them.

use super::cards::{Card, Cards};
use super::document::{Document, Spot};
use crate::deck::{Kind, Scope};
use lsp_types::{DocumentSymbol, Position, Range, SymbolKind};

/// Keywords that begin blocks which end with an `END` keyword.
const WITH_END: [&str; 4] = ["PART", "ASSEMBLY", "INSTANCE", "STEP"];

/// An entry of the outline whose end is not known yet.
struct Open {
    /// Name of the keyword; empty for the file itself.
    name: &'static str,
    entry: Option<DocumentSymbol>,
    children: Vec<DocumentSymbol>,
}

/// The outline of a file.
pub(super) fn outline(cards: &Cards, file: usize, document: &Document) -> Vec<DocumentSymbol> {
    let mut open = vec![Open {
        name: "",
        entry: None,
        children: Vec::new(),
    }];
    for card in cards.of_file(file) {
        let name = card.head.name();
        match name.strip_prefix("END ") {
            Some(begin) if open.iter().any(|one| one.name == begin) => {
                close_until(&mut open, |one| one.name == begin);
                close(
                    &mut open,
                    Some(document.position(card.head.last, usize::MAX)),
                );
                continue;
            }
            _ => close_until(&mut open, |one| holds(one.name, card)),
        }
        open.push(Open {
            name,
            entry: Some(entry(card, document)),
            children: Vec::new(),
        });
    }
    close_until(&mut open, |one| one.entry.is_none());
    open.into_iter().flat_map(|one| one.children).collect()
}

/// Whether a card may stand in the block of a keyword; the empty name means the file, which holds all cards.
fn holds(name: &str, card: &Card) -> bool {
    let own = card.head.name();
    match card.head.keyword.map(|keyword| keyword.scope) {
        _ if name.is_empty() => true,
        _ if own == "STEP" || own == "PART" => false,
        Some(Scope::Block(head) | Scope::BlockOrModel(head)) if head == name => true,
        Some(Scope::BlockOrAfter(head, other)) if [head, other].contains(&name) => true,
        _ => WITH_END.contains(&name) && !(own == "INSTANCE" && name == "INSTANCE"),
    }
}

fn close_until(open: &mut Vec<Open>, is_last: impl Fn(&Open) -> bool) {
    while open.len() > 1 && open.last().is_some_and(|last| !is_last(last)) {
        close(open, None);
    }
}

/// Closes the last entry, which ends at `end` or with its last child, whichever is later.
fn close(open: &mut Vec<Open>, end: Option<Position>) {
    let Some(last) = open.pop() else { return };
    let (Some(mut entry), Some(outer)) = (last.entry, open.last_mut()) else {
        return;
    };
    let of_children = last.children.last().map(|child| child.range.end);
    entry.range.end = [end, of_children]
        .into_iter()
        .flatten()
        .fold(entry.range.end, Position::max);
    entry.children = Some(last.children).filter(|children| !children.is_empty());
    outer.children.push(entry);
}

#[expect(deprecated, reason = "the field is there and has to be given")]
fn entry(card: &Card, document: &Document) -> DocumentSymbol {
    let head = &card.head;
    let last = card.end.max(head.last + 1) - 1;
    let start = Position::new(head.spot.line as u32, 0);
    let end = document.position(last, usize::MAX);
    let typed = document.line(head.spot.line);
    let keyword = typed.chars().take(head.spot.end).collect::<String>();
    let name = match head.defined().and_then(|piece| piece.value.as_ref()) {
        Some((name, _)) => format!("{} {name}", keyword.trim()),
        None => keyword.trim().to_owned(),
    };
    let pieces: Vec<&str> = typed.split(',').skip(1).map(str::trim).collect();
    DocumentSymbol {
        name: if name.is_empty() { "*".into() } else { name },
        detail: Some(pieces.join(", ")),
        kind: kind(card),
        tags: None,
        deprecated: None,
        range: Range { start, end },
        selection_range: document.range(Spot {
            start: 0,
            ..head.spot
        }),
        children: None,
    }
}

fn kind(card: &Card) -> SymbolKind {
    let defines = card.head.keyword.and_then(|keyword| keyword.definition());
    match defines.map(|(_, kind)| kind) {
        Some(Kind::Part) => SymbolKind::CLASS,
        Some(Kind::Instance) => SymbolKind::OBJECT,
        Some(Kind::Step) => SymbolKind::EVENT,
        Some(Kind::NodeSet | Kind::ElementSet) => SymbolKind::ARRAY,
        Some(Kind::Surface) => SymbolKind::INTERFACE,
        Some(Kind::Amplitude | Kind::TimePoints) => SymbolKind::FUNCTION,
        Some(_) => SymbolKind::STRUCT,
        None if card.head.name() == "ASSEMBLY" => SymbolKind::MODULE,
        None => SymbolKind::KEY,
    }
}
