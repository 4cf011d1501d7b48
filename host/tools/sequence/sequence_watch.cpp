// SPDX-License-Identifier: MIT
#include "tools/sequence/sequence_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "tools/sequence/sequence_camera.h"

namespace quincunx::tools {
namespace {

constexpr int kCell = 16;  // pixels

// The jitter shifts a picture by a pixel at most in x and in y. That changes the mean of a cell of values in [0, 1] by
// no more than 2 kCell / kCell^2: what changes more has moved, or other light falls on it.
constexpr float kMostByJitter = 2.0f / kCell;

// As far_velocity.cl has it: depths up to this are infinitely far away.
constexpr float kFarDepth = 1e-9f;

// Infinity and what is no number become some large number.
float from_half(std::uint16_t half) {
  const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(half & 0x7fffu) << 13) * 0x1p112f;
  return (half & 0x8000u) != 0 ? -value : value;
}

float tone_mapped(float value) {
  return value > 0 ? 1 - 1 / (1 + value) : 0;  // NaN is 0
}

bool is_at_rest(Vec2 motion) {
  return motion.x == 0 && motion.y == 0;
}

// Where the previous frame had a point of this one that is infinitely far away; both in normalised coordinates.
Vec2 previous_place(const CameraMotion& motion, Vec2 at) {
  const auto& m = motion.clip_to_previous_clip;
  const float w = m[3] * at.x + m[7] * at.y + m[15];
  return {(m[0] * at.x + m[4] * at.y + m[12]) / w, (m[1] * at.x + m[5] * at.y + m[13]) / w};
}

// How far the camera's turning moves the sky, in pixels, at the most of five places of the picture.
float sky_motion(const CameraMotion& motion, Extent render) {
  float most = 0;
  for (const Vec2 at : {Vec2{0, 0}, Vec2{.7f, .7f}, Vec2{-.7f, .7f}, Vec2{.7f, -.7f}, Vec2{-.7f, -.7f}}) {
    const Vec2 was = previous_place(motion, at);
    const float x = (at.x - was.x) * static_cast<float>(render.width) / 2;
    const float y = (at.y - was.y) * static_cast<float>(render.height) / 2;
    most = std::max(most, std::hypot(x, y));
  }
  return most;
}

}  // namespace

std::vector<std::string> SequenceWatch::see(const SequenceFrame& frame, bool reset) {
  std::vector<std::string> sentences = {see_motion(frame, reset), see_sky(frame, reset)};
  std::erase(sentences, "");
  last_world_to_ndc_ = frame.world_to_ndc;
  return sentences;
}

std::string SequenceWatch::see_motion(const SequenceFrame& frame, bool reset) {
  if (motion_is_known_ || frame.velocity.empty()) return {};
  motion_is_known_ = !std::all_of(frame.velocity.begin(), frame.velocity.end(), is_at_rest);
  if (motion_is_known_) return {};
  Cells now = cells_of(frame);
  if (reset || !first_ || first_->render != frame.render) {
    first_ = std::move(now);
    return {};
  }
  for (std::size_t i = 0; i < now.means.size(); ++i)
    motion_is_known_ |= std::abs(now.means[i] - first_->means[i]) > kMostByJitter;
  if (!motion_is_known_) return {};
  return fmt::format(
      "motion is 0 in every pixel of frames {} to {}, although their pictures differ: if the renderer "
      "blurs motion itself, as Blender can, it writes none; turn that off",
      first_->number, now.number);
}

std::string SequenceWatch::see_sky(const SequenceFrame& frame, bool reset) {
  constexpr float kLeastMotion = .25f;  // pixels
  constexpr int kLeastPart = 100;       // one pixel of so many
  const bool asked = plan_.settings.far == FarMotion::kAsDrawn && !sky_is_known_ && !reset;
  if (!asked || !frame.world_to_ndc || !last_world_to_ndc_ || frame.velocity.empty() || frame.depth.empty())
    return {};
  const auto camera = camera_motion(*frame.world_to_ndc, *last_world_to_ndc_, near_plane_);
  if (!camera || !(sky_motion(*camera, frame.render) >= kLeastMotion)) return {};
  std::size_t resting = 0;
  for (std::size_t i = 0; i < frame.depth.size(); ++i)
    resting += frame.depth[i] <= kFarDepth && is_at_rest(frame.velocity[i]) ? 1 : 0;
  if (resting * kLeastPart < frame.depth.size()) return {};
  sky_is_known_ = true;
  return fmt::format(
      "the sky of frame {} has a motion of 0, although the camera turns: --far camera moves it",
      frame.number);
}

SequenceWatch::Cells SequenceWatch::cells_of(const SequenceFrame& frame) const {
  const bool half = plan_.settings.colour == PixelFormat::kRGBA16F;
  const auto value = [&](std::size_t index) {
    std::uint16_t bits = 0;
    float number = 0;
    if (half) {
      std::memcpy(&bits, frame.colour.data() + index * sizeof bits, sizeof bits);
      return tone_mapped(from_half(bits));
    }
    std::memcpy(&number, frame.colour.data() + index * sizeof number, sizeof number);
    return tone_mapped(number);
  };
  const int across = frame.render.width / kCell, down = frame.render.height / kCell;
  Cells cells = {frame.number, frame.render, std::vector<float>(static_cast<std::size_t>(across) * down)};
  for (int y = 0; y < down * kCell; ++y) {
    for (int x = 0; x < across * kCell; ++x) {
      const std::size_t pixel =
          static_cast<std::size_t>(y) * frame.render.width + static_cast<std::size_t>(x);
      float& mean =
          cells.means[static_cast<std::size_t>(y / kCell) * across + static_cast<std::size_t>(x / kCell)];
      for (std::size_t c = 0; c < 3; ++c)
        mean += value(pixel * 4 + c) / (3.0f * kCell * kCell);
    }
  }
  return cells;
}

}  // namespace quincunx::tools
