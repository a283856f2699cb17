/// The camera that all views share.

#ifndef VIEWER_CAMERA_HPP
#define VIEWER_CAMERA_HPP

#include <glm/glm.hpp>

namespace viewer {

/// Looks at a point that it goes around. Lengths are those of a `Frame`, in which a mesh has a diagonal of 1; y is up.
class Camera {
public:
    /// Goes around by so many degrees to the right, and up. It stays short of the poles, where up is nowhere.
    void orbit(float right, float up);

    /// Moves what it looks at by so many heights of the picture.
    void pan(float right, float up);

    /// Goes nearer by so many steps of a wheel, or away where they are negative.
    void zoom(float steps);

    float yaw() const noexcept { return yaw_; }
    float pitch() const noexcept { return pitch_; }
    float distance() const noexcept { return distance_; }

    /// From the frame to the eye, which looks along -z.
    glm::mat4 view() const;

    /// From the eye to OpenGL's cube, for a picture that is `aspect` times as wide as high. A mesh that is looked at
    /// from the first distance is in the picture whole, however narrow that is.
    glm::mat4 projection(float aspect) const;

private:
    glm::vec3 looked_at_{0};
    float yaw_ = 25;
    float pitch_ = 15;
    float distance_ = 1.7F;
};

}   // namespace viewer

#endif
