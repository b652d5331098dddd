//! Places of elements, in few bytes each.

use crate::diagnostics::{FileId, Span};

/// Places of rows of the deck.
#[derive(Debug, Clone, Default)]
pub(crate) struct Places {
    places: Vec<Place>,
    /// Runs of places in the same file and instance: the first place of each.
    runs: Vec<(usize, FileId, u32)>,
}

/// A place in a file; no line has more characters than the columns count.
#[derive(Debug, Clone, Copy)]
struct Place {
    line: u32,
    /// Characters before it.
    before: u16,
    /// Characters behind its first one.
    more: u16,
}

impl Places {
    /// Adds a place at the end.
    pub fn push(&mut self, span: Span) {
        let last = self.runs.last();
        if last.is_none_or(|(_, file, instance)| (*file, *instance) != (span.file, span.instance)) {
            self.runs
                .push((self.places.len(), span.file, span.instance));
        }
        let short = |count: u32| u16::try_from(count.saturating_sub(1)).unwrap_or(u16::MAX);
        self.places.push(Place {
            line: span.line,
            before: short(span.column),
            more: short(span.length),
        });
    }

    /// Makes room for so many places more.
    pub fn reserve(&mut self, count: usize) {
        self.places.reserve(count);
    }

    /// The place with this index; that of nothing behind the last one.
    pub fn get(&self, index: usize) -> Span {
        let run = self.runs.partition_point(|&(first, ..)| first <= index);
        let run = run.checked_sub(1).and_then(|run| self.runs.get(run));
        let (Some(&(_, file, instance)), Some(place)) = (run, self.places.get(index)) else {
            return Span::default();
        };
        Span {
            file,
            line: place.line,
            column: u32::from(place.before) + 1,
            length: u32::from(place.more) + 1,
            instance,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_kept() {
        let span = |file, line, column, length, instance| Span {
            file: FileId(file),
            line,
            column,
            length,
            instance,
        };
        let spans = [
            span(0, 1, 1, 65536, 0),
            span(0, 3, 65536, 1, 0),
            span(1, u32::MAX, 2, 3, 0),
            span(1, 4, 2, 3, 1),
            span(1, 4, 2, 3, 2),
            span(0, 9, 1, 1, 0),
        ];
        let mut places = Places::default();
        spans.iter().for_each(|&span| places.push(span));
        for (index, &span) in spans.iter().enumerate() {
            assert_eq!(places.get(index), span);
        }
        assert_eq!(
            (places.get(spans.len()), places.runs.len()),
            (Span::default(), 5)
        );
    }
}
