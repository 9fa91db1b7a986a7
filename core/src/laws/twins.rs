//! For every law there is an implementation that breaks it and nothing before it.

use super::{Law, LawBroken};

/// The report, which must be about this law and say all there is to say.
#[track_caller]
pub(super) fn catches(found: Result<(), LawBroken>, law: &'static Law) -> LawBroken {
    let broken = match found {
        Ok(()) => panic!("nothing was found wrong, expected '{}' of {}", law.name, law.subject),
        Err(broken) => broken,
    };
    assert_eq!((broken.law.subject, broken.law.name), (law.subject, law.name), "{broken}");
    let text = broken.to_string();
    for part in [law.name, law.subject, law.look_for, &broken.input, &broken.found] {
        assert!(!part.is_empty() && text.contains(part), "{text}");
    }
    assert_eq!(text, format!("{broken:?}"));
    broken
}
