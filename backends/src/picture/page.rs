//! stub
use super::Scene;
use crosscap_core::Error;
/// stub
pub fn page(scene: &Scene) -> Result<String, Error> {
    scene.check()?;
    Ok("<!DOCTYPE html>".into())
}
