//! The cards of a deck in their order: blocks of the model, and steps. Reports cards out of place.

use super::context::Context;
use crate::deck::{Card, Data, Level, Levels, Scope, Status};
use crate::diagnostics::Code;

/// A model card with the cards that belong to this card, such as a material with its constants.
pub(crate) struct CardBlock<'a> {
    /// The card that begins the block.
    pub head: &'a Card,
    /// The cards that belong to the card that begins the block.
    pub parts: Vec<&'a Card>,
    /// Index of the step that the block stands in.
    pub step: Option<usize>,
}

impl<'a> CardBlock<'a> {
    /// The cards of the block with a given keyword.
    pub fn parts_of(&self, keyword: &str) -> Vec<&'a Card> {
        let parts = self.parts.iter().copied();
        parts.filter(|card| card.keyword.name == keyword).collect()
    }
}

/// A step with its cards.
pub(crate) struct StepCards<'a> {
    /// `*STEP`.
    pub head: &'a Card,
    /// The cards up to `*END STEP`.
    pub cards: Vec<&'a Card>,
}

/// The cards of a deck, sorted into blocks of the model and steps.
#[derive(Default)]
pub(crate) struct Outline<'a> {
    /// Blocks of cards of the model: cards outside steps, and cards in steps that define something of the model.
    pub model: Vec<CardBlock<'a>>,
    /// Steps in order.
    pub steps: Vec<StepCards<'a>>,
    /// Whether the deck has any steps.
    has_steps: bool,
    /// Whether a step is open.
    open: bool,
    /// Whether the last card belongs to the model, so that its block may continue.
    in_model: bool,
}

impl<'a> Outline<'a> {
    /// Sorts the cards of a deck; reports cards that are out of place.
    pub fn new(cx: &mut Context<'a>) -> Outline<'a> {
        let deck = cx.deck;
        let mut outline = Outline {
            has_steps: deck.cards.iter().any(|card| card.keyword.name == "STEP"),
            ..Outline::default()
        };
        for card in &deck.cards {
            if card.keyword.status == Status::Read {
                outline.check_data(card, cx);
                outline.place(card, cx);
            }
        }
        outline.finish(cx);
        outline
    }

    /// Cards with a given keyword that begin blocks of the model.
    pub fn model_cards(&self, keyword: &str) -> Vec<&'a Card> {
        self.blocks(keyword).map(|block| block.head).collect()
    }

    /// Blocks that begin with a given keyword.
    pub fn blocks(&self, keyword: &str) -> impl Iterator<Item = &CardBlock<'a>> {
        self.model
            .iter()
            .filter(move |block| block.head.keyword.name == keyword)
    }

    fn check_data(&self, card: &Card, cx: &mut Context) {
        let required = matches!(card.keyword.data, Data::Required(_));
        if required && card.rows.is_empty() && !card.faulty && !cx.deck.incomplete {
            let message = format!("{} needs data lines", card.title());
            cx.error(Code::MissingData, card.span, message);
        }
    }

    fn place(&mut self, card: &'a Card, cx: &mut Context) {
        match (card.keyword.name, card.keyword.scope) {
            ("STEP", _) => self.begin_step(card, cx),
            ("END STEP", _) => self.end_step(card, cx),
            (_, Scope::Block(head)) => self.place_in_block(card, head, cx),
            (_, Scope::BlockOrAfter(head, of_step)) => match self.is_after(of_step) {
                true => self.place_in_step(card, cx),
                false => self.place_in_block(card, head, cx),
            },
            (_, Scope::BlockOrModel(head)) => match self.open_block(head) {
                Some(block) => block.parts.push(card),
                None => self.place_in_model(card, cx),
            },
            (_, Scope::At(levels)) => self.place_at(card, levels, cx),
            (_, Scope::Structure) => self.place_in_model(card, cx),
        }
    }

    /// Finds the place of a card that belongs to no block, by the levels at which the card may stand.
    fn place_at(&mut self, card: &'a Card, levels: Levels, cx: &mut Context) {
        let is_in_step = self.open && levels.has(self.step_level());
        if is_in_step && levels.hold_from_the_start() {
            self.add_to_model(card);
        } else if is_in_step || !levels.are_of_model() {
            self.place_in_step(card, cx);
        } else {
            self.place_in_model(card, cx);
        }
    }

    /// Level of the step that is open.
    fn step_level(&self) -> Level {
        match self.steps.len() {
            1 => Level::FirstStep,
            _ => Level::LaterStep,
        }
    }

    fn place_in_model(&mut self, card: &'a Card, cx: &mut Context) {
        let may_begin = card.keyword.levels.has(Level::FirstStep);
        let fault = match (self.open, self.steps.is_empty()) {
            (true, _) if may_begin => Some("cannot stand in a step behind the first"),
            (true, _) => Some("cannot stand in a step"),
            (false, false) => Some("must stand before the first step"),
            (false, true) => None,
        };
        if let Some(fault) = fault {
            out_of_place(card, fault, "move it above the first *STEP", cx);
        }
        self.add_to_model(card);
    }

    fn add_to_model(&mut self, card: &'a Card) {
        self.in_model = true;
        self.model.push(CardBlock {
            head: card,
            parts: Vec::new(),
            step: self.open.then(|| self.steps.len() - 1),
        });
    }

    fn begin_step(&mut self, card: &'a Card, cx: &mut Context) {
        if self.open {
            let message = "a step begins before the last one ends";
            cx.error(Code::StepStructure, card.span, message)
                .help("close the step before with *END STEP");
        }
        self.open = true;
        self.in_model = false;
        self.steps.push(StepCards {
            head: card,
            cards: Vec::new(),
        });
    }

    fn end_step(&mut self, card: &Card, cx: &mut Context) {
        if !self.open && self.has_steps {
            cx.error(Code::StepStructure, card.span, "*END STEP without *STEP");
        }
        self.open = false;
        self.in_model = false;
    }

    /// The block in which the last card stands, if this block begins with the given keyword.
    fn open_block(&mut self, head: &str) -> Option<&mut CardBlock<'a>> {
        let last = self.model.last_mut().filter(|_| self.in_model);
        last.filter(|block| block.head.keyword.name == head)
    }

    /// Whether the last card belongs to a step and has a given keyword.
    fn is_after(&self, of_step: &str) -> bool {
        let step = self.steps.last().filter(|_| self.open && !self.in_model);
        let last = step.and_then(|step| step.cards.last());
        last.is_some_and(|card| card.keyword.name == of_step)
    }

    fn place_in_block(&mut self, card: &'a Card, head: &str, cx: &mut Context) {
        match self.open_block(head) {
            Some(block) => block.parts.push(card),
            None => {
                let help = format!("put it under the *{head} it belongs to");
                out_of_place(card, &format!("must follow *{head}"), &help, cx);
            }
        }
    }

    fn place_in_step(&mut self, card: &'a Card, cx: &mut Context) {
        match self.steps.last_mut().filter(|_| self.open) {
            Some(step) => {
                self.in_model = false;
                step.cards.push(card);
            }
            None if !self.has_steps => {}
            None => {
                let help = "move it between *STEP and *END STEP";
                out_of_place(card, "must stand in a step", help, cx);
            }
        }
    }

    fn finish(&self, cx: &mut Context) {
        match self.steps.last() {
            Some(step) if self.open => {
                let message = "this step is not closed by *END STEP";
                cx.warning(Code::MissingEndStep, step.head.span, message);
            }
            None if !cx.may_lack_cards() => {
                let message = "the deck has no *STEP: there is nothing to compute";
                let end = cx.deck.cards.last().map(|card| card.span);
                if let Some(end) = end {
                    cx.error(Code::NoStep, end, message)
                        .label("the last keyword of the deck");
                }
            }
            _ => {}
        }
    }
}

fn out_of_place(card: &Card, fault: &str, help: &str, cx: &mut Context) {
    let message = format!("{} {fault}", card.title());
    cx.error(Code::WrongPlace, card.span, message).help(help);
}
