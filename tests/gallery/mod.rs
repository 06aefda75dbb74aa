//! The gallery's pictures, from the committed manifests: what each of them says that one sees is measured.

mod ours;
mod ours_light;
