//! The modules of a crate, read from its files.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use syn::{Attribute, Item, Visibility};

/// A module: its items, and the modules in it by name.
pub struct Module {
    pub items: Vec<Item>,
    pub children: BTreeMap<String, Module>,
}

impl Module {
    /// The crate whose root is this file.
    pub fn read(root: &Path) -> Self {
        Self::parse(&fs::read_to_string(root).unwrap(), root)
    }

    /// The module of this text, which stands in this file.
    pub fn parse(text: &str, file: &Path) -> Self {
        let parsed = syn::parse_file(text).unwrap();
        Self::of(parsed.items, &folder_of(file))
    }

    /// A module of these items, whose children have their files in a folder.
    fn of(items: Vec<Item>, folder: &Path) -> Self {
        let mut module = Self {
            items: Vec::new(),
            children: BTreeMap::new(),
        };
        for item in items {
            if is_for_tests(attributes(&item)) {
                continue;
            }
            if let Item::Mod(child) = &item {
                let name = child.ident.to_string();
                let own = folder.join(&name);
                let made = match &child.content {
                    Some((_, items)) => Self::of(items.clone(), &own),
                    None => Self::read(&file_of(folder, &name)),
                };
                module.children.insert(name, made);
            }
            module.items.push(item);
        }
        module
    }
}

fn folder_of(file: &Path) -> PathBuf {
    let parent = file.parent().unwrap();
    match file.file_stem().unwrap().to_str().unwrap() {
        "lib" | "mod" | "main" => parent.into(),
        name => parent.join(name),
    }
}

fn file_of(folder: &Path, name: &str) -> PathBuf {
    let flat = folder.join(format!("{name}.rs"));
    if flat.exists() {
        flat
    } else {
        folder.join(name).join("mod.rs")
    }
}

fn is_for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg")
            && attribute
                .parse_args::<syn::Ident>()
                .is_ok_and(|condition| condition == "test")
    })
}

/// The attributes of an item.
pub fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(i) => &i.attrs,
        Item::Enum(i) => &i.attrs,
        Item::Fn(i) => &i.attrs,
        Item::Impl(i) => &i.attrs,
        Item::Macro(i) => &i.attrs,
        Item::Mod(i) => &i.attrs,
        Item::Static(i) => &i.attrs,
        Item::Struct(i) => &i.attrs,
        Item::Trait(i) => &i.attrs,
        Item::Type(i) => &i.attrs,
        Item::Use(i) => &i.attrs,
        _ => &[],
    }
}

/// Name and visibility of an item that can be named from elsewhere.
pub fn name(item: &Item) -> Option<(String, &Visibility)> {
    let (ident, visibility) = match item {
        Item::Const(i) => (&i.ident, &i.vis),
        Item::Enum(i) => (&i.ident, &i.vis),
        Item::Fn(i) => (&i.sig.ident, &i.vis),
        Item::Mod(i) => (&i.ident, &i.vis),
        Item::Static(i) => (&i.ident, &i.vis),
        Item::Struct(i) => (&i.ident, &i.vis),
        Item::Trait(i) => (&i.ident, &i.vis),
        Item::Type(i) => (&i.ident, &i.vis),
        _ => return None,
    };
    Some((ident.to_string(), visibility))
}
