#include "camera.hpp"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace viewer {

namespace {

/// Of the shorter side of the picture, in degrees.
constexpr float field_of_view = 35;
constexpr float nearest = 0.02F;
constexpr float farthest = 20;
constexpr float highest = 89;

float tangent() {
    return std::tan(glm::radians(field_of_view) / 2);
}

}   // namespace

void Camera::orbit(float right, float up) {
    yaw_ = std::remainder(yaw_ + right, 360.0F);
    pitch_ = std::clamp(pitch_ + up, -highest, highest);
}

void Camera::pan(float right, float up) {
    const glm::mat4 to_eye = view();
    const glm::vec3 eye_right{to_eye[0][0], to_eye[1][0], to_eye[2][0]};
    const glm::vec3 eye_up{to_eye[0][1], to_eye[1][1], to_eye[2][1]};
    const float height = 2 * distance_ * tangent();
    looked_at_ -= height * (right * eye_right + up * eye_up);
}

void Camera::zoom(float steps) {
    distance_ = std::clamp(distance_ * std::pow(0.9F, steps), nearest, farthest);
}

glm::mat4 Camera::view() const {
    const float yaw = glm::radians(yaw_);
    const float pitch = glm::radians(pitch_);
    const glm::vec3 outwards{std::cos(pitch) * std::sin(yaw), std::sin(pitch), std::cos(pitch) * std::cos(yaw)};
    return glm::lookAt(looked_at_ + distance_ * outwards, looked_at_, glm::vec3{0, 1, 0});
}

glm::mat4 Camera::projection(float aspect) const {
    const float half_height = tangent() / std::min(aspect, 1.0F);
    // Planes that go with the distance leave the depth its digits, near and far.
    const float closest = std::max(distance_ - 2, distance_ / 100);
    return glm::perspective(2 * std::atan(half_height), aspect, closest, distance_ + 4);
}

}   // namespace viewer
