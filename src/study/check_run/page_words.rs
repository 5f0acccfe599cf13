//! The page of a run, if there is one: all of it against the page that its files give.

use super::finding::{InvariantOutcome, Search};
use super::folder::Folder;
use super::invariant::Invariant;
use crate::base::error::Result;
use crate::base::regular;
use crate::page::{self, Source};
use crate::run::folder::REPORT;

/// A page is made from the run's files alone and the same each time, so that comparing it with one that is made anew leaves
/// no number of it unseen, in words, tables, charts or pictures. Three things may differ in an honest run. Its study of error
/// against run time is no file of the run, and that section is left out. Frames may have been drawn after the page was made,
/// so it may be a page without any. And it may have been made of doubtful files, with `--anyway`, and says so. A page by
/// another version of the program cannot be made anew.
pub const WORDS: Invariant = Invariant {
    name: "page-words",
    about: "report.html is what `strandsnap report` makes of the run's files, to the letter, but for its study of errors",
    check: words,
};

/// The section that shows what is not of the run.
const STUDY: &str = "accuracy";

/// Letters of a page that are shown before and from where it differs.
const SHOWN: [usize; 2] = [40, 60];

fn words(run: &Folder) -> InvariantOutcome {
    let not = |why: String| InvariantOutcome::NotApplicable(why);
    let found = match regular::text_if_there(&run.path.join(REPORT), regular::LONGEST_TABLE) {
        Ok(Some(text)) => text,
        Ok(None) => return not(format!("there is no {REPORT}; `strandsnap report` makes it")),
        Err(error) => return failed(error.to_string()),
    };
    if let Some(other) = made_by(&found).filter(|by| *by != env!("CARGO_PKG_VERSION")) {
        return not(format!("strandsnap {other} has made {REPORT}; `strandsnap report --overwrite` makes it again"));
    }
    match compared(run, &found) {
        Ok(search) => search.end(0.0, "parts", ""),
        Err(error) => failed(error.to_string()),
    }
}

fn failed(what: String) -> InvariantOutcome {
    let mut search = Search::new();
    search.add(f64::NAN, || what);
    search.end(0.0, "parts", "")
}

/// Version of the program that has made a page.
fn made_by(page: &str) -> Option<&str> {
    let (_, after) = page.split_once("<meta name=\"generator\" content=\"strandsnap ")?;
    after.split('"').next()
}

/// The page against each that may be right; the differences from the first of them when it is none.
fn compared(run: &Folder, found: &str) -> Result<Search> {
    let mut source = Source::read(&run.path)?;
    let first = differences(found, &page::html(&source)?);
    if first.holds() {
        return Ok(first);
    }
    let mut others = Vec::new();
    let own = source.notes.clone();
    for pictures in [true, false] {
        if !pictures {
            source.leave_out_pictures();
        }
        for doubts in [&[][..], &run.doubts] {
            source.notes = own.iter().cloned().chain(doubts.iter().map(page::doubtful)).collect();
            others.push(differences(found, &page::html(&source)?));
        }
    }
    Ok(others.into_iter().find(|other| other.holds()).unwrap_or(first))
}

/// The parts of a page that differ from those of another.
fn differences(found: &str, right: &str) -> Search {
    let mut search = Search::new();
    let (found, right) = (parts(found), parts(right));
    search.same(found.len(), right.len(), || format!("parts of {REPORT}"));
    for ((name, found), (_, right)) in found.into_iter().zip(right).filter(|((name, _), _)| *name != STUDY) {
        let off = if found == right { 0.0 } else { 1.0 };
        search.add(off, || format!("{REPORT}, {name}: {}", difference(found, right)));
    }
    search
}

/// Head, sections by their anchor, and foot of a page.
fn parts(page: &str) -> Vec<(&str, &str)> {
    // Text of a run has no tags of its own: they are written as entities. Scripts come last.
    let (head, rest) = page.split_once("<main>").unwrap_or((page, ""));
    let (main, foot) = rest.split_once("</main>").unwrap_or((rest, ""));
    let sections = main.split("<section id=\"").skip(1);
    let named = sections.map(|section| section.split_once('"').unwrap_or((section, "")));
    std::iter::once(("head", head)).chain(named).chain([("foot", foot)]).collect()
}

/// Where two texts part, for people.
fn difference(found: &str, right: &str) -> String {
    let at = found.bytes().zip(right.bytes()).take_while(|(a, b)| a == b).count();
    let at = (0..=at).rev().find(|at| found.is_char_boundary(*at)).unwrap_or(0);
    let tag = found[..at].rfind('<').map_or("", |from| &found[from..]);
    if let Some((_, of)) = tag.strip_prefix("<script").and_then(|tag| tag.split_once("data-of=\"")) {
        return format!("the data of `{}` are not those of the run", of.split('"').next().unwrap_or_default());
    }
    if tag.starts_with("<img") {
        return "a picture is not the run's".into();
    }
    format!("`{}` against `{}`", excerpt(found, at), excerpt(right, at))
}

/// What people read of `text` around the letter `at`.
fn excerpt(text: &str, at: usize) -> String {
    let at = (0..=at.min(text.len())).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0);
    // Far enough for tags between the words; a tag that is cut at its beginning is none.
    let begin = (0..=at.saturating_sub(1000)).rev().find(|begin| text.is_char_boundary(*begin)).unwrap_or(0);
    let after: String = text[at..].chars().take(1000).collect();
    let mut before: Vec<char> = plain(&text[begin..at]).chars().rev().take(SHOWN[0]).collect();
    before.reverse();
    before.into_iter().chain(plain(&after).chars().take(SHOWN[1])).collect()
}

/// Text without its tags.
fn plain(text: &str) -> String {
    let mut plain = String::new();
    let mut inside = false;
    for letter in text.chars() {
        match letter {
            '<' => inside = true,
            '>' if inside => {
                inside = false;
                plain.push(' ');
            }
            _ if !inside => plain.push(letter),
            _ => {}
        }
    }
    plain.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str = "<head></head><main><section id=\"answer\"><p>It held <b>12.5 MPa</b>.</p></section>\
                        <section id=\"accuracy\">x</section></main><footer></footer>";

    fn told(found: &str) -> Option<String> {
        let search = differences(found, PAGE);
        match search.end(0.0, "parts", "") {
            InvariantOutcome::Failed(seen) => Some(seen.place),
            _ => None,
        }
    }

    #[test]
    fn a_part_that_differs_is_named_with_its_words() {
        assert_eq!(told(PAGE), None);
        assert_eq!(told(&PAGE.replace(">x<", ">y<")), None, "the study is not the run's");
        let words = told(&PAGE.replace("12.5", "13.5")).unwrap();
        assert!(words.contains("answer") && words.contains("3.5 MPa") && words.contains("2.5 MPa"), "{words}");
        assert!(told(&PAGE.replace("<footer>", "<footer>Really. ")).unwrap().contains("foot"));
        let less = PAGE.replace("<section id=\"accuracy\">x</section>", "");
        assert!(told(&less).unwrap().contains("parts"), "a section is missing");
    }
}
