//! Rules as Rust functions of `Reader`, which say whether they match.
//!
//! A function that fails may have moved on and recorded steps; what tries another way goes back to
//! the mark that it made before.

use crate::bytes::Bytes;
use crate::first::{Rules, first, single, skips};
use pest_meta::ast::RuleType;
use pest_meta::optimizer::{OptimizedExpr as Expr, OptimizedRule};
use std::collections::BTreeMap;

/// What goes for everything within a rule, unless a rule in it says otherwise.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Mode {
    /// White space and comments may stand between the parts.
    skips: bool,
    /// What matches is recorded.
    records: bool,
}

/// A rule in a mode.
type Key = (String, Mode);

struct Emitter {
    rules: Rules,
    functions: BTreeMap<Key, String>,
    /// Called, and not made yet.
    called: Vec<Key>,
}

/// The functions of all rules that the entries need.
pub fn reader(rules: Vec<OptimizedRule>, entries: &[&str]) -> Result<String, String> {
    let rules: Rules = rules.into_iter().map(|rule| (rule.name.clone(), rule)).collect();
    let mut emitter = Emitter { rules, functions: BTreeMap::new(), called: Vec::new() };
    let skip = emitter.skip()?;
    for entry in entries {
        emitter.call(entry, Mode { skips: true, records: true })?;
    }
    while let Some(key) = emitter.called.pop() {
        if !emitter.functions.contains_key(&key) {
            let function = emitter.function(&key)?;
            emitter.functions.insert(key, function);
        }
    }
    let functions: String = emitter.functions.into_values().collect();
    Ok(format!("impl Reader<'_> {{\n{skip}{functions}}}\n"))
}

/// Whether a rule matches one text only: it is there to be matched, or named in an error.
fn is_mark(expr: &Expr) -> bool {
    match expr {
        Expr::Str(_) => true,
        Expr::Seq(left, right) => is_mark(left) && matches!(**right, Expr::NegPred(_)),
        _ => false,
    }
}

/// The two sides of an expression of some kind.
type Sides = fn(&Expr) -> Option<[&Expr; 2]>;

fn sequence(expr: &Expr) -> Option<[&Expr; 2]> {
    if let Expr::Seq(left, right) = expr { Some([left, right]) } else { None }
}

fn choice(expr: &Expr) -> Option<[&Expr; 2]> {
    if let Expr::Choice(left, right) = expr { Some([left, right]) } else { None }
}

/// The parts of a sequence, or the alternatives of a choice, from left to right.
fn flat(expr: &Expr, sides: Sides) -> Vec<&Expr> {
    match sides(expr) {
        Some(both) => both.into_iter().flat_map(|side| flat(side, sides)).collect(),
        None => vec![expr],
    }
}

/// `true` if the next byte is of the set.
fn next_is(bytes: Bytes) -> String {
    match bytes.pattern() {
        _ if bytes == Bytes::ALL => "true".to_owned(),
        Some(pattern) => format!("matches!(self.peek(), {pattern})"),
        None => "false".to_owned(),
    }
}

impl Emitter {
    /// What may stand between two parts.
    fn skip(&mut self) -> Result<String, String> {
        let mode = Mode { skips: false, records: false };
        let [space, comment] = ["WHITESPACE", "COMMENT"].map(|name| Expr::Ident(name.to_owned()));
        let [spaces, comments] = [space, comment].map(|expr| Expr::Rep(Box::new(expr)));
        let comment = first(&self.rules, &comments, false).bytes;
        let begins = next_is(first(&self.rules, &spaces, false).bytes.or(comment));
        let comment = next_is(comment);
        let (spaces, comments) = (self.expr(&spaces, mode)?, self.expr(&comments, mode)?);
        // White space is mostly one stretch, without a comment behind it.
        Ok(format!(
            "#[inline] fn skip(&mut self) -> bool {{ !{begins} || self.skip_some() }}\n\
             fn skip_some(&mut self) -> bool {{ let from = self.at; {spaces}; \
             while {comment} {{ let at = self.at; {comments} && {spaces}; if self.at == at {{ break; }} }} \
             self.skipped(from) }}\n"
        ))
    }

    fn function(&mut self, (name, mode): &Key) -> Result<String, String> {
        let rule = self.rules.get(name).cloned().ok_or_else(|| format!("no rule `{name}`"))?;
        let records = mode.records && rule.ty != RuleType::Atomic;
        let inner = Mode { skips: skips(&rule, mode.skips), records };
        let body = self.expr(&rule.expr, inner)?;
        let body = if mode.records && rule.ty != RuleType::Silent && !is_mark(&rule.expr) {
            format!("let open = self.open(); {body} && self.close(open, Rule::{name})")
        } else {
            body
        };
        Ok(format!("pub(super) fn {}(&mut self) -> bool {{ {body} }}\n", function_name(name, *mode)))
    }

    fn call(&mut self, name: &str, mode: Mode) -> Result<String, String> {
        Ok(match name {
            "SOI" => "(self.at == 0)".to_owned(),
            "EOI" => "self.is_at_end()".to_owned(),
            "ANY" => "self.any()".to_owned(),
            _ => {
                self.called.push((name.to_owned(), mode));
                format!("self.{}()", function_name(name, mode))
            }
        })
    }

    /// Rust that matches an expression.
    fn expr(&mut self, expr: &Expr, mode: Mode) -> Result<String, String> {
        if let Some(bytes) = single(&self.rules, expr) {
            return Ok(format!("({} && self.step())", next_is(bytes)));
        }
        Ok(match expr {
            Expr::Str(text) => format!("self.word({:?}.as_bytes())", text),
            Expr::Ident(name) => self.call(name, mode)?,
            Expr::Seq(..) => {
                let parts = flat(expr, sequence).into_iter().map(|part| self.expr(part, mode));
                let parts: Result<Vec<String>, String> = parts.collect();
                format!("({})", parts?.join(if mode.skips { " && self.skip() && " } else { " && " }))
            }
            Expr::Choice(..) => self.choice(expr, mode)?,
            Expr::Opt(inner) => {
                let code = self.expr(inner, mode)?;
                let begins = next_is(first(&self.rules, inner, mode.skips).bytes);
                format!("({{ let mark = self.mark(); !{begins} || {code} || self.back(mark) }})")
            }
            Expr::Rep(inner) => self.repetition(inner, mode)?,
            Expr::PosPred(inner) => self.look_ahead(inner, mode, "")?,
            Expr::NegPred(inner) => self.look_ahead(inner, mode, "!")?,
            Expr::RestoreOnErr(inner) => self.expr(inner, mode)?,
            Expr::Skip(ends) => {
                let ends: Vec<String> = ends.iter().map(|end| format!("{end:?}.as_bytes()")).collect();
                format!("self.until(&[{}])", ends.join(", "))
            }
            other => return Err(format!("the reader can't be made for {other:?}")),
        })
    }

    /// Bytes that the same alternatives can begin with are one arm.
    fn choice(&mut self, expr: &Expr, mode: Mode) -> Result<String, String> {
        let mut codes = Vec::new();
        for alternative in flat(expr, choice) {
            let begins = first(&self.rules, alternative, mode.skips);
            let begins = if begins.is_empty { Bytes::ALL } else { begins.bytes };
            codes.push((begins, self.expr(alternative, mode)?));
        }
        let mut arms: BTreeMap<Vec<usize>, Bytes> = BTreeMap::new();
        for byte in 0..=u8::MAX {
            let possible = (0..codes.len()).filter(|i| codes[*i].0.contains(byte)).collect();
            let bytes = arms.entry(possible).or_insert(Bytes::NONE);
            *bytes = bytes.or(Bytes::range(byte..=byte));
        }
        let arms: String = arms
            .into_iter()
            .filter_map(|(possible, bytes)| {
                let tries: Vec<&str> = possible.iter().map(|i| codes[*i].1.as_str()).collect();
                let tries =
                    if tries.is_empty() { "false".to_owned() } else { tries.join(" || self.back(mark) && ") };
                Some(format!("{} => {tries}, ", bytes.pattern()?))
            })
            .collect();
        Ok(format!("({{ let mark = self.mark(); match self.peek() {{ {arms} }} }})"))
    }

    fn repetition(&mut self, inner: &Expr, mode: Mode) -> Result<String, String> {
        let single = single(&self.rules, inner).filter(|_| !mode.skips);
        if let Some(pattern) = single.and_then(Bytes::pattern) {
            return Ok(format!("self.run(|byte| matches!(byte, {pattern}))"));
        }
        let code = self.expr(inner, mode)?;
        let begins = next_is(first(&self.rules, inner, mode.skips).bytes);
        let skip = if mode.skips { "self.skip() && " } else { "" };
        Ok(format!(
            "({{ let mut mark = self.mark(); let mut more = {begins} && {code}; \
             while more {{ mark = self.mark(); more = {skip}{begins} && {code}; }} self.back(mark) }})"
        ))
    }

    fn look_ahead(&mut self, inner: &Expr, mode: Mode, not: &str) -> Result<String, String> {
        if let Some(bytes) = single(&self.rules, inner) {
            return Ok(format!("{not}{}", next_is(bytes)));
        }
        let code = self.expr(inner, Mode { records: false, ..mode })?;
        Ok(format!("({{ let mark = self.mark(); let found = {code}; self.back(mark) && {not}found }})"))
    }
}

fn function_name(rule: &str, mode: Mode) -> String {
    let skips = if mode.skips { "" } else { "_tight" };
    let records = if mode.records { "" } else { "_quiet" };
    format!("match_{}{skips}{records}", rule.to_lowercase())
}
