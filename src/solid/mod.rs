//! Shapes without a file: exact closed bodies, and those cut out of and joined from them.
//!
//! Nothing is made of triangles: a lens keeps its normals, a plane has no end, and nothing is lost between facets.
//! A solid is a list of placed shapes, its leaves, and an expression over them; a line is inside each leaf
//! along one span at most, and `sweep` counts its way through the ends of these spans.

mod span;
mod surface;
mod sweep;

pub use surface::Facet;
pub use sweep::Crossing;

use crate::tree::{Bounds, Line};
use glam::{DAffine3, DMat3, DVec3};
use surface::EVERYWHERE;

/// A shape in its own coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// The half space y <= 0. Its texture: u = x, v = z.
    Plane,
    /// Radius 1 about the origin. Its texture: u = longitude / 2π, 0 at +x and 1/4 at -z; v = 0 at +y, 1 at -y.
    Sphere,
    /// |x|, |y|, |z| <= 1/2. Each face has the whole texture, upright at the sides; faces: -x, +x, -y, +y, -z, +z.
    Box,
    /// x² + z² <= 1, |y| <= 1/2. The side (face 0) has the whole texture, u as on the sphere, v = 0 at the top;
    /// top (1) and bottom (2) have the disk that fits into it.
    Cylinder,
    /// A disk of radius 1 at y = -1/2 and all that is between it and the apex at y = 1/2. Textures as on the cylinder.
    Cone,
}

/// Above all gates.
const NONE: u32 = u32::MAX;

/// What a leaf or a gate counts for.
#[derive(Debug, Clone, Copy)]
struct Slot {
    // The gate, or `NONE` for the whole solid.
    gate: u32,
    // Whether what is meant is all that is not it.
    complement: bool,
}

#[derive(Debug, Clone)]
struct Leaf {
    shape: Shape,
    slot: Slot,
    // Whether the shape's inside is the solid's outside: an odd number of complements on the way up.
    turned: bool,
    solid_from_own: DAffine3,
    own_from_solid: DAffine3,
    solid_from_own_normals: DMat3,
}

impl Leaf {
    /// None if the map cannot be undone.
    fn place(&mut self, solid_from_own: DAffine3) -> Option<()> {
        let own_from_solid = solid_from_own.inverse();
        self.solid_from_own_normals = own_from_solid.matrix3.transpose();
        (self.solid_from_own, self.own_from_solid) = (solid_from_own, own_from_solid);
        (solid_from_own.is_finite() && own_from_solid.is_finite()).then_some(())
    }

    #[inline]
    fn line(&self, line: &Line) -> Line {
        Line {
            origin: self.own_from_solid.transform_point3(line.origin),
            step: self.own_from_solid.transform_vector3(line.step),
        }
    }
}

/// True where at least so many of its members are; members come before the gates that they count for.
#[derive(Debug, Clone, Copy)]
struct Gate {
    slot: Slot,
    needs: u32,
    // How many of its members are true where no leaf is.
    resting: u32,
}

/// A closed body, perhaps without end: leaves joined, in what they have in common, or cut out of others.
///
/// Leaves are numbered in the order in which they were mentioned.
#[derive(Debug, Clone)]
pub struct Solid {
    leaves: Vec<Leaf>,
    gates: Vec<Gate>,
    bounds: Bounds,
    // Whether it holds what is far from all leaves.
    resting: bool,
    // Amid the leaves.
    centre: DVec3,
    // The largest coordinate that a leaf was placed by.
    size: f64,
}

impl From<Shape> for Solid {
    fn from(shape: Shape) -> Self {
        let leaf = Leaf {
            shape,
            slot: Slot { gate: NONE, complement: false },
            turned: false,
            solid_from_own: DAffine3::IDENTITY,
            own_from_solid: DAffine3::IDENTITY,
            solid_from_own_normals: DMat3::IDENTITY,
        };
        Self::sealed(vec![leaf], Vec::new())
    }
}

impl Solid {
    /// The solid moved, turned, scaled, mirrored or sheared; none if the map cannot be undone.
    pub fn placed(mut self, outer_from_own: DAffine3) -> Option<Self> {
        for leaf in &mut self.leaves {
            leaf.place(outer_from_own * leaf.solid_from_own)?;
        }
        Some(Self::sealed(self.leaves, self.gates))
    }

    /// All points of any member. Without members: nothing.
    pub fn union(members: impl IntoIterator<Item = Self>) -> Self {
        Self::gated(members, |_| 1)
    }

    /// The points that all members have in common. Without members: everything.
    pub fn intersection(members: impl IntoIterator<Item = Self>) -> Self {
        Self::gated(members, |members| members)
    }

    /// What is left without the parts.
    pub fn difference(self, parts: impl IntoIterator<Item = Self>) -> Self {
        Self::intersection(std::iter::once(self).chain(parts.into_iter().map(Self::complement)))
    }

    /// All points that are not of it.
    pub fn complement(mut self) -> Self {
        if let Some(slot) = self.root() {
            slot.complement = !slot.complement;
        }
        self.leaves.iter_mut().for_each(|leaf| leaf.turned = !leaf.turned);
        Self::sealed(self.leaves, self.gates)
    }

    fn root(&mut self) -> Option<&mut Slot> {
        match self.gates.last_mut() {
            Some(gate) => Some(&mut gate.slot),
            None => self.leaves.first_mut().map(|leaf| &mut leaf.slot),
        }
    }

    fn gated(members: impl IntoIterator<Item = Self>, needs: fn(u32) -> u32) -> Self {
        let mut members: Vec<Self> = members.into_iter().collect();
        if members.len() == 1 {
            return members.swap_remove(0);
        }
        let top = members.iter().map(|member| member.gates.len() as u32).sum();
        let count = members.len() as u32;
        let (mut leaves, mut gates) = (Vec::new(), Vec::new());
        for member in members {
            let below = gates.len() as u32;
            let raised =
                |slot: Slot| Slot { gate: if slot.gate == NONE { top } else { slot.gate + below }, ..slot };
            leaves.extend(member.leaves.into_iter().map(|leaf| Leaf { slot: raised(leaf.slot), ..leaf }));
            gates.extend(member.gates.into_iter().map(|gate| Gate { slot: raised(gate.slot), ..gate }));
        }
        let slot = Slot { gate: NONE, complement: false };
        gates.push(Gate { slot, needs: needs(count), resting: 0 });
        Self::sealed(leaves, gates)
    }

    /// With all that follows from leaves and gates.
    fn sealed(leaves: Vec<Leaf>, gates: Vec<Gate>) -> Self {
        let places = leaves.iter().map(|leaf| leaf.solid_from_own.translation);
        let centre = places.sum::<DVec3>() / leaves.len().max(1) as f64;
        let size = leaves.iter().map(|leaf| {
            let [x, y, z] = leaf.solid_from_own.matrix3.to_cols_array_2d().map(|c| DVec3::from(c).length());
            leaf.solid_from_own.translation.length() + x + y + z
        });
        let size = size.fold(0.0, f64::max);
        let mut solid = Self { leaves, gates, bounds: EVERYWHERE, resting: false, centre, size };
        solid.resting = solid.rest();
        solid.bounds = solid.extent();
        solid
    }

    /// Counts the gates' members with no leaf true.
    fn rest(&mut self) -> bool {
        self.gates.iter_mut().for_each(|gate| gate.resting = 0);
        let mut whole = false;
        let mut count = |gates: &mut [Gate], slot: Slot, value: bool| {
            let value = value != slot.complement;
            match gates.get_mut(slot.gate as usize) {
                Some(gate) => gate.resting += u32::from(value),
                None => whole = value,
            }
        };
        for leaf in &self.leaves {
            count(&mut self.gates, leaf.slot, false);
        }
        for number in 0..self.gates.len() {
            let gate = self.gates[number];
            count(&mut self.gates, gate.slot, gate.resting >= gate.needs);
        }
        whole
    }

    /// Of each gate the box and that of its complement, from the leaves up.
    fn extent(&self) -> Bounds {
        let meet = |a: Bounds, b: Bounds| Bounds { lo: a.lo.max(b.lo), hi: a.hi.min(b.hi) };
        let start = |gate: &Gate| {
            if gate.needs == 1 { [Bounds::EMPTY, EVERYWHERE] } else { [EVERYWHERE, Bounds::EMPTY] }
        };
        let mut boxes: Vec<[Bounds; 2]> = self.gates.iter().map(start).collect();
        let mut whole = EVERYWHERE;
        let mut add = |boxes: &mut [[Bounds; 2]], slot: Slot, own: [Bounds; 2]| {
            let [own, other] = if slot.complement { [own[1], own[0]] } else { own };
            match boxes.get_mut(slot.gate as usize) {
                None => whole = own,
                Some(sum) if self.gates[slot.gate as usize].needs == 1 => {
                    *sum = [sum[0].with(own), meet(sum[1], other)];
                }
                Some(sum) => *sum = [meet(sum[0], own), sum[1].with(other)],
            }
        };
        for leaf in &self.leaves {
            add(&mut boxes, leaf.slot, leaf.shape.extents(&leaf.solid_from_own, &leaf.own_from_solid));
        }
        for (number, gate) in self.gates.iter().enumerate() {
            let own = boxes[number];
            add(&mut boxes, gate.slot, own);
        }
        if whole.lo.cmpgt(whole.hi).any() {
            return Bounds { lo: DVec3::ZERO, hi: DVec3::ZERO };
        }
        let pad = sweep::ROUNDING * self.size;
        Bounds { lo: whole.lo - pad, hi: whole.hi + pad }
    }

    /// A box that holds it, infinite where it has no end; finite for what has no points at all.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Whether its box is finite.
    pub fn bounded(&self) -> bool {
        self.bounds.lo.is_finite() && self.bounds.hi.is_finite()
    }

    /// The shape of each leaf.
    pub fn shapes(&self) -> impl ExactSizeIterator<Item = Shape> {
        self.leaves.iter().map(|leaf| leaf.shape)
    }

    /// Whether the point is inside; on a surface either may be found.
    pub fn contains(&self, point: DVec3) -> bool {
        let mut counts: Vec<u32> = self.gates.iter().map(|gate| gate.resting).collect();
        let mut inside = self.resting;
        for leaf in &self.leaves {
            if leaf.shape.contains(leaf.own_from_solid.transform_point3(point)) {
                inside = self.toggle(&mut counts, leaf.slot, true).unwrap_or(inside);
            }
        }
        inside
    }

    /// The surface at a crossing of this solid, `point` being the line's point there as well as it is known.
    pub fn surface_at(&self, crossing: &Crossing, point: DVec3) -> Facet {
        let leaf = &self.leaves[crossing.leaf as usize];
        let own = leaf.shape.facet(crossing.face, leaf.own_from_solid.transform_point3(point));
        let normal = leaf.solid_from_own_normals * own.normal;
        // Its square might not be a number, for it goes with one over the size.
        let normal = (normal / normal.abs().max_element()).normalize_or(DVec3::Y);
        Facet {
            place: leaf.solid_from_own.transform_point3(own.place),
            normal: if leaf.turned { -normal } else { normal },
            uv: own.uv,
            tangent_u: leaf.solid_from_own.transform_vector3(own.tangent_u),
            tangent_v: leaf.solid_from_own.transform_vector3(own.tangent_v),
        }
    }
}
