// SPDX-License-Identifier: MIT
// Ways to break whole frames, for the tests of diagnose() and for its proof over built-in scenes. Frames are those of
// the exchange format: velocity as nuke has it, linear depth.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tools/diagnose/findings.h"

namespace quincunx::testing {

using tools::DiagnosedFrame;
using Frames = std::vector<DiagnosedFrame>;

struct Fault {
  std::string name;  // "velocity: sign of x", as diagnose() names it
  std::function<void(Frames&)> apply;
  std::function<void(tools::DiagnosedInput&)> say = [](tools::DiagnosedInput&) {
  };                   // what the input says then
  bool draws = false;  // motion of its own
};

inline std::function<void(Frames&)> velocity(const std::function<Vec2(Vec2, Extent)>& change) {
  return [change](Frames& frames) {
    for (DiagnosedFrame& frame : frames)
      for (Vec2& v : frame.velocity)
        v = change(v, frame.render);
  };
}

inline std::function<void(Frames&)> jitter(const std::function<Vec2(Vec2)>& change) {
  return [change](Frames& frames) {
    for (DiagnosedFrame& frame : frames)
      frame.jitter = change(frame.jitter);
  };
}

inline void jitter_into_velocity(Frames& frames) {
  for (std::size_t i = frames.size(); i-- > 1;) {
    const float x = frames[i].jitter.x - frames[i - 1].jitter.x,
                y = frames[i].jitter.y - frames[i - 1].jitter.y;
    for (Vec2& v : frames[i].velocity)
      v = {v.x + x, v.y - y};
  }
  frames.erase(frames.begin());
}

inline void device_depth(Frames& frames, float near_plane, bool reversed) {
  for (DiagnosedFrame& frame : frames)
    for (float& d : frame.depth) {
      const float device = d < 1e9f ? near_plane / d : 0;
      d = reversed ? device : 1 - device;
    }
}

inline void dilate(Frames& frames) {
  for (DiagnosedFrame& frame : frames) {
    const std::vector<Vec2> own = frame.velocity;
    const int width = frame.render.width, height = frame.render.height;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        std::size_t nearest = static_cast<std::size_t>(y * width + x);
        for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height - 1); ++j)
          for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width - 1); ++i)
            if (frame.depth[static_cast<std::size_t>(j * width + i)] < frame.depth[nearest])
              nearest = static_cast<std::size_t>(j * width + i);
        frame.velocity[static_cast<std::size_t>(y * width + x)] = own[nearest];
      }
    }
  }
}

// Things that move by themselves get the motion of what is at rest: the camera's, or 0.
inline void stop_objects(Frames& frames, float near_plane, bool zero) {
  for (std::size_t i = frames.size(); i-- > 1;) {
    DiagnosedFrame& frame = frames[i];
    const auto camera = tools::camera_motion(*frame.world_to_ndc, *frames[i - 1].world_to_ndc, near_plane);
    for (int y = 0; y < frame.render.height; ++y) {
      for (int x = 0; x < frame.render.width; ++x) {
        const auto at = static_cast<std::size_t>(y * frame.render.width + x);
        if (frame.depth[at] >= 1e9f) continue;
        const Vec2 moved = tools::camera_moves(
            *camera,
            {static_cast<float>(x) + .5f + frame.jitter.x, static_cast<float>(y) + .5f + frame.jitter.y},
            near_plane / frame.depth[at], frame.render);
        const Vec2 rests = {-moved.x, moved.y};
        Vec2& v = frame.velocity[at];
        if (std::hypot(v.x - rests.x, v.y - rests.y) > .3f) v = zero ? Vec2{} : rests;
      }
    }
  }
  frames.erase(frames.begin());
}

// As a screen wants it: the middle light at .18, white cut off, sRGB; in steps of 8 bits where that is asked for.
inline void encode(Frames& frames, bool in_steps) {
  const float scale = .36f * tools::light_scale(frames);
  const auto encoded = [&](float value) {
    const float light = value > 0 ? std::min(value * scale, 1.0f) : 0;
    const float screen = light <= .0031308f ? light * 12.92f : 1.055f * std::pow(light, 1 / 2.4f) - .055f;
    return in_steps ? std::round(screen * 255) / 255 : screen;
  };
  for (DiagnosedFrame& frame : frames) {
    for (std::size_t i = 0; i < frame.luminance.size(); ++i) {
      frame.luminance[i] = encoded(frame.luminance[i]);
      if (frame.colour.empty()) continue;
      auto& c = frame.colour[i];
      c = {encoded(c[0]), encoded(c[1]), encoded(c[2])};
      frame.luminance[i] = .2126f * c[0] + .7152f * c[1] + .0722f * c[2];
    }
  }
}

// 1 2 1 in both directions, of luminance.
inline void blur(Frames& frames) {
  for (DiagnosedFrame& frame : frames) {
    const int width = frame.render.width, height = frame.render.height;
    for (const bool down : {false, true}) {
      const std::vector<float> sharp = frame.luminance;
      const auto at = [&](int x, int y) {
        x = std::clamp(x, 0, width - 1), y = std::clamp(y, 0, height - 1);
        return sharp[static_cast<std::size_t>(y * width + x)];
      };
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          frame.luminance[static_cast<std::size_t>(y * width + x)] =
              .5f * at(x, y) + .25f * (down ? at(x, y - 1) + at(x, y + 1) : at(x - 1, y) + at(x + 1, y));
    }
  }
}

// Returns every single fault, in the order in which two are applied: those that look at whole frames come first.
// `near_plane`: of the frames' device depth.
inline std::vector<Fault> faults(float near_plane) {
  return {
      {"cuts: unmarked",
       [](Frames& frames) {  // the second half is another shot: the same upside down
         for (std::size_t i = frames.size() / 2; i < frames.size(); ++i) {
           DiagnosedFrame& frame = frames[i];
           std::reverse(frame.luminance.begin(), frame.luminance.end());
           std::reverse(frame.colour.begin(), frame.colour.end());
           std::reverse(frame.velocity.begin(), frame.velocity.end());
           std::reverse(frame.depth.begin(), frame.depth.end());
           for (Vec2& v : frame.velocity)
             v = {-v.x, -v.y};
           frame.jitter = {-frame.jitter.x, -frame.jitter.y};
           for (std::size_t k : {0, 1, 4, 5, 8, 9, 12, 13})
             (*frame.world_to_ndc)[k] *= -1;
         }
       }},
      {.name = "objects: at rest",
       .apply = [near_plane](Frames& frames) { stop_objects(frames, near_plane, false); },
       .draws = true},
      {.name = "objects: at rest",
       .apply = [near_plane](Frames& frames) { stop_objects(frames, near_plane, true); },
       .draws = true},
      {"dilation: dilated", dilate},
      {"sky: at rest",
       [](Frames& frames) {
         for (DiagnosedFrame& frame : frames)
           for (std::size_t i = 0; i < frame.depth.size(); ++i)
             if (frame.depth[i] >= 1e9f) frame.velocity[i] = {};
       }},
      {"velocity's size: half",
       [](Frames& frames) {
         for (DiagnosedFrame& frame : frames)
           for (int y = 0; y < frame.render.height; ++y)
             for (int x = 0; x < frame.render.width; ++x)
               frame.velocity[static_cast<std::size_t>(y * frame.render.width + x)] =
                   frame.velocity[static_cast<std::size_t>(y / 2 * 2 * frame.render.width + x / 2 * 2)];
       }},
      {.name = "velocity: jitter in it", .apply = jitter_into_velocity, .draws = true},
      {"velocity: sign of x", velocity([](Vec2 v, Extent) {
         return Vec2{-v.x, v.y};
       })},
      {"velocity: sign of y", velocity([](Vec2 v, Extent) {
         return Vec2{v.x, -v.y};
       })},
      {"velocity: direction", velocity([](Vec2 v, Extent) {
         return Vec2{-v.x, -v.y};
       })},
      {"velocity: axes", velocity([](Vec2 v, Extent) {
         return Vec2{v.y, v.x};
       })},
      {"velocity: unit", velocity([](Vec2 v, Extent e) {
         return Vec2{v.x / static_cast<float>(e.width), v.y / static_cast<float>(e.height)};
       })},
      {"velocity: unit", velocity([](Vec2 v, Extent e) {
         return Vec2{2 * v.x / static_cast<float>(e.width), 2 * v.y / static_cast<float>(e.height)};
       })},
      {"velocity: unit", velocity([](Vec2 v, Extent) {
         return Vec2{2 * v.x, 2 * v.y};
       })},
      {"velocity: frame",
       [](Frames& frames) {
         for (std::size_t i = frames.size(); i-- > 1;)
           frames[i].velocity = frames[i - 1].velocity;
         frames.erase(frames.begin());
       }},
      {"jitter: sign of x", jitter([](Vec2 j) {
         return Vec2{-j.x, j.y};
       })},
      {"jitter: sign of y", jitter([](Vec2 j) {
         return Vec2{j.x, -j.y};
       })},
      {"jitter: sign", jitter([](Vec2 j) {
         return Vec2{-j.x, -j.y};
       })},
      {"jitter: axes", jitter([](Vec2 j) {
         return Vec2{j.y, j.x};
       })},
      {"jitter: scale", jitter([](Vec2 j) {
         return Vec2{j.x / 2, j.y / 2};
       })},
      {"jitter: scale", jitter([](Vec2 j) {
         return Vec2{j.x * 2, j.y * 2};
       })},
      {"jitter: pattern", jitter([](Vec2) { return Vec2{}; })},
      {"jitter: frame",
       [](Frames& frames) {
         for (std::size_t i = frames.size(); i-- > 1;)
           frames[i].jitter = frames[i - 1].jitter;
         frames.erase(frames.begin());
       }},
      {"depth: kind", [near_plane](Frames& frames) { device_depth(frames, near_plane, false); }},
      {"depth: kind", [near_plane](Frames& frames) { device_depth(frames, near_plane, true); }},
      {"depth: near plane", [near_plane](Frames& frames) { device_depth(frames, near_plane, true); },
       [](tools::DiagnosedInput& input) {
         input.depth_kind = tools::DepthKind::kDeviceReversed;
         input.near_plane *= 4;
       }},
      {"depth: near plane", [near_plane](Frames& frames) { device_depth(frames, near_plane, false); },
       [](tools::DiagnosedInput& input) {
         input.depth_kind = tools::DepthKind::kDevice;
         input.near_plane *= .3f;
       }},
      {"camera: transposed",
       [](Frames& frames) {
         for (DiagnosedFrame& frame : frames)
           for (std::size_t i = 0; i < 16; ++i)
             if (i / 4 < i % 4) std::swap((*frame.world_to_ndc)[i], (*frame.world_to_ndc)[i % 4 * 4 + i / 4]);
       }},
      {"camera: frame",
       [](Frames& frames) {
         for (std::size_t i = frames.size(); i-- > 1;)
           frames[i].world_to_ndc = frames[i - 1].world_to_ndc;
         frames.erase(frames.begin());
       }},
      {"exposure: jump",
       [](Frames& frames) {
         for (std::size_t i = frames.size() * 2 / 3; i < frames.size(); ++i)
           for (std::size_t k = 0; k < frames[i].luminance.size(); ++k) {
             frames[i].luminance[k] *= 1.2f;
             for (std::size_t c = 0; c < 3 && !frames[i].colour.empty(); ++c)
               frames[i].colour[k][c] *= 1.2f;
           }
       }},
      {"colour: encoded", [](Frames& frames) { encode(frames, false); }},
      {"colour: encoded", [](Frames& frames) { encode(frames, true); }},
      {"picture: filtered", blur},
  };
}

// Returns the faults that a diagnosis names, "velocity: axes + velocity: sign of x"; "none".
inline std::string named(const tools::Diagnosis& diagnosis) {
  std::string text;
  for (const tools::Finding& finding : diagnosis.findings) {
    for (const std::string& fault : finding.faults)
      text += (text.empty() ? "" : " + ") + finding.subject + ": " + fault;
  }
  return text.empty() ? "none" : text;
}

}  // namespace quincunx::testing
