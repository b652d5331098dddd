//! `*MATERIAL` with its law and `*DENSITY`.

use super::constant::{Constant, constant, out_of_range, temperature};
use super::{damping, law};
use crate::deck::Row;
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::materials::{Law, Plane};
use crate::model::{Damping, Material, Section};
use crate::reader::context::Context;
use crate::reader::mesh::{Block, Outline};
use crate::reader::names::Names;

/// A material as far as the deck gives it.
struct Draft {
    name: String,
    span: Span,
    /// Place of what Poisson's ratio follows from.
    poisson_span: Span,
    law: Constant<Law>,
    density: Constant<f64>,
    damping: Damping,
    /// Place of mass-proportional damping.
    damping_span: Span,
}

/// The materials of a deck before their sections are known.
pub(super) struct Drafts {
    /// Names, in the order of the materials.
    pub names: Names,
    all: Vec<Draft>,
}

impl Drafts {
    /// Reads all materials.
    pub fn read(outline: &Outline, cx: &mut Context) -> Self {
        let mut names = Names::new("material");
        let mut all = Vec::new();
        let general = damping::general(outline, cx);
        for block in outline.blocks("MATERIAL") {
            if let Some(name) = names.new_name(block.head, cx) {
                all.push(draft(name.typed.clone(), block, general, cx));
                names.define(name);
            }
        }
        Drafts { names, all }
    }

    /// Places of the materials.
    pub fn spans(&self) -> Vec<Span> {
        self.all.iter().map(|draft| draft.span).collect()
    }

    /// Places of what their Poisson's ratios follow from.
    pub fn poisson_spans(&self) -> Vec<Span> {
        self.all.iter().map(|draft| draft.poisson_span).collect()
    }

    /// Places of their mass-proportional damping.
    pub fn damping_spans(&self) -> Vec<Span> {
        self.all.iter().map(|draft| draft.damping_span).collect()
    }

    /// Reports constants that a material in use lacks.
    pub fn report_incomplete(&self, sections: &[Section], cx: &mut Context) {
        if cx.may_lack_cards() {
            return;
        }
        for (index, draft) in self.all.iter().enumerate() {
            if sections.iter().any(|section| section.material == index) {
                draft.report_incomplete(cx);
            }
        }
    }

    /// The materials, with unknown constants as zero, which a model without errors never has in use.
    pub fn complete(self, cx: &mut Context) -> Vec<Material> {
        let drafts = self.all.into_iter();
        drafts.map(|draft| draft.complete(cx)).collect()
    }
}

/// A material; `general` is the damping of one that has none of its own.
fn draft(name: String, block: &Block, general: Option<damping::Placed>, cx: &mut Context) -> Draft {
    let density = block.parts_of("DENSITY");
    cx.only_once(&density);
    let damping = damping::own(block, cx).or(general);
    let (damping, damping_span) = damping.unwrap_or((Damping::default(), block.head.span));
    Draft {
        name,
        span: block.head.span,
        poisson_span: law::poisson_span(block).unwrap_or(block.head.span),
        law: law::read(block, cx),
        density: constant(&density, density_row, cx),
        damping,
        damping_span,
    }
}

/// `rho[, T]`
fn density_row(row: Row, cx: &mut Context) -> Option<f64> {
    row.at_most(2, cx.d);
    let density = row.real(0, "the density", cx.d);
    temperature(row, 1, cx)?;
    let density = density?;
    if density <= 0.0 {
        out_of_range("the density must be positive", row, 0, cx);
        return None;
    }
    Some(density)
}

impl Draft {
    fn report_incomplete(&self, cx: &mut Context) {
        let mut missing = Vec::new();
        if self.law == Constant::Missing {
            missing.push("*ELASTIC");
        }
        if self.density == Constant::Missing {
            missing.push("*DENSITY");
        }
        if !missing.is_empty() {
            let message = format!("material {} lacks {}", self.name, missing.join(" and "));
            cx.error(Code::IncompleteMaterial, self.span, message);
        }
    }

    fn complete(self, cx: &mut Context) -> Material {
        let material = Material {
            name: self.name,
            law: self.law.given().unwrap_or(Law::elastic(0.0, 0.0)),
            density: self.density.given().unwrap_or(0.0),
            damping: self.damping,
        };
        hint_at_units(&material, self.span, cx);
        material
    }
}

/// Notes a wave speed that hints at mixed units.
fn hint_at_units(material: &Material, span: Span, cx: &mut Context) {
    let speed = material.wave_speed(Plane::Strain);
    if speed.is_finite() && speed > 0.0 && !(10.0..=1e8).contains(&speed) {
        let name = &material.name;
        let message = format!("the waves in material {name} run at {speed:.3e}");
        let note = Diagnostic::note(Code::UnitsHint, span, message);
        cx.d.push(note.help("most materials lie between 10 and 1e8 in common units"));
    }
}
