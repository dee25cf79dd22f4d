//! The flexible rocking model and its solver.
