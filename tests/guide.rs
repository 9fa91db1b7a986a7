//! The guide and the pages beside it: every link leads somewhere, and every page is in the table of contents.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// All pages below a folder.
fn pages(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            pages(&path, found);
        } else if path.extension().is_some_and(|e| e == "md") {
            found.push(path);
        }
    }
}

/// A page without its blocks and spans of code.
fn prose(text: &str) -> String {
    let mut out = String::new();
    let mut fenced = false;
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
        } else if !fenced {
            for (k, part) in line.split('`').enumerate() {
                out.push_str(if k % 2 == 0 { part } else { "code" });
            }
        }
        out.push('\n');
    }
    out
}

/// Targets of links and pictures, with their line.
fn links(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for (number, line) in prose(text).lines().enumerate() {
        let mut rest = line;
        while let Some(at) = rest.find("](") {
            rest = &rest[at + 2..];
            let end = rest.find(')').expect("a link ends on its line");
            found.push((number + 1, rest[..end].to_string()));
            rest = &rest[end..];
        }
    }
    found
}

/// The names that a page gives to its headings, as mdBook and code hosts make them.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut fenced = false;
    let mut found = BTreeSet::new();
    for line in text.lines() {
        fenced ^= line.trim_start().starts_with("```");
        let title = line.trim_start_matches('#');
        if !fenced && title.len() < line.len() && title.starts_with(' ') {
            let kept = |c: &char| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_');
            let name: String = title.trim().chars().filter(kept).collect();
            found.insert(name.to_lowercase().replace(' ', "-"));
        }
    }
    found
}

#[test]
fn every_link_leads_somewhere() {
    let mut all = Vec::new();
    pages(&root().join("docs"), &mut all);
    for name in [
        "README.md",
        "CHANGELOG.md",
        "CONTRIBUTING.md",
        "python/README.md",
    ] {
        all.push(root().join(name));
    }
    let (mut checked, mut broken) = (0, Vec::new());
    for page in &all {
        let text = fs::read_to_string(page).unwrap();
        for (line, target) in links(&text) {
            if target.contains("://") {
                continue;
            }
            let (file, anchor) = target.split_once('#').unwrap_or((&target, ""));
            let file = match file {
                "" => page.clone(),
                file => page.parent().unwrap().join(file),
            };
            let there = file.exists()
                && (anchor.is_empty()
                    || anchors(&fs::read_to_string(&file).unwrap()).contains(anchor));
            checked += 1;
            if !there {
                broken.push(format!("{}:{line}: {target}", page.display()));
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
    assert!(checked > 150, "{checked}");
}

#[test]
fn the_table_of_contents_has_every_page_once() {
    let source = root().join("docs/src");
    let contents = fs::read_to_string(source.join("SUMMARY.md")).unwrap();
    let mut listed: Vec<PathBuf> = links(&contents)
        .into_iter()
        .map(|(_, target)| source.join(target))
        .collect();
    let mut there = Vec::new();
    pages(&source, &mut there);
    there.retain(|page| !page.ends_with("SUMMARY.md"));
    listed.sort();
    there.sort();
    assert_eq!(listed, there);
}

#[test]
fn pictures_of_the_guide_are_shown_somewhere() {
    let mut all = Vec::new();
    pages(&root().join("docs"), &mut all);
    all.push(root().join("README.md"));
    let text: String = all.iter().map(|p| fs::read_to_string(p).unwrap()).collect();
    let mut folders = vec![root().join("docs/src/images")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let name = path.file_name().unwrap().to_str().unwrap();
            assert!(text.contains(name), "{}", path.display());
        }
    }
}
