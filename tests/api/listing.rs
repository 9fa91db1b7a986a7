//! What can be named from outside a crate, as text.

use crate::modules::{Module, attributes, name};
use std::collections::{BTreeMap, BTreeSet};
use syn::{
    Attribute, Block, Fields, ImplItem, Item, ItemImpl, TraitItem, Type, UseTree, Visibility,
};

/// The public interface of a crate: under the public name of every item its declaration without bodies and documentation,
/// then what is implemented for it.
pub fn listing(name: &str, root: &Module) -> String {
    let mut found = Listing::default();
    found.module(root, root, &mut Vec::new(), &[name.into()]);
    let mut implementations = Vec::new();
    collect(root, &mut implementations);
    let mut text = format!("# {name}\n");
    for (path, declaration) in &found.items {
        text += &format!("\n## {path}\n\n```rust\n{}", declaration.text);
        let of: BTreeSet<String> = implementations
            .iter()
            .filter(|one| {
                is_type(one, &declaration.name)
                    || is_type(one, path.rsplit("::").next().unwrap_or_default())
            })
            .filter_map(|one| implementation(one))
            .collect();
        for one in of {
            text += &one;
        }
        text += "```\n";
    }
    text
}

/// A declaration under the name that it has where it stands.
struct Declaration {
    name: String,
    text: String,
}

#[derive(Default)]
struct Listing {
    items: BTreeMap<String, Declaration>,
}

impl Listing {
    /// Everything public in a module; `inside` is where it stands, `public` how it is called from outside.
    fn module(
        &mut self,
        root: &Module,
        module: &Module,
        inside: &mut Vec<String>,
        public: &[String],
    ) {
        for item in &module.items {
            if let Item::Use(using) = item {
                if matches!(using.vis, Visibility::Public(_)) {
                    self.exports(root, inside, public, &using.tree, &mut Vec::new());
                }
            } else if let Item::Macro(made) = item {
                let exported = made.attrs.iter().any(|a| a.path().is_ident("macro_export"));
                if let (true, Some(ident)) = (exported, &made.ident) {
                    let path = format!("{}::{ident}!", public[0]);
                    self.add(path, ident.to_string(), format!("macro {ident}!\n"));
                }
            } else if let Some((name, Visibility::Public(_))) = name(item) {
                self.item(root, module, item, inside, public, &name);
            }
        }
    }

    /// A public item under the name `public::called`.
    fn item(
        &mut self,
        root: &Module,
        module: &Module,
        item: &Item,
        inside: &mut Vec<String>,
        public: &[String],
        called: &str,
    ) {
        if is_hidden(attributes(item)) {
            return;
        }
        let (own, _) = name(item).unwrap();
        let path = [public, &[called.to_string()]].concat();
        if let Item::Mod(_) = item {
            inside.push(own.clone());
            self.module(root, &module.children[&own], inside, &path);
            inside.pop();
        } else {
            self.add(path.join("::"), own, declaration(item));
        }
    }

    /// What a `pub use` exports: what is found in this crate, under its new name; of another crate the line itself.
    fn exports(
        &mut self,
        root: &Module,
        inside: &[String],
        public: &[String],
        tree: &UseTree,
        path: &mut Vec<String>,
    ) {
        match tree {
            UseTree::Path(step) => {
                path.push(step.ident.to_string());
                self.exports(root, inside, public, &step.tree, path);
                path.pop();
            }
            UseTree::Group(group) => {
                for tree in &group.items {
                    self.exports(root, inside, public, tree, path);
                }
            }
            UseTree::Name(leaf) => {
                let leaf = leaf.ident.to_string();
                self.export(root, inside, public, path, &leaf, &leaf);
            }
            UseTree::Rename(leaf) => {
                let (own, called) = (leaf.ident.to_string(), leaf.rename.to_string());
                self.export(root, inside, public, path, &own, &called);
            }
            UseTree::Glob(_) => match resolve(root, inside, path) {
                Some((module, mut at)) => self.module(root, module, &mut at, public),
                None => self.foreign(public, path, "*", "*"),
            },
        }
    }

    fn export(
        &mut self,
        root: &Module,
        inside: &[String],
        public: &[String],
        path: &[String],
        own: &str,
        called: &str,
    ) {
        let Some((module, mut at)) = resolve(root, inside, path) else {
            return self.foreign(public, path, own, called);
        };
        let found = module
            .items
            .iter()
            .find(|item| name(item).is_some_and(|(name, _)| name == own));
        if let Some(item) = found {
            return self.item(root, module, item, &mut at, public, called);
        }
        // Exported a second time: the module has it from elsewhere.
        for item in &module.items {
            if let Item::Use(using) = item
                && let Some(path) = origin(&using.tree, own)
            {
                let (from, leaf) = path.split_at(path.len() - 1);
                return self.export(root, &at, public, from, &leaf[0], called);
            }
        }
        self.foreign(public, path, own, called);
    }

    fn foreign(&mut self, public: &[String], path: &[String], own: &str, called: &str) {
        let mut line = format!("pub use {}", [path, &[own.to_string()]].concat().join("::"));
        if own != called {
            line += &format!(" as {called}");
        }
        let path = [public, &[called.to_string()]].concat().join("::");
        self.add(path, own.into(), line + ";\n");
    }

    fn add(&mut self, path: String, name: String, text: String) {
        self.items.insert(path, Declaration { name, text });
    }
}

/// The module of this crate that a path leads to, and where it stands.
fn resolve<'a>(
    root: &'a Module,
    inside: &[String],
    path: &[String],
) -> Option<(&'a Module, Vec<String>)> {
    let mut at = inside.to_vec();
    for (k, step) in path.iter().enumerate() {
        match step.as_str() {
            "crate" => at.clear(),
            "self" => {}
            "super" => {
                at.pop();
            }
            name => {
                at.push(name.into());
                if walk(root, &at).is_none() && k == 0 {
                    return None;
                }
            }
        }
    }
    Some((walk(root, &at)?, at))
}

fn walk<'a>(root: &'a Module, path: &[String]) -> Option<&'a Module> {
    path.iter()
        .try_fold(root, |module, name| module.children.get(name))
}

/// The path under which a `use` brings a name, if it does.
fn origin(tree: &UseTree, wanted: &str) -> Option<Vec<String>> {
    match tree {
        UseTree::Path(step) => {
            let mut path = vec![step.ident.to_string()];
            path.extend(origin(&step.tree, wanted)?);
            Some(path)
        }
        UseTree::Group(group) => group.items.iter().find_map(|tree| origin(tree, wanted)),
        UseTree::Name(leaf) => (leaf.ident == wanted).then(|| vec![wanted.into()]),
        UseTree::Rename(leaf) => (leaf.rename == wanted).then(|| vec![leaf.ident.to_string()]),
        UseTree::Glob(_) => None,
    }
}

fn is_hidden(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("doc")
            && attribute
                .parse_args::<syn::Ident>()
                .is_ok_and(|word| word == "hidden")
    })
}

/// Only the attributes that are part of the interface.
fn keep(attributes: &mut Vec<Attribute>) {
    const PUBLIC: [&str; 6] = [
        "derive",
        "non_exhaustive",
        "cfg",
        "repr",
        "must_use",
        "deprecated",
    ];
    attributes.retain(|a| PUBLIC.iter().any(|name| a.path().is_ident(name)));
}

/// An item as it is declared: no body, no documentation, no private field.
fn declaration(item: &Item) -> String {
    let mut item = item.clone();
    let mut private = false;
    match &mut item {
        Item::Const(i) => {
            keep(&mut i.attrs);
            *i.expr = syn::parse_quote!(_);
        }
        Item::Static(i) => {
            keep(&mut i.attrs);
            *i.expr = syn::parse_quote!(_);
        }
        Item::Type(i) => keep(&mut i.attrs),
        Item::Fn(i) => {
            keep(&mut i.attrs);
            *i.block = empty();
        }
        Item::Struct(i) => {
            keep(&mut i.attrs);
            private = only_public(&mut i.fields);
        }
        Item::Enum(i) => {
            keep(&mut i.attrs);
            for variant in &mut i.variants {
                keep(&mut variant.attrs);
                variant.fields.iter_mut().for_each(|f| keep(&mut f.attrs));
            }
        }
        Item::Trait(i) => {
            keep(&mut i.attrs);
            i.items.iter_mut().for_each(required);
        }
        _ => {}
    }
    let mut text = pretty(item);
    if private {
        text += "// and private fields\n";
    }
    text
}

/// A method of a trait keeps whether it has a body, not what is in it.
fn required(item: &mut TraitItem) {
    match item {
        TraitItem::Fn(f) => {
            keep(&mut f.attrs);
            if let Some(body) = &mut f.default {
                *body = empty();
            }
        }
        TraitItem::Const(c) => keep(&mut c.attrs),
        TraitItem::Type(t) => keep(&mut t.attrs),
        _ => {}
    }
}

/// Takes away the fields that are not public, and says whether there were any.
fn only_public(fields: &mut Fields) -> bool {
    let before = fields.len();
    match fields {
        Fields::Named(named) => {
            named.named = named
                .named
                .iter()
                .filter(|f| is_public(&f.vis))
                .cloned()
                .collect();
        }
        Fields::Unnamed(tuple) => {
            // The place of a field of a tuple is its name.
            if tuple.unnamed.iter().any(|f| !is_public(&f.vis)) {
                tuple.unnamed.clear();
            }
        }
        Fields::Unit => {}
    }
    fields.iter_mut().for_each(|f| keep(&mut f.attrs));
    fields.len() < before
}

fn is_public(visibility: &Visibility) -> bool {
    matches!(visibility, Visibility::Public(_))
}

fn empty() -> Block {
    syn::parse_quote!({})
}

fn pretty(item: Item) -> String {
    prettyplease::unparse(&syn::File {
        shebang: None,
        attrs: Vec::new(),
        items: vec![item],
    })
}

fn collect<'a>(module: &'a Module, found: &mut Vec<&'a ItemImpl>) {
    for item in &module.items {
        if let Item::Impl(one) = item {
            found.push(one);
        }
    }
    for child in module.children.values() {
        collect(child, found);
    }
}

/// Whether something is implemented for the type of this name.
fn is_type(one: &ItemImpl, name: &str) -> bool {
    let mut of = &*one.self_ty;
    while let Type::Reference(to) = of {
        of = &to.elem;
    }
    let Type::Path(path) = of else { return false };
    path.path.segments.last().is_some_and(|s| s.ident == name)
}

/// Public methods and constants, or the name of the trait; nothing where there are none.
fn implementation(one: &ItemImpl) -> Option<String> {
    let mut one = one.clone();
    keep(&mut one.attrs);
    if one.trait_.is_some() {
        one.items.clear();
        return Some(pretty(Item::Impl(one)));
    }
    one.items.retain(|item| match item {
        ImplItem::Fn(f) => is_public(&f.vis) && !is_hidden(&f.attrs),
        ImplItem::Const(c) => is_public(&c.vis) && !is_hidden(&c.attrs),
        _ => false,
    });
    for item in &mut one.items {
        match item {
            ImplItem::Fn(f) => {
                keep(&mut f.attrs);
                f.block = empty();
            }
            ImplItem::Const(c) => {
                keep(&mut c.attrs);
                c.expr = syn::parse_quote!(_);
            }
            _ => {}
        }
    }
    (!one.items.is_empty()).then(|| pretty(Item::Impl(one)))
}
