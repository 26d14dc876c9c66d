//! With which bytes a match can begin.

use crate::bytes::Bytes;
use pest_meta::ast::RuleType;
use pest_meta::optimizer::{OptimizedExpr as Expr, OptimizedRule};
use std::collections::HashMap;

/// The grammar by name.
pub type Rules = HashMap<String, OptimizedRule>;

/// How a match can begin.
#[derive(Clone, Copy)]
pub struct First {
    /// The bytes it can begin with, and perhaps more.
    pub bytes: Bytes,
    /// Whether it may match nothing; then what follows counts as well.
    pub is_empty: bool,
}

/// The one byte that an expression matches, if that is all it does.
pub fn single(rules: &Rules, expr: &Expr) -> Option<Bytes> {
    match expr {
        Expr::Str(text) => match text.as_bytes() {
            [byte] => Some(Bytes::range(*byte..=*byte)),
            _ => None,
        },
        Expr::Range(start, end) => match (start.as_bytes(), end.as_bytes()) {
            ([start], [end]) => Some(Bytes::range(*start..=*end)),
            _ => None,
        },
        Expr::Choice(left, right) => Some(single(rules, left)?.or(single(rules, right)?)),
        Expr::Ident(name) => match rules.get(name) {
            Some(rule) if rule.ty == RuleType::Silent => single(rules, &rule.expr),
            Some(_) => None,
            None => builtin(name),
        },
        _ => None,
    }
}

/// pest's own rules for one byte.
fn builtin(name: &str) -> Option<Bytes> {
    let digit = Bytes::range(b'0'..=b'9');
    let alpha = Bytes::range(b'a'..=b'z').or(Bytes::range(b'A'..=b'Z'));
    Some(match name {
        "ASCII_DIGIT" => digit,
        "ASCII_ALPHA" => alpha,
        "ASCII_ALPHANUMERIC" => digit.or(alpha),
        "ASCII_HEX_DIGIT" => digit.or(Bytes::range(b'a'..=b'f')).or(Bytes::range(b'A'..=b'F')),
        _ => return None,
    })
}

/// Whether white space and comments may stand between the parts of a rule, given whether they may
/// where it is called.
pub fn skips(rule: &OptimizedRule, around: bool) -> bool {
    match rule.ty {
        RuleType::Normal | RuleType::Silent => around,
        RuleType::Atomic | RuleType::CompoundAtomic => false,
        RuleType::NonAtomic => true,
    }
}

/// How a match of an expression can begin; `is_loose` if something may be skipped between its parts.
/// Terminates because no rule of a valid grammar begins with itself.
pub fn first(rules: &Rules, expr: &Expr, is_loose: bool) -> First {
    let all = First { bytes: Bytes::ALL, is_empty: true };
    let of = |inner: &Expr| first(rules, inner, is_loose);
    match expr {
        Expr::Str(text) => match text.as_bytes() {
            [byte, ..] => First { bytes: Bytes::range(*byte..=*byte), is_empty: false },
            [] => all,
        },
        Expr::Seq(left, right) => {
            let left = of(left);
            if !left.is_empty {
                return left;
            }
            let right = of(right);
            let skipped = if is_loose { skipped(rules) } else { Bytes::NONE };
            First { bytes: left.bytes.or(skipped).or(right.bytes), is_empty: right.is_empty }
        }
        Expr::Choice(left, right) => {
            let (left, right) = (of(left), of(right));
            First { bytes: left.bytes.or(right.bytes), is_empty: left.is_empty || right.is_empty }
        }
        Expr::Opt(inner) | Expr::Rep(inner) => First { is_empty: true, ..of(inner) },
        Expr::RestoreOnErr(inner) => of(inner),
        // They match nothing themselves.
        Expr::PosPred(_) | Expr::NegPred(_) => First { bytes: Bytes::NONE, is_empty: true },
        Expr::Ident(name) => match rules.get(name) {
            Some(rule) => first(rules, &rule.expr, skips(rule, is_loose)),
            None => builtin(name).map_or(all, |bytes| First { bytes, is_empty: false }),
        },
        _ => all,
    }
}

/// What can begin a stretch that is skipped.
fn skipped(rules: &Rules) -> Bytes {
    let skipped = ["WHITESPACE", "COMMENT"].into_iter().filter_map(|name| rules.get(name));
    skipped.fold(Bytes::NONE, |bytes, rule| bytes.or(first(rules, &rule.expr, false).bytes))
}
