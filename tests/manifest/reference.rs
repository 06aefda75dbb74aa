//! The reference that users read is the one that the program reads by.

#[test]
fn reference_is_current() {
    crate::support::is_current("manifests/REFERENCE.md", &terrell::manifest::reference(), "reference");
}
