//! `*STICKSLIP`.

use crate::deck::Card;
use crate::diagnostics::{Code, Diagnostic, shown};
use crate::model::{
    Factorization, Impact, ImpactTime, LandingRule, LcpChoice, Scheme, Settings, SolverChoice,
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
    check_landing(card, settings, cx);
}

/// The landing return needs the energy-momentum scheme, whose contact force takes Pn g0 at a landing and
/// nothing else.
fn check_landing(card: &Card, settings: &Settings, cx: &mut Context) {
    let is_ss22 = matches!(settings.scheme, Scheme::Ss22 { .. });
    if settings.landing == LandingRule::Return && is_ss22 {
        let given = ["LANDING", "SCHEME"].map(|name| (card.choice(name), name));
        let named = given.iter().find(|(value, _)| value.is_some());
        let span = named.map_or(card.span, |(_, name)| card.span_of(name));
        let message = "LANDING=RETURN is not for SCHEME=SS22";
        let error = Diagnostic::error(Code::SchemeOption, span, message);
        cx.d.push(error.help("leave out SCHEME=SS22, or choose LANDING=PLASTIC"));
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
