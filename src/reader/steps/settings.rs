//! `*STICKSLIP`.

use crate::deck::Card;
use crate::diagnostics::{Code, Diagnostic, shown};
use crate::model::{
    ContactMass, Factorization, Impact, ImpactTime, LandingRule, LcpChoice, Scheme, Settings,
    SolverChoice,
};
use crate::reader::context::Context;

/// Changes settings as a card says.
pub(crate) fn apply(card: &Card, settings: &mut Settings, cx: &mut Context) {
    settings.scheme = scheme(card, settings.scheme, cx);
    match card.choice("IMPACT") {
        Some("NONE") => settings.impact = Impact::None,
        Some(_) => settings.impact = Impact::Impulse,
        None => {}
    }
    match card.choice("IMPACT TIME") {
        Some("EVENT") => settings.impact_time = ImpactTime::Event,
        Some(_) => settings.impact_time = ImpactTime::Increment,
        None => {}
    }
    match card.choice("LANDING") {
        Some("RETURN") => settings.landing = LandingRule::Return,
        Some(_) => settings.landing = LandingRule::Plastic,
        None => {}
    }
    match card.choice("CONTACT MASS") {
        Some("REDISTRIBUTED") => settings.contact_mass = ContactMass::Redistributed,
        Some(_) => settings.contact_mass = ContactMass::Consistent,
        None => {}
    }
    match card.choice("LCP") {
        Some("LEMKE") => settings.lcp = LcpChoice::Lemke,
        Some(_) => settings.lcp = LcpChoice::Hybrid,
        None => {}
    }
    match card.choice("FACTORIZATION") {
        Some("KEEP") => settings.factorization = Factorization::Keep,
        Some(_) => settings.factorization = Factorization::EveryPass,
        None => {}
    }
    match card.choice("SOLVER") {
        Some("SPRS") => settings.solver = SolverChoice::Sprs,
        Some(_) => settings.solver = SolverChoice::Faer,
        None => {}
    }
    if let Some(tolerance) = tolerance(card, cx) {
        settings.tolerance = tolerance;
    }
    if let Some(passes) = max_passes(card, cx) {
        settings.max_passes = passes;
    }
    check_scheme(card, settings, cx);
}

/// The landing return needs the energy-momentum scheme, whose contact force takes Pn g0 at a landing and
/// nothing else, as do nodes without mass, for which end rows and impulses are not made.
fn check_scheme(card: &Card, settings: &Settings, cx: &mut Context) {
    if settings.scheme == Scheme::EnergyMomentum {
        return;
    }
    let returns = settings.landing == LandingRule::Return;
    let redistributes = settings.contact_mass == ContactMass::Redistributed;
    let options = [
        (returns, "LANDING", "RETURN", "PLASTIC"),
        (redistributes, "CONTACT MASS", "REDISTRIBUTED", "CONSISTENT"),
    ];
    for (_, option, value, other) in options.into_iter().filter(|option| option.0) {
        let mut given = [option, "SCHEME"].into_iter().filter(|name| card.has(name));
        let span = given.next().map_or(card.span, |name| card.span_of(name));
        let message = format!("{option}={value} is not for SCHEME=SS22");
        let help = format!("leave out SCHEME=SS22, or choose {option}={other}");
        cx.d.push(Diagnostic::error(Code::SchemeOption, span, message).help(help));
    }
}

/// The scheme, whose weights must make it stable: theta2 >= theta1 >= 1/2.
fn scheme(card: &Card, before: Scheme, cx: &mut Context) -> Scheme {
    let (old1, old2) = match (card.choice("SCHEME"), before) {
        (Some("SS22"), Scheme::EnergyMomentum) => (1.0, 1.0),
        (Some("SS22") | None, Scheme::Ss22 { theta1, theta2 }) => (theta1, theta2),
        _ if card.choice("SCHEME").is_some() => return Scheme::EnergyMomentum,
        _ => return before,
    };
    let theta1 = card.real("THETA1", cx.d).unwrap_or(old1);
    let theta2 = card.real("THETA2", cx.d).unwrap_or(old2);
    if theta1 < 0.5 || theta2 < theta1 {
        let message = format!(
            "SS22 is unstable with THETA1 = {} and THETA2 = {}",
            shown(theta1),
            shown(theta2)
        );
        let span = card.span_of(if theta1 < 0.5 { "THETA1" } else { "THETA2" });
        let error = Diagnostic::error(Code::UnstableScheme, span, message);
        cx.d.push(error.help("it is stable for THETA2 >= THETA1 >= 1/2"));
    }
    Scheme::Ss22 { theta1, theta2 }
}

/// The first step says what the mass of contact surfaces is.
pub(crate) fn check_contact_mass(
    card: &Card,
    [before, now]: [ContactMass; 2],
    step: usize,
    cx: &mut Context,
) {
    if step > 1 && now != before {
        let message = "CONTACT MASS is the same in all steps";
        let error = Diagnostic::error(Code::BadValue, card.span_of("CONTACT MASS"), message);
        cx.d.push(error.help("give it in the first step"));
    }
}

fn tolerance(card: &Card, cx: &mut Context) -> Option<f64> {
    let tolerance = card.real("TOLERANCE", cx.d)?;
    if tolerance <= 0.0 || tolerance >= 1.0 {
        let message = format!(
            "the tolerance must lie between 0 and 1, found {}",
            shown(tolerance)
        );
        cx.error(Code::BadValue, card.span_of("TOLERANCE"), message);
        return None;
    }
    Some(tolerance)
}

fn max_passes(card: &Card, cx: &mut Context) -> Option<usize> {
    let passes = card.integer("MAX PASSES", cx.d)?;
    if passes < 1 {
        let message = format!("at least one pass is needed, found {passes}");
        cx.error(Code::BadValue, card.span_of("MAX PASSES"), message);
    }
    usize::try_from(passes).ok().filter(|&passes| passes > 0)
}
