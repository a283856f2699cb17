//! Which level to draw.

use decimesh::coarsest_within;
use decimesh::lod::View;

#[test]
fn an_error_covers_the_pixels_that_it_was_allowed() {
    let view = View { fov: std::f32::consts::FRAC_PI_2, height: 1000.0 };
    // At a right angle, what is seen is twice as high as it is far.
    assert!((view.error_at(10.0, 1.0) - 0.02).abs() < 1e-6);
    assert!((view.pixels_at(10.0, 0.02) - 1.0).abs() < 1e-4);
    assert_eq!(view.error_at(20.0, 3.0), 6.0 * view.error_at(10.0, 1.0));
}

#[test]
fn the_coarsest_level_that_is_good_enough() {
    let errors = [0.0, 0.5, 0.5, 2.0];
    for (max_error, level) in [(0.0, Some(0)), (0.4, Some(0)), (0.5, Some(2)), (9.0, Some(3)), (-1.0, None)] {
        assert_eq!(coarsest_within(errors.into_iter(), max_error), level);
    }
}
