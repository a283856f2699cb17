//! Which level of a chain is good enough from where one stands.

/// A perspective camera and its screen.
///
/// At a distance d it sees a slice of the world that is 2 d tan(fov / 2) high, on `height` pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Vertical field of view in radians, above 0 and below π.
    pub fov: f32,
    /// Height of the screen in pixels.
    pub height: f32,
}

impl View {
    /// The error, in the unit of `distance`, that looks as large as `pixels` from this far.
    ///
    /// `distance` is that to the nearest point of the object, where an error looks largest: such as the one
    /// to the middle of its bounding sphere less the radius.
    pub fn error_at(&self, distance: f32, pixels: f32) -> f32 {
        pixels * self.pixel_at(distance)
    }

    /// How many pixels an `error`, in the unit of `distance`, covers from this far.
    pub fn pixels_at(&self, distance: f32, error: f32) -> f32 {
        error / self.pixel_at(distance)
    }

    fn pixel_at(&self, distance: f32) -> f32 {
        2.0 * distance * (self.fov / 2.0).tan() / self.height
    }
}

/// Which level of a chain to draw: the coarsest whose error is at most `max_error`; `None` if none is so
/// good. `errors` are those of the levels ([`Simplified::error`](crate::Simplified::error),
/// [`Level::error`](super::Level::error)), from fine to coarse, all in units of the positions.
/// [`View::error_at`] says which error can be seen.
pub fn coarsest_within(
    mut errors: impl DoubleEndedIterator<Item = f32> + ExactSizeIterator,
    max_error: f32,
) -> Option<usize> {
    errors.rposition(|error| error <= max_error)
}
