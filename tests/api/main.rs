//! The public interface of every crate stands in `docs/api`, and this test compares: what a release changes for those who build
//! on it can be read off the difference of these files.
//!
//! `CROSSCAP_BLESS=1 cargo test --test api` writes them anew. The listing is read off the sources, so that it is the same
//! for every toolchain; what a macro makes is not in it.

mod circles;
mod listing;
mod modules;

use circles::circles;
use listing::listing;
use modules::Module;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Name of a crate and the folder of its sources.
const CRATES: [(&str, &str); 4] = [
    ("crosscap_core", "core/src"),
    ("crosscap_algorithms", "algorithms/src"),
    ("crosscap_backends", "backends/src"),
    ("crosscap", "src"),
];

fn lines(text: &str) -> BTreeSet<&str> {
    text.lines().collect()
}

#[test]
fn the_public_interface_is_as_listed() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut changed = String::new();
    for (name, sources) in CRATES {
        let found = listing(name, &Module::read(&root.join(sources).join("lib.rs")));
        let listed = root.join("docs/api").join(format!("{name}.md"));
        if std::env::var_os("CROSSCAP_BLESS").is_some() {
            fs::create_dir_all(listed.parent().unwrap()).unwrap();
            fs::write(&listed, &found).unwrap();
        }
        let before = fs::read_to_string(&listed).unwrap_or_default();
        if before != found {
            changed += &format!("{name}:\n");
            for line in lines(&before).difference(&lines(&found)) {
                changed += &format!("- {line}\n");
            }
            for line in lines(&found).difference(&lines(&before)) {
                changed += &format!("+ {line}\n");
            }
        }
    }
    assert!(
        changed.is_empty(),
        "the public interface has changed; if that is meant, write it down in CHANGELOG.md, and \
         list it anew with `CROSSCAP_BLESS=1 cargo test --test api`\n{changed}"
    );
}

#[test]
fn files_import_each_other_in_no_circle() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (name, sources) in CRATES {
        let found = circles(&Module::read(&root.join(sources).join("lib.rs")));
        assert!(found.is_empty(), "{name}: {found:?}");
    }
}

#[test]
fn a_circle_is_found_through_what_is_handed_on() {
    let circle = |inner: &str| {
        let source = format!(
            "mod one {{ use super::Two; pub struct One(Two); }}
             mod two {{ {inner} pub struct Two; }}
             pub use one::One; pub use two::Two;"
        );
        circles(&Module::parse(&source, Path::new("lib.rs")))
    };
    assert!(circle("").is_empty());
    for inner in ["use crate::One;", "fn ask(x: super::one::One) {}"] {
        let found = circle(inner);
        assert_eq!(found.len(), 1, "{inner}: {found:?}");
        assert!(found[0].contains("one") && found[0].contains("two"));
    }
    // A module that calls into one inside it, which asks for what stands outside.
    let inside = "mod outer { mod inner { use super::Own; pub fn ask(_: Own) {} } pub struct Own; fn call() { inner::ask(Own) } }";
    let found = circles(&Module::parse(inside, Path::new("lib.rs")));
    assert_eq!(found.len(), 1, "{found:?}");
}

#[test]
fn private_things_are_not_listed_and_exported_ones_are_under_their_public_name() {
    let source = "
        mod room { pub struct Inner { pub seen: u8, hidden: u8 } impl Inner { pub fn ask(&self) -> u8 { 3 } fn own(&self) {} } struct Secret; pub struct Unreachable; }
        pub mod open { pub(crate) fn within() {} pub fn all() {} #[cfg(test)] pub fn tests() {} }
        pub use room::Inner as Outer;
        impl Clone for Outer { fn clone(&self) -> Self { todo!() } }
        pub use elsewhere::Thing;
    ";
    let found = listing("made", &Module::parse(source, Path::new("lib.rs")));
    for listed in [
        "## made::Outer",
        "pub seen: u8",
        "private fields",
        "pub fn ask(&self) -> u8",
        "impl Clone for Outer",
        "pub fn all()",
        "pub use elsewhere::Thing",
    ] {
        assert!(found.contains(listed), "{listed} in\n{found}");
    }
    for private in ["hidden", "own", "Secret", "Unreachable", "within", "tests"] {
        assert!(!found.contains(private), "{private} in\n{found}");
    }
}
