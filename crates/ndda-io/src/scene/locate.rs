//! Where in the text of a scene a value stands.
//!
//! RON's parser forgets positions; this scanner keeps only them. It reads the shape of a text (structs, lists, maps,
//! words) and nothing of its meaning, so that any text gives a tree and none gives a panic.

mod around;
mod keys;

use std::ops::Range;

use keys::current;

/// Nesting beyond this is not followed; RON itself refuses it.
const DEEPEST: usize = 100;

/// A value in the text, with what is inside it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Node {
    /// Current name of the field that holds the value, when it is in a struct.
    pub key: Option<String>,
    /// Bytes of the name as it is written, which may be a former one.
    pub key_span: Range<usize>,
    /// Bytes of the value, brackets included.
    pub span: Range<usize>,
    /// Bracket that opens it; `None` for a word, number or string.
    pub opening: Option<char>,
    /// Fields or items.
    pub children: Vec<Node>,
    /// Whether the bracket that opens it is closed.
    is_bracket_closed: bool,
}

impl Node {
    /// Reads the shape of a text; fields that have been renamed go by their current keys.
    pub fn of(text: &str) -> Self {
        let mut scanner = Scanner { text, at: 0 };
        scanner.skip_blank();
        while scanner.rest().starts_with("#![") {
            scanner.skip_attribute();
        }
        let mut tree = scanner.value(0).unwrap_or_default();
        rename(&mut tree);
        tree
    }
}

/// Whether a text is one value and nothing else.
///
/// # Errors
/// The reason, in words that follow the text.
pub(crate) fn one_value(text: &str) -> Result<(), String> {
    let mut scanner = Scanner { text, at: 0 };
    let Some(node) = scanner.value(0) else { return Err("is not a value".into()) };
    let rest = text[node.span.end..].trim();
    if !rest.is_empty() && node.is_closed(text) {
        return Err(format!("is more than one value: `{rest}` follows"));
    }
    match node.unclosed(text) {
        Some(open) => Err(format!("is incomplete: `{open}` is not closed")),
        None => Ok(()),
    }
}

/// Gives the fields in the tree of a scene their current keys; their places in the text stay.
fn rename(tree: &mut Node) {
    for parent in &mut tree.children {
        let name = parent.key.clone().unwrap_or_default();
        for field in &mut parent.children {
            field.key = field.key.take().map(|key| current(&name, &key).to_string());
        }
    }
}

impl Node {
    /// The value at a path such as `blocks[1].shape.size_m[0]`; items of lists also go by the text of their `name`.
    pub fn find(&self, text: &str, path: &str) -> Option<&Self> {
        segments(path).iter().try_fold(self, |node, segment| node.child(text, segment))
    }

    /// The value of one more segment.
    pub(crate) fn child(&self, text: &str, segment: &str) -> Option<&Self> {
        if let Some(child) = self.children.iter().find(|c| c.key.as_deref() == Some(segment)) {
            return Some(child);
        }
        if let Ok(index) = segment.parse::<usize>() {
            return self.children.get(index).filter(|c| c.key.is_none());
        }
        let named = |item: &&Self| {
            let name = item.children.iter().find(|c| c.key.as_deref() == Some("name"));
            name.is_some_and(|n| text[n.span.clone()].trim_matches('"') == segment)
        };
        self.children.iter().find(named)
    }

    /// The word before the bracket that opens it, as `Box` in `Box(…)`; empty for anything else.
    pub(crate) fn word<'a>(&self, text: &'a str) -> &'a str {
        let Some('(') = self.opening else { return "" };
        text[self.span.clone()].split(|c: char| "(/".contains(c) || c.is_whitespace()).next().unwrap_or("")
    }

    /// Whether its bracket or its quotes are closed.
    pub(crate) fn is_closed(&self, text: &str) -> bool {
        let own = &text[self.span.clone()];
        match self.opening {
            Some(_) => self.is_bracket_closed,
            None if own.starts_with(['"', '\'']) => own.len() > 1 && own.ends_with(&own[..1]),
            None => true,
        }
    }

    /// The first bracket or quote in it that is not closed.
    fn unclosed(&self, text: &str) -> Option<char> {
        let inside = self.children.iter().find_map(|child| child.unclosed(text));
        let quote = || text[self.span.start..].chars().next();
        let own = self.opening.or_else(quote).filter(|_| !self.is_closed(text));
        own.or(inside)
    }

    /// The byte where it begins, with its name.
    fn begun(&self) -> usize {
        self.key.as_ref().map_or(self.span.start, |_| self.key_span.start)
    }

    /// Path of the innermost value around or before a byte.
    pub(crate) fn path_at(&self, offset: usize) -> String {
        let mut path = String::new();
        let mut node = self;
        while let Some((i, child)) =
            node.children.iter().enumerate().find(|(_, c)| c.begun() <= offset && offset <= c.span.end)
        {
            match &child.key {
                Some(key) if path.is_empty() => path.push_str(key),
                Some(key) => path.push_str(&format!(".{key}")),
                None => path.push_str(&format!("[{i}]")),
            }
            node = child;
        }
        path
    }

    /// Calls `leaf` for each word, number and string.
    pub fn for_each_leaf(&self, leaf: &mut impl FnMut(&Self)) {
        if self.opening.is_none() {
            leaf(self);
        }
        self.children.iter().for_each(|child| child.for_each_leaf(leaf));
    }
}

/// Segments of a path: `a.b[1].c` is a, b, 1, c.
pub(crate) fn segments(path: &str) -> Vec<&str> {
    path.split(['.', '[', ']']).filter(|segment| !segment.is_empty()).collect()
}

/// Segments of a path with their current keys.
pub(crate) fn current_segments(path: &str) -> Vec<&str> {
    let mut names = segments(path);
    if let [parent, field, ..] = &mut names[..] {
        *field = current(parent, field);
    }
    names
}

struct Scanner<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Scanner<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn bump(&mut self) {
        self.at += self.peek().map_or(0, char::len_utf8);
    }

    /// Skips white space and comments, block comments with their nesting.
    fn skip_blank(&mut self) {
        loop {
            let rest = self.rest();
            if rest.starts_with(char::is_whitespace) {
                self.bump();
            } else if rest.starts_with("//") {
                self.at += rest.find('\n').unwrap_or(rest.len());
            } else if rest.starts_with("/*") {
                self.skip_block_comment();
            } else {
                return;
            }
        }
    }

    fn skip_block_comment(&mut self) {
        let mut depth = 0usize;
        while !self.rest().is_empty() {
            if self.rest().starts_with("/*") {
                depth += 1;
                self.at += 2;
            } else if self.rest().starts_with("*/") {
                depth -= 1;
                self.at += 2;
                if depth == 0 {
                    return;
                }
            } else {
                self.bump();
            }
        }
    }

    fn skip_attribute(&mut self) {
        self.at += self.rest().find(']').map_or(self.rest().len(), |i| i + 1);
        self.skip_blank();
    }

    /// A value, or `None` where the text has none.
    fn value(&mut self, depth: usize) -> Option<Node> {
        let start = self.at;
        let word = self.word();
        let after_word = self.at;
        self.skip_blank();
        match self.peek() {
            Some(opening @ ('(' | '[' | '{')) if depth < DEEPEST && (word.is_empty() || opening == '(') => {
                let mut node = self.bracket(opening, depth);
                node.span.start = start;
                // `Some(x)` is x to a reader.
                if word == "Some" && node.children.len() == 1 && node.children[0].key.is_none() {
                    return node.children.pop();
                }
                Some(node)
            }
            _ if after_word > start => {
                self.at = after_word;
                Some(Node { span: start..after_word, ..Node::default() })
            }
            _ => None,
        }
    }

    /// A string, character, number or identifier; empty at a bracket or separator.
    fn word(&mut self) -> &'a str {
        let start = self.at;
        let rest = self.rest();
        let raw = rest.starts_with("r\"") || rest.starts_with("r#");
        match self.peek() {
            Some('"') => self.skip_quoted('"'),
            Some('\'') => self.skip_quoted('\''),
            _ if raw => self.skip_raw(),
            _ => {
                let end = |c: char| c.is_whitespace() || "()[]{},:\"'".contains(c);
                let mut length = rest.find(end).unwrap_or(rest.len());
                let comment = ["//", "/*"].iter().filter_map(|m| rest[..length].find(m)).min();
                length = comment.unwrap_or(length);
                self.at += length;
            }
        }
        &self.text[start..self.at]
    }

    fn skip_quoted(&mut self, quote: char) {
        self.bump();
        while let Some(c) = self.peek() {
            self.bump();
            if c == '\\' {
                self.bump();
            } else if c == quote {
                return;
            }
        }
    }

    fn skip_raw(&mut self) {
        self.at += 1;
        let hashes = self.rest().len() - self.rest().trim_start_matches('#').len();
        self.at += hashes;
        if self.peek() != Some('"') {
            return;
        }
        self.at += 1;
        let closing = format!("\"{}", "#".repeat(hashes));
        self.at += self.rest().find(&closing).map_or(self.rest().len(), |i| i + closing.len());
    }

    /// The inside of a bracket; stops at the first thing that fits nowhere.
    fn bracket(&mut self, opening: char, depth: usize) -> Node {
        let closing = match opening {
            '(' => ')',
            '[' => ']',
            _ => '}',
        };
        let mut node = Node { opening: Some(opening), span: self.at..self.at, ..Node::default() };
        self.bump();
        loop {
            self.skip_blank();
            match self.peek() {
                Some(c) if c == closing => {
                    self.bump();
                    node.is_bracket_closed = true;
                    break;
                }
                Some(',') => self.bump(),
                _ => match self.entry(depth) {
                    Some(child) => node.children.push(child),
                    None => break,
                },
            }
        }
        node.span.end = self.at;
        node
    }

    /// `key: value` or a value.
    fn entry(&mut self, depth: usize) -> Option<Node> {
        let first = self.value(depth + 1)?;
        self.skip_blank();
        if self.peek() != Some(':') {
            return Some(first);
        }
        self.bump();
        self.skip_blank();
        let key_span = first.span;
        let key = Some(self.text[key_span.clone()].to_string());
        let mut value =
            self.value(depth + 1).unwrap_or_else(|| Node { span: self.at..self.at, ..Node::default() });
        (value.key, value.key_span) = (key, key_span);
        Some(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TEXT: &str = r##"#![enable(implicit_some)]
// a comment with (brackets
( title: "a \" (quoted", /* nested /* ( */ */ time: (step_s: 1e-3, integrator: Midpoint(theta: 0.5)),
  blocks: [(name: "A", at_m: (1, 2.5, -3)), (name: "B", spin: Some((4, 5, 6)), raw: r#"x"y"#,)],
)"##;

    fn found(path: &str) -> &'static str {
        Node::of(TEXT).find(TEXT, path).map_or("nothing", |node| &TEXT[node.span.clone()])
    }

    #[test]
    fn values_are_found_by_path_index_and_name() {
        assert_eq!(found("time.step_s"), "1e-3");
        assert_eq!(found("time.integrator.theta"), "0.5");
        assert_eq!(found("blocks[0].at_m[1]"), "2.5");
        assert_eq!(found("blocks.B.spin[2]"), "6");
        assert_eq!(found("blocks.B.raw"), "r#\"x\"y\"#");
        assert_eq!(found("blocks[7]"), "nothing");
        assert_eq!(found("title"), "\"a \\\" (quoted\"");
    }

    #[test]
    fn the_innermost_struct_around_a_byte_is_found() {
        let offset = TEXT.find("2.5").unwrap();
        let tree = Node::of(TEXT);
        assert_eq!(&TEXT[tree.innermost(offset).unwrap().span.clone()], "(1, 2.5, -3)");
    }

    proptest! {
        #[test]
        fn no_text_panics(text in "\\PC{0,80}", cut in 0..TEXT.len(), insert in "[(){}\\[\\]\"'/*r#:,\\\\]{0,6}") {
            Node::of(&text);
            let mut damaged = TEXT.to_string();
            damaged.insert_str(cut, &insert);
            let shape = Node::of(&damaged);
            shape.find(&damaged, "blocks[0].at_m[1]");
            shape.innermost(cut);
            Node::of(&TEXT[..cut]);
        }
    }
}
