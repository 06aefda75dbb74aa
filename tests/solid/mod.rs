//! Solids are closed, agree with the points that they are said to be made of, and keep to the algebra of sets.

mod cases;
mod laws;
mod sets;
