//! Speed against accuracy, limits of stability and a gallery of failures, for the flexible rocking structure.

pub mod engine;
pub mod equations;
pub mod failures;
pub mod fixed_step;
pub mod guards;
pub mod hybrid;
pub mod libraries;
pub mod precision;
pub mod response;
pub mod scene;
pub mod stability;
pub mod tables;
pub mod validity;
