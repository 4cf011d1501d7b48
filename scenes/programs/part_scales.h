// SPDX-License-Identifier: MIT
// PartScales: at which resolution each frame draws the parts of it that have one of their own: the shadow map and the
// particles. Either a fixed scale, or a controller of that part alone that holds a budget of milliseconds.
//
//   for each frame:  scales.choose(view);
//                    renderer.draw(targets, view, scales.parts(index, particle targets));
//                    scales.learn();
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "programs/part_controller.h"
#include "render/renderer.h"

namespace quincunx::scenes {

struct PartSettings {
  float scale = 1;       // per axis, in [kLeastPartScale, 1]; not read where a controller chooses
  double budget_ms = 0;  // of OpenGL's work on it, by a controller; 0: the scale is fixed

  bool is_controlled() const { return budget_ms > 0; }
  friend bool operator==(const PartSettings&, const PartSettings&) = default;
};

struct PartsSettings {
  PartSettings shadow;  // of the side of the shadow map
  // Of the viewport of particles: a fixed scale is one of the frame's viewport, a controller chooses one that is never
  // larger. Absent: they are drawn with everything else.
  std::optional<PartSettings> particles = {};

  friend bool operator==(const PartsSettings&, const PartsSettings&) = default;
};

// A line for each part, as ResolvePlan::explain() words them.
std::string explain(const PartsSettings& settings, bool has_particles);

// Of targets that hold the particles of every frame that is drawn in targets of the extent `target`; 0x0 where
// particles are drawn with everything else.
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

  // What was used so far: "shadow map 0.25 to 1, mean 0.61, held at 1.67 ms; particles 0.5".
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

}  // namespace quincunx::scenes
