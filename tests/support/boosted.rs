//! Everything as the lab sees it that moves with a velocity in the old lab.

use super::{Body, Eye, Heaven, Lantern, Stage};
use glam::{DAffine3, DQuat, DVec3};
use terrell::lamp::Beam;
use terrell::observer::Aim;
use terrell::spacetime::{Boost, Event, Lab, Lorentz, Poincare, Rest, SightRay, Velocity};

/// The new lab's view of an event.
pub(crate) fn event(boost: Velocity, event: Event) -> Event {
    Event::ORIGIN + Boost::<Lab, Lab>::to_moving(boost) * (event - Event::ORIGIN)
}

/// The new lab's velocity of something, and the turn that takes coordinates of its rest frame with the old axes
/// to ones with axes that are the pure boost of the new lab's.
pub(crate) fn velocity(boost: Velocity, velocity: Velocity) -> (Velocity, DQuat) {
    let lab_from_new = Lorentz::from(Boost::<Lab, Lab>::to_moving(boost)).inverse();
    let rest_from_new = Lorentz::from(Boost::<Rest, Lab>::to_moving(velocity)) * lab_from_new;
    let (velocity, turn) = rest_from_new.boost_then_rotation();
    (velocity, turn.inverse())
}

fn body(boost: Velocity, body: &Body) -> Body {
    let mut body = body.clone();
    let (moves, turn) = velocity(boost, body.placement.velocity);
    body.placement.origin = event(boost, body.placement.origin);
    body.placement.velocity = moves;
    body.mapped(DAffine3::from_quat(turn))
}

fn lantern(boost: Velocity, lantern: &Lantern) -> Lantern {
    let (moves, turn) = velocity(boost, lantern.velocity);
    let beam = match lantern.beam {
        Beam::Point { place } => Beam::Point { place: turn * place },
        Beam::Spot { place, axis, cos_inner, cos_outer } => {
            Beam::Spot { place: turn * place, axis: turn * axis, cos_inner, cos_outer }
        }
        Beam::Sun { axis } => Beam::Sun { axis: turn * axis },
    };
    Lantern { origin: event(boost, lantern.origin), velocity: moves, beam, light: lantern.light.clone() }
}

fn heaven(boost: Velocity, heaven: &Heaven) -> Heaven {
    let (moves, turn) = velocity(boost, heaven.velocity);
    heaven.clone().turned(turn).moving(moves)
}

/// Bodies, lamps and what is infinitely far away.
pub(crate) fn stage(boost: Velocity, stage: &Stage) -> Stage {
    Stage {
        bodies: stage.bodies.iter().map(|b| body(boost, b)).collect(),
        lamps: stage.lamps.iter().map(|l| lantern(boost, l)).collect(),
        skies: stage.skies.iter().map(|sky| heaven(boost, sky)).collect(),
        ..stage.clone()
    }
}

/// The observer.
pub(crate) fn eye(boost: Velocity, eye: &Eye) -> Eye {
    let (moves, turn) = velocity(boost, eye.velocity);
    let aim = match eye.aim {
        Aim::Along(direction) => Aim::Along(direction),
        Aim::At { rest_from_lab, place } => target(boost, rest_from_lab, place),
    };
    Eye {
        origin: event(boost, eye.origin),
        velocity: moves,
        rotation: turn * eye.rotation,
        aim,
        ..eye.clone()
    }
}

fn target(boost: Velocity, rest_from_lab: Poincare<Rest, Lab>, place: DVec3) -> Aim {
    let (moves, turn) = velocity(boost, rest_from_lab.boost().velocity());
    let origin = event(boost, rest_from_lab.origin());
    Aim::At { rest_from_lab: Poincare::to_moving(moves, origin), place: turn * place }
}

/// A sight ray as the new lab sees it, in units of who stands still there.
pub(crate) fn ray(boost: Velocity, ray: &SightRay) -> SightRay {
    let k = Boost::<Lab, Lab>::to_moving(boost) * ray.k;
    SightRay { event: event(boost, ray.event), k: k * (1.0 / k.t) }
}
