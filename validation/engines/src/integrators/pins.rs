//! The libraries' versions: the pins of this package's manifest. A test holds them equal to
//! Cargo.lock.

const MANIFEST: &str = include_str!("../../Cargo.toml");

/// The pinned version of a dependency; empty if it is not pinned, and then the engine is refused.
#[must_use]
pub(super) fn version(library: &str) -> String {
    let manifest: toml::Table = MANIFEST.parse().unwrap_or_default();
    let dependency = manifest.get("dependencies").and_then(|all| all.get(library));
    let wanted = dependency.and_then(|it| it.as_str().or_else(|| it.get("version")?.as_str()));
    wanted.and_then(|text| text.strip_prefix('=')).unwrap_or_default().trim().to_owned()
}

#[cfg(test)]
mod tests {
    #[test]
    fn pins_are_what_is_locked() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../Cargo.lock");
        // Absent where the package stands alone, as under `cargo package`.
        let Ok(text) = std::fs::read_to_string(path) else { return };
        let lock: toml::Table = text.parse().unwrap_or_default();
        let locked = |name: &str| {
            let packages = lock.get("package")?.as_array()?;
            let package = packages
                .iter()
                .find(|it| it.get("name").and_then(toml::Value::as_str) == Some(name))?;
            package.get("version")?.as_str().map(str::to_owned)
        };
        for engine in super::super::all() {
            let declaration = engine.declaration();
            assert_eq!(
                Some(&declaration.version),
                locked(declaration.library).as_ref(),
                "{}",
                declaration.name
            );
        }
    }
}
