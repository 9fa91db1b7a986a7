//! Facade of Crosscap.
