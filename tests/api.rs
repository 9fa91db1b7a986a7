//! The public interface of every crate, listed in `docs/api` and compared: what a release changes for those who build on it
//! stands in the difference of these files.
//!
//! `CROSSCAP_BLESS=1 cargo test --test api` writes them anew. They are read off the documentation, whose words for a
//! signature do not depend on where an item is defined and from where it is exported again.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const CRATES: [&str; 4] = [
    "crosscap_core",
    "crosscap_algorithms",
    "crosscap_backends",
    "crosscap",
];

/// Makes the documentation, and returns its folder.
fn documentation(root: &Path) -> PathBuf {
    let made = Command::new(env!("CARGO"))
        .current_dir(root)
        // As the continuous integration makes it, so that it is made once.
        .env("RUSTDOCFLAGS", "-D warnings")
        .args([
            "doc",
            "--workspace",
            "--no-deps",
            "--quiet",
            "--message-format=json",
        ])
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&made.stderr);
    assert!(made.status.success(), "{told}");
    let about = Command::new(env!("CARGO"))
        .current_dir(root)
        .args(["metadata", "--format-version=1", "--no-deps", "--offline"])
        .output()
        .unwrap();
    let about: serde_json::Value = serde_json::from_slice(&about.stdout).unwrap();
    Path::new(about["target_directory"].as_str().unwrap()).join("doc")
}

/// The text of HTML in one line.
fn text(html: &str) -> String {
    let mut out = String::new();
    let mut inside = false;
    for c in html.chars() {
        match c {
            '<' => inside = true,
            '>' => inside = false,
            c if !inside => out.push(c),
            _ => {}
        }
    }
    for (coded, plain) in [
        ("&lt;", "<"),
        ("&gt;", ">"),
        ("&quot;", "\""),
        ("&#39;", "'"),
        ("&nbsp;", " "),
        ("&amp;", "&"),
    ] {
        out = out.replace(coded, plain);
    }
    out.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// What stands between two marks, wherever they are.
fn between<'a>(page: &'a str, open: &str, close: &str) -> Vec<&'a str> {
    let parts = page.split(open).skip(1);
    parts.filter_map(|part| part.split(close).next()).collect()
}

/// The lines of one item: its declaration, its own methods and constants, the traits that it has.
fn item(page: &str, path: &str, lines: &mut BTreeSet<String>) {
    // What every type has is no interface of its own.
    let own = page
        .split("id=\"synthetic-implementations\"")
        .next()
        .unwrap_or(page);
    for declaration in between(own, "<pre class=\"rust item-decl\"><code>", "</code></pre>") {
        // Remarks of the documentation on fields that are not shown.
        let told = text(declaration).replace("/* private fields */", "..");
        lines.insert(format!("{path}: {told}"));
    }
    for method in between(own, "<h4 class=\"code-header\">", "</h4>") {
        let told = text(method);
        if told.starts_with("pub ") {
            lines.insert(format!("{path}: {told}"));
        }
    }
    let traits = own
        .split("id=\"trait-implementations-list\"")
        .nth(1)
        .unwrap_or_default();
    for implemented in between(traits, "<h3 class=\"code-header\">", "</h3>") {
        lines.insert(format!("{path}: {}", text(implemented)));
    }
}

/// All lines of a crate.
fn listing(documentation: &Path, name: &str) -> String {
    let folder = documentation.join(name);
    let all = fs::read_to_string(folder.join("all.html")).unwrap();
    let main = all.split("id=\"main-content\"").nth(1).unwrap();
    let mut lines = BTreeSet::new();
    for link in between(main, "<a href=\"", "\"") {
        let Ok(page) = fs::read_to_string(folder.join(link)) else {
            continue;
        };
        let (module, file) = link.rsplit_once('/').unwrap_or(("", link));
        let path = format!("{module}/{}", file.split('.').nth(1).unwrap_or(file));
        let path = format!("{name}/{}", path.trim_start_matches('/')).replace('/', "::");
        item(&page, &path, &mut lines);
    }
    lines
        .into_iter()
        .fold(String::new(), |all, line| all + &line + "\n")
}

#[test]
fn the_public_interface_is_as_listed() {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let documentation = documentation(&root);
    let mut changed = Vec::new();
    for name in CRATES {
        let found = listing(&documentation, name);
        assert!(found.lines().count() > 50, "{name}: {found}");
        let path = root.join("docs/api").join(format!("{name}.txt"));
        if std::env::var_os("CROSSCAP_BLESS").is_some() {
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(&path, found).unwrap();
            continue;
        }
        let listed = fs::read_to_string(&path).unwrap_or_default();
        let [old, new] = [&listed, &found].map(|text| text.lines().collect::<BTreeSet<_>>());
        changed.extend(old.difference(&new).map(|line| format!("- {line}")));
        changed.extend(new.difference(&old).map(|line| format!("+ {line}")));
    }
    assert!(
        changed.is_empty(),
        "the public interface has changed; if that is meant: CROSSCAP_BLESS=1 cargo test --test api, and a line in CHANGELOG.md\n{}",
        changed.join("\n")
    );
}
