// SPDX-License-Identifier: MIT
// Parts of a frame that follow a resolution of their own: the shadow map and the particles (PartScales), and the detail
// of the scene (FrameDetail).
//
//   for each frame:  scales.choose(view);
//                    renderer.draw(targets, view, scales.parts(index, particle targets));
//                    scales.learn();
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "quincunx/control/detail_follower.h"
#include "quincunx/control/resolution_controller.h"
#include "render/renderer.h"

namespace quincunx::scenes {

// Holds the time that one part of a frame takes, by the part's own resolution: the predictive controller on a ladder of
// the part's own. It learns from the times of that part what it would cost in full, how much of that does not scale,
// and how noisy it is. Pure; one thread.
class PartController {
 public:
  // `whole`: the part's largest extent. `step`: by which a side grows or shrinks, texels. Errors: kInvalidArgument for
  // an empty extent, a step below 1 or a budget outside (0, ResolutionController::kMaxMs].
  static Result<PartController> create(Extent whole, int step, double budget_ms);

  Extent next() const { return controller_->next(); }

  // A part of frame `frame` at `extent` took so long. What is late, or no time, changes nothing.
  void learn(std::uint64_t frame, Extent extent, double ms);

 private:
  explicit PartController(std::unique_ptr<ResolutionController> controller)
      : controller_(std::move(controller)) {}

  std::unique_ptr<ResolutionController> controller_;
};

// Either a fixed scale, or a controller of that part alone that holds a budget of milliseconds.
struct PartSettings {
  float scale = 1;       // per axis, in [kLeastPartScale, 1]; not read where a controller chooses
  double budget_ms = 0;  // OpenGL time for it, kept by a controller; 0: the scale is fixed

  bool is_controlled() const { return budget_ms > 0; }
  friend bool operator==(const PartSettings&, const PartSettings&) = default;
};

struct PartsSettings {
  PartSettings shadow;  // scale of the shadow map's side
  // The viewport of particles: a fixed scale is part of the frame's viewport, a controller chooses one that is never
  // larger. Absent: particles are drawn with everything else.
  std::optional<PartSettings> particles = {};

  friend bool operator==(const PartsSettings&, const PartsSettings&) = default;
};

// A line for each part, as ResolvePlan::explain() words them.
std::string explain(const PartsSettings& settings, bool has_particles);

// Returns the extent of targets that hold the particles of every frame that is drawn in targets of the extent `target`;
// 0x0 where particles are drawn with everything else.
Extent particle_target(const PartsSettings& settings, Extent target);

class PartScales {
 public:
  // `target`: of the frames. The context is current and stays longer than this object; one thread, that of the context.
  // Errors: of the controllers and timers, as they word them.
  static Result<PartScales> create(const PartsSettings& settings, Extent target);

  // Sets what the next frame draws its parts at.
  void choose(FrameView& view);

  // For Renderer::draw(), frame `index`: with timers of the parts that are controlled.
  FrameParts parts(std::int64_t index, const gl::RenderTargets* particle_targets);

  // Takes the times that have come back.
  void learn();

  // Names the scales used so far: "shadow map 0.25 to 1, mean 0.61, held at 1.67 ms; particles 0.5".
  std::string summary() const;

 private:
  // A part under a controller, and what it has chosen.
  struct Controlled {
    PartController controller;
    gl::PartTimer timer;
    float least = 1;
    float largest = 0;
    double sum = 0;
    std::int64_t count = 0;

    void note(float scale);
    void learn();
    std::string range() const;
  };

  explicit PartScales(const PartsSettings& settings) : settings_(settings) {}

  PartsSettings settings_;
  std::optional<Controlled> shadow_;
  std::optional<Controlled> particles_;
};

// Lets the detail of a scene follow the resolution. There are four levels. At each, surfaces that span another .8 % of
// the picture's height are left out, and the shadows of what moves are drawn less often: in every frame, every second,
// third or fourth one. Called once a frame, in order; one thread.
class FrameDetail {
 public:
  static Result<FrameDetail> create();

  // Takes the area fraction that `view` is drawn at into account, and takes detail from it.
  void follow(double area_fraction, FrameView& view);

  int level() const { return follower_.level(); }  // 0: full detail

 private:
  explicit FrameDetail(const DetailFollower& follower) : follower_(follower) {}

  DetailFollower follower_;
};

}  // namespace quincunx::scenes
