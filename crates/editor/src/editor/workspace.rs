//! The decks of the editor: which file belongs to which deck, and the cards and names of each deck.

use super::cards::Cards;
use super::document::{Document, Spot};
use super::files::{Files, neighbours};
use super::symbols::{Occurrence, Symbols};
use lsp_types::{Location, Position, Url};
use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Deepest chain of files that include each other.
const DEEPEST: usize = 20;

/// Cards and names of a deck.
#[derive(Debug)]
pub(super) struct View {
    /// Cards of the deck.
    pub cards: Cards,
    /// Names of the deck.
    pub symbols: Symbols,
}

/// All files and decks of the editor.
#[derive(Debug, Default)]
pub(super) struct Workspace {
    /// The files.
    pub files: Files,
    views: HashMap<PathBuf, Arc<View>>,
    /// Decks of the disk that include an open file.
    parents: BTreeSet<PathBuf>,
}

/// A place: a character of a file of a deck.
#[derive(Debug)]
pub(super) struct Place {
    /// The deck.
    pub view: Arc<View>,
    /// Number of the file in the deck.
    pub file: usize,
    /// Line, from 0.
    pub line: usize,
    /// Character of the line, from 0.
    pub column: usize,
}

impl Place {
    /// The name at the place.
    pub fn occurrence(&self) -> Option<&Occurrence> {
        self.view.symbols.at(self.file, self.line, self.column)
    }
}

impl Workspace {
    /// Stores a file that the editor has opened, and searches for a deck that includes the file.
    pub fn open(&mut self, uri: &Url, text: &str) -> PathBuf {
        let path = self.files.open(uri, text);
        if self.root_of(&path) == path {
            for deck in neighbours(&path) {
                if self.view(&deck).cards.file(&path).is_some() {
                    self.parents.insert(deck);
                    break;
                }
            }
        }
        path
    }

    /// Forgets a file that the editor has closed; afterwards the text on the disk is used.
    pub fn close(&mut self, path: &Path) {
        self.files.close(path);
        self.views.remove(path);
    }

    /// Cards and names of the deck with the given main file.
    pub fn view(&mut self, root: &Path) -> Arc<View> {
        let known = self.views.get(root);
        if let Some(view) = known.filter(|view| view.cards.are_of(&self.files)) {
            return Arc::clone(view);
        }
        let cards = Cards::new(root, &mut self.files);
        let symbols = Symbols::new(&cards, &self.files);
        let view = Arc::new(View { cards, symbols });
        self.views.insert(root.to_owned(), Arc::clone(&view));
        view
    }

    /// The main file of the deck to which a file belongs; the file itself if no deck includes the file.
    pub fn root_of(&mut self, path: &Path) -> PathBuf {
        let mut root = path.to_owned();
        for _ in 0..DEEPEST {
            let known = self.files.open_paths().into_iter();
            let mut known = known.chain(self.parents.iter().cloned().collect::<Vec<_>>());
            let includes =
                |deck: &PathBuf| *deck != root && self.view(deck).cards.file(&root).is_some();
            match known.find(includes) {
                Some(deck) => root = deck,
                None => break,
            }
        }
        root
    }

    /// The place at a position of a file.
    pub fn place(&mut self, path: &Path, position: Position) -> Option<Place> {
        let root = self.root_of(path);
        let view = self.view(&root);
        let file = view.cards.file(path)?;
        let document = &self.files.get(path)?.document;
        Some(Place {
            file,
            line: position.line as usize,
            column: document.column(position),
            view,
        })
    }

    /// The document of a file of a deck.
    pub fn document(&self, view: &View, file: usize) -> Option<&Document> {
        let path = &view.cards.files.get(file)?.path;
        Some(&self.files.get(path)?.document)
    }

    /// A range of characters of a file of a deck, in the form of the protocol.
    pub fn location(&self, view: &View, file: usize, spot: Spot) -> Option<Location> {
        let path = &view.cards.files.get(file)?.path;
        let uri = self.files.uri(path)?;
        let range = self.files.get(path)?.document.range(spot);
        Some(Location { uri, range })
    }
}
