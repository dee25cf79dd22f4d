//! The library in the FMU of the example `bouncing_ball`.

#[path = "bouncing_ball.rs"]
pub mod bouncing_ball;
