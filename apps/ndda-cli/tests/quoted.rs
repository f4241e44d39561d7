//! Output that the documentation and the headers of scenes quote is what the program says.
//!
//! A fenced block after the line `<!-- run -->` holds commands, `$ ndda …`, each with its output; `<!-- run after: COMMAND -->` runs something
//! else first, `<!-- run nightly -->` runs only where NDDA_LARGE is set, and `<!-- file: NAME -->` writes the block to a file. In a scene,
//! comments that begin with `// $ ndda` are such a block. All blocks of a page run one after the other in one folder, which has `scenes`.
//!
//! `…` stands for what is left out: lines, or part of one. Not compared are durations, `1.5 s`, unless `=` or `≥` stands before them or they
//! have an exponent, sizes in kB and MB, and numbers of `steps timed`: they differ from machine to machine.
//!
//! `NDDA_ACCEPT=1 cargo test -p ndda-cli --features full --test quoted` writes new output into the pages; read it before it is committed.
#![cfg(all(unix, feature = "plots", feature = "terminal", feature = "png", feature = "fancy"))]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Mark of text that is left out.
const LEFT_OUT: &str = "…";

/// A command with the lines of its output that are quoted, and where these are in the page.
struct Quote {
    command: String,
    lines: std::ops::Range<usize>,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Pages and scenes that may quote output.
fn pages() -> Vec<PathBuf> {
    let listed = |folder: &str, ending: &str| -> Vec<PathBuf> {
        let files = fs::read_dir(root().join(folder)).unwrap().map(|entry| entry.unwrap().path());
        files.filter(|path| path.extension().is_some_and(|found| found == ending)).collect()
    };
    let mut pages = vec![root().join("README.md")];
    pages.extend(["docs/guide", "docs/reference"].iter().flat_map(|folder| listed(folder, "md")));
    pages
        .extend(["scenes", "scenes/joints", "scenes/safety"].iter().flat_map(|folder| listed(folder, "ron")));
    pages.sort();
    pages
}

/// A folder in which the commands of a page run.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::os::unix::fs::symlink(root().join("scenes").canonicalize().unwrap(), folder.path().join("scenes"))
        .unwrap();
    folder
}

/// Runs a line of a shell, in which `ndda` is the program of this build.
fn shell(folder: &Path, line: &str) -> Output {
    let bin = Path::new(env!("CARGO_BIN_EXE_ndda")).parent().unwrap().display().to_string();
    let path = format!("{bin}:{}", std::env::var("PATH").unwrap_or_default());
    Command::new("sh").arg("-c").arg(line).env("PATH", path).current_dir(folder).output().unwrap()
}

/// Output of a command: complaints first.
fn said(output: &Output) -> Vec<String> {
    let text =
        [&output.stderr, &output.stdout].map(|bytes| String::from_utf8_lossy(bytes).into_owned()).concat();
    text.trim_end().lines().map(|line| line.trim_end().to_string()).collect()
}

/// A text with what differs from machine to machine as `#`.
fn masked(line: &str) -> String {
    let words: Vec<&str> = line.split(' ').collect();
    let is_number = |word: &str| {
        let word = word.trim_start_matches('(');
        !word.is_empty() && word.chars().all(|c| c.is_ascii_digit() || c == '.')
    };
    let after = |i: usize| words.get(i + 1).map_or("", |word| word.trim_end_matches([',', ')', ';']));
    let differs = |i: usize| {
        let timed =
            words.get(i + 1..i + 3).is_some_and(|next| next[0] == "steps" && next[1].starts_with("timed"));
        let compared = i > 0 && ["=", "≥"].contains(&words[i - 1]);
        is_number(words[i])
            && (["kB", "MB", "B"].contains(&after(i)) || timed || (after(i) == "s" && !compared))
    };
    let mask = |i: usize| if differs(i) { "#" } else { words[i] };
    // Columns are as wide as their numbers.
    (0..words.len()).map(mask).filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
}

/// Whether a line is what is quoted, parts that are left out being anything.
fn same(quoted: &str, found: &str) -> bool {
    let (quoted, found) = (masked(quoted), masked(found));
    let mut rest = found.as_str();
    let mut parts = quoted.split(LEFT_OUT);
    let first = parts.next().unwrap_or_default();
    let Some(after) = rest.strip_prefix(first) else { return false };
    rest = after;
    let mut is_open = false;
    for part in parts {
        is_open = true;
        let Some(at) = rest.find(part) else { return false };
        is_open &= part.is_empty();
        rest = &rest[at + part.len()..];
    }
    rest.is_empty() || is_open
}

/// Parts of a quote between lines that are left out, and whether something is left out before each.
fn parts(quoted: &[String]) -> Vec<(bool, &[String])> {
    let mut found = Vec::new();
    let (mut from, mut after_gap) = (0, false);
    for (i, line) in quoted.iter().enumerate() {
        if line.trim() == LEFT_OUT {
            found.push((after_gap, &quoted[from..i]));
            (from, after_gap) = (i + 1, true);
        }
    }
    found.push((after_gap, &quoted[from..]));
    found
}

/// The first lines that do not agree, or none.
fn disagreement(quoted: &[String], found: &[String]) -> Option<String> {
    let all = parts(quoted);
    let mut at = 0;
    for (i, (after_gap, part)) in all.iter().enumerate() {
        let fits = |start: usize| {
            part.len() <= found.len() - start && part.iter().zip(&found[start..]).all(|(q, f)| same(q, f))
        };
        let is_last = i + 1 == all.len();
        let mut starts = if *after_gap { at..found.len() + 1 } else { at..at + 1 };
        // The last line of a quote is the last line of the output.
        let ends =
            |start: usize| !is_last || part.is_empty() && *after_gap || start + part.len() == found.len();
        match starts.find(|&start| start <= found.len() && fits(start) && ends(start)) {
            Some(start) => at = start + part.len(),
            None => return Some(part.join("\n")),
        }
    }
    None
}

/// Output as it is to be quoted: the lines that were, each in the place of the line most like it.
fn accepted(quoted: &[String], found: &[String]) -> Vec<String> {
    let likeness = |a: &str, b: &str| {
        let words: Vec<&str> = b.split_whitespace().collect();
        a.split_whitespace().filter(|word| words.contains(word)).count()
    };
    if parts(quoted).len() == 1 {
        return found.to_vec();
    }
    let (mut lines, mut at) = (Vec::new(), 0);
    for (i, (after_gap, part)) in parts(quoted).into_iter().enumerate() {
        if i > 0 {
            lines.push(LEFT_OUT.to_string());
        }
        let last = found.len().saturating_sub(part.len());
        let like =
            |start: &usize| part.iter().zip(&found[*start..]).map(|(q, f)| likeness(q, f)).sum::<usize>();
        let start = if after_gap { (at..=last).rev().max_by_key(like).unwrap_or(at) } else { at };
        for (k, old) in part.iter().enumerate() {
            let new = found.get(start + k).cloned().unwrap_or_default();
            lines.push(if same(old, &new) { old.clone() } else { new });
        }
        at = start + part.len();
    }
    lines
}

/// Commands of a block that begins at a line.
fn quotes(lines: &[String], block: std::ops::Range<usize>) -> Vec<Quote> {
    let begins: Vec<usize> = block.clone().filter(|&i| lines[i].starts_with("$ ")).collect();
    let ends = begins.iter().skip(1).copied().chain([block.end]);
    let quote =
        |(begin, end): (&usize, usize)| Quote { command: lines[*begin][2..].into(), lines: begin + 1..end };
    begins.iter().zip(ends).map(quote).collect()
}

/// A page of text with blocks after markers, or the header of a scene.
struct Page {
    lines: Vec<String>,
    /// Prefix that was taken off each line.
    prefix: &'static str,
}

impl Page {
    fn read(path: &Path) -> Self {
        let text = fs::read_to_string(path).unwrap();
        let is_scene = path.extension().is_some_and(|ending| ending == "ron");
        let prefix = if is_scene { "// " } else { "" };
        let taken = |line: &str| line.strip_prefix(prefix).map_or_else(|| format!("\0{line}"), String::from);
        Self { lines: text.lines().map(taken).collect(), prefix }
    }

    fn write(&self, path: &Path) {
        let back = |line: &String| match line.strip_prefix('\0') {
            Some(whole) => whole.to_string(),
            None => format!("{}{line}", self.prefix),
        };
        let text = self.lines.iter().map(back).collect::<Vec<_>>().join("\n");
        fs::write(path, text + "\n").unwrap();
    }

    /// Markers and their blocks, as ranges of lines.
    fn blocks(&self) -> Vec<(String, std::ops::Range<usize>)> {
        let mut found = Vec::new();
        for (i, line) in self.lines.iter().enumerate() {
            let is_fence = |line: &String| line.starts_with("```");
            if !self.prefix.is_empty() {
                if line.starts_with("$ ndda") && (i == 0 || !self.lines[i - 1].starts_with("$ ndda")) {
                    let end = (i..self.lines.len()).find(|&k| self.lines[k].starts_with('\0'));
                    found.push(("run".into(), i..end.unwrap_or(self.lines.len())));
                }
            } else if let Some(marker) = line.strip_prefix("<!-- ").and_then(|rest| rest.strip_suffix(" -->"))
                && self.lines.get(i + 1).is_some_and(is_fence)
                && (marker.starts_with("run") || marker.starts_with("file: "))
            {
                let end = (i + 2..self.lines.len()).find(|&k| is_fence(&self.lines[k])).unwrap();
                found.push((marker.into(), i + 2..end));
            }
        }
        found
    }
}

/// Runs the blocks of a page; what is wrong, in words. Accepts what is found where `accept` is set.
fn check(path: &Path, accept: bool) -> Vec<String> {
    let mut page = Page::read(path);
    let (blocks, mut wrong, mut changes) = (page.blocks(), Vec::new(), Vec::new());
    if blocks.is_empty() {
        return wrong;
    }
    let folder = folder();
    for (marker, block) in blocks {
        if let Some(name) = marker.strip_prefix("file: ") {
            fs::write(folder.path().join(name), page.lines[block].join("\n") + "\n").unwrap();
            continue;
        }
        if marker == "run nightly" && std::env::var_os("NDDA_LARGE").is_none() {
            continue;
        }
        if let Some(before) = marker.strip_prefix("run after: ") {
            assert!(shell(folder.path(), before).status.success(), "{before}");
        }
        for quote in quotes(&page.lines, block) {
            let (quoted, found) =
                (&page.lines[quote.lines.clone()], said(&shell(folder.path(), &quote.command)));
            if let Some(lines) = disagreement(quoted, &found) {
                let (line, page) = (quote.lines.start, path.display());
                wrong.push(format!(
                    "{page}:{line}: $ {}\nquotes\n{lines}\nbut says\n{}",
                    quote.command,
                    found.join("\n")
                ));
                changes.push((quote.lines.clone(), accepted(quoted, &found)));
            }
        }
    }
    if accept && !changes.is_empty() {
        for (lines, new) in changes.into_iter().rev() {
            page.lines.splice(lines, new);
        }
        page.write(path);
        return Vec::new();
    }
    wrong
}

#[test]
fn quoted_output_is_what_the_program_says() {
    let accept = std::env::var_os("NDDA_ACCEPT").is_some();
    let wrong: Vec<String> = pages().iter().flat_map(|page| check(page, accept)).collect();
    assert!(wrong.is_empty(), "{}\nNDDA_ACCEPT=1 writes it anew", wrong.join("\n\n"));
}

#[test]
fn quotes_are_compared_but_for_what_is_left_out_and_what_differs_between_machines() {
    let lines = |text: &str| text.split('|').map(String::from).collect::<Vec<_>>();
    let found = lines("a run would take 1.5 s and 12.6 MB|limit 2.00, at t = 0.3 s|step 6.4e-5 s|end");
    for (quoted, agrees) in [
        ("a run would take 9.0 s and 3 MB|limit 2.00, at t = 0.3 s|step 6.4e-5 s|end", true),
        ("a run would take 9.0 s and 3 MB|…|end", true),
        ("…|step 6.4e-5 s|…", true),
        ("a run …|…|…e…d", true),
        ("a run would take 9.0 s and 3 MB|…|step 6.4e-5 s", false),
        ("a run would take 9.0 s and 3 MB|end", false),
        ("…|limit 2.00, at t = 0.4 s|…", false),
        ("…|step 6.5e-5 s|…", false),
        ("…|limit 3.00…|…", false),
    ] {
        assert_eq!(disagreement(&lines(quoted), &found).is_none(), agrees, "{quoted}");
    }
    let old = lines("a run would take 9.0 s and 3 MB|…|step 7e-5 s|…");
    assert_eq!(accepted(&old, &found), lines("a run would take 9.0 s and 3 MB|…|step 6.4e-5 s|…"));
}
