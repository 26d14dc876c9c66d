//! One test per row of the language's syntax: a small source, and what the tree says.

use std::f64::consts::{PI, TAU};
use texgraph_grammar::syntax::{
    Argument, Dim, Expr, ExprKind, Fold, Item, ItemKind, Node, Pattern, Postfix, Statement, Type, TypeKind,
    UnaryOperator,
};
use texgraph_grammar::{parse, parse_signature};

fn items(source: &str) -> Vec<Item> {
    parse(source).unwrap_or_else(|errors| panic!("{errors:?}\n{source}")).items
}

fn item(source: &str) -> ItemKind {
    let mut items = items(source);
    assert_eq!(items.len(), 1, "{source}");
    items.remove(0).kind
}

fn expr(source: &str) -> Expr {
    let text = format!("let a = {source}");
    let ItemKind::Let { value, .. } = item(&text) else { panic!("{text}") };
    assert_eq!(&text[value.span.range()], source.trim(), "the span is tight");
    value
}

/// An expression with brackets around every operation.
fn show(expr: &Expr) -> String {
    match &expr.kind {
        ExprKind::Int(value) => value.map_or("∞".into(), |value| value.to_string()),
        ExprKind::Float(value) => format!("{value:?}"),
        ExprKind::Bool(value) => value.to_string(),
        ExprKind::Text(value) => format!("{value:?}"),
        ExprKind::Color(value) => format!("{value:?}"),
        ExprKind::Name(name) => name.to_string(),
        ExprKind::Paren(inner) => format!("paren({})", show(inner)),
        ExprKind::Call(call) => format!(
            "{}{}({})",
            call.name.text,
            call.dim.as_ref().map_or(String::new(), show_dim),
            show_arguments(&call.arguments)
        ),
        ExprKind::Postfix { base, links } => {
            links.iter().fold(show(base), |base, link| base + &show_link(link))
        }
        ExprKind::Unary { operators, operand } => {
            let signs: String = operators
                .iter()
                .map(|(operator, _)| if *operator == UnaryOperator::Not { '!' } else { '-' })
                .collect();
            format!("{signs}({})", show(operand))
        }
        ExprKind::Chain { first, links } => {
            let links: String = links
                .iter()
                .map(|link| format!(" {} {}", link.operator.symbol(), show(&link.operand)))
                .collect();
            format!("({}{links})", show(first))
        }
        ExprKind::If { arms, otherwise } => {
            let arms: String = arms
                .iter()
                .map(|(condition, value)| format!("if {} {} ", show(condition), show(value)))
                .collect();
            format!("{arms}else {}", show(otherwise))
        }
        ExprKind::List(values) => {
            format!("[{}]", values.iter().map(show).collect::<Vec<_>>().join(", "))
        }
        ExprKind::Lambda { inputs, body } => {
            let inputs: Vec<_> = inputs.iter().map(|input| input.text.as_str()).collect();
            format!("|{}| {}", inputs.join(", "), show(body))
        }
        ExprKind::Fold(fold) => format!("fold {}", fold.variable.text),
    }
}

fn show_dim(dim: &Dim) -> String {
    match dim {
        Dim::Name(name) => format!("<{}>", name.text),
        Dim::Number(number, _) => format!("<{number}>"),
    }
}

fn show_link(link: &Postfix) -> String {
    match link {
        Postfix::Field(name) => format!(".{}", name.text),
        Postfix::Method(call, _) => {
            let dim = call.dim.as_ref().map_or(String::new(), show_dim);
            format!(".{}{dim}({})", call.name.text, show_arguments(&call.arguments))
        }
        Postfix::Index(index, _) => format!("[{}]", show(index)),
    }
}

fn show_arguments(arguments: &[Argument]) -> String {
    let arguments: Vec<_> = arguments
        .iter()
        .map(|argument| match &argument.name {
            Some(name) => format!("{}: {}", name.text, show(&argument.value)),
            None => show(&argument.value),
        })
        .collect();
    arguments.join(", ")
}

fn show_type(ty: &Type) -> String {
    let fields = |fields: &[texgraph_grammar::syntax::Field]| {
        let fields: Vec<_> =
            fields.iter().map(|field| format!("{}: {}", field.name.text, show_type(&field.ty))).collect();
        format!("({})", fields.join(", "))
    };
    match &ty.kind {
        TypeKind::Named { name, dim } => {
            name.text.to_string() + &dim.as_ref().map_or(String::new(), show_dim)
        }
        TypeKind::Choice(names) => names.iter().map(|name| name.text.as_str()).collect::<Vec<_>>().join("|"),
        TypeKind::Node { inputs, output } => {
            format!("node{} -> {}", fields(inputs), show_type(output))
        }
        TypeKind::Record(inner) => fields(inner),
    }
}

fn shows(cases: &[(&str, &str)]) {
    for (source, expected) in cases {
        assert_eq!(show(&expr(source)), *expected, "{source}");
    }
}

fn node(source: &str) -> Node {
    match item(source) {
        ItemKind::Node(node) | ItemKind::Texture { node, .. } => node,
        other => panic!("{other:?}"),
    }
}

// ---- Lexical ----

#[test]
fn comments_stand_anywhere_and_nest() {
    let file = parse("/* a /* b */ c */ let // d\n a /**/ = 1 /// e").unwrap();
    assert_eq!(file.comments.len(), 4);
    assert_eq!(file.items[0].doc, "");
}

#[test]
fn documentation_belongs_to_what_follows() {
    let source = "//! The file.\n//!\n//!  Indented.\n\n/// One.\r\n/// Two.\nlet a = 1 /// not\n//// ruler\n/// Three.\n// plain\nparam b: int = 1\nlet c = 1\n";
    let file = parse(source).unwrap();
    assert_eq!(file.doc, "The file.\n\n Indented.");
    let docs: Vec<_> = file.items.iter().map(|item| item.doc.as_str()).collect();
    assert_eq!(docs, ["One.\nTwo.", "Three.", ""]);
}

#[test]
fn keywords_end_at_word_boundaries() {
    shows(&[
        ("letz", "letz"),
        ("iff + truely", "(iff + truely)"),
        ("_in.max.tiles.as", "_in.max.tiles.as"),
        ("true", "true"),
    ]);
}

#[test]
fn numbers() {
    shows(&[
        ("3", "3"),
        ("3.0", "3.0"),
        ("1e-3", "0.001"),
        ("2.5E+2", "250.0"),
        ("18446744073709551615", "18446744073709551615"),
        ("18446744073709551616", "∞"),
        ("1.abs()", "1.abs()"),
        ("1.0.abs()", "1.0.abs()"),
    ]);
}

#[test]
fn angles_are_radians() {
    assert_eq!(expr("90deg").kind, ExprKind::Float(90.0 * (PI / 180.0)));
    assert_eq!(expr("0.25turn").kind, ExprKind::Float(0.25 * TAU));
}

#[test]
fn colours() {
    shows(&[
        ("#1aF", "[17, 170, 255, 255]"),
        ("#102030", "[16, 32, 48, 255]"),
        ("#10203040", "[16, 32, 48, 64]"),
        ("#102030.rgb", "[16, 32, 48, 255].rgb"),
    ]);
}

#[test]
fn strings() {
    let value = expr(r#"f("a\"b\\c\nd\te\u{e9}\u{1F600} ü // no comment")"#);
    assert_eq!(show(&value), "f(\"a\\\"b\\\\c\\nd\\teé😀 ü // no comment\")");
}

#[test]
fn white_space_never_matters_but_before_brackets() {
    shows(&[
        ("a\n.b\n.c(\n1\n)", "a.b.c(1)"),
        ("f<int>(1)", "f<int>(1)"),
        ("f<3>(1)", "f<3>(1)"),
        ("a < b", "(a < b)"),
        ("a<b", "(a < b)"),
        ("a<b && c>(d)", "((a < b) && (c > paren(d)))"),
        ("a .b<n>()", "a.b<n>()"),
    ]);
}

// ---- Items ----

#[test]
fn uses() {
    let ItemKind::Use { path, alias } = item("use \"a/b.tex\"") else { panic!() };
    assert_eq!((path.value.as_str(), alias), ("a/b.tex", None));
    let ItemKind::Use { alias, .. } = item("use \"a.tex\" as brick") else { panic!() };
    assert_eq!(alias.unwrap().text, "brick");
    let items = items("use \"a.tex\"\nuse \"b.tex\"   ");
    assert_eq!(items[0].span.range(), 0..11, "no white space in the span");
}

#[test]
fn lets() {
    let ItemKind::Let { name, value } = item("let a = f(1)") else { panic!() };
    assert_eq!((name.text.as_str(), show(&value).as_str()), ("a", "f(1)"));
}

#[test]
fn params() {
    let source = "param cells: int = 64 in 1..=65536";
    let ItemKind::Param { name, ty, default, range } = item(source) else { panic!() };
    assert_eq!((name.text.as_str(), show_type(&ty)), ("cells", "int".into()));
    let range = range.unwrap();
    assert!(range.inclusive);
    let shown = [&default, &*range.start, &*range.end].map(show);
    assert_eq!(shown, ["64", "1", "65536"]);
    assert_eq!(&source[range.span.range()], "1..=65536");
    let ItemKind::Param { range, .. } = item("param a: vec2 = vec2(1.0)  ") else { panic!() };
    assert_eq!(range, None);
    let ItemKind::Param { range, .. } = item("param a: int = 0 in 0..4") else { panic!() };
    assert!(!range.unwrap().inclusive);
}

#[test]
fn nodes() {
    let node =
        node("node n<n, m,>(a: vec<n>, b: int = a.x + 1,) -> (v: vec<n>, w: float,) { v = a w = 1.0 }");
    let names = |names: &[texgraph_grammar::syntax::Name]| {
        names.iter().map(|name| name.text.to_string()).collect::<Vec<_>>().join(" ")
    };
    assert_eq!(names(&node.dims), "n m");
    assert_eq!(node.inputs.len(), 2);
    assert_eq!(show(node.inputs[1].default.as_ref().unwrap()), "(a.x + 1)");
    assert_eq!(node.outputs.len(), 2);
    assert_eq!(show_type(&node.outputs[0].ty), "vec<n>");
    assert_eq!(node.body.statements.len(), 2);
    assert!(self::node("node n() -> (v: int) {}").inputs.is_empty());
}

#[test]
fn textures() {
    let ItemKind::Texture { node, tiles } =
        item("texture t(uv: vec2) -> (color: color) tiles vec2(1, 2) { color = #fff }")
    else {
        panic!()
    };
    assert_eq!(node.name.text, "t");
    assert_eq!(show(&tiles.unwrap()), "vec2(1, 2)");
    let source = "texture t(uv: vec2) -> (color: color) { color = #fff }";
    assert!(matches!(item(source), ItemKind::Texture { tiles: None, .. }));
}

#[test]
fn statements() {
    let node = node("node n() -> (v: int) { let a = 1 let (b, c,) = f(a)\n v = b - c }");
    let patterns: Vec<_> = node
        .body
        .statements
        .iter()
        .map(|statement| match statement {
            Statement::Let { pattern: Pattern::Name(name), .. } => name.text.to_string(),
            Statement::Let { pattern: Pattern::Record(names, _), .. } => format!("{}", names.len()),
            Statement::Assign { name, value } => format!("{} = {}", name.text, show(value)),
        })
        .collect();
    assert_eq!(patterns, ["a", "2", "v = (b - c)"]);
}

#[test]
fn a_statement_ends_where_no_operator_follows() {
    let node = node("node n() -> (v: int) { v = a\n -b\n w = c\n }");
    let Statement::Assign { value, .. } = &node.body.statements[0] else { panic!() };
    assert_eq!(show(value), "(a - b)");
    assert_eq!(node.body.statements.len(), 2);
}

// ---- Types ----

#[test]
fn types() {
    let cases = [
        ("float", "float"),
        ("vec<n>", "vec<n>"),
        ("vec < 3 >", "vec<3>"),
        ("repeat | clamp | clear", "repeat|clamp|clear"),
        ("node(a: vec2, b: ivec<n>,) -> color", "node(a: vec2, b: ivec<n>) -> color"),
        ("node() -> (d: float, r: float)", "node() -> (d: float, r: float)"),
        (
            "node(old: vec4, s: (d: float, r: float)) -> vec4",
            "node(old: vec4, s: (d: float, r: float)) -> vec4",
        ),
        ("node(f: node(a: int) -> int) -> int", "node(f: node(a: int) -> int) -> int"),
    ];
    for (source, expected) in cases {
        let text = format!("node n(x: {source} ) -> (v: int) {{}}");
        let ty = &node(&text).inputs[0].ty;
        assert_eq!(show_type(ty), expected);
        assert_eq!(&text[ty.span.range()], source);
    }
    assert!(parse("node n(x: (a: int)) -> (v: int) {}").is_err(), "records stand in node types only");
}

#[test]
fn signatures() {
    let signature = parse_signature("<n>(a: vec<n>, seed: int = 0) -> vec<n>").unwrap();
    assert_eq!(signature.dims[0].text, "n");
    assert_eq!(signature.inputs.len(), 2);
    assert_eq!(show_type(&signature.output), "vec<n>");
    let record = parse_signature("() -> (a: int, b: int)").unwrap();
    assert_eq!(show_type(&record.output), "(a: int, b: int)");
}

// ---- Expressions ----

#[test]
fn operators_bind_by_precedence() {
    shows(&[
        ("a + b * c - d / e % f", "(a + (b * c) - (d / e % f))"),
        ("a * b + c * d", "((a * b) + (c * d))"),
        ("a || b && c == d + e * f", "(a || (b && (c == (d + (e * f)))))"),
        ("a * b + c < d && e || f", "(((((a * b) + c) < d) && e) || f)"),
        ("a < b && c >= d || e != f", "(((a < b) && (c >= d)) || (e != f))"),
        ("(a + b) * c", "(paren((a + b)) * c)"),
    ]);
}

#[test]
fn prefixes_are_looser_than_dots() {
    shows(&[
        ("-a.b", "-(a.b)"),
        ("-!- a", "-!-(a)"),
        ("a - -b", "(a - -(b))"),
        ("!a && -b * c", "(!(a) && (-(b) * c))"),
        ("-1.abs()", "-(1.abs())"),
    ]);
}

#[test]
fn postfixes_chain() {
    shows(&[
        ("a.b.c(1).d[2][i].e", "a.b.c(1).d[2][i].e"),
        ("[1, 2][i]", "[1, 2][i]"),
        ("(a).x", "paren(a).x"),
        ("if a { b } else { c }.x", "if a b else c.x"),
    ]);
}

#[test]
fn arguments_by_position_then_by_name() {
    shows(&[("f(p, octaves: 6, x: y,)", "f(p, octaves: 6, x: y)"), ("f()", "f()")]);
}

#[test]
fn choices() {
    shows(&[
        ("if a { b } else { c }", "if a b else c"),
        ("if a { b } else if c { d } else if e { f } else { g }", "if a b if c d if e f else g"),
        ("1 + if a { b } else { c } * 2", "(1 + (if a b else c * 2))"),
        ("if a < b { c } else { d }", "if (a < b) c else d"),
    ]);
}

#[test]
fn lists() {
    shows(&[("[]", "[]"), ("[a, [b, 1], #fff,]", "[a, [b, 1], [255, 255, 255, 255]]")]);
}

#[test]
fn lambdas_are_arguments() {
    shows(&[
        ("f(|a, b,| a + b, x: |p| p.y)", "f(|a, b| (a + b), x: |p| p.y)"),
        ("f(|| 1, | | 2)", "f(|| 1, || 2)"),
        ("f(a || b)", "f((a || b))"),
    ]);
}

fn fold(source: &str) -> Fold {
    let ExprKind::Fold(fold) = expr(source).kind else { panic!("{source}") };
    *fold
}

#[test]
fn folds() {
    let whole = fold(
        "fold (hit = clear, p = -1.0,) for o in ivec2(-1)..=k max 64 while p < 1.0 { hit = p let x = 1 }",
    );
    let accumulators: Vec<_> =
        whole.accumulators.iter().map(|(name, start)| format!("{} = {}", name.text, show(start))).collect();
    assert_eq!(accumulators, ["hit = clear", "p = -(1.0)"]);
    assert_eq!(whole.variable.text, "o");
    assert_eq!((show(&whole.range.start), show(&whole.range.end)), ("ivec2(-(1))".into(), "k".into()));
    assert!(whole.range.inclusive);
    assert_eq!(show(&whole.max.unwrap()), "64");
    assert_eq!(show(&whole.condition.unwrap()), "(p < 1.0)");
    assert_eq!(whole.body.statements.len(), 2);
    let short = fold("fold (a = 0) for i in 0..max(k, 4) { a = a + i }");
    assert_eq!(show(&short.range.end), "max(k, 4)");
    assert!(!short.range.inclusive && short.max.is_none() && short.condition.is_none());
}

#[test]
fn the_design_s_fold_parses() {
    let source = "fold (hit = clear, priority = -1.0) for o in ivec2(-1)..=ivec2(0) {
    let rnd = hash(cell + o)
    let img = leaf.reference(0, at - o - rnd.xy)
    let win = img.a > 0.0 && rnd.w > priority
    hit      = if win { img } else { hit }
    priority = if win { rnd.w } else { priority }
}";
    assert_eq!(fold(source).body.statements.len(), 5);
}

#[test]
fn spans_are_tight() {
    let source = "texture t(uv: vec2) -> (color: color) { let a = f( b ).c  color = a }  ";
    let items = items(source);
    assert_eq!(&source[items[0].span.range()], source.trim_end());
    let ItemKind::Texture { node, .. } = &items[0].kind else { panic!() };
    let Statement::Let { span, value, .. } = &node.body.statements[0] else { panic!() };
    assert_eq!(&source[span.range()], "let a = f( b ).c");
    assert_eq!(&source[value.span.range()], "f( b ).c");
    assert_eq!(&source[node.body.span.range()], "{ let a = f( b ).c  color = a }");
}
