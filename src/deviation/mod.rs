//! Measured distance between two surfaces.
