// SPDX-License-Identifier: MIT
#include "frames/focus_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>

#include "quincunx/advanced/focus.h"
#include "render/view_math.h"
#include "tools/program/command_line.h"

namespace quincunx::scenes {
namespace {

constexpr int kGuard =
    8;  // pixels of the region around what is shown: resolves look at neighbours and history
constexpr int kObjectMargin =
    static_cast<int>(FocusInputs::kDefaultFeather);  // so that all of it has the full weight
constexpr int kPointerPart = 4;                      // the picture's sides over those of the pointer's box
constexpr std::int64_t kLooks = 256;                 // at most, for the largest size of an object

std::optional<Rectangle> rectangle_in(const std::string& text) {
  std::array<int, 4> values = {};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto read = std::from_chars(at, end, values[i]);
    const bool last = i + 1 == values.size();
    if (read.ec != std::errc() || (last ? read.ptr != end : read.ptr == end || *read.ptr != ','))
      return std::nullopt;
    at = read.ptr + 1;
  }
  return Rectangle{values[0], values[1], values[2], values[3]};
}

// Returns the part of the pixels from (left, top) up to (right, bottom) that lies in the picture; nothing where that is
// empty.
std::optional<Rectangle> within(Extent picture, double left, double top, double right, double bottom) {
  const int x = static_cast<int>(std::clamp(std::floor(left), 0.0, static_cast<double>(picture.width)));
  const int y = static_cast<int>(std::clamp(std::floor(top), 0.0, static_cast<double>(picture.height)));
  const int end_x = static_cast<int>(std::clamp(std::ceil(right), 0.0, static_cast<double>(picture.width)));
  const int end_y = static_cast<int>(std::clamp(std::ceil(bottom), 0.0, static_cast<double>(picture.height)));
  if (end_x <= x || end_y <= y) return std::nullopt;
  return Rectangle{x, y, end_x - x, end_y - y};
}

// The part of an axis that the region takes, and what of it shows; `size` is the region's.
struct Span {
  int from, shown_from, shown_size;
};
Span place_on_axis(int wanted, int wanted_size, int size, int picture) {
  const int shown = std::min(wanted_size, size);
  const int shown_from = wanted + (wanted_size - shown) / 2;
  return {std::clamp(shown_from - (size - shown) / 2, 0, picture - size), shown_from, shown};
}

// The bounds of points in clip space, in pixels of the picture.
struct ScreenBounds {
  glm::dvec2 low{1e9}, high{-1e9};

  void add(const glm::dvec4& clip, Extent output) {
    const glm::dvec2 place(.5 + .5 * clip.x / clip.w, .5 - .5 * clip.y / clip.w);
    const glm::dvec2 pixel = place * glm::dvec2(output.width, output.height);
    low = glm::min(low, pixel);
    high = glm::max(high, pixel);
  }
};

// Depth is near / w: what lies before the near plane has w < near, and an edge that crosses it is cut there.
void add_edge(ScreenBounds& bounds, glm::dvec4 a, glm::dvec4 b, double near_plane, Extent output) {
  if (a.w > b.w) std::swap(a, b);
  if (b.w < near_plane) return;
  if (a.w < near_plane) a = glm::mix(a, b, (near_plane - a.w) / (b.w - a.w));
  bounds.add(a, output);
  bounds.add(b, output);
}

void add_box(ScreenBounds& bounds, const Bounds& box, const glm::dmat4& clip_from_box, double near_plane,
             Extent output) {
  std::array<glm::dvec4, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 corner((i & 1) != 0 ? box.high.x : box.low.x, (i & 2) != 0 ? box.high.y : box.low.y,
                            (i & 4) != 0 ? box.high.z : box.low.z);
    corners[i] = clip_from_box * glm::dvec4(corner, 1);
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (const std::size_t axis : {1u, 2u, 4u}) {
      if ((i & axis) == 0) add_edge(bounds, corners[i], corners[i | axis], near_plane, output);
    }
  }
}

}  // namespace

Result<FocusTarget> FocusTarget::parse(const std::string& text, Extent output) {
  FocusTarget target;
  target.rectangle = rectangle_in(text);
  target.pointer = text == kFocusPointer;
  if (!target.rectangle) {
    if (!target.pointer) target.object = text;
    return target;
  }
  const auto [x, y, width, height] = *target.rectangle;
  if (x >= 0 && y >= 0 && width >= 1 && height >= 1 && width <= output.width - x &&
      height <= output.height - y)
    return target;
  return Status::invalid(
      fmt::format("--focus {} is no rectangle within the picture of {}x{}; write X,Y,W,H in its pixels", text,
                  output.width, output.height));
}

FocusPath::FocusPath(const FocusTarget& target, const Scene& scene, Extent output)
    : target_(target), scene_(&scene), output_(output) {}

Result<FocusPath> FocusPath::create(const FocusTarget& target, const Scene& scene, Extent output,
                                    const FocusTimes& times) {
  FocusPath path(target, scene, output);
  if (!target.object.empty()) {
    if (Status status = path.find_object(); !status.ok()) return status;
  }
  if (Status status = path.fit_region(times); !status.ok()) return status;
  return path;
}

Status FocusPath::find_object() {
  std::set<std::string> names;
  for (std::size_t i = 0; i < scene_->instances.size(); ++i) {
    const Instance& instance = scene_->instances[i];
    if (!instance.name.empty()) names.insert(instance.name);
    if (instance.name != target_.object) continue;
    parts_.push_back(
        {static_cast<int>(i), bounds_of(scene_->meshes[static_cast<std::size_t>(instance.mesh)])});
  }
  if (!parts_.empty()) return {};
  return Status::invalid(
      fmt::format("--focus: the scene '{}' has no object '{}'; it has {}{}", scene_->name, target_.object,
                  names.empty() ? "none with a name" : fmt::format("{}", fmt::join(names, ", ")),
                  tools::did_you_mean(target_.object, {names.begin(), names.end()})));
}

// One size for all frames, so that the region keeps its memory and its history.
Status FocusPath::fit_region(const FocusTimes& times) {
  Extent largest;
  if (target_.pointer) {
    largest = {std::max(output_.width / kPointerPart, 1), std::max(output_.height / kPointerPart, 1)};
  }
  const std::int64_t looks = target_.object.empty() ? 1 : std::min(times.count, kLooks);
  for (std::int64_t look = 0; look < looks && !target_.pointer; ++look) {
    const auto frame = static_cast<double>(look * std::max<std::int64_t>(times.count - 1, 1) /
                                           std::max<std::int64_t>(looks - 1, 1));
    const auto wanted = wanted_at(times.start + frame * times.step, std::nullopt);
    if (!wanted) continue;
    largest.width = std::max(largest.width, wanted->width);
    largest.height = std::max(largest.height, wanted->height);
  }
  if (largest.area() == 0 && !target_.object.empty())
    return Status::invalid(
        fmt::format("--focus: the object '{}' is never in the picture in these frames", target_.object));
  if (largest.area() == 0) return {};  // a rectangle beyond a window that has become small
  region_ = {std::min(largest.width + 2 * kGuard, output_.width),
             std::min(largest.height + 2 * kGuard, output_.height)};
  return {};
}

std::optional<Rectangle> FocusPath::wanted_at(double seconds, const std::optional<Vec2>& pointer) const {
  if (target_.rectangle) {
    const auto [x, y, width, height] = *target_.rectangle;
    return within(output_, x, y, static_cast<double>(x) + width, static_cast<double>(y) + height);
  }
  if (!target_.pointer) return object_at(seconds);
  if (!pointer) return std::nullopt;
  const double half_width = output_.width / kPointerPart / 2;
  const double half_height = output_.height / kPointerPart / 2;
  return within(output_, pointer->x - half_width, pointer->y - half_height, pointer->x + half_width,
                pointer->y + half_height);
}

std::optional<Rectangle> FocusPath::object_at(double seconds) const {
  const Camera camera = scene_->camera(seconds);
  const ViewMatrices view =
      view_of(camera, static_cast<float>(output_.width) / static_cast<float>(output_.height));
  ScreenBounds bounds;
  for (const Part& part : parts_) {
    const Instance& instance = scene_->instances[static_cast<std::size_t>(part.instance)];
    const glm::dmat4 world = instance.motion ? instance.motion(seconds) : instance.transform;
    add_box(bounds, part.box, view.clip_from_camera * view.camera_from_world * world, camera.near_plane,
            output_);
  }
  if (bounds.low.x > bounds.high.x ||
      !within(output_, bounds.low.x, bounds.low.y, bounds.high.x, bounds.high.y))
    return std::nullopt;
  return within(output_, bounds.low.x - kObjectMargin, bounds.low.y - kObjectMargin,
                bounds.high.x + kObjectMargin, bounds.high.y + kObjectMargin);
}

std::optional<FocusPlace> FocusPath::at(double seconds, const std::optional<Vec2>& pointer) const {
  const auto wanted = wanted_at(seconds, pointer);
  if (!wanted || region_.area() == 0) return std::nullopt;
  const Span across = place_on_axis(wanted->x, wanted->width, region_.width, output_.width);
  const Span down = place_on_axis(wanted->y, wanted->height, region_.height, output_.height);
  return FocusPlace{{across.from, down.from, region_.width, region_.height},
                    {across.shown_from, down.shown_from, across.shown_size, down.shown_size}};
}

Result<std::optional<FocusRegion>> FocusRegion::create(const FocusOptions& options, const Scene& scene,
                                                       const SequenceSettings& picture) {
  FocusTimes times = {picture.start_seconds, 1 / picture.fps, picture.frames};
  if (options.endless) times.count = static_cast<std::int64_t>(std::ceil(scene.duration * picture.fps));
  auto path = FocusPath::create(*options.target, scene, picture.output, times);
  if (!path.ok()) return path.status();
  if (path->region().area() == 0) return std::optional<FocusRegion>();
  SequenceSettings region = picture;
  region.output = path->region();
  region.shading = Shading::kFull;
  auto scale = ScalePath::fixed({options.scale, options.scale});
  if (!scale.ok()) return scale.status();
  region.scale_path = scale.value();
  auto sequence = FrameSequence::create(region);
  if (!sequence.ok()) return sequence.status();
  return std::optional<FocusRegion>(FocusRegion(path.value(), sequence.value(), picture.output));
}

ViewWindow FocusRegion::window_of(const Rectangle& region) const {
  const glm::dvec2 picture(output_.width, output_.height);
  return {glm::dvec2(region.x, region.y) / picture, glm::dvec2(region.width, region.height) / picture};
}

std::optional<FocusFrame> FocusRegion::at(std::int64_t index, const FrameView& picture, bool reset) {
  const std::optional<FocusPlace> place = path_.at(picture.seconds, pointer_);
  if (!place) {
    previous_.reset();
    return std::nullopt;
  }
  const bool follows = previous_.has_value() && !reset;
  const Rectangle previous = follows ? *previous_ : place->region;
  previous_ = place->region;
  FocusFrame frame = {.view = picture, .place = *place, .reset = !follows};
  const FrameView own = sequence_.at(index);
  frame.view.render = own.render;
  frame.view.jitter = own.jitter;
  frame.view.lod_bias = own.lod_bias;
  frame.view.parity = {};
  frame.view.least_size = 0;
  frame.view.particles = {};  // with everything else
  frame.view.window = window_of(place->region);
  frame.view.previous_window = window_of(previous);
  return frame;
}

}  // namespace quincunx::scenes
