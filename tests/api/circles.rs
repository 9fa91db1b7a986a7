//! Which files import each other, read from their sources.

use super::modules::Module;
use std::collections::{BTreeMap, BTreeSet};
use syn::{Item, ItemUse, UseTree, Visibility};

/// A path, from the root of the crate.
type Path = Vec<String>;

/// The modules of a crate with the paths that each of them names.
#[derive(Default)]
struct Names {
    modules: BTreeSet<Path>,
    /// What a name of a module stands for, where it was imported there.
    imported: BTreeMap<Path, Path>,
    named: BTreeMap<Path, BTreeSet<Path>>,
}

/// Groups of modules that cannot be understood without each other: each imports from another one, and so back to the
/// first. Handing something on (`pub use`) is no import.
pub fn circles(root: &Module) -> Vec<BTreeSet<String>> {
    let mut names = Names::default();
    names.list(root, &Path::new());
    names.read(root, &Path::new());
    let edges: BTreeMap<&Path, BTreeSet<Path>> = (names.modules.iter())
        .map(|module| (module, names.imports(module)))
        .collect();
    let reached = |from: &Path| {
        let mut seen = BTreeSet::new();
        let mut open = vec![from.clone()];
        while let Some(at) = open.pop() {
            for next in &edges[&at] {
                if seen.insert(next.clone()) {
                    open.push(next.clone());
                }
            }
        }
        seen
    };
    let reach: BTreeMap<&Path, BTreeSet<Path>> =
        names.modules.iter().map(|m| (m, reached(m))).collect();
    let mut found: Vec<BTreeSet<String>> = Vec::new();
    for module in names.modules.iter().filter(|&m| reach[m].contains(m)) {
        let circle = reach[module].iter().filter(|m| reach[*m].contains(module));
        let circle: BTreeSet<String> = circle.map(|m| m.join("::")).collect();
        if !found.contains(&circle) {
            found.push(circle);
        }
    }
    found
}

impl Names {
    fn list(&mut self, module: &Module, at: &Path) {
        self.modules.insert(at.clone());
        for (name, child) in &module.children {
            self.list(child, &[&at[..], std::slice::from_ref(name)].concat());
        }
    }

    fn read(&mut self, module: &Module, at: &Path) {
        for item in &module.items {
            match item {
                Item::Use(item) => self.import(item, at),
                // Its items are read as those of a module of their own.
                Item::Mod(_) => {}
                _ => self.scan(item, at),
            }
        }
        for (name, child) in &module.children {
            self.read(child, &[&at[..], std::slice::from_ref(name)].concat());
        }
    }

    fn import(&mut self, item: &ItemUse, at: &Path) {
        let mut leaves = Vec::new();
        spread(&item.tree, &Path::new(), &mut leaves);
        for (path, name) in leaves {
            let Some(path) = self.absolute(&path, at) else {
                continue;
            };
            if matches!(item.vis, Visibility::Inherited) {
                self.name(at, path.clone());
            }
            self.imported.insert([&at[..], &[name]].concat(), path);
        }
    }

    /// Paths in the text of an item that begin at the root, with a module above or with one inside.
    fn scan(&mut self, item: &Item, at: &Path) {
        let text = prettyplease::unparse(&syn::File {
            shebang: None,
            attrs: Vec::new(),
            items: vec![item.clone()],
        });
        let code = text
            .lines()
            .filter(|line| !line.trim_start().starts_with("//"));
        for line in code {
            // Who may see an item is no import.
            let line = match line.split_once("pub(in ") {
                Some((_, rest)) => rest.split_once(')').map_or("", |x| x.1),
                None => line,
            };
            let words = line.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':'));
            for word in words {
                let path: Path = word.split("::").map(String::from).collect();
                if path.len() > 1
                    && let Some(path) = self.absolute(&path, at)
                {
                    self.name(at, path);
                }
            }
        }
    }

    fn name(&mut self, at: &Path, path: Path) {
        self.named.entry(at.clone()).or_default().insert(path);
    }

    /// A path from the root of the crate; `None` for one into another crate.
    fn absolute(&self, path: &[String], at: &Path) -> Option<Path> {
        let mut base = at.clone();
        let mut rest = path;
        if path.first()? == "crate" {
            return Some(path[1..].to_vec());
        }
        if path[0] == "self" {
            rest = &rest[1..];
        }
        let own = rest.len() < path.len();
        let above = rest.iter().take_while(|part| *part == "super").count();
        base.truncate(base.len().saturating_sub(above));
        rest = &rest[above..];
        let there = [&base[..], rest].concat();
        let inside = rest.first().is_some_and(|part| {
            self.modules
                .contains(&[&base[..], std::slice::from_ref(part)].concat())
        });
        (own || above > 0 || inside).then_some(there)
    }

    /// The modules that a module imports from, itself left out.
    fn imports(&self, module: &Path) -> BTreeSet<Path> {
        let named = self.named.get(module).into_iter().flatten();
        let owners = named.map(|path| self.owner(path.clone()));
        owners.filter(|owner| owner != module).collect()
    }

    /// The module that has what a path names, however it was handed on.
    fn owner(&self, mut path: Path) -> Path {
        for _ in 0..16 {
            let length = (0..=path.len())
                .rev()
                .find(|&k| self.modules.contains(&path[..k]));
            let (owner, rest) = path.split_at(length.unwrap_or(0));
            let Some(first) = rest.first() else {
                break;
            };
            let key = [owner, std::slice::from_ref(first)].concat();
            let Some(target) = self.imported.get(&key) else {
                return owner.to_vec();
            };
            path = [&target[..], &rest[1..]].concat();
        }
        path
    }
}

/// The single paths of a tree of imports, each with the name that it gets.
fn spread(tree: &UseTree, before: &Path, out: &mut Vec<(Path, String)>) {
    let with = |name: &syn::Ident| [&before[..], &[name.to_string()]].concat();
    match tree {
        UseTree::Path(path) => spread(&path.tree, &with(&path.ident), out),
        UseTree::Name(name) if name.ident == "self" => {
            out.extend(before.last().map(|last| (before.clone(), last.clone())));
        }
        UseTree::Name(name) => out.push((with(&name.ident), name.ident.to_string())),
        UseTree::Rename(name) => out.push((with(&name.ident), name.rename.to_string())),
        UseTree::Group(group) => group
            .items
            .iter()
            .for_each(|tree| spread(tree, before, out)),
        UseTree::Glob(_) => out.push((before.clone(), "*".into())),
    }
}
